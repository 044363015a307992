// Images of indirect light behind blended surfaces: a surface of coverage α takes α of what comes from behind it. Of light from
// media, the part that comes from before the surface stays; that part is taken for the one of the light that the
// media before it take from the whole ray.
#include "lighting/blend_surface.glsl"
#if MEDIA
#include "media/optical_depth.glsl"
uniform sampler2D transmittance; // of the media between the eye and what is behind
#endif

layout(location = 0) out vec4 indirectTarget;

void main() {
    Surface surface = blendedSurface();
    float behind = 1.0;
#if MEDIA
    if (blend.inMedia != 0u) {
        Ray ray = cameraRay(gl_FragCoord.xy);
        float distance = max(dot(fromEye + view.cameraPosition.xyz - ray.origin, ray.direction), 0.0);
        vec3 taken = 1.0 - exp(-opticalDepthAlong(ray.origin, ray.direction, distance));
        vec3 takenInAll = 1.0 - texelFetch(transmittance, ivec2(gl_FragCoord.xy), 0).rgb;
        float all = takenInAll.r + takenInAll.g + takenInAll.b;
        behind = all > 0.0 ? clamp(1.0 - (taken.r + taken.g + taken.b) / all, 0.0, 1.0) : 1.0;
    }
#endif
    indirectTarget = vec4(0.0, 0.0, 0.0, surface.alpha * behind);
}
