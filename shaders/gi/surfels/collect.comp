// From sub-buffers back to rays, from the coarsest level to the finest: a level's light is added to what is coarser, after that has been filtered over as many
// rays as its level has sub-buffers. Light is over what the ray scatters, so that outlines of media stay; rays that end elsewhere count less. The paper's filter is a plain one.
#include "common/view.glsl"
#include "gi/surfels/interleave.glsl"
#include "gi/surfels/interval_map.glsl"
#include "media/nearest_rays.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std140) uniform Collect { SurfelCollectParams collect; };
layout(std140) uniform Params { MarchParams params; };
uniform sampler2D depth;
uniform sampler2D ways;
uniform sampler2DArray totals;
uniform sampler2DArray levels;
uniform sampler2D coarser;
layout(rgba32f) writeonly uniform image2D collected;

float scatteredBy(ivec2 ray) {
    if (collect.plain != 0u) return 1.0;
    float sum = 0.0;
    for (uint g = 0u; g < map.groups; ++g) sum += meanOf(texelFetch(totals, ivec3(ray, int(g)), 0).rgb);
    return sum;
}

float distanceOf(ivec2 ray) {
    ivec2 pixel = marchedPixel(ray, params, textureSize(depth, 0));
    return rayDistanceFromDepth(vec2(pixel) + 0.5, texelFetch(depth, pixel, 0).r);
}

/// Of the coarser levels, over 3×3 rays `spacing` apart.
vec3 filtered(ivec2 ray, RayWay way) {
    if (collect.spacing == 0) return texelFetch(coarser, ray, 0).rgb;
    float distance = distanceOf(ray);
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (int i = 0; i < 9; ++i) {
        ivec2 step = ivec2(i % 3, i / 3) - 1;
        ivec2 at = ray + step * collect.spacing;
        if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, collect.size))) continue;
        RayWay other = rayWay(texelFetch(ways, at, 0));
        if (!(other.length > 0.0) && collect.plain == 0u) continue;
        float like = collect.plain != 0u ? 1.0 : likeness(distance, vec3(1.0 - way.opacity), distanceOf(at), vec3(1.0 - other.opacity), params);
        float weight = like * like * float((2 - abs(step.x)) * (2 - abs(step.y)));
        sum += weight * texelFetch(coarser, at, 0).rgb;
        weights += weight;
    }
    return sum / max(weights, 1e-37);
}

void main() {
    ivec2 ray = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(ray, collect.size))) return;
    RayWay way = rayWay(texelFetch(ways, ray, 0));
    float scattered = scatteredBy(ray);
    vec3 light = vec3(0.0);
    if ((way.length > 0.0 && scattered > 0.0) || collect.plain != 0u) {
        if (collect.hasCoarser != 0u) light = filtered(ray, way);
        if (collect.hasOwn != 0u) {
            uint level = uint(collect.level);
            uint subBuffer = subBufferOf(level, ray);
            ivec2 texel = subBufferCorner(level, subBuffer, collect.size) + (ray >> collect.level);
            light += texelFetch(levels, ivec3(texel, collect.level), 0).rgb / scattered;
        }
        if (collect.last != 0u) light *= scattered;
    }
    imageStore(collected, ray, vec4(light, 1.0));
}
