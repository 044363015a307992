// Reflection in two bands of harmonics: of a lobe they hold the power and the mean direction.
#ifndef TYNDALL_GI_LPV_REFLECTION
#define TYNDALL_GI_LPV_REFLECTION
#include "lighting/brdf.glsl"

/// Reflectances of the diffuse part, and of coats and metals around the mirror direction.
struct Reflection {
    vec3 even;
    vec3 mirrored;
};

/// Means over light from all sides of the microfacets of lighting/brdf.glsl, which lose light where they are rough: fits to within 0.003 (coat) and 0.03
/// (metal) of its integrals over the hemisphere.
Reflection reflectionOf(Brdf brdf, float roughness) {
    float r = clamp(roughness, 0.0, 1.0);
    float coat = brdf.specular * (0.0189 + 0.0669 * (1.0 + r * r * (1.896 * r - 2.896)));
    vec3 metal = brdf.baseColor * (1.0 - 0.591 * pow(r, 2.2));
    const float kFresnel = 0.06; // mean of the coat's over the half-way vectors of rough surfaces: the part that the base does not receive
    return Reflection(brdf.baseColor * ((1.0 - kFresnel * brdf.specular) * (1.0 - brdf.metallic)), mix(vec3(coat), metal, brdf.metallic));
}

/// Mean direction of the lobe about `mirror`: that itself where the surface is smooth, Lambert's where it is rough.
vec3 meanOfLobe(vec3 mirror, vec3 normal, float roughness) { return mix(mirror, (2.0 / 3.0) * normal, roughness * roughness); }

#endif
