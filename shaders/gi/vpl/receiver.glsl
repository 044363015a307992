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

vec3 diffuseColour(Receiver r) { return r.brdf.baseColor * (1.0 - r.brdf.metallic); }

/// About what microfacets reflect of even light; from 60 degrees off the normal, or else as seen: nothing but a surface without microfacets has 0.
vec3 specularColour(Receiver r) { return specularFresnel(r.brdf, min(abs(dot(r.normal, r.toEye)), 0.5)); }

#endif
