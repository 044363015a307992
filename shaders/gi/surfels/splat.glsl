// Where a surfel is splatted on a level of the interleaved framebuffer.
#ifndef TYNDALL_GI_SURFELS_SPLAT
#define TYNDALL_GI_SURFELS_SPLAT
#include "common/random.glsl"
#include "common/view.glsl"
#include "gi/surfels/interleave.glsl"
#include "shared/surfels.h"

layout(std140) uniform Splat { SurfelSplatParams splat; };
layout(std430) readonly buffer LitSurfels { LitSurfel lit[]; };
layout(std430) readonly buffer Brightness { SurfelBrightness brightness; };

const float kEndless = 1e18; // metres; its square is finite

/// Radius within which a surfel counts at the finest level: there its light in the media is more than ε of the light that half a sphere of average radiance gives. Around a dim surfel
/// it is less bright: its own radiance counts as much as the average. The printed radius, r B/ε, has no root; B is taken over the average.
float reachOf(LitSurfel s) {
    float mean = brightness.weighted / max(brightness.total, 1e-37);
    float relative = s.normal.w / max(mean, 1e-37);
    float radius = sqrt(s.position.w / 3.14159265);
    float reach = splat.mode == kSurfelEncodingPaper ? relative / splat.threshold : sqrt(max(relative, sqrt(relative)) / (2.0 * splat.threshold));
    return min(radius * reach, 0.5 * kEndless / 64.0);
}

/// A surfel's place among its neighbours, in base 4: digit k from the k-th bits of its coordinates, in units of about its size. In a plane along any two axes, surfels of any
/// block of 2^k × 2^k have different last k digits. It depends on nothing but the surfel: what is drawn besides, and where the eye is, does not make light flicker.
uint placeDigits(LitSurfel s, uint digits) {
    float unit = exp2(ceil(0.5 * log2(max(s.position.w, 1e-30))));
    uvec3 cell = uvec3(ivec3(floor(clamp((s.position.xyz - splat.anchor.xyz) / unit + 0.37, -1e9, 1e9))));
    uint place = 0u;
    for (uint k = 0u; k < digits; ++k) {
        uvec3 bits = cell >> k & 1u;
        place |= (bits.x ^ bits.z | (bits.y ^ bits.z) << 1u) << (2u * k);
    }
    return place;
}

/// By digits in reverse: four neighbours are in different quarters of the ranks. The paper chooses at random.
uint subBufferFor(uint surfel, uint level) {
    uint count = 1u << (2u * level);
    uint shift = hashUint(splat.seed + level);
    if (splat.mode == kSurfelEncodingPaper) return hashUint(surfel + shift) & (count - 1u);
    uint place = placeDigits(lit[surfel], level);
    uint rank = 0u;
    for (uint digit = 0u; digit < level; ++digit) rank = rank << 2u | (place >> (2u * digit) & 3u);
    return (rank + shift) & (count - 1u);
}

/// Does the shell's ball touch the media?
bool touchesMedia(vec3 centre, float radius) {
    vec3 off = max(max(splat.mediaMinimum.xyz - centre, centre - splat.mediaMaximum.xyz), vec3(0.0));
    return dot(off, off) <= radius * radius;
}

/// Slopes x/z between which a ball is seen: `across` and `ahead` of the eye. Endless to a side where the ball reaches beside the eye.
vec2 slopes(float across, float ahead, float radius) {
    float squared = across * across + ahead * ahead - radius * radius;
    if (squared <= 0.0) return vec2(-kEndless, kEndless);
    float tangent = sqrt(squared);
    float low = ahead * tangent + across * radius;
    float high = ahead * tangent - across * radius;
    return vec2(low > 0.0 ? (across * tangent - ahead * radius) / low : -kEndless, high > 0.0 ? (across * tangent + ahead * radius) / high : kEndless);
}

/// The pixels of the ball, lowest and highest; false where no ray meets it.
bool pixelsOf(vec3 centre, float radius, out vec2 lowest, out vec2 highest) {
    lowest = vec2(0.0);
    highest = view.size.xy;
    vec3 c = (view.viewFromRender * vec4(centre, 1.0)).xyz;
    if (radius >= 0.25 * kEndless) return true;
    vec2 x, y;
    if (viewIsOrthographic()) {
        x = c.x + radius * vec2(-1.0, 1.0);
        y = c.y + radius * vec2(-1.0, 1.0);
    } else {
        if (-c.z <= -radius) return false;
        x = slopes(c.x, -c.z, radius);
        y = slopes(c.y, -c.z, radius);
    }
    // A pixel more on each side, for the frame's offset and for rounding.
    vec2 low = (clamp(vec2(x.x, y.x) * splat.focal.xy, -2.0, 2.0) * 0.5 + 0.5) * view.size.xy - 1.5;
    vec2 high = (clamp(vec2(x.y, y.y) * splat.focal.xy, -2.0, 2.0) * 0.5 + 0.5) * view.size.xy + 1.5;
    lowest = max(low, vec2(0.0));
    highest = min(high, view.size.xy);
    return all(lessThan(lowest, highest));
}

struct SplatQuad {
    uint subBuffer;
    vec2 shell;  // inner and outer radius, metres
    ivec2 first; // texels in the sub-buffer
    ivec2 end;
};

/// The texels of one sub-buffer whose rays a shell around a surfel can touch; false where there are none.
bool splatQuad(uint surfel, uint level, out SplatQuad quad) {
    LitSurfel s = lit[surfel];
    float reach = reachOf(s);
    bool tail = splat.tail != 0u && level + 1u == splat.levels;
    quad.subBuffer = subBufferFor(surfel, level);
    quad.shell = vec2(level == 0u ? 0.0 : reach * exp2(float(level) - 1.0), tail ? kEndless : reach * exp2(float(level)));
    vec2 lowest, highest;
    bool lights = s.position.w * s.normal.w > 0.0;
    if (!lights || !touchesMedia(s.position.xyz, quad.shell.y) || !pixelsOf(s.position.xyz, quad.shell.y, lowest, highest)) return false;
    ivec2 most = subBufferSize(level, splat.size);
    // A ray stands for a square of pixels, of which its own is one.
    float perRay = float(splat.factor << level);
    quad.first = clamp(ivec2(floor(lowest / perRay)), ivec2(0), most);
    quad.end = clamp(ivec2(floor(highest / perRay)) + 1, ivec2(0), most);
    return all(lessThan(quad.first, quad.end));
}

#endif
