// Of a single frame: light that fog scatters to the eye, averaged over neighbouring rays. In fog a ray gathers light at few places, far from each other: one
// ray shows the pattern of these places. Any 3×3 rays have well-spread ones (common/random.glsl): the mean over them is as good as nine times the steps. Rays
// count by how alike they are in where they end and in what gets through to there. Light from grids, which have many steps and detail of their own, stays.
#include "common/math.glsl"
#include "common/view.glsl"
#include "media/nearest_rays.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std140) uniform Params { MarchParams params; };
uniform sampler2D depth;
uniform sampler2D transmittance; // of each ray
uniform sampler2D inScatter;
layout(rgba32f) uniform writeonly image2D smoothed;

const int kRadius = 1;

float distanceOf(ivec2 ray, ivec2 size) {
    ivec2 pixel = marchedPixel(ray, params, size);
    return rayDistanceFromDepth(vec2(pixel) + 0.5, texelFetch(depth, pixel, 0).r);
}

void main() {
    ivec2 ray = ivec2(gl_GlobalInvocationID.xy);
    ivec2 rays = imageSize(smoothed);
    if (any(greaterThanEqual(ray, rays))) return;
    ivec2 size = textureSize(depth, 0);
    float distance = distanceOf(ray, size);
    vec3 through = texelFetch(transmittance, ray, 0).rgb;
    vec4 own = texelFetch(inScatter, ray, 0);
    vec3 fog = vec3(0.0);
    float total = 0.0;
    for (int y = -kRadius; y <= kRadius; ++y)
        for (int x = -kRadius; x <= kRadius; ++x) {
            ivec2 other = ray + ivec2(x, y);
            if (any(lessThan(other, ivec2(0))) || any(greaterThanEqual(other, rays))) continue;
            vec3 otherThrough = texelFetch(transmittance, other, 0).rgb;
            float like = likeness(distance, through, distanceOf(other, size), otherThrough, params);
            float weight = like * like;
            vec4 light = texelFetch(inScatter, other, 0);
            fog += weight * scaledByOpacity(light.rgb * (1.0 - light.w), 1.0 - otherThrough, 1.0 - through);
            total += weight;
        }
    imageStore(smoothed, ray, vec4(own.rgb * own.w + fog / total, own.w));
}
