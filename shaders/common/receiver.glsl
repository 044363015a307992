// What the G-buffer has at a pixel: a point of a surface that light falls on. The pass binds it by bindGBuffer (engine/plugin/frame_resources.h).
#ifndef TYNDALL_COMMON_RECEIVER
#define TYNDALL_COMMON_RECEIVER
#include "common/octahedral.glsl"
#include "common/view.glsl"
#include "lighting/brdf.glsl"
#include "shared/gbuffer.h"

uniform sampler2D gbufferDepth;
uniform sampler2D gbufferNormal;
uniform sampler2D gbufferBase;
uniform sampler2D gbufferMaterial;

struct Receiver {
    vec3 position; // render space
    vec3 facet;    // unit, geometric, towards the eye
    vec3 normal;   // unit, shading
    vec3 toEye;    // unit
    float roughness; // as the material has it
    float occlusion; // for light from all around: 1 open, 0 closed
    Brdf brdf;
};

/// False where there is no surface that light falls on. `leastRoughness`: smoother surfaces reflect as if they were this rough.
bool receiverAt(ivec2 texel, float leastRoughness, out Receiver r) {
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
    r.roughness = material.x;
    r.occlusion = material.z;
    r.brdf = makeBrdf(base.rgb, base.w, max(material.x, leastRoughness), material.y);
    return true;
}

bool receiverAt(ivec2 texel, out Receiver r) { return receiverAt(texel, 0.0, r); }

#endif
