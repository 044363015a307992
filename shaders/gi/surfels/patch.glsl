// A surfel of a patch, from its place in the tessellated triangle. The tessellator and the compute shader that stands in for it share this.
//
// OpenGL's tessellator puts the points of level n (equal spacing) on concentric triangles: ring k has its corners at 1 − 2k/n of the way from the middle to
// the patch's corners, and n − 2k steps along each edge (OpenGL 4.5, section 11.2.2.2). Here ring k moves to 1 − (2k+1)/(n+1). Then the bands between the scales
// 1 − 2k/(n+1) hold one ring each, all points of all rings have the same area, 4/3 (n+1)⁻² of the patch's, and a point in the middle, for even n, has (n+1)⁻².
// No point is on an edge; three points (n = 1) are the quadrature rule of degree 2.
#ifndef TYNDALL_GI_SURFELS_PATCH
#define TYNDALL_GI_SURFELS_PATCH
#include "shared/material.h"
#include "shared/object.h"
#include "shared/surfels.h"

layout(std140) uniform Set { SurfelSet set; };
layout(std430) readonly buffer Vertices { float vertices[]; };
layout(std430) readonly buffer Indices { uint indices[]; };
layout(std430) readonly buffer Objects { ObjectData objects[]; };
layout(std430) readonly buffer Materials { MaterialData materials[]; };
layout(std430) readonly buffer SurfelPatches { SurfelPatch patches[]; };
uniform sampler2D baseColorTexture;
uniform sampler2D metallicRoughnessTexture;

/// Barycentric coordinates in the patch, from those of the tessellator.
vec3 surfelPlace(vec3 tessellated, uint level) {
    float n = float(level);
    float ring = round(1.5 * n * min(tessellated.x, min(tessellated.y, tessellated.z)));
    float scale = 1.0 - 2.0 * ring / n;
    if (scale < 0.5 / n) return vec3(1.0 / 3.0);
    return 1.0 / 3.0 + (tessellated - 1.0 / 3.0) * ((1.0 - (2.0 * ring + 1.0) / (n + 1.0)) / scale);
}

/// The part of the patch's area that the surfel has.
float surfelShare(vec3 tessellated, uint level) {
    float n = float(level);
    bool middle = (level & 1u) == 0u && min(tessellated.x, min(tessellated.y, tessellated.z)) > 1.0 / 3.0 - 1.0 / (3.0 * n);
    return (middle ? 1.0 : 4.0 / 3.0) / ((n + 1.0) * (n + 1.0));
}

uint vertexOf(uint triangle, uint corner) { return indices[3u * triangle + corner] * set.strideFloats; }

vec3 positionOf(uint vertex) {
    vec4 local = vec4(vertices[vertex], vertices[vertex + 1u], vertices[vertex + 2u], 1.0);
    return (objects[set.object].renderFromLocal * local).xyz;
}

vec2 uvOf(uint vertex, MaterialTexture use) {
    uint floats = set.uvFloats[uint(use.offset.z)];
    vec2 uv = floats == 0u ? vec2(0.0) : vec2(vertices[vertex + floats], vertices[vertex + floats + 1u]);
    return vec2(dot(use.linear.xy, uv), dot(use.linear.zw, uv)) + use.offset.xy;
}

vec4 colorOf(uint vertex) {
    uint at = vertex + set.colorFloats;
    return vec4(vertices[at], vertices[at + 1u], vertices[at + 2u], vertices[at + 3u]);
}

/// `weights`: of the triangle's corners. `share`: of the triangle's area, over which the texture is averaged.
vec4 textureOver(sampler2D map, MaterialTexture use, uvec3 corners, vec3 weights, float share) {
    vec2 a = uvOf(corners.x, use);
    vec2 b = uvOf(corners.y, use);
    vec2 c = uvOf(corners.z, use);
    vec2 size = vec2(textureSize(map, 0));
    vec2 ab = (b - a) * size;
    vec2 ac = (c - a) * size;
    float texels = 0.5 * abs(ab.x * ac.y - ab.y * ac.x) * share;
    return textureLod(map, weights.x * a + weights.y * b + weights.z * c, 0.5 * log2(max(texels, 1.0)));
}

/// Surfel at `tessellated` of a patch.
Surfel surfelOf(uint number, vec3 tessellated) {
    SurfelPatch p = patches[number];
    vec3 place = surfelPlace(tessellated, p.level);
    vec2 at = place.x * p.corners.xy + place.y * p.corners.zw + place.z * p.lastCorner;
    vec3 weights = vec3(1.0 - at.x - at.y, at);
    uvec3 corners = uvec3(vertexOf(p.triangle, 0u), vertexOf(p.triangle, 1u), vertexOf(p.triangle, 2u));
    vec3 a = positionOf(corners.x);
    vec3 ab = positionOf(corners.y) - a;
    vec3 ac = positionOf(corners.z) - a;
    Surfel surfel;
    float area = surfelShare(tessellated, p.level) * p.area;
    surfel.position = vec4(a + weights.y * ab + weights.z * ac, area);
    vec3 across = cross(ab, ac);
    float twiceArea = length(across);
    surfel.normal = vec4(twiceArea > 0.0 ? across / twiceArea : vec3(0.0, 1.0, 0.0), 0.0);
    float share = twiceArea > 0.0 ? min(2.0 * area / twiceArea, 1.0) : 0.0;

    MaterialData material = materials[objects[set.object].material];
    vec4 base = material.baseColor;
    if (set.colorFloats != 0u) base *= weights.x * colorOf(corners.x) + weights.y * colorOf(corners.y) + weights.z * colorOf(corners.z);
    if (material.baseColorTexture.offset.w != 0.0) base *= textureOver(baseColorTexture, material.baseColorTexture, corners, weights, share);
    vec2 metalRough = vec2(material.metallic, material.roughness);
    if (material.metallicRoughnessTexture.offset.w != 0.0)
        metalRough *= textureOver(metallicRoughnessTexture, material.metallicRoughnessTexture, corners, weights, share).bg;
    bool unlit = (material.flags & kMaterialUnlit) != 0u || (objects[set.object].flags & kObjectHasNormals) == 0u;
    surfel.base = vec4(clamp(base.rgb, 0.0, 1.0), metalRough.x);
    surfel.surface = vec4(material.specular, unlit ? 0.0 : 1.0, metalRough.y, 0.0);
    // Holes have no area; over many surfels the rest is the surface's.
    if ((material.flags & kMaterialMask) != 0u && base.a < material.emissive.w) surfel.position.w = 0.0;
    return surfel;
}

#endif
