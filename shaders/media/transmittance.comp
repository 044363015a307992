// How much light gets through the media between the eye and the surfaces, where nothing else is wanted of them.
#include "common/view.glsl"
#include "media/optical_depth.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

uniform sampler2D depth;
layout(rgba32f) uniform writeonly image2D transmittance;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(transmittance)))) return;
    vec2 centre = vec2(pixel) + 0.5;
    Ray ray = cameraRay(centre);
    float distance = rayDistanceFromDepth(centre, texelFetch(depth, pixel, 0).r);
    imageStore(transmittance, pixel, vec4(exp(-opticalDepthAlong(ray.origin, ray.direction, distance)), 1.0));
}
