// Optical depth along rays through the media: closed forms for homogeneous media and height fog; brick by brick for grids,
// where empty and constant bricks are closed forms too, and the others are stepped through or, in exact mode, integrated
// cell by cell: inside a cell the density along a line is a cubic, for which Simpson's rule is exact.
//
// Light-to-point optical depth of grids comes from the light-space volume that optical_depth.comp fills, where the light has one.
#ifndef TYNDALL_MEDIA_OPTICAL_DEPTH
#define TYNDALL_MEDIA_OPTICAL_DEPTH
#include "common/octahedral.glsl"
#include "media/density.glsl"

// Optical depths beyond this are as opaque; sums and products of them stay finite.
const float kOpaque = 1e30;

// ---- closed forms ----------------------------------------------------------------------------------------------

/// Integral of a height medium's density over [t0,t1] of a local ray (metres). Below the origin the density is 1; above it
/// falls off exponentially. Summed from the lower end upwards, where the exponential cannot overflow.
float heightIntegral(LocalRay ray, float scaleHeight, float t0, float t1) {
    float slope = ray.direction.y;
    float y0 = ray.origin.y + slope * t0;
    float y1 = ray.origin.y + slope * t1;
    float below = 0.0;
    float above = t1 - t0;
    float lowest = min(y0, y1);
    if (lowest < 0.0) {
        below = max(y0, y1) <= 0.0 ? above : min(above, -lowest / abs(slope));
        above -= below;
        lowest = 0.0;
    }
    float x = abs(slope) * above / scaleHeight;
    // Past 20 scale heights the rest is below single precision; there the quotient needs no (possibly endless) length.
    float integral = x > 20.0 ? scaleHeight / abs(slope) : above * oneMinusExpOverX(x);
    return below + exp(-lowest / scaleHeight) * integral;
}

// ---- grids -----------------------------------------------------------------------------------------------------

/// Integral of a brick's density over [t0,t1], which lies inside the brick. `ray` is in cells from the brick's corner.
float brickIntegralExact(uint slot, LocalRay ray, vec3 inverse, float t0, float t1) {
    vec3 towards = step(0.0, ray.direction);
    ivec3 cell = clamp(ivec3(floor(positionAt(ray, t0))), ivec3(0), ivec3(7));
    float t = t0;
    float sum = 0.0;
    for (int i = 0; i < 32 && t < t1; ++i) {
        vec3 planes = (vec3(cell) + towards - ray.origin) * inverse;
        float next = clamp(minimumOf(planes), t, t1);
        if (next > t) {
            Cell c = fetchCell(slot, cell);
            vec3 corner = ray.origin - vec3(cell);
            float simpson = interpolate(c, corner + ray.direction * t) + 4.0 * interpolate(c, corner + ray.direction * (0.5 * (t + next))) +
                            interpolate(c, corner + ray.direction * next);
            sum += simpson * (next - t) * (1.0 / 6.0);
        }
        if (planes.x <= next) cell.x += ray.direction.x > 0.0 ? 1 : -1;
        if (planes.y <= next) cell.y += ray.direction.y > 0.0 ? 1 : -1;
        if (planes.z <= next) cell.z += ray.direction.z > 0.0 ? 1 : -1;
        if (any(lessThan(cell, ivec3(0))) || any(greaterThan(cell, ivec3(7)))) break;
        t = next;
    }
    return sum;
}

// A shader that needs no more than a few steps through a brick says how many.
#ifndef MOST_BRICK_STEPS
#define MOST_BRICK_STEPS kMostBrickSteps
#endif

/// The same by equal steps, each taken for its middle.
float brickIntegralSteps(uint slot, LocalRay ray, float t0, float t1) {
    float count = clamp(ceil((t1 - t0) * length(ray.direction) / mediaHeader.stepVoxels), 1.0, float(MOST_BRICK_STEPS));
    float width = (t1 - t0) / count;
    float sum = 0.0;
    for (float i = 0.5; i < count; i += 1.0) sum += filteredSample(slot, positionAt(ray, t0 + i * width));
    return sum * width;
}

/// Integral of the density of grid `m` over [t0,t1] of a ray, in metres.
float gridIntegral(uint m, LocalRay ray, float t0, float t1) {
    ivec4 table = media[m].gridBricks;
    vec3 inverse = 1.0 / ray.direction;
    vec3 towards = step(0.0, ray.direction);
    ivec3 brick = clamp(ivec3(floor(positionAt(ray, t0) * 0.125)), ivec3(0), table.xyz - 1);
    float t = t0;
    float sum = 0.0;
    int most = table.x + table.y + table.z + 4;
    for (int i = 0; i < most && t < t1; ++i) {
        vec3 planes = (8.0 * (vec3(brick) + towards) - ray.origin) * inverse;
        float next = clamp(minimumOf(planes), t, t1);
        BrickData data = brickAt(table, brick);
        if (data.maximum > 0.0 && next > t) {
            if (data.slot == kNoSlot) {
                sum += data.maximum * (next - t);
            } else {
                LocalRay inside = LocalRay(ray.origin - vec3(8 * brick), ray.direction);
                sum += mediaExact() ? brickIntegralExact(data.slot, inside, inverse, t, next) : brickIntegralSteps(data.slot, inside, t, next);
            }
        }
        if (planes.x <= next) brick.x += ray.direction.x > 0.0 ? 1 : -1;
        if (planes.y <= next) brick.y += ray.direction.y > 0.0 ? 1 : -1;
        if (planes.z <= next) brick.z += ray.direction.z > 0.0 ? 1 : -1;
        if (any(lessThan(brick, ivec3(0))) || any(greaterThanEqual(brick, table.xyz))) break;
        t = next;
    }
    return sum;
}

