// Virtual point lights: what one of them sends in a direction, and what it sees.
#ifndef TYNDALL_GI_VPL_LIGHTS
#define TYNDALL_GI_VPL_LIGHTS
#include "common/octahedral.glsl"
#include "common/phase_function.glsl"
#include "common/view.glsl"
#include "lighting/brdf.glsl"
#include "gi/vpl/bound.glsl"
#include "shared/vpl.h"

layout(std140) uniform Vpl { VplParams vpl; };
layout(std430) readonly buffer VplLights { VplData vplLights[]; };
layout(std430) readonly buffer VplWalks { uint vplWalks[]; };   // where each walk's lights begin; one more: where the last ends
layout(std430) readonly buffer VplMaps { uint vplMaps[]; };     // for each light mapSide² numbers of planes, by direction
layout(std430) readonly buffer VplPlanes { vec4 vplPlanes[]; }; // n·p + w = 0
layout(std430) readonly buffer VplDepths { uvec2 vplDepths[]; }; // the grids' optical depth, rgb in half precision, by light, direction, distance

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

const float kBesideTexels = 1.5; // a texel spans 4π/side² steradians: 3.545/side radians

/// Does the light see the point? `direction`: unit, from the light. `normal`: of the facet that the point lies on; vec3(0) in a medium. A map names
/// for each direction the plane of the first surface. A point behind that plane is in shadow, but on a facet only where what
/// the light sees is before that facet: two sides of an edge do not shadow each other. Walls may be thin; a bias have only facets that
/// face the same way as what is seen.
bool vplSees(uint light, vec3 position, vec3 direction, float distance, vec3 normal) {
    if (vpl.mapSide == 0u || distance < vplLights[light].power.w) return true;
    float side = float(vpl.mapSide);
    uvec2 texel = uvec2(clamp((octahedralEncode(direction) * 0.5 + 0.5) * side, vec2(0.0), vec2(side - 0.5)));
    uint id = vplMaps[(light * vpl.mapSide + texel.y) * vpl.mapSide + texel.x];
    if (id == kVplNothing) return true;
    vec4 plane = vplPlanes[id];
    vec3 from = vplLights[light].position.xyz;
    float ofLight = dot(plane.xyz, from) + plane.w;
    float ofPoint = dot(plane.xyz, position) + plane.w;
    if (ofLight < 0.0) ofPoint = -ofPoint;
    float rounding = 1e-4 * (distance + length(position));
    if (!(ofPoint < -rounding)) return true;
    if (dot(normal, normal) == 0.0) return false;
    vec3 middle = octahedralDecode((vec2(texel) + 0.5) / side * 2.0 - 1.0);
    float slope = dot(plane.xyz, middle);
    if (abs(slope) < 1e-6) return false;
    float seenDistance = -ofLight / slope;
    vec3 seen = from + middle * seenDistance;
    if (dot(normal, seen - position) <= rounding) return true;
    // Mouldings and tiles: a facet that faces the same way a little farther back does not lie behind the other, but beside it.
    vec3 towardsLight = ofLight < 0.0 ? -plane.xyz : plane.xyz;
    return dot(towardsLight, normal) > 0.5 && distance - seenDistance < kBesideTexels * 3.545 / side * distance;
}

/// The nearest virtual light that sees a point: it stands for what the scene is like around there.
struct Guide {
    uint light; // kVplNothing: none does
    float squared;
};
const Guide kNoGuide = Guide(kVplNothing, 1e38);

void consider(inout Guide guide, uint light, float squared) {
    if (squared < guide.squared) guide = Guide(light, squared);
}

/// Is `position` in the same room as the point that the guide sees? Not if that light does not see it.
bool guideSees(Guide guide, vec3 position) {
    if (guide.light == kVplNothing) return vpl.mapSide == 0u;
    vec3 way = position - vplLights[guide.light].position.xyz;
    float distance = length(way);
    return distance == 0.0 || vplSees(guide.light, position, way / distance, distance, vec3(0.0));
}

#endif
