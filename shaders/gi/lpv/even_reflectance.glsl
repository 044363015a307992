// What a surface reflects, taken as Lambert's: two bands of harmonics hold no lobes of coats and metals.
#ifndef TYNDALL_GI_LPV_EVEN_REFLECTANCE
#define TYNDALL_GI_LPV_EVEN_REFLECTANCE

/// `base`: base colour and metallic, `specular`: weight of the coat, as in the G-buffer.
vec3 evenReflectance(vec4 base, float specular) {
    float coat = 0.04 * specular; // at normal incidence, index of refraction 1.5
    return mix(base.rgb * (1.0 - coat) + coat, base.rgb, base.w);
}

#endif
