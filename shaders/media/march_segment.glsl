// Cuts a ray into segments in which every medium's density is constant, exponential, or (in exact mode) a cubic along one
// cell of a grid, and sums up the media's coefficients over a segment.
#ifndef TYNDALL_MEDIA_MARCH_SEGMENT
#define TYNDALL_MEDIA_MARCH_SEGMENT
#include "common/view.glsl"
#include "media/blackbody.glsl"
#include "media/optical_depth.glsl"

#ifndef MARCH_PHASE_GROUPS
#define MARCH_PHASE_GROUPS 8
#endif

const float kFarthestGather = 1e15;   // metres; squares of it are finite
const float kDeepestGather = 32.0;    // optical depth beyond which an endless medium sends nothing that counts: e^-32 = 1e-14
const float kHighestGather = 30.0;    // scale heights above which a height medium counts as empty, for gathering light

/// All media over [start, start + size] of a ray, metres.
struct Segment {
    float start;
    float size;
    vec3 depth;            // optical depth
    vec3 scattering[MARCH_PHASE_GROUPS]; // scattering coefficient times length, of each phase group
    vec3 emission;         // nits that would leave it without extinction; not the blackbodies' (blackbodyLight in march.glsl)
    float extinctionStart; // mean over the channels, at the ends
    float extinctionEnd;
    bool scatters;
    bool inGrid;           // a grid has part of it
    bool glows;            // a blackbody has part of it
};

/// Metres from `t` on after which the density of a height medium has summed up to `target` metres; 1e30 where it never does.
float heightDistance(LocalRay ray, float scaleHeight, float t, float target) {
    float slope = ray.direction.y;
    float y = ray.origin.y + slope * t;
    float start = 0.0;
    if (y < 0.0) {
        if (slope <= 0.0) return target;
        start = -y / slope;
        if (target <= start) return target;
        target -= start;
        y = 0.0;
    }
    float density = max(exp(-y / scaleHeight), 1e-30);
    float z = target * slope / (density * scaleHeight);
    if (z >= 1.0) return kInfiniteDistance;
    float way = target / density * minusLogOneMinusOverZ(z);
    if (slope < 0.0 && way > -y / slope) {
        // Down to the origin's level and on at density 1.
        float down = -y / slope;
        way = down + max(target - heightIntegral(ray, scaleHeight, t, t + down), 0.0);
    }
    return min(start + way, kInfiniteDistance);
}

/// Where gathering light from medium `m` may end: an endless medium is cut where it is opaque or has thinned out.
float gatherEnd(uint m, LocalRay ray, float t1) {
    uint kind = media[m].kind;
    if (!kHasShapes || (kind != kMediumEverywhere && kind != kMediumHeight)) return t1;
    vec3 extinction = media[m].extinction.rgb;
    vec3 positive = mix(extinction, vec3(kInfiniteDistance), lessThanEqual(extinction, vec3(0.0)));
    float thinnest = minimumOf(positive);
    t1 = min(t1, kFarthestGather);
    if (thinnest >= kInfiniteDistance) return t1; // it only shines
    if (kind == kMediumEverywhere) return min(t1, kDeepestGather / thinnest);
    float scaleHeight = media[m].extinction.w;
    float slope = ray.direction.y;
    if (slope > 0.0) t1 = min(t1, max(kHighestGather * scaleHeight - ray.origin.y, 0.0) / slope);
    return min(t1, heightDistance(ray, scaleHeight, 0.0, kDeepestGather / thinnest));
}

/// The stretch of the ray in which light can be gathered; false where there is none.
bool mediaExtent(Ray ray, float distance, out float start, out float end) {
    start = kInfiniteDistance;
    end = 0.0;
    for (uint m = 0u; m < mediumCount(); ++m) {
        LocalRay local = localRay(media[m].localFromRender, ray.origin, ray.direction);
        float t0 = 0.0;
        float t1 = distance;
        if (!clipToMedium(m, local, t0, t1)) continue;
        start = min(start, t0);
        end = max(end, gatherEnd(m, local, t1));
    }
    return start < end;
}

