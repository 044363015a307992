#!/usr/bin/env bash
# Makes plugins/NAME from plugins/example_tint. Usage: cmake/new-plugin.sh NAME   (lower case, digits and underscores)
set -euo pipefail
cd "$(dirname "$0")/.."
name=${1:-}
if ! [[ $name =~ ^[a-z][a-z0-9_]*$ ]]; then
    echo "usage: cmake/new-plugin.sh NAME, where NAME is made of a-z, 0-9 and _ and starts with a letter" >&2
    exit 2
fi
if [ -e "plugins/$name" ]; then
    echo "plugins/$name exists already: choose another name" >&2
    exit 2
fi
mkdir "plugins/$name"
for file in plugins/example_tint/*; do
    sed "s/example_tint/$name/g; s/\"tint\./\"$name./g" "$file" > "plugins/$name/$(basename "$file")"
done
sed -i "s/^tyndall_builtin_plugins()/add_subdirectory($name)\n&/" plugins/CMakeLists.txt
echo "plugins/$name is made and listed in plugins/CMakeLists.txt; its setting is '$name.enabled'"