// ---- all media -------------------------------------------------------------------------------------------------

/// Integral of the density of medium `m` over [t0,t1] of a ray of render space, in metres.
float mediumIntegral(uint m, vec3 origin, vec3 direction, float t0, float t1) {
    LocalRay ray = localRay(media[m].localFromRender, origin, direction);
    if (!clipToMedium(m, ray, t0, t1)) return 0.0;
    if (isGrid(m)) return gridIntegral(m, ray, t0, t1);
    if (media[m].kind == kMediumHeight) return heightIntegral(ray, media[m].extinction.w, t0, t1);
    return t1 - t0;
}

vec3 opticalDepthOf(uint first, uint last, vec3 origin, vec3 direction, float t0, float t1) {
    vec3 depth = vec3(0.0);
    for (uint m = first; m < last; ++m)
        depth += media[m].extinction.rgb * mediumIntegral(m, origin, direction, t0, t1);
    return min(depth, vec3(kOpaque));
}

/// Optical depth of all media over [t0,t1] metres along a ray. `direction` is unit; 1e30 stands for infinity.
vec3 opticalDepthBetween(vec3 origin, vec3 direction, float t0, float t1) {
    return opticalDepthOf(0u, mediumCount(), origin, direction, t0, t1);
}

vec3 opticalDepthAlong(vec3 origin, vec3 direction, float distance) {
    return opticalDepthBetween(origin, direction, 0.0, distance);
}

/// Optical depth of the media that are not grids: always exact, never marched.
vec3 analyticOpticalDepth(vec3 origin, vec3 direction, float t0, float t1) {
    if (!kHasShapes) return vec3(0.0);
    return opticalDepthOf(0u, firstGrid(), origin, direction, t0, t1);
}

vec3 gridOpticalDepth(vec3 origin, vec3 direction, float t0, float t1) {
    return opticalDepthOf(firstGrid(), mediumCount(), origin, direction, t0, t1);
}

// ---- towards lights --------------------------------------------------------------------------------------------

/// Place of `position` in the volume of a view: lateral coordinates and the way from the light, each 0..1.
/// False where no grid can lie between the light and the point.
bool opticalDepthCoordinates(OpticalDepthView v, vec3 position, out vec3 uvw) {
    uvw = vec3(0.0);
    if (v.kind == kDepthViewParallel) {
        uvw = (v.volumeFromRender * vec4(position, 1.0)).xyz;
    } else {
        vec3 away = position - v.origin.xyz;
        float distance = length(away);
        uvw.z = (distance - v.radial.x) * v.origin.w;
        if (!(uvw.z > 0.0)) return false;
        if (v.kind == kDepthViewCone) {
            vec3 d = mat3(v.volumeFromRender) * away;
            if (d.z <= 0.0) return false;
            uvw.xy = d.xy / d.z * 0.5 + 0.5;
        } else {
            uvw.xy = octahedralEncode(away / distance) * 0.5 + 0.5;
        }
    }
    if (!(uvw.z > 0.0) || any(lessThan(uvw.xy, vec2(0.0))) || any(greaterThan(uvw.xy, vec2(1.0)))) return false;
    uvw.z = min(uvw.z, 1.0);
    return true;
}

/// Optical depth of the grids between a light and a point, from the light's volume. Linear in the stored depths: texel
/// centres lie on the planes and edges of the volume, so that nothing is extrapolated.
vec3 volumeOpticalDepth(OpticalDepthView v, vec3 position) {
    vec3 uvw;
    if (!opticalDepthCoordinates(v, position, uvw)) return vec3(0.0);
    vec3 texel = vec3(v.block.xyz) + uvw * float(v.block.w - 1) + 0.5;
    return textureLod(lightOpticalDepth, texel / vec3(textureSize(lightOpticalDepth, 0)), 0.0).rgb;
}

/// Optical depth from `position` to light number `light`, which lies `distance` metres (1e30: infinity) along `direction`.
vec3 opticalDepthToLight(uint light, vec3 position, vec3 direction, float distance) {
    vec3 depth = analyticOpticalDepth(position, direction, 0.0, distance);
    if (firstGrid() == mediumCount()) return depth;
    bool volumes = kLightVolumes || (mediaHeader.flags & kMediaLightDepthVolume) != 0u;
    uint kind = volumes ? opticalDepthViews[light].kind : kDepthViewMarch;
    if (kind == kDepthViewNone) return depth;
    if (!kLightVolumes && kind == kDepthViewMarch) return depth + gridOpticalDepth(position, direction, 0.0, distance);
    return depth + volumeOpticalDepth(opticalDepthViews[light], position);
}

#endif
