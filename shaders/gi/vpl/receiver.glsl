// Surfaces of the picture that light falls on.
#ifndef TYNDALL_GI_VPL_RECEIVER
#define TYNDALL_GI_VPL_RECEIVER
#include "common/math.glsl"
#include "common/octahedral.glsl"
#include "common/view.glsl"
#include "gi/vpl/params.glsl"
#include "lighting/brdf.glsl"
#include "shared/gbuffer.h"

uniform sampler2D gbufferDepth;
uniform sampler2D gbufferNormal;
uniform sampler2D gbufferBase;
uniform sampler2D gbufferMaterial;

struct Receiver {
    vec3 position;
    vec3 facet;
    vec3 normal;
    vec3 toEye;
    Brdf brdf;
};

/// False where there is no surface that light falls on.
bool receiverAt(ivec2 texel, out Receiver r) {
    float depth = texelFetch(gbufferDepth, texel, 0).r;
    vec4 material = texelFetch(gbufferMaterial, texel, 0);
    if (!(depth > 0.0) || (uint(material.w * 65535.0 + 0.5) & kGBufferUnlit) != 0u) return false;
    vec2 pixel = vec2(texel) + 0.5;
    vec4 normals = texelFetch(gbufferNormal, texel, 0);
    vec4 base = texelFetch(gbufferBase, texel, 0);
    r.position = renderPosition(pixel, depth);
    r.toEye = -cameraRay(pixel).direction;
    r.normal = octahedralDecodeUnorm(normals.xy);
    r.facet = octahedralDecodeUnorm(normals.zw);
    r.brdf = makeBrdf(base.rgb, base.w, max(material.x, vpl.leastRoughness), material.y);
    return true;
}

/// Light that leaves a surface towards the eye, nits, over the colours that neighbours do not share: of the base, and of microfacets that reflect all or,
/// after Schlick, what grazes them.
struct SurfaceLight {
    vec3 diffuse;
    vec3 specular;
    vec3 grazing;
};
const SurfaceLight kDark = SurfaceLight(vec3(0.0), vec3(0.0), vec3(0.0));

/// With the surface's colours: as evaluateBrdf() has it.
vec3 coloured(Receiver r, SurfaceLight light) {
    float metallic = r.brdf.metallic;
    vec3 straight = mix(vec3(kDielectricF0 * r.brdf.specular), r.brdf.baseColor, metallic);
    return (1.0 - metallic) * r.brdf.baseColor * light.diffuse + straight * light.specular + mix(r.brdf.specular, 1.0, metallic) * light.grazing;
}

const float kLeastReflectance = 1e-3; // black surfaces mirror no less

/// Of light from all around, about: what neighbours do not share. As the processor has it (vpl_near.cpp).
vec3 reflectance(Receiver r) {
    float metallic = r.brdf.metallic;
    vec3 base = r.brdf.baseColor;
    return max((1.0 - metallic) * (base + kDielectricF0 * r.brdf.specular) + metallic * base, vec3(kLeastReflectance));
}

#endif
