// The lattice's light at a point.
#ifndef TYNDALL_GI_LPV_LOOKUP
#define TYNDALL_GI_LPV_LOOKUP
#include "gi/lpv/sides.glsl"

uniform sampler3D redLight;
uniform sampler3D greenLight;
uniform sampler3D blueLight;

/// xyz: vector flux, w: fluence, W/m², of each channel.
struct LatticeLight {
    vec4 red;
    vec4 green;
    vec4 blue;
};

/// The light around `place` (cells from the lattice's corner): linear between the cells that are open to the one on whose side it is.
LatticeLight latticeLight(vec3 place) {
    ivec3 own = cellOnSide(place);
    uint blocked = links[kLpvBlocked * cellCount() + cellIndex(own)];
    LatticeLight sum = LatticeLight(vec4(0.0), vec4(0.0), vec4(0.0));
    if (blocked == 0u) {
        vec3 uvw = place / vec3(params.size.xyz);
        return LatticeLight(textureLod(redLight, uvw, 0.0), textureLod(greenLight, uvw, 0.0), textureLod(blueLight, uvw, 0.0));
    }
    ivec3 last = params.size.xyz - 1;
    vec3 low = floor(place - 0.5);
    vec3 f = place - 0.5 - low;
    float total = 0.0;
    for (int k = 0; k < 8; ++k) {
        ivec3 corner = ivec3(k & 1, (k >> 1) & 1, k >> 2);
        ivec3 cell = clamp(ivec3(low) + corner, ivec3(0), last);
        vec3 share = mix(1.0 - f, f, vec3(corner));
        // At least a little, so that a cell that is alone on its side counts in full.
        if (!areOpen(blocked, own, cell)) continue;
        float weight = share.x * share.y * share.z + 1e-4;
        sum.red += weight * texelFetch(redLight, cell, 0);
        sum.green += weight * texelFetch(greenLight, cell, 0);
        sum.blue += weight * texelFetch(blueLight, cell, 0);
        total += weight;
    }
    if (!(total > 0.0)) return LatticeLight(texelFetch(redLight, own, 0), texelFetch(greenLight, own, 0), texelFetch(blueLight, own, 0));
    return LatticeLight(sum.red / total, sum.green / total, sum.blue / total);
}

vec3 fluence(LatticeLight light) { return vec3(light.red.w, light.green.w, light.blue.w); }

/// Vector flux along `direction`.
vec3 fluxAlong(LatticeLight light, vec3 direction) {
    return vec3(dot(light.red.xyz, direction), dot(light.green.xyz, direction), dot(light.blue.xyz, direction));
}

#endif
