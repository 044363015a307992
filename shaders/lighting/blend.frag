// A blended surface at its depth in the media. With α its coverage, each term's image C becomes
//   (1-α)·C + α·(what the media before it send + what it sends, times the media's transmittance),
// as premultiplied outputs: the blend unit does the first part.
#include "lighting/surface_light.glsl"
#if MEDIA
#define MARCH_PHASE_GROUPS PHASE_GROUPS
#include "media/march.glsl"
#endif
#include "lighting/blend_surface.glsl"

layout(location = 0) out vec4 emissionTarget; // LE
layout(location = 1) out vec4 directTarget;   // LSE
#if MEDIA
layout(location = 2) out vec4 inScatterTarget; // LVE
#endif

void main() {
    Surface surface = blendedSurface();
    vec3 position = fromEye + view.cameraPosition.xyz;
    Ray ray = cameraRay(gl_FragCoord.xy);
    vec3 emission = surface.unlit ? surface.baseColor : surface.emissive;
    vec3 direct = vec3(0.0);
    if (!surface.unlit && blend.direct != 0u) {
        LitPoint point;
        point.position = position;
        point.normal = surface.normal;
        point.geometricNormal = surface.geometricNormal;
        point.toEye = -ray.direction;
        point.brdf = makeBrdf(clamp(surface.baseColor, vec3(0.0), vec3(1.0)), clamp(surface.metallic, 0.0, 1.0),
                              clamp(surface.roughness, 0.0, 1.0), clamp(surface.specular, 0.0, 1.0));
        point.occlusion = clamp(surface.occlusion, 0.0, 1.0);
        point.pixel = uvec2(gl_FragCoord.xy);
        direct = directLight(point);
    }
#if MEDIA
    float distance = max(dot(position - ray.origin, ray.direction), 0.0);
    MarchResult march = marchMedia(ray, distance, blend.marchFlags, blend.lightCount, uvec2(gl_FragCoord.xy));
    vec3 transmittance = exp(-march.opticalDepth);
    emission = emission * transmittance + march.emission;
    direct *= transmittance;
    inScatterTarget = vec4(surface.alpha * march.inScatter, surface.alpha);
#endif
    emissionTarget = vec4(surface.alpha * max(emission, vec3(0.0)), surface.alpha);
    directTarget = vec4(surface.alpha * direct, surface.alpha);
}
