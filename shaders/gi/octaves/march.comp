// Multiple scattering by octaves: the engine's march with its source replaced by the octaves beyond single scattering.
#define MARCH_PHASE_GROUPS PHASE_GROUPS
#define MARCH_OCTAVES 1
#include "media/march.glsl"
#include "shared/octaves.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std140) uniform Params { OctavesParams params; };
uniform sampler2D depth;
layout(rgba32f) uniform writeonly image2D inScatter;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(inScatter)))) return;
    marchedMedia = params.media;
    marchOctaves = MarchOctaves(1u, params.last, params.scatteringFactor, params.extinctionFactor, params.phaseFactor);
    vec2 centre = vec2(pixel) + 0.5;
    float distance = rayDistanceFromDepth(centre, texelFetch(depth, pixel, 0).r);
    MarchResult march = marchMedia(cameraRay(centre), distance, kMarchInScatter, params.lightCount, uvec2(pixel));
    imageStore(inScatter, pixel, vec4(march.inScatter, 1.0));
}
