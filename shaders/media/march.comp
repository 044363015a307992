// What the media do to the light on its way from the surfaces to the eye: how much gets through, what they scatter towards the
// eye, and what they emit. At full resolution, or one ray for 2×2 or 4×4 pixels, to be upsampled by upsample.comp.
#define MARCH_PHASE_GROUPS PHASE_GROUPS
#include "media/march.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std140) uniform Params { MarchParams params; };
uniform sampler2D depth;
layout(rgba32f) uniform writeonly image2D transmittance;
#if IN_SCATTER
layout(rgba32f) uniform writeonly image2D inScatter;
#endif
#if EMISSION
layout(rgba32f) uniform writeonly image2D emission;
#endif

// Known when compiling: what is not wanted costs nothing.
const uint kWanted = (IN_SCATTER == 1 ? kMarchInScatter : 0u) | (EMISSION == 1 ? kMarchEmission : 0u);

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(transmittance)))) return;
    // The ray of one of the pixels that it stands for: its depth is that pixel's own, not a mixture.
    ivec2 full = min(pixel * int(params.factor) + int(params.factor) / 2, textureSize(depth, 0) - 1);
    vec2 centre = vec2(full) + 0.5;
    float distance = rayDistanceFromDepth(centre, texelFetch(depth, full, 0).r);
    MarchResult march = marchMedia(cameraRay(centre), distance, kWanted, params.lightCount, uvec2(full));
    imageStore(transmittance, pixel, vec4(exp(-march.opticalDepth), 1.0));
#if IN_SCATTER
    imageStore(inScatter, pixel, vec4(march.inScatter, 1.0));
#endif
#if EMISSION
    imageStore(emission, pixel, vec4(march.emission, 1.0));
#endif
}
