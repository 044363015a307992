// Light of virtual point lights on surfaces, before the media between them and the eye: for each pixel those of one class of walks.
// MEDIA: 0: there are none; else they attenuate the light.
#if MEDIA
#include "media/optical_depth.glsl"
#endif
#include "common/random.glsl"
#include "gi/vpl/lights.glsl"
#include "shared/gbuffer.h"

layout(local_size_x = 8, local_size_y = 8) in;

uniform sampler2D gbufferDepth;
uniform sampler2D gbufferNormal;
uniform sampler2D gbufferBase;
uniform sampler2D gbufferMaterial;
layout(rgba32f) writeonly uniform image2D surfaceRadiance;

struct Receiver {
    vec3 position;
    vec3 facet;
    vec3 normal;
    vec3 toEye;
    Brdf brdf;
};

/// Nits towards the eye from one virtual light.
vec3 lightFrom(uint light, Receiver r) {
    vec3 way = vplLights[light].position.xyz - r.position;
    float squared = dot(way, way);
    float distance = sqrt(squared);
    vec3 direction = way / max(distance, 1e-30);
    float facing = dot(r.facet, direction);
    if (!(facing > 0.0)) return vec3(0.0);
    float cosine = dot(r.normal, direction);
    if (!(cosine > 0.0)) return vec3(0.0);
    vec3 intensity = vplIntensity(light, -direction);
    if (!(maximumOf(intensity) > 0.0) || !vplSees(light, r.position, -direction, distance, r.facet)) return vec3(0.0);
    // min(G, b)/G of 1/d²; G has both facets' cosines.
    bool onSurface = vplLights[light].position.w < 0.0;
    float cosines = facing * (onSurface ? dot(vplLights[light].normal.xyz, -direction) : 1.0);
    float perArea = 1.0 / max(squared, cosines * vpl.clampSquared);
    BrdfValue value = evaluateBrdf(r.brdf, r.normal, r.toEye, direction);
    vec3 light3 = intensity * (value.diffuse + value.specular) * (cosine * perArea);
#if MEDIA
    light3 *= exp(-opticalDepthAlong(r.position, direction, distance));
#endif
    return light3;
}

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, imageSize(surfaceRadiance)))) return;
    vec3 radiance = vec3(0.0);
    float depth = texelFetch(gbufferDepth, texel, 0).r;
    vec4 material = texelFetch(gbufferMaterial, texel, 0);
    if (depth > 0.0 && (uint(material.w * 65535.0 + 0.5) & kGBufferUnlit) == 0u) {
        vec2 pixel = vec2(texel) + 0.5;
        vec4 normals = texelFetch(gbufferNormal, texel, 0);
        vec4 base = texelFetch(gbufferBase, texel, 0);
        Receiver r;
        r.position = renderPosition(pixel, depth);
        r.toEye = -cameraRay(pixel).direction;
        r.normal = octahedralDecodeUnorm(normals.xy);
        r.facet = octahedralDecodeUnorm(normals.zw);
        r.brdf = makeBrdf(base.rgb, base.w, max(material.x, vpl.leastRoughness), material.y);
        uint number = uint(pixelNoise(uvec2(texel), 20u) * float(vpl.classes)) % vpl.classes;
        for (uint walk = number; walk < vpl.walkCount; walk += vpl.classes)
            for (uint light = vplWalks[walk]; light < vplWalks[walk + 1u]; ++light) radiance += lightFrom(light, r);
        radiance *= float(vpl.classes);
    }
    imageStore(surfaceRadiance, texel, vec4(radiance, 1.0));
}
