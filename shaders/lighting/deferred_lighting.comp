// LSE of the surfaces in the G-buffer, before the media between them and the eye.
#include "common/receiver.glsl"
#include "lighting/surface_light.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(rgba32f) writeonly uniform image2D surfaceDirect;

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, imageSize(surfaceDirect)))) return;
    vec3 radiance = vec3(0.0);
    Receiver r;
    if (receiverAt(texel, r)) radiance = directLight(LitPoint(r.position, r.normal, r.facet, r.toEye, r.brdf, r.occlusion, uvec2(texel)));
    imageStore(surfaceDirect, texel, vec4(radiance, 1.0));
}
