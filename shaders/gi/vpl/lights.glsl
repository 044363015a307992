// Virtual point lights: the intensity of one in a direction.
#ifndef TYNDALL_GI_VPL_LIGHTS
#define TYNDALL_GI_VPL_LIGHTS
#include "common/octahedral.glsl"
#include "common/phase_function.glsl"
#include "common/view.glsl"
#include "lighting/brdf.glsl"
#include "gi/vpl/clamping.glsl"
#include "gi/vpl/params.glsl"

layout(std430) readonly buffer VplLights { VplData vplLights[]; };
layout(std430) readonly buffer VplWalks { uint vplWalks[]; };   // first light of each walk, and the end of the last
layout(std430) readonly buffer VplDepths { uvec2 vplDepths[]; }; // the grids' optical depth, rgb in half precision, by light, direction, distance

/// 1/b at a receiver over that in the content: outside it, the distance between lights grows in proportion to the distance from it.
float vplClampScale(vec3 position) {
    vec3 off = position - vpl.content.xyz;
    return max(1.0, dot(off, off) * vpl.content.w);
}

const float kMostLost = 1e4; // over the clamped value: the loss at a light itself is infinite

/// clampedInverseSquare(), or what clamping removes, for the view that shows it.
float vplInverseSquare(float squared, float cosines, float clampSquared) {
    float clamped = clampedInverseSquare(squared, cosines, clampSquared);
    return vpl.lost == 0u ? clamped : min(1.0 / max(squared, 1e-30), kMostLost * clamped) - clamped;
}

bool vplCounts(uint light, uint terms) { return (terms & (1u << uint(vplLights[light].power.w))) != 0u; }

/// Watts per steradian towards `direction` (unit); on a surface with the cosine there.
vec3 vplIntensity(uint light, vec3 direction) {
    float kind = vplLights[light].position.w;
    vec3 travel = vplLights[light].travel.xyz;
    vec3 power = vplLights[light].power.rgb;
    if (kind >= 0.0) return power * phaseFunction(uint(kind), vplLights[light].travel.w, dot(travel, direction));
    float cosine = dot(vplLights[light].normal.xyz, direction);
    if (!(cosine > 0.0)) return vec3(0.0);
    vec4 base = vplLights[light].base;
    Brdf brdf = makeBrdf(base.rgb, base.w, max(vplLights[light].normal.w, vpl.leastRoughness), vplLights[light].shading.w);
    BrdfValue value = evaluateBrdf(brdf, vplLights[light].shading.xyz, -travel, direction);
    return power * (value.diffuse + value.specular) * cosine;
}

#endif
