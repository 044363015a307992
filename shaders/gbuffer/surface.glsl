// What a material makes of a point of a surface (glTF 2.0, section 3.9): textures times factors. Fragment shaders only.
#ifndef TYNDALL_GBUFFER_SURFACE
#define TYNDALL_GBUFFER_SURFACE
#include "common/view.glsl"
#include "shared/material.h"
#include "shared/object.h"

layout(std430) readonly buffer Materials {
    MaterialData materials[];
};
uniform sampler2D baseColorTexture;         // sRGB
uniform sampler2D metallicRoughnessTexture; // G: roughness, B: metallic
uniform sampler2D normalTexture;
uniform sampler2D occlusionTexture;         // R
uniform sampler2D emissiveTexture;          // sRGB
uniform float textureLodBias;
uniform float textureAnisotropy; // of the sampler of base colours

// What the rasteriser interpolates.
struct SurfacePoint {
    vec3 fromEye;  // render space, from the camera's position
    vec3 normal;   // not unit; 0: the mesh has none
    vec4 tangent;  // not unit; w: handedness; 0: none
    vec4 uvSets01;
    vec4 uvSets23;
    vec4 color;
    bool frontFacing; // seen from the side that the triangle's winding calls front, mirrored transforms minded
    bool isTriangle;
};

struct Surface {
    vec3 baseColor; // unlit: the radiance in nits
    float alpha;
    float metallic;
    float roughness;
    float specular;
    float occlusion;        // for light from all around: 1 open, 0 closed
    vec3 emissive;          // nits
    vec3 normal;            // unit, shading; on the side of a double-sided surface that is seen
    vec3 geometricNormal;   // unit, towards the eye
    bool unlit;
};

// Where a texture is looked up, and how far from there the pixels to the right and below look.
struct TexturePoint {
    vec2 uv;
    vec2 right;
    vec2 below;
};

// Differences of what is interpolated, which all four pixels of a quad have: a material comes from a buffer, which drivers (llvmpipe) need not read for those
// that a triangle does not cover, and differences of what follows from it may be anything.
TexturePoint texturePoint(MaterialTexture use, SurfacePoint point) {
    bvec4 second = bvec4(use.offset.z > 1.5);
    vec4 sets = mix(point.uvSets01, point.uvSets23, second);
    vec4 right = mix(dFdx(point.uvSets01), dFdx(point.uvSets23), second);
    vec4 below = mix(dFdy(point.uvSets01), dFdy(point.uvSets23), second);
    bvec2 odd = bvec2(use.offset.z == 1.0 || use.offset.z == 3.0);
    mat2 linear = mat2(use.linear.xz, use.linear.yw);
    return TexturePoint(linear * mix(sets.xy, sets.zw, odd) + use.offset.xy, linear * mix(right.xy, right.zw, odd),
                        linear * mix(below.xy, below.zw, odd));
}

// Averaged frames sample the finest level: filtering normals and alpha would be a bias that no number of frames removes.
vec4 sampleMaterial(sampler2D map, TexturePoint at) {
    float scale = exp2(textureLodBias);
    return viewConverges() ? textureLod(map, at.uv, 0.0) : textureGrad(map, at.uv, scale * at.right, scale * at.below);
}

vec4 surfaceBaseColor(MaterialData material, SurfacePoint point) {
    vec4 base = material.baseColor * point.color;
    if (material.baseColorTexture.offset.w != 0.0) base *= sampleMaterial(baseColorTexture, texturePoint(material.baseColorTexture, point));
    return base;
}

// Smaller mip levels blur alpha, and a fixed cutoff would make foliage thinner with distance: each level has a cutoff of its own.
float surfaceAlphaCutoff(MaterialData material, SurfacePoint point) {
    if (material.baseColorTexture.offset.w == 0.0 || viewConverges()) return material.emissive.w;
    TexturePoint at = texturePoint(material.baseColorTexture, point);
    vec2 size = vec2(textureSize(baseColorTexture, 0));
    float right = length(at.right * size);
    float below = length(at.below * size);
    float level = log2(max(max(min(right, below), max(right, below) / textureAnisotropy), 1e-6)) + textureLodBias;
    level = clamp(level, 0.0, 15.0);
    int lower = int(level);
    int upper = min(lower + 1, 15);
    return mix(material.alphaCutoffs[lower >> 2][lower & 3], material.alphaCutoffs[upper >> 2][upper & 3], level - float(lower));
}

vec3 unitOrElse(vec3 v, vec3 otherwise) {
    float squared = dot(v, v);
    return squared > 0.0 && squared < 1e37 ? v * inversesqrt(squared) : otherwise;
}

// The tangent frame as MikkTSpace has it: interpolated vectors are used as they are, and only the result is made unit.
vec3 surfaceNormal(MaterialData material, SurfacePoint point, vec3 geometricNormal) {
    vec3 normal = unitOrElse(point.normal, geometricNormal);
    if (material.normalTexture.offset.w != 0.0 && point.tangent.w != 0.0) {
        vec3 texel = sampleMaterial(normalTexture, texturePoint(material.normalTexture, point)).xyz * 2.0 - 1.0;
        texel.xy *= material.normalScale;
        vec3 bitangent = cross(point.normal, point.tangent.xyz) * point.tangent.w;
        normal = unitOrElse(point.tangent.xyz * texel.x + bitangent * texel.y + point.normal * texel.z, normal);
    }
    return normal;
}

Surface evaluateSurface(MaterialData material, SurfacePoint point) {
    Surface surface;
    vec3 toEye = viewIsOrthographic() ? -view.cameraForward.xyz : normalize(-point.fromEye);
    vec3 facet = vec3(0.0);
    if (point.isTriangle) facet = cross(dFdx(point.fromEye), dFdy(point.fromEye));
    vec3 sideSeen = point.frontFacing ? point.normal : -point.normal;
    // Lines, points and triangles too small for derivatives have no facet.
    vec3 geometricNormal = unitOrElse(facet, unitOrElse(sideSeen, toEye));
    surface.geometricNormal = dot(geometricNormal, toEye) < 0.0 ? -geometricNormal : geometricNormal;

    vec4 base = surfaceBaseColor(material, point);
    surface.baseColor = base.rgb;
    surface.alpha = base.a;
    surface.unlit = (material.flags & kMaterialUnlit) != 0u || dot(point.normal, point.normal) == 0.0;

    surface.metallic = material.metallic;
    surface.roughness = material.roughness;
    if (material.metallicRoughnessTexture.offset.w != 0.0) {
        vec4 texel = sampleMaterial(metallicRoughnessTexture, texturePoint(material.metallicRoughnessTexture, point));
        surface.roughness *= texel.g;
        surface.metallic *= texel.b;
    }
    surface.specular = material.specular;
    surface.occlusion = 1.0;
    if (material.occlusionTexture.offset.w != 0.0) {
        float texel = sampleMaterial(occlusionTexture, texturePoint(material.occlusionTexture, point)).r;
        surface.occlusion = 1.0 + material.occlusionStrength * (texel - 1.0);
    }
    surface.emissive = material.emissive.rgb;
    if (material.emissiveTexture.offset.w != 0.0)
        surface.emissive *= sampleMaterial(emissiveTexture, texturePoint(material.emissiveTexture, point)).rgb;

    vec3 normal = surfaceNormal(material, point, surface.geometricNormal);
    // glTF 2.0, 3.9.6: back faces reverse the normal before lighting, normal map and all.
    surface.normal = point.frontFacing ? normal : -normal;
    return surface;
}

#endif
