#!/bin/bash
# Packs a build into DIST/tyndall-VERSION-linux-x86_64.tar.gz: programs, plugins, shaders, scenes, and every shared library
# that is not part of a Linux system with a GL driver. Usage: cmake/package.sh BUILD DIST
set -euo pipefail
build=$1
dist=$2

version=$(sed -n 's/^CMAKE_PROJECT_VERSION:STATIC=//p' "$build/CMakeCache.txt")
name=tyndall-$version-linux-x86_64
mkdir -p "$dist"
work=$(mktemp -d "$dist/.package.XXXXXX")
trap 'rm -rf "$work"' EXIT
root=$work/$name
cmake --install "$build" --prefix "$root" --strip >/dev/null
mkdir -p "$root/lib/compat" "$root/share/doc/tyndall/licenses"

# Part of every system, or of its GL driver and window system: a copy of ours would not fit the rest of theirs.
system='^(ld-linux.*|linux-vdso|lib(c|m|dl|rt|pthread|util|resolv|nsl|anl|mvec)|lib(GL|EGL|OpenGL|GLX|GLdispatch|GLESv2|gbm|drm|OSMesa|vulkan)[a-zA-Z_]*|lib(X11|X11-xcb|Xext|Xau|Xdmcp|Xi|Xrandr|Xcursor|Xinerama|Xfixes|Xrender|Xxf86vm|xcb)(-[a-z0-9]+)*|libwayland-[a-z]+|libxkbcommon)\.so'
# Younger is better, since the GL driver in the same process may need it: the system's is taken where there is one.
compat='^lib(stdc\+\+|gcc_s)\.so'

license_of() {
    local package
    package=$(dpkg-query --search "$1" 2>/dev/null | head -n 1 | cut -d : -f 1) || true
    if [[ -n $package && -f /usr/share/doc/$package/copyright ]]; then
        cp "/usr/share/doc/$package/copyright" "$root/share/doc/tyndall/licenses/$package.txt"
    fi
}

find "$root/bin" "$root/lib" -type f | xargs ldd 2>/dev/null | awk '$2 == "=>" && $3 ~ /^\// { print $1, $3 }' | sort -u |
    while read -r soname path; do
        [[ $soname =~ $system ]] && continue
        folder=$root/lib
        [[ $soname =~ $compat ]] && folder=$root/lib/compat
        cp --dereference "$path" "$folder/$soname"
        license_of "$(readlink --canonicalize "$path")"
    done

# Where each file looks: our libraries, then the system's folders, then lib/compat.
usual=/usr/lib/x86_64-linux-gnu:/usr/lib64:/usr/lib
set_path() { patchelf --set-rpath "$1:$usual:$2" "${@:3}"; }
chmod -R u+w "$root"
set_path '$ORIGIN/../lib' '$ORIGIN/../lib/compat' "$root"/bin/*
if compgen -G "$root/lib/*.so*" >/dev/null; then set_path '$ORIGIN' '$ORIGIN/compat' "$root"/lib/*.so*; fi
if compgen -G "$root/lib/tyndall/plugins/*.so" >/dev/null; then
    set_path '$ORIGIN/../..' '$ORIGIN/../../compat' "$root"/lib/tyndall/plugins/*.so
fi

# The same content gives the same file.
tar --create --sort=name --owner=0 --group=0 --numeric-owner --mtime='2026-01-01 00:00Z' --directory "$work" "$name" |
    gzip --no-name >"$work/$name.tar.gz"
mv "$work/$name.tar.gz" "$dist/$name.tar.gz"
echo "$dist/$name.tar.gz"
