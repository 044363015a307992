// The lattice's light at a point.
#ifndef TYNDALL_GI_LPV_LOOKUP
#define TYNDALL_GI_LPV_LOOKUP
#include "gi/lpv/lattice.glsl"

uniform sampler3D redLight;
uniform sampler3D greenLight;
uniform sampler3D blueLight;

/// xyz: vector flux, w: fluence, W/m², of each channel.
struct LatticeLight {
    vec4 red;
    vec4 green;
    vec4 blue;
};

LatticeLight latticeLight(vec3 position) {
    vec3 uvw = latticePosition(position) / vec3(params.size.xyz);
    return LatticeLight(textureLod(redLight, uvw, 0.0), textureLod(greenLight, uvw, 0.0), textureLod(blueLight, uvw, 0.0));
}

vec3 fluence(LatticeLight light) { return vec3(light.red.w, light.green.w, light.blue.w); }

/// Vector flux along `direction`.
vec3 fluxAlong(LatticeLight light, vec3 direction) {
    return vec3(dot(light.red.xyz, direction), dot(light.green.xyz, direction), dot(light.blue.xyz, direction));
}

#endif
