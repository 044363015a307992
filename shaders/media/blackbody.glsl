// Blackbody radiance from a table with entries evenly spaced in 1/T, where the logarithm of luminance is nearly straight
// (engine/media/blackbody.h makes it).
#ifndef TYNDALL_MEDIA_BLACKBODY
#define TYNDALL_MEDIA_BLACKBODY
#include "media/density.glsl"

/// RGB nits of a black body; 0 for matter cooler than the table.
vec3 blackbodyRadiance(float kelvin) {
    if (!(kelvin >= blackbodyRange.x)) return vec3(0.0);
    float x = (1.0 / blackbodyRange.x - 1.0 / min(kelvin, blackbodyRange.y)) * blackbodyRange.z * blackbodyRange.w;
    float i = clamp(floor(x), 0.0, blackbodyRange.w - 1.0);
    vec4 entry = mix(blackbodyTable[int(i)], blackbodyTable[int(i) + 1], clamp(x - i, 0.0, 1.0));
    return entry.xyz * exp2(entry.w);
}

/// Nits per metre that medium `m` emits by its temperature at a point of render space where its density is 1.
vec3 blackbodyEmission(uint m, vec3 position) {
    vec3 cell = (media[m].temperatureFromRender * vec4(position, 1.0)).xyz;
    return media[m].emission.w * blackbodyRadiance(sampleGrid(media[m].temperatureBricks, cell));
}

/// The same of all media, with their densities.
vec3 blackbodyEmission(vec3 position) {
    vec3 sum = vec3(0.0);
    for (uint m = 0u; m < mediumCount(); ++m) {
        if (!(media[m].emission.w > 0.0)) continue;
        float density = mediumDensity(m, position);
        if (density > 0.0) sum += density * blackbodyEmission(m, position);
    }
    return sum;
}

#endif
