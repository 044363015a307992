// The direct march from one ray for 2×2 or 4×4 pixels to every pixel. A pixel that no ray fits is marched again on its own.
#define MARCH_PHASE_GROUPS PHASE_GROUPS
#define MARCH_GATHERS (IN_SCATTER != 0)
#include "media/march.glsl"
#include "media/spread_rays.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

uniform sampler2D coarseTransmittance;
layout(rgba32f) uniform writeonly image2D transmittance;
#if IN_SCATTER
uniform sampler2D coarseInScatter;
layout(rgba32f) uniform image2D inScatter; // from turn to turn light comes to pixels that are marched again
#endif
#if EMISSION
uniform sampler2D coarseEmission;
layout(rgba32f) uniform image2D emission;
#endif

// Known when compiling: what is not wanted costs nothing.
const uint kWanted = (IN_SCATTER > 0 ? kMarchInScatter : 0u) | (EMISSION == 1 ? kMarchEmission : 0u);

vec3 rayThrough(NearRay ray) { return texelFetch(coarseTransmittance, ray.coarse, 0).rgb; }

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(transmittance)))) return;
    Ray ray = cameraRay(vec2(pixel) + 0.5);
    float distance = distanceAt(pixel);
    vec3 through = exp(-opticalDepthAlong(ray.origin, ray.direction, distance));
    RaysAround rays = raysAround(pixel, distance, through, textureSize(coarseTransmittance, 0));
    bool begun = params.firstSegment > 0u;
    bool alone = isAlone(rays);
    if (begun && !alone) return;
    MarchResult march = MarchResult(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
#if IN_SCATTER
    march.inScatter = spreadScattered(rays, coarseInScatter);
#endif
#if EMISSION
    march.emission = spread(rays, coarseEmission);
#endif
    if (alone) {
        marchFirstSegment = params.firstSegment;
        marchEndSegment = params.endSegment;
        march = marchMedia(ray, distance, kWanted, params.lightCount, uvec2(pixel));
        through = exp(-march.opticalDepth);
    }
    imageStore(transmittance, pixel, vec4(through, 1.0));
#if IN_SCATTER
    imageStore(inScatter, pixel, vec4(march.inScatter + (begun ? imageLoad(inScatter, pixel).rgb : vec3(0.0)), 1.0));
#endif
#if EMISSION
    imageStore(emission, pixel, vec4(march.emission + (begun ? imageLoad(emission, pixel).rgb : vec3(0.0)), 1.0));
#endif
}
