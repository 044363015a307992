#!/usr/bin/env bash
# Makes, in an empty folder, what cmake/new-technique.sh makes in the source's: a technique as it comes, and six broken copies.
# Usage: make.sh SOURCE FOLDER
set -euo pipefail
source=$1 folder=$2
rm -rf "$folder"
mkdir -p "$folder/cmake" "$folder/plugins/volumetric_gi" "$folder/shaders"
cp -r "$source/cmake/new-technique.sh" "$source/cmake/technique" "$folder/cmake"
cp "$source/plugins/volumetric_gi/plugin.cpp" "$folder/plugins/volumetric_gi"
cp "$source/shaders/variants.txt" "$folder/shaders"
cd "$folder"
for name in two_fold black doubled leaking noisy late misplaced; do cmake/new-technique.sh $name > /dev/null; done

# broken FILE EXPRESSION: a change that finds nothing to change is an error.
broken() {
    sed -i.before "$2" "$1"
    if cmp -s "$1" "$1.before"; then
        echo "make.sh: '$2' changes nothing in $1: the template has changed, so must this script" >&2
        exit 1
    fi
    rm "$1.before"
}
shader() { echo "shaders/gi/$1/march.comp"; }
code() { echo "plugins/volumetric_gi/$1/$1_technique.cpp"; }

broken "$(shader black)" 's/once \* around/0.0 * &/'
broken "$(shader doubled)" 's/once \* around/2.0 * &/'
# Nothing casts a shadow.
broken "$(shader leaking)" 's/^#include "media\/march.glsl"/#include "lighting\/shadow.glsl"\n#define shadowVisibility(light, position, normal, u) 1.0\n&/'
# Right on average, and the same in each frame: one pixel in 16 has the light of 16.
broken "$(shader noisy)" 's/once \* around/(pixelRandom(number, 7u).x < 0.0625 ? 16.0 : 0.0) * &/'
broken "$(code misplaced)" 's/outputs.inMedia = addLitMarch/outputs.onSurfaces = addLitMarch/'
# Shows the picture of the frame before.
broken "$(code late)" '/^    return outputs;/i\
    if (graph.isAbsent(outputs.inMedia)) return outputs;\
    const fg::TextureHistory pictures = graph.historyTexture(\
        "gi.late.pictures", fg::texture2D(fg::Format::RGBA32F, inputs.view.width, inputs.view.height));\
    struct Keep {\
        fg::TextureHandle from, to;\
    };\
    graph.addPass<Keep>(\
        "gi.late.keep",\
        [\&](fg::Builder\& builder, Keep\& keep) {\
            keep.from = builder.read(outputs.inMedia, fg::Access::TransferRead);\
            keep.to = builder.write(pictures.current, fg::Access::TransferWrite);\
            graph.markOutput(keep.to);\
        },\
        [](const Keep\& keep, fg::PassContext\& context) { context.copyTexture(keep.from, keep.to); });\
    outputs.inMedia = pictures.previous;'
