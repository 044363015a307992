// Makes the transmittance interval map, in two walks over the same segments: the first sums up, the second puts points and borders where equal parts of the light are gone.
#define MARCH_PHASE_GROUPS PHASE_GROUPS
#include "common/random.glsl"
#include "common/view.glsl"
#define INTERVAL_PLACES
#include "gi/surfels/interval_map.glsl"
#include "media/march_loop.glsl"
#include "media/nearest_rays.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std140) uniform Params { MarchParams params; };
uniform sampler2D depth;
layout(rgba32f) writeonly uniform image2D ways;
layout(rgba32f) writeonly uniform image2DArray totals;
layout(rgba16) writeonly uniform image2DArray shares;

struct Light {
    vec3 of[PHASE_GROUPS];
};

/// ∫ T σs dt over the first part of a segment, up to this fraction of its optical depth.
Light upTo(Segment s, vec3 before, float fraction) {
    Light light;
    for (int g = 0; g < PHASE_GROUPS; ++g) light.of[g] = exp(-before) * s.scattering[g] * (fraction * oneMinusExpOverX(fraction * s.depth));
    return light;
}

float opacityBehind(vec3 before) { return meanOf(vec3(oneMinusExp(before.r), oneMinusExp(before.g), oneMinusExp(before.b))); }

/// Optical depth of a grey medium of this opacity, without cancellation.
float depthOfOpacity(float opacity) { return opacity * minusLogOneMinusOverZ(min(opacity, 1.0)); }

float fractionAtOpacity(vec3 before, vec3 depth, float target) {
    float wanted = depthOfOpacity(target);
    float fraction = 0.0;
    for (int i = 0; i < 4; ++i) {
        vec3 gone = before + fraction * depth;
        vec3 through = exp(-gone);
        float mean = max(meanOf(through), 1e-30);
        fraction += (wanted - depthOfOpacity(opacityBehind(gone))) * mean / max(meanOf(through * depth), 1e-30);
        fraction = clamp(fraction, 0.0, 1.0);
    }
    return fraction;
}

/// Of a ray that the second walk makes intervals of.
struct Cutter {
    uint next;      // event: point of interval next/2, then its border
    float code;     // of the interval's point
    uint before;    // of the one before
    uvec3 done[PHASE_GROUPS]; // of the light of each phase function, codes
};

/// Opacity at event `e`.
float eventOpacity(uint e, float shift, float opacity) {
    float part = (e & 1u) == 0u ? float(e / 2u) + shift : float(e / 2u + 1u);
    return opacity * (part / float(map.intervals));
}

/// The border of an interval: `light` has gone since the beginning, of `total`.
void putBorder(ivec2 ray, inout Cutter cutter, Light light, Light total) {
    uint interval = cutter.next / 2u;
    if ((interval & 1u) == 0u) cutter.before = uint(cutter.code);
    else intervalPlaces[placesOf(ray) + interval / 2u] = cutter.before | uint(cutter.code) << 16u;
    for (uint g = 0u; g < map.groups; ++g) {
        vec3 part = light.of[g] / max(total.of[g], vec3(1e-37));
        uvec3 code = max(uvec3(clamp(part, 0.0, 1.0) * kCodes + 0.5), cutter.done[g]);
        imageStore(shares, ivec3(ray, intervalLayer(interval, g)), vec4(vec3(code - cutter.done[g]), 0.0) / kCodes);
        cutter.done[g] = code;
    }
}

void main() {
    ivec2 number = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(number, map.size))) return;
    marchedMedia = params.media;
    ivec2 pixel = marchedPixel(number, params, textureSize(depth, 0));
    vec2 centre = vec2(pixel) + 0.5;
    Ray ray = cameraRay(centre);
    float distance = rayDistanceFromDepth(centre, texelFetch(depth, pixel, 0).r);

    Light total;
    for (int g = 0; g < PHASE_GROUPS; ++g) total.of[g] = vec3(0.0);
    March march;
    Segment s;
    RayWay way = RayWay(0.0, 0.0, 0.0, 0.0);
    bool any = beginMarch(ray, distance, march);
    March start = march;
    float end = march.next;
    while (any && nextSegment(ray, march, s)) {
        Light light = upTo(s, march.before, 1.0);
        for (int g = 0; g < PHASE_GROUPS; ++g) total.of[g] += light.of[g];
        end = s.start + s.size;
    }
    float most = 0.0;
    for (int g = 0; g < PHASE_GROUPS; ++g) most = max(most, maximumOf(total.of[g]));
    if (any && most > 0.0) way = RayWay(start.next, end - start.next, opacityBehind(march.before), 0.0);
    imageStore(ways, number, vec4(way.start, way.length, way.opacity, 0.0));
    for (uint g = 0u; g < map.groups; ++g) imageStore(totals, ivec3(number, int(g)), vec4(total.of[g], 0.0));
    if (!(way.length > 0.0)) return;

    float shift = 0.5;
    if (map.jitter != 0u) shift = viewConverges() ? pixelNoise(uvec2(number), 0u) : unitFloat(pixelOffset(uvec2(number), 0u));
    Cutter cutter;
    cutter.next = 0u;
    cutter.code = 0.0;
    cutter.before = 0u;
    for (int g = 0; g < PHASE_GROUPS; ++g) cutter.done[g] = uvec3(0u);
    Light sum;
    for (int g = 0; g < PHASE_GROUPS; ++g) sum.of[g] = vec3(0.0);
    march = start;
    uint events = 2u * map.intervals;
    // An event a round, or a segment without one.
    bool inside = false;
    while (cutter.next < events) {
        if (!inside) {
            if (!nextSegment(ray, march, s)) break;
            inside = true;
        }
        float target = eventOpacity(cutter.next, shift, way.opacity);
        if (target > opacityBehind(march.before + s.depth)) {
            Light light = upTo(s, march.before, 1.0);
            for (int g = 0; g < PHASE_GROUPS; ++g) sum.of[g] += light.of[g];
            inside = false;
            continue;
        }
        float fraction = fractionAtOpacity(march.before, s.depth, target);
        if ((cutter.next & 1u) == 0u) {
            // Rounded, so that a point lies where its code says; never before the last one.
            float at = s.start + s.size * fractionAtDepth(s, fraction);
            cutter.code = max(min(round(codeOfDistance(way, at)), kCodes), cutter.code);
        } else {
            Light light = upTo(s, march.before, fraction);
            for (int g = 0; g < PHASE_GROUPS; ++g) light.of[g] += sum.of[g];
            if (cutter.next + 1u == events) light = total;
            putBorder(number, cutter, light, total);
        }
        ++cutter.next;
    }
    // What rounding has left: at the end of the way.
    for (; cutter.next < events; ++cutter.next) {
        if ((cutter.next & 1u) == 0u) cutter.code = kCodes;
        else putBorder(number, cutter, total, total);
    }
}
