// Multiple scattering by octaves: the engine's march with its source replaced by the octaves beyond single scattering.
#define MARCH_PHASE_GROUPS PHASE_GROUPS
#define MARCH_OCTAVES 1
#define MARCH_TURNS
#include "gi/shared/march.glsl"
#include "media/march.glsl"
#include "shared/octaves.h"

layout(std140) uniform Technique { OctavesParams octaves; };

vec3 mediaLight(Ray ray, float distance, ivec2 pixel, uvec2 number) {
    marchedMedia = params.media;
    marchOctaves = MarchOctaves(1u, octaves.last, octaves.scatteringFactor, octaves.extinctionFactor, octaves.phaseFactor);
    marchFirstSegment = params.firstSegment;
    marchEndSegment = params.endSegment;
    vec3 before = params.firstSegment > 0u ? imageLoad(inScatter, ivec2(number)).rgb : vec3(0.0);
    return before + marchMedia(ray, distance, kMarchInScatter, params.lightCount, number).inScatter;
}
