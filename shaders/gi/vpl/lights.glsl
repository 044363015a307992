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
layout(std430) readonly buffer VplMaps { uint vplMaps[]; };     // for each light mapSide² numbers of triangles, by direction
layout(std430) readonly buffer VplTriangles { VplTriangle vplTriangles[]; };
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

const float kTexelAngle = 3.545;  // radians times texels along an edge: a texel spans 4π/side² steradians
const float kBesideTexels = 1.5;
const float kWideTexels = 3.0;    // a wider triangle is met by the ray of a texel beside each that it fills in part
const float kSeam = 1e-4;         // barycentric: neighbours overlap, so that nothing comes through between them

/// The four texels of a light's map whose middles lie around a direction, the one that it falls into first. Over an edge an octahedron's map goes on turned
/// about the edge's middle.
uint vplTexel(uint light, ivec2 texel) {
    int side = int(vpl.mapSide);
    if (texel.x < 0 || texel.x >= side) texel = ivec2(texel.x < 0 ? 0 : side - 1, side - 1 - texel.y);
    if (texel.y < 0 || texel.y >= side) texel = ivec2(side - 1 - texel.x, texel.y < 0 ? 0 : side - 1);
    return vplMaps[(light * vpl.mapSide + uint(texel.y)) * vpl.mapSide + uint(texel.x)];
}

/// Does a point of a triangle's plane lie in the triangle?
bool inTriangle(VplTriangle triangle, vec3 point) {
    vec3 off = point - triangle.corner.xyz;
    float second = dot(triangle.second.xyz, off);
    float third = dot(triangle.third.xyz, off);
    return triangle.corner.w > 0.0 && min(second, third) > -kSeam && second + third < 1.0 + kSeam;
}

/// Is a point behind a triangle that fills its texel in part, among others? It counts as filling it. But a point on a facet is in shadow only
/// where what the light sees is before that facet: two sides of an edge do not shadow each other.
bool vplBehindPlane(vec4 plane, vec3 from, vec3 position, float ofLight, uvec2 texel, float distance, vec3 normal, float rounding) {
    if (dot(normal, normal) == 0.0) return true;
    float side = float(vpl.mapSide);
    vec3 middle = octahedralDecode((vec2(texel) + 0.5) / side * 2.0 - 1.0);
    float slope = dot(plane.xyz, middle);
    if (abs(slope) < 1e-6) return true;
    float seenDistance = -ofLight / slope;
    vec3 seen = from + middle * seenDistance;
    if (dot(normal, seen - position) <= rounding) return false;
    // Mouldings and tiles: a facet that faces the same way a little farther back does not lie behind the other, but beside it.
    vec3 towardsLight = ofLight < 0.0 ? -plane.xyz : plane.xyz;
    return dot(towardsLight, normal) <= 0.5 || distance - seenDistance >= kBesideTexels * kTexelAngle / side * distance;
}

/// Does the light see the point? `direction`: unit, from the light. `normal`: of the facet that the point lies on; vec3(0) in a medium. A map names
/// for each direction the first triangle. What the way to the point crosses hides it, be it the triangle of a texel beside: what ends within a texel is seen by
/// one of those around. Of a triangle that is narrow, seen from the light, the plane counts in its texel, for the others that fill it. Walls may be thin.
bool vplSees(uint light, vec3 position, vec3 direction, float distance, vec3 normal) {
    if (vpl.mapSide == 0u || distance < vplLights[light].power.w) return true;
    float side = float(vpl.mapSide);
    vec2 at = clamp((octahedralEncode(direction) * 0.5 + 0.5) * side, vec2(0.0), vec2(side - 0.5));
    uvec2 texel = uvec2(at);
    ivec2 beside = ivec2(lessThan(fract(at), vec2(0.5))) * -2 + 1;
    vec3 from = vplLights[light].position.xyz;
    float rounding = 1e-4 * (distance + length(position));
    uint own = vplTexel(light, ivec2(texel));
    for (int i = 0; i < 4; ++i) {
        uint id = i == 0 ? own : vplTexel(light, ivec2(texel) + beside * ivec2(i & 1, i >> 1));
        if (id == kVplNothing || (i > 0 && id == own)) continue;
        VplTriangle triangle = vplTriangles[id];
        float ofLight = dot(triangle.plane.xyz, from) + triangle.plane.w;
        float ofPoint = dot(triangle.plane.xyz, position) + triangle.plane.w;
        if (abs(ofPoint) <= rounding || ofLight * ofPoint >= 0.0) continue;
        float part = ofLight / (ofLight - ofPoint);
        if (inTriangle(triangle, mix(from, position, part))) return false;
        float seenDistance = part * distance;
        bool wide = triangle.corner.w * abs(ofLight) > kWideTexels * kTexelAngle / side * seenDistance * seenDistance;
        if (i == 0 && !wide && vplBehindPlane(triangle.plane, from, position, ofLight, texel, distance, normal, rounding)) return false;
    }
    return true;
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
