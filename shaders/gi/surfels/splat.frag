// Light of one surfel in the intervals of one eye ray that lie inside a shell around it, added to the ray's sub-buffer.
//
// RAYS 0: whatever lies between is ignored, but for the closed forms of media without a grid. 1: one interval, chosen in proportion to its light, is asked for all: the mean
// over choices is the light of all, with what is between. 2: every interval is asked. PAPER: kernel and weights as printed (section 4.2).
#include "gi/surfels/splat.glsl"
#include "common/phase_function.glsl"
#include "gi/surfels/interval_map.glsl"
#include "gi/surfels/kernel.glsl"
#include "media/nearest_rays.glsl"
#include "media/optical_depth.glsl"
#if RAYS
#include "gi/shared/visibility.glsl"
#endif

flat in uint surfelNumber;
flat in uint subBuffer;
flat in vec2 shell;

uniform sampler2D ways;
uniform sampler2DArray totals;
uniform sampler2DArray shares;
layout(std140) uniform Params { MarchParams params; };

layout(location = 0) out vec4 light; // w: 1 for each surfel that has come to the ray

/// The first interval whose point is not before `code`.
uint firstInterval(uint places, float code) {
    uint low = 0u;
    uint high = map.intervals;
    while (low < high) {
        uint middle = (low + high) / 2u;
        if (float(placeCode(places, middle)) < code) low = middle + 1u;
        else high = middle;
    }
    return low;
}

#if PAPER
/// As printed: πr² max(cos, 0)/max(d², δ). What the paper calls radiosity is radiance here, or all would be too bright by π.
float printedKernel(float area, float height, float squared) {
    return area * abs(height) * inversesqrt(max(squared, 1e-30)) / max(squared, splat.nearest);
}
#endif

struct Pair {
    vec3 light;    // of the interval, before what is between is asked
    vec3 position; // of the interval's point
};

vec3 totalOf[PHASE_GROUPS]; // of the ray

void readTotals(ivec2 ray) {
    for (uint g = 0u; g < min(map.groups, uint(PHASE_GROUPS)); ++g) totalOf[g] = texelFetch(totals, ivec3(ray, int(g)), 0).rgb;
}

/// Of the interval's light of all phase functions.
vec3 scatteredToEye(ivec2 ray, RayWay way, uint interval, float cosine) {
    vec3 sum = vec3(0.0);
#if PAPER
    // Of point i, counted from 1: (1 − i (1 − τ_min)/(n − 1)) (d_i − d_(i−1)) c_i; negative for the last one, which is never reached.
    vec2 texel = texelFetch(shares, ivec3(ray, int(interval)), 0).rg * kCodes;
    float through = 1.0 - float(interval + 1u) * (1.0 - way.opacity) / float(map.intervals - 1u);
    float weight = through * texel.x * way.length * (texel.y / 255.0) * way.largest;
    sum = weight * totalOf[0] * phaseFunction(uint(mediaHeader.phases[0].x), mediaHeader.phases[0].y, cosine);
#elif PHASE_GROUPS == 1
    vec3 weight = totalOf[0] * texelFetch(shares, ivec3(ray, int(interval)), 0).rgb;
    sum = weight * phaseFunction(uint(mediaHeader.phases[0].x), mediaHeader.phases[0].y, cosine);
#else
    for (uint g = 0u; g < map.groups; ++g) {
        vec3 weight = totalOf[g] * texelFetch(shares, ivec3(ray, intervalLayer(interval, g)), 0).rgb;
        sum += weight * phaseFunction(uint(mediaHeader.phases[g].x), mediaHeader.phases[g].y, cosine);
    }
#endif
    return sum;
}

