// LSE of the surfaces in the G-buffer, before the media between them and the eye.
#include "common/octahedral.glsl"
#include "common/view.glsl"
#include "lighting/surface_light.glsl"
#include "shared/gbuffer.h"

layout(local_size_x = 8, local_size_y = 8) in;

uniform sampler2D gbufferDepth;
uniform sampler2D gbufferNormal;
uniform sampler2D gbufferBase;
uniform sampler2D gbufferMaterial;
layout(rgba32f) writeonly uniform image2D surfaceDirect;

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, imageSize(surfaceDirect)))) return;
    vec3 radiance = vec3(0.0);
    float depth = texelFetch(gbufferDepth, texel, 0).r;
    if (depth > 0.0) {
        vec4 normals = texelFetch(gbufferNormal, texel, 0);
        vec4 base = texelFetch(gbufferBase, texel, 0);
        vec4 material = texelFetch(gbufferMaterial, texel, 0);
        if ((uint(material.w * 65535.0 + 0.5) & kGBufferUnlit) == 0u) {
            LitPoint point;
            vec2 pixel = vec2(texel) + 0.5;
            point.position = renderPosition(pixel, depth);
            point.normal = octahedralDecodeUnorm(normals.xy);
            point.geometricNormal = octahedralDecodeUnorm(normals.zw);
            point.toEye = -cameraRay(pixel).direction;
            point.brdf = makeBrdf(base.rgb, base.w, material.x, material.y);
            point.occlusion = material.z;
            point.pixel = uvec2(texel);
            radiance = directLight(point);
        }
    }
    imageStore(surfaceDirect, texel, vec4(radiance, 1.0));
}
