// Indirect light of surfaces from the lattice, before the media between them and the eye: two bands hold no reflections, so what a
// coat or a metal would reflect is spread as evenly as what the base scatters.
#include "common/octahedral.glsl"
#include "common/view.glsl"
#include "gi/lpv/even_reflectance.glsl"
#include "gi/lpv/lookup.glsl"
#include "shared/gbuffer.h"

layout(local_size_x = 8, local_size_y = 8) in;

uniform sampler2D gbufferDepth;
uniform sampler2D gbufferNormal;
uniform sampler2D gbufferBase;
uniform sampler2D gbufferMaterial;
layout(rgba32f) writeonly uniform image2D surfaceRadiance;

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, imageSize(surfaceRadiance)))) return;
    vec3 radiance = vec3(0.0);
    float depth = texelFetch(gbufferDepth, texel, 0).r;
    vec4 material = texelFetch(gbufferMaterial, texel, 0);
    if (depth > 0.0 && (uint(material.w * 65535.0 + 0.5) & kGBufferUnlit) == 0u) {
        vec4 normals = texelFetch(gbufferNormal, texel, 0);
        vec4 base = texelFetch(gbufferBase, texel, 0);
        vec3 normal = octahedralDecodeUnorm(normals.xy);
        // Off the surface: cells behind it have no part in its light. A little towards the eye: a point on an edge is on no side of the
        // other surface there, but the eye is.
        vec2 pixel = vec2(texel) + 0.5;
        vec3 offSurface = kOffSurface * octahedralDecodeUnorm(normals.zw) - 0.01 * cameraRay(pixel).direction;
        LatticeLight light = latticeLight(renderPosition(pixel, depth), offSurface);
        // Of radiance (Φ + 3 F·ω)/4π, what arrives on a plane: Φ/4 - F·n/2.
        vec3 irradiance = max(0.25 * fluence(light) - 0.5 * fluxAlong(light, normal), vec3(0.0));
        radiance = evenReflectance(base, material.y) * irradiance / kPi;
    }
    imageStore(surfaceRadiance, texel, vec4(radiance, 1.0));
}