Pair pairLight(LitSurfel s, Ray ray, ivec2 number, uint places, RayWay way, uint interval) {
    Pair pair;
    pair.position = ray.origin + ray.direction * distanceOfCode(way, float(placeCode(places, interval)));
    vec3 off = pair.position - s.position.xyz;
    float squared = dot(off, off);
    float height = dot(off, s.normal.xyz);
    vec3 radiance = height > 0.0 ? s.front.rgb : s.back.rgb;
    float distance = sqrt(squared);
    float cosine = distance > 0.0 ? -dot(off, ray.direction) / distance : 0.0;
#if PAPER
    float form = printedKernel(s.position.w, height, squared);
#else
    float form = kernel(s.position.w, height, squared);
#endif
    pair.light = radiance * scatteredToEye(number, way, interval, cosine) * form;
    if (RAYS != 1 && splat.attenuation != 0u && maximumOf(pair.light) > 0.0) {
        vec3 direction = distance > 0.0 ? -off / distance : vec3(1.0, 0.0, 0.0);
        pair.light *= exp(-analyticOpticalDepth(pair.position, direction, 0.0, distance));
    }
    return pair;
}

#if RAYS
/// What of a pair's light gets through surfaces and grids.
vec3 between(Pair pair, LitSurfel s) {
    if (splat.visibility != 0u && triangleBetween(pair.position, s.position.xyz)) return vec3(0.0);
    if (splat.attenuation == 0u) return vec3(1.0);
    vec3 way = s.position.xyz - pair.position;
    float distance = length(way);
    way /= max(distance, 1e-30);
    if (RAYS == 1) return exp(-opticalDepthAlong(pair.position, way, distance));
    return exp(-gridOpticalDepth(pair.position, way, 0.0, distance));
}
#endif

void main() {
    light = vec4(0.0);
    ivec2 cell = ivec2(gl_FragCoord.xy) - subBufferCorner(splat.level, subBuffer, splat.size);
    ivec2 number = rayOf(splat.level, subBuffer, cell);
    if (any(greaterThanEqual(number, splat.size))) return;
    RayWay way = rayWay(texelFetch(ways, number, 0));
    if (!(way.length > 0.0)) return;
    LitSurfel s = lit[surfelNumber];
    Ray ray = cameraRay(vec2(marchedPixel(number, params, ivec2(view.size.xy))) + 0.5);
    vec3 toSurfel = s.position.xyz - ray.origin;
    float abreast = dot(toSurfel, ray.direction);
    vec3 aside = toSurfel - abreast * ray.direction;
    float off = dot(aside, aside);
    uint places = placesOf(number);
    float outer = shell.y * shell.y - off;
    if (!(outer > 0.0)) return;
    outer = sqrt(outer);
    uint first = firstInterval(places, codeOfDistance(way, abreast - outer));
    uint end = firstInterval(places, codeOfDistance(way, abreast + outer));
    uint hole = end;
    uint holeEnd = end;
    float inner = shell.x * shell.x - off;
    if (inner > 0.0) {
        inner = sqrt(inner);
        hole = firstInterval(places, codeOfDistance(way, abreast - inner));
        holeEnd = firstInterval(places, codeOfDistance(way, abreast + inner));
    }
    readTotals(number);
    vec3 sum = vec3(0.0);
#if RAYS == 1
    float u = unitFloat(hashUint(surfelNumber * 0x9e3779b9u + hashUint(uint(number.x) + hashUint(uint(number.y) + splat.seed))));
    float total = 0.0;
    float chosenLight = 0.0;
    Pair chosen = Pair(vec3(0.0), vec3(0.0));
#endif
    for (uint i = first; i < end; ++i) {
        if (i == hole) i = holeEnd;
        if (i >= end) break;
        Pair pair = pairLight(s, ray, number, places, way, i);
#if RAYS == 1
        float strength = maximumOf(pair.light);
        total += strength;
        float part = strength / max(total, 1e-37);
        bool take = strength > 0.0 && u < part;
        u = take ? u / part : (u - part) / max(1.0 - part, 1e-7);
        if (take) {
            chosen = pair;
            chosenLight = strength;
        }
#elif RAYS == 2
        if (maximumOf(pair.light) > 0.0) sum += pair.light * between(pair, s);
#else
        sum += pair.light;
#endif
    }
#if RAYS == 1
    if (chosenLight > 0.0) sum = chosen.light * (total / chosenLight) * between(chosen, s);
#endif
    light = vec4(sum * float(1u << (2u * splat.level)), 1.0);
}
