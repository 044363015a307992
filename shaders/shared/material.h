// Materials as shaders see them: storage buffer `Materials`, one struct a material; the last entry is the default material.
#ifndef TYNDALL_SHARED_MATERIAL_H
#define TYNDALL_SHARED_MATERIAL_H
#include "shared/types.h"
TYNDALL_SHARED_BEGIN

TYNDALL_CONST uint kMaterialDoubleSided = 1u;
TYNDALL_CONST uint kMaterialUnlit = 2u;
TYNDALL_CONST uint kMaterialMask = 4u;
TYNDALL_CONST uint kMaterialBlend = 8u;

// A texture's place in a material: uv' = (dot(linear.xy, uv), dot(linear.zw, uv)) + offset.xy
struct MaterialTexture {
    vec4 linear;
    vec4 offset; // xy: offset; z: UV set 0..3; w: 1 where there is a texture, else 0
};

struct MaterialData {
    vec4 baseColor;         // linear; w: alpha
    vec4 emissive;          // nits; w: alpha cutoff
    float metallic;
    float roughness;
    float specular;         // scales the dielectric F0
    float normalScale;
    float occlusionStrength;
    uint flags;             // kMaterial…
    uint padding0;
    uint padding1;
    vec4 alphaCutoffs[4];   // kMaterialMask: the cutoff in each mip level of the base colour texture that keeps the area of level 0
    MaterialTexture baseColorTexture;
    MaterialTexture metallicRoughnessTexture;
    MaterialTexture normalTexture;
    MaterialTexture occlusionTexture;
    MaterialTexture emissiveTexture;
};

TYNDALL_SHARED_END
#endif
