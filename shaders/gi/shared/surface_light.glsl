// Light that surfaces reflect to the eye, in parts that neighbouring pixels share.
#ifndef TYNDALL_GI_SHARED_SURFACE_LIGHT
#define TYNDALL_GI_SHARED_SURFACE_LIGHT
#include "common/math.glsl"
#include "common/receiver.glsl"

/// Light that leaves a surface towards the eye, nits, over the colours that neighbours do not share: of the base, of microfacets at normal incidence,
/// and of Schlick's part at grazing angles.
struct SurfaceLight {
    vec3 diffuse;
    vec3 specular;
    vec3 grazing;
};
const SurfaceLight kDark = SurfaceLight(vec3(0.0), vec3(0.0), vec3(0.0));

/// With the surface's colours, as in evaluateBrdf().
vec3 coloured(Receiver r, SurfaceLight light) {
    float metallic = r.brdf.metallic;
    vec3 straight = mix(vec3(kDielectricF0 * r.brdf.specular), r.brdf.baseColor, metallic);
    return (1.0 - metallic) * r.brdf.baseColor * light.diffuse + straight * light.specular + mix(r.brdf.specular, 1.0, metallic) * light.grazing;
}

const float kLeastReflectance = 1e-3; // of black surfaces

/// Approximate reflectance for even light: the part that neighbours do not share. The same as (volumetric_gi/vpl/compensation_light.cpp).
vec3 reflectance(Receiver r) {
    float metallic = r.brdf.metallic;
    vec3 base = r.brdf.baseColor;
    return max((1.0 - metallic) * (base + kDielectricF0 * r.brdf.specular) + metallic * base, vec3(kLeastReflectance));
}

#endif
