// LE of surfaces and background: what the surfaces emit, and the environment where there is none.
#include "lighting/environment.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

uniform sampler2D gbufferDepth;
uniform sampler2D gbufferEmissive;
layout(rgba32f) writeonly uniform image2D surfaceEmission;

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, imageSize(surfaceEmission)))) return;
    bool surface = texelFetch(gbufferDepth, texel, 0).r > 0.0;
    vec3 radiance = surface ? texelFetch(gbufferEmissive, texel, 0).rgb : environmentBackground(vec2(texel) + 0.5);
    imageStore(surfaceEmission, texel, vec4(radiance, 1.0));
}
