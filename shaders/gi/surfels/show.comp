// Debug views in place of the picture: the levels of the framebuffer, as they are or unshuffled, six panels; or four depths of intervals (as the paper's figure 7).
#include "gi/surfels/interleave.glsl"
#include "gi/surfels/interval_map.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std140) uniform Show { SurfelShowParams show; };
uniform sampler2DArray levels;
uniform sampler2D ways;
layout(rgba32f) writeonly uniform image2D shown;

const float kBrighter = 8.0; // than the picture: each level has a part of the light

vec3 levelAt(uint level, vec2 at) {
    if (level >= uint(textureSize(levels, 0).z)) return vec3(0.0);
    if (show.what == kSurfelShowLevels) return texelFetch(levels, ivec3(at * vec2(textureSize(levels, 0).xy), int(level)), 0).rgb;
    ivec2 ray = ivec2(at * vec2(map.size));
    ivec2 texel = subBufferCorner(level, subBufferOf(level, ray), map.size) + (ray >> int(level));
    return texelFetch(levels, ivec3(texel, int(level)), 0).rgb;
}

/// Brighter is farther away; black where there is no medium.
vec3 depthAt(uint interval, vec2 at) {
    ivec2 ray = ivec2(at * vec2(map.size));
    RayWay way = rayWay(texelFetch(ways, ray, 0));
    if (!(way.length > 0.0)) return vec3(0.0);
    float code = float(placeCode(placesOf(ray), interval));
    return vec3(show.white * clamp((distanceOfCode(way, code) - show.nearest) / (show.farthest - show.nearest), 0.0, 1.0));
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(shown);
    if (any(greaterThanEqual(pixel, size))) return;
    ivec2 panels = show.what == kSurfelShowIntervals ? ivec2(2, 2) : ivec2(3, 2);
    vec2 at = vec2(pixel) / vec2(size) * vec2(panels);
    // Panels from the top left.
    uint panel = uint(panels.y - 1 - int(at.y)) * uint(panels.x) + uint(at.x);
    at = fract(at);
    vec3 light = show.what == kSurfelShowIntervals ? depthAt(panel * (map.intervals - 1u) / 3u, at) : kBrighter * levelAt(panel, at);
    imageStore(shown, pixel, vec4(light, 1.0));
}
