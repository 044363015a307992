// Blackbody radiance from a table: logarithms, evenly spaced in temperature (engine/renderer/media_system.cpp fills it).
#ifndef TYNDALL_MEDIA_BLACKBODY
#define TYNDALL_MEDIA_BLACKBODY
#include "media/density.glsl"

/// xyz: natural logarithm of the RGB radiance in nits at temperature index · blackbodyStep kelvin; entry 0 is absolute zero.
layout(std430) readonly buffer Blackbody {
    vec4 blackbodyTable[];
};
const float kBlackbodyStep = 5.0; // kelvin

/// RGB nits of a black body.
vec3 blackbodyRadiance(float kelvin) {
    float x = clamp(kelvin / kBlackbodyStep, 0.0, float(blackbodyTable.length() - 1) - 1e-3);
    int i = int(x);
    return exp(mix(blackbodyTable[i].xyz, blackbodyTable[i + 1].xyz, x - float(i)));
}

/// Nits per metre and density that medium `m` emits by its temperature at a point of render space.
vec3 blackbodyEmission(uint m, vec3 position) {
    vec3 cell = (media[m].temperatureFromRender * vec4(position, 1.0)).xyz;
    return media[m].emission.w * blackbodyRadiance(sampleGrid(media[m].temperatureBricks, cell));
}

#endif