/// The next border of a step after `t`, in a medium without a grid that fills [t0,t1]. Steps are of equal length; through
/// a dense medium every other one ends where equal parts of the light are gone, so that near and far both have their share.
float analyticStep(uint m, LocalRay ray, float t0, float t1, float t) {
    float steps = float(mediaHeader.analyticSteps);
    float sigma = meanOf(media[m].extinction.rgb);
    bool height = media[m].kind == kMediumHeight;
    float scaleHeight = media[m].extinction.w;
    float total = sigma * (height ? heightIntegral(ray, scaleHeight, t0, t1) : t1 - t0);
    // Steps share what is not opaque, however far the medium goes on.
    float opaque = -log(max(mediaHeader.minTransmittance, 1e-30));
    float last = t1;
    if (total > opaque) {
        t1 = t0 + (height ? heightDistance(ray, scaleHeight, t0, opaque / sigma) : opaque / sigma);
        total = opaque;
        if (t >= t1) return last;
    }
    bool dense = total > 0.5;
    float lengths = dense ? max(ceil(0.5 * steps), 1.0) : steps;
    // A thousandth of a step more, so that a border that was reached is not found again.
    float i = floor((t - t0) / (t1 - t0) * lengths + 1e-3) + 1.0;
    float next = i < lengths ? t0 + (t1 - t0) * (i / lengths) : last;
    if (dense) {
        float gone = sigma * (height ? heightIntegral(ray, scaleHeight, t0, t) : t - t0);
        float whole = oneMinusExp(total);
        float j = floor(oneMinusExp(gone) / whole * lengths + 1e-3) + 1.0;
        if (j < lengths) {
            float way = (-log(1.0 - j / lengths * whole) - gone) / sigma;
            if (way > 0.0) next = min(next, t + (height ? heightDistance(ray, scaleHeight, t, way) : way));
        }
    }
    return next;
}

/// The next border after `t` inside grid `m`, whose box ends at `t1`: the end of a run of empty bricks, of a constant
/// brick, of a cell (exact) or of a step.
float gridStep(uint m, LocalRay ray, float t1, float t) {
    ivec4 table = media[m].gridBricks;
    vec3 inverse = 1.0 / ray.direction;
    vec3 towards = step(0.0, ray.direction);
    float perCell = 1.0 / length(ray.direction);
    // Looked up a little ahead: the border itself belongs to both sides.
    float inside = t + max(1e-3 * perCell, 4e-7 * t);
    ivec3 brick = clamp(ivec3(floor(positionAt(ray, inside) * 0.125)), ivec3(0), table.xyz - 1);
    int most = table.x + table.y + table.z + 4;
    float border = t;
    for (int i = 0; i < most; ++i) {
        vec3 planes = (8.0 * (vec3(brick) + towards) - ray.origin) * inverse;
        float next = max(minimumOf(planes), border);
        BrickData data = brickAt(table, brick);
        if (data.maximum > 0.0) {
            if (i > 0) return border; // the empty run ends here
            next = clamp(next, inside, t1);
            if (data.slot == kNoSlot) return next;
            if (mediaExact()) {
                vec3 cell = floor(positionAt(ray, inside));
                return clamp(minimumOf((cell + towards - ray.origin) * inverse), inside, next);
            }
            float steps = max(ceil((next - t) / (perCell * mediaHeader.stepVoxels) - 1e-2), 1.0);
            return t + (next - t) / steps;
        }
        if (planes.x <= next) brick.x += ray.direction.x > 0.0 ? 1 : -1;
        if (planes.y <= next) brick.y += ray.direction.y > 0.0 ? 1 : -1;
        if (planes.z <= next) brick.z += ray.direction.z > 0.0 ? 1 : -1;
        if (next >= t1 || any(lessThan(brick, ivec3(0))) || any(greaterThanEqual(brick, table.xyz))) return t1;
        border = next;
    }
    return t1;
}

/// The next border that medium `m` puts on the ray after `t`; 1e30 where there is none.
float nextBorder(uint m, Ray ray, float t, float end) {
    LocalRay local = localRay(media[m].localFromRender, ray.origin, ray.direction);
    float t0 = 0.0;
    float t1 = end;
    if (!clipToMedium(m, local, t0, t1) || t >= t1) return kInfiniteDistance;
    if (t < t0) return t0;
    if (isGrid(m)) return gridStep(m, local, t1, t);
    return analyticStep(m, local, t0, gatherEnd(m, local, t1), t);
}

/// Integral of a grid's density over a segment that lies inside one brick (exact: one cell); `ends`: density at both ends.
float gridSegment(uint m, LocalRay ray, float t0, float t1, out vec2 ends) {
    ends = vec2(0.0);
    vec3 middle = positionAt(ray, 0.5 * (t0 + t1));
    ivec4 table = media[m].gridBricks;
    ivec3 brick = clamp(ivec3(floor(middle * 0.125)), ivec3(0), table.xyz - 1);
    BrickData data = brickAt(table, brick);
    if (!(data.maximum > 0.0)) return 0.0;
    float density = data.maximum;
    ends = vec2(density);
    if (data.slot != kNoSlot) {
        vec3 local = middle - vec3(8 * brick);
        if (mediaExact()) {
            ivec3 cell = clamp(ivec3(floor(local)), ivec3(0), ivec3(7));
            Cell c = fetchCell(data.slot, cell);
            vec3 toEnd = ray.direction * (0.5 * (t1 - t0));
            local -= vec3(cell);
            ends = vec2(interpolate(c, local - toEnd), interpolate(c, local + toEnd));
            density = (ends.x + 4.0 * interpolate(c, local) + ends.y) * (1.0 / 6.0);
        } else {
            // Three samples: where density falls off, light does not reach it evenly, and one sample would not show it.
            vec3 toEnd = ray.direction * (0.5 * (t1 - t0));
            ends = vec2(filteredSample(data.slot, local - toEnd), filteredSample(data.slot, local + toEnd));
            density = (ends.x + 4.0 * filteredSample(data.slot, local) + ends.y) * (1.0 / 6.0);
        }
    }
    return density * (t1 - t0);
}

