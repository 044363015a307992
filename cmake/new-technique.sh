#!/usr/bin/env bash
# Makes a technique of the plugin volumetric_gi from cmake/technique. Usage: cmake/new-technique.sh NAME   (lower case, digits and underscores)
set -euo pipefail
cd "$(dirname "$0")/.."
name=${1:-}
if ! [[ $name =~ ^[a-z][a-z0-9_]*$ ]]; then
    echo "usage: cmake/new-technique.sh NAME, where NAME is made of a-z, 0-9 and _ and starts with a letter" >&2
    exit 2
fi
type=$(sed -E 's/(^|_)([a-z0-9])/\U\2/g' <<< "$name") # two_words: TwoWords
title=$(tr _ ' ' <<< "${name^}")
sources=plugins/volumetric_gi/$name
for taken in "$sources" "shaders/gi/$name" "shaders/shared/$name.h" "docs/techniques/$name.md"; do
    if [ -e "$taken" ]; then
        echo "$taken exists already: choose another name" >&2
        exit 2
    fi
done
if [[ $name =~ ^(auto|none|direct)$ ]] || grep -q "^    X($type)" plugins/volumetric_gi/plugin.cpp; then
    echo "'$name' means something else to --gi, or looks like another technique's name: choose another name" >&2
    exit 2
fi

# make TEMPLATE FILE
make() {
    mkdir -p "$(dirname "$2")"
    sed "s/@name@/$name/g; s/@Name@/$type/g; s/@NAME@/${name^^}/g; s/@title@/$title/g" "cmake/technique/$1" > "$2"
    echo "  $2"
}
echo "made:"
make technique.h "$sources/${name}_technique.h"
make technique.cpp "$sources/${name}_technique.cpp"
make march.comp "shaders/gi/$name/march.comp"
make params.h "shaders/shared/$name.h"
make page.md "docs/techniques/$name.md"
sed "s/@name@/$name/g" cmake/technique/variants.txt >> shaders/variants.txt
echo "  its programs in shaders/variants.txt"
# The table is a macro: its last line goes on with a backslash in column 100.
table=plugins/volumetric_gi/plugin.cpp
last=$(grep -n '^    X(' $table | tail -1)
sed -i "${last%%:*}s/.*/$(printf '%-99s' "${last#*:}")\\\\\n    X($type)/" $table
echo "  its line in the table of $table"
echo "next: build, then  tyndall capture SCENE -o out.png --gi $name  and  physics_technique_laws --gtest_filter='*/$name'"
