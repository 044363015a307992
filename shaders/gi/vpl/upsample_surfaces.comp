// From the surfaces of surfaces.comp to every pixel: of the four nearest, those in about the same plane that face the same way. A pixel that
// none of them fits is left to surfaces.comp again, because gathering shaders are large.
#include "gi/shared/surface_light.glsl"
#include "gi/vpl/params.glsl"
#include "media/nearest_rays.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std140) uniform Params { MarchParams params; };
uniform sampler2D squares; // the parts of SurfaceLight side by side
uniform sampler2D transmittance; // of media in view
layout(std430) readonly buffer VplPathLight { vec4 vplPathLight[]; }; // light of compensation paths, by square: nits over reflectance()
layout(rgba32f) writeonly uniform image2D surfaceRadiance; // w: 0 where the pixel is left open

const float kFar = 0.1; // of the distance to the eye: on a surface that is seen at a grazing angle neighbouring pixels lie far apart

const float kDeep = 0.3; // optical depth over which light changes in a medium

/// Weight by the difference of optical depth in front of two pixels: in thick fog light changes over a free path.
float depthApart(ivec2 a, ivec2 b) {
    if (vpl.mediaInView == 0u) return 0.0;
    vec3 quotient = max(texelFetch(transmittance, a, 0).rgb, vec3(1e-30)) / max(texelFetch(transmittance, b, 0).rgb, vec3(1e-30));
    return maximumOf(abs(log(quotient)));
}

/// How well the light of one surface fits another: 1 for a perfect fit.
float surfaceLikeness(Receiver r, Receiver other, float distance) {
    vec3 way = (other.position - r.position) / distance;
    float offPlane = abs(dot(r.facet, way));
    float facing = max(dot(r.normal, other.normal), 0.0);
    float f2 = facing * facing;
    float f4 = f2 * f2;
    return f4 * f4 / (1.0 + offPlane / params.depthTolerance) / (1.0 + dot(way, way) / (kFar * kFar));
}

vec3 pathLightOf(ivec2 square, int squaresAcross) { return (vpl.pathLight & kVplPathsOnSurfaces) != 0u ? vplPathLight[square.y * squaresAcross + square.x].rgb : vec3(0.0); }

void addSquare(inout SurfaceLight sum, ivec2 square, ivec2 right, float weight) {
    sum.diffuse += weight * texelFetch(squares, square, 0).rgb;
    sum.specular += weight * texelFetch(squares, square + right, 0).rgb;
    sum.grazing += weight * texelFetch(squares, square + 2 * right, 0).rgb;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(surfaceRadiance)))) return;
    Receiver r;
    if (!receiverAt(pixel, vpl.leastRoughness, r)) {
        imageStore(surfaceRadiance, pixel, vec4(vec3(0.0), 1.0));
        return;
    }
    float distance = max(length(r.position - cameraRay(vec2(pixel) + 0.5).origin), 1e-20);
    ivec2 size = textureSize(squares, 0) / ivec2(3, 1);
    ivec2 right = ivec2(size.x, 0);
    SurfaceLight light = kDark;
    vec3 near = vec3(0.0);
    float total = 0.0;
    float best = params.factor > 1u ? 0.0 : 1.0;
    if (params.factor > 1u) {
        for (int i = 0; i < 4; ++i) {
            NearRay ray = nearRay(i, pixel, params, size, textureSize(gbufferDepth, 0));
            Receiver other;
            if (!receiverAt(ray.pixel, vpl.leastRoughness, other)) continue;
            float like = surfaceLikeness(r, other, distance) / (1.0 + depthApart(pixel, ray.pixel) / kDeep);
            float weight = rayWeight(like, ray.share);
            best = max(best, like);
            total += weight;
            addSquare(light, ray.coarse, right, weight);
            near += weight * pathLightOf(ray.coarse, size.x);
        }
        total = max(total, 1e-30);
        near /= total;
        light = SurfaceLight(light.diffuse / total, light.specular / total, light.grazing / total);
    } else {
        addSquare(light, pixel, right, 1.0);
        near = pathLightOf(pixel, size.x);
    }
    vec4 radiance = best < params.refineWeight ? vec4(0.0) : vec4(coloured(r, light), 1.0);
    radiance.rgb += near * reflectance(r);
    imageStore(surfaceRadiance, pixel, radiance);
}