/// Extinction is taken to change linearly over the segment, between the values at its ends.
/// Fraction of the segment's optical depth before `x`.
float depthFraction(Segment s, float x) {
    float sum = s.extinctionStart + s.extinctionEnd;
    if (sum <= 0.0) return x;
    return x * (2.0 * s.extinctionStart + (s.extinctionEnd - s.extinctionStart) * x) / sum;
}

/// The inverse of depthFraction(): where the fraction `f` of the optical depth lies before.
float fractionAtDepth(Segment s, float f) {
    float a = s.extinctionStart;
    float b = s.extinctionEnd;
    if (a + b <= 0.0) return f;
    // Scaled, because squares of large coefficients overflow.
    float scale = 1.0 / max(a, b);
    a *= scale;
    b *= scale;
    float root = sqrt(max(a * a + f * (b * b - a * a), 0.0));
    return clamp(f * (a + b) / max(a + root, 1e-20), 0.0, 1.0);
}

/// The kinds of media whose scattering segments have; the others take light away all the same. A technique that computes light in some kinds alone sets it.
uint marchedMedia = 0xffffffffu;

/// Adds what medium `m` has in the segment.
void addMedium(uint m, Ray ray, inout Segment s) {
    LocalRay local = localRay(media[m].localFromRender, ray.origin, ray.direction);
    float middle = s.start + 0.5 * s.size;
    float end = s.start + s.size;
    float t0 = s.start;
    float t1 = end;
    // Borders of media are borders of segments: the middle tells whether the segment is inside.
    if (!clipToMedium(m, local, t0, t1) || middle < t0 || middle > t1) return;
    float integral = s.size;
    vec2 ends = vec2(1.0);
    if (isGrid(m)) {
        integral = gridSegment(m, local, s.start, end, ends);
        s.inGrid = s.inGrid || integral > 0.0;
    } else if (media[m].kind == kMediumHeight) {
        float scaleHeight = media[m].extinction.w;
        integral = heightIntegral(local, scaleHeight, s.start, end);
        ends = vec2(heightDensity(positionAt(local, s.start).y, scaleHeight), heightDensity(positionAt(local, end).y, scaleHeight));
    }
    if (integral <= 0.0) return;
    vec3 extinction = media[m].extinction.rgb;
    s.depth += extinction * integral;
    s.extinctionStart += meanOf(extinction) * ends.x;
    s.extinctionEnd += meanOf(extinction) * ends.y;
    vec3 scattering = (media[m].set & marchedMedia) != 0u ? media[m].scattering.rgb : vec3(0.0);
    s.scatters = s.scatters || maximumOf(scattering) > 0.0;
#if MARCH_PHASE_GROUPS == 1
    s.scattering[0] += scattering * integral;
#else
    s.scattering[media[m].phaseGroup] += scattering * integral;
#endif
    s.emission += media[m].emission.rgb * integral;
    s.glows = s.glows || media[m].emission.w > 0.0;
}

/// The segment of the ray that begins at `t`.
Segment marchSegment(Ray ray, float t, float end) {
    float next = end;
    for (uint m = 0u; m < mediumCount(); ++m) next = min(next, nextBorder(m, ray, t, end));
    Segment s;
    s.start = t;
    // Always forward, by more than rounding, so that every march ends.
    s.size = max(next - t, max(2e-7 * t, 1e-30));
    s.depth = vec3(0.0);
    for (int g = 0; g < MARCH_PHASE_GROUPS; ++g) s.scattering[g] = vec3(0.0);
    s.emission = vec3(0.0);
    s.extinctionStart = 0.0;
    s.extinctionEnd = 0.0;
    s.scatters = false;
    s.inGrid = false;
    s.glows = false;
    for (uint m = 0u; m < mediumCount(); ++m) addMedium(m, ray, s);
    s.depth = min(s.depth, vec3(kOpaque));
    return s;
}

#endif
