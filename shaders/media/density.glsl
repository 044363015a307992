// The media of a frame: where a ray meets each of them, and the density there. Every ray parameter is in metres of
// render space; a density multiplies a medium's coefficients and is 1 inside homogeneous media.
#ifndef TYNDALL_MEDIA_DENSITY
#define TYNDALL_MEDIA_DENSITY
#include "common/math.glsl"
#include "shared/medium.h"
#include "shared/optical_depth.h"

// All that the media bind (bindMedia in engine/renderer/frame_resources.h), so that every shader of theirs knows the names.
layout(std430) readonly buffer Media {
    MediaHeader mediaHeader;
    MediumData media[];
};
layout(std430) readonly buffer Bricks {
    BrickData bricks[];
};
layout(std430) readonly buffer Blackbody {
    vec4 blackbodyRange;   // kelvin of the first entry, of the last, 1 / (1/first - 1/last), number of entries - 1
    vec4 blackbodyTable[]; // xyz: linear sRGB at 1 nit; w: log2 of the luminance in nits
};
layout(std430) readonly buffer OpticalDepthViews {
    OpticalDepthView opticalDepthViews[];
};
uniform sampler3D mediumAtlas;
uniform sampler3D lightOpticalDepth;

// A shader that is run for many rays defines MEDIA_KINDS (kMediaShapes and so on): code for what a frame does not have costs
// registers, even where it is never reached, and software drivers run both sides of every branch. Without it, everything is there.
#ifdef MEDIA_KINDS
const bool kHasShapes = (uint(MEDIA_KINDS) & kMediaShapes) != 0u;
const bool kHasGrids = (uint(MEDIA_KINDS) & kMediaGrids) != 0u;
const bool kOneMedium = (uint(MEDIA_KINDS) & kMediaSingle) != 0u;
const bool kLightVolumes = (uint(MEDIA_KINDS) & kMediaLightVolumes) != 0u;
bool mediaExact() { return (uint(MEDIA_KINDS) & kMediaExactGrids) != 0u; }
#else
const bool kOneMedium = false;
const bool kLightVolumes = false;
const bool kHasShapes = true;
const bool kHasGrids = true;
bool mediaExact() { return (mediaHeader.flags & kMediaExact) != 0u; }
#endif

uint mediumCount() { return kOneMedium ? 1u : mediaHeader.mediumCount; }
/// The grids come last.
uint firstGrid() { return !kHasShapes ? 0u : !kHasGrids ? mediumCount() : mediaHeader.mediumCount - mediaHeader.gridCount; }
bool isGrid(uint m) { return kHasGrids && (!kHasShapes || media[m].kind == kMediumGrid); }

/// A ray in a medium's own coordinates with the parameter still in metres of render space.
struct LocalRay {
    vec3 origin;
    vec3 direction; // no component is zero: divisions are safe
};

LocalRay localRay(mat4 localFromRender, vec3 origin, vec3 direction) {
    LocalRay ray;
    ray.origin = (localFromRender * vec4(origin, 1.0)).xyz;
    vec3 d = mat3(localFromRender) * direction;
    // A ray along an axis never reaches the other planes: 1e-20 puts them beyond every distance.
    ray.direction = mix(d, vec3(1e-20), lessThan(abs(d), vec3(1e-20)));
    return ray;
}

vec3 positionAt(LocalRay ray, float t) { return ray.origin + ray.direction * t; }

/// Clips [t0,t1] to a box. Half-open, so that two boxes that share a face do not both hold a ray inside that face.
bool clipToBox(LocalRay ray, vec3 lowest, vec3 highest, inout float t0, inout float t1) {
    vec3 inverse = 1.0 / ray.direction;
    vec3 a = (lowest - ray.origin) * inverse;
    vec3 b = (highest - ray.origin) * inverse;
    t0 = max(t0, maximumOf(min(a, b)));
    t1 = min(t1, minimumOf(max(a, b)));
    return t0 < t1;
}

/// Clips [t0,t1] to the unit ball, from the point of the ray that is nearest to its centre: no cancellation for far origins.
bool clipToUnitBall(LocalRay ray, inout float t0, inout float t1) {
    float squaredSpeed = dot(ray.direction, ray.direction);
    float nearest = -dot(ray.origin, ray.direction) / squaredSpeed;
    vec3 p = positionAt(ray, nearest);
    float discriminant = 1.0 - dot(p, p);
    if (!(discriminant > 0.0)) return false;
    float halfChord = sqrt(discriminant / squaredSpeed);
    t0 = max(t0, nearest - halfChord);
    t1 = min(t1, nearest + halfChord);
    return t0 < t1;
}

/// Clips [t0,t1] to the part of the ray where medium `m` can have density. False where it has none.
bool clipToMedium(uint m, LocalRay ray, inout float t0, inout float t1) {
    if (isGrid(m)) return clipToBox(ray, vec3(0.0), vec3(8 * media[m].gridBricks.xyz), t0, t1);
    uint kind = media[m].kind;
    if (kind == kMediumBox) return clipToBox(ray, vec3(-0.5), vec3(0.5), t0, t1);
    if (kind == kMediumSphere) return clipToUnitBall(ray, t0, t1);
    return t0 < t1;
}

// ---- bricks ----------------------------------------------------------------------------------------------------

BrickData brickAt(ivec4 table, ivec3 brick) {
    return bricks[table.w + (brick.z * table.y + brick.y) * table.x + brick.x];
}

/// First texel of a brick's samples in the atlas.
ivec3 atlasTexel(uint slot) {
    return 9 * ivec3(slot & 1023u, (slot >> 10u) & 1023u, slot >> 20u);
}

/// The samples at the corners of one cell of a brick: x fastest in `low` (z = 0) and `high` (z = 1).
struct Cell {
    vec4 low;
    vec4 high;
};

Cell fetchCell(uint slot, ivec3 cell) {
    ivec3 texel = atlasTexel(slot) + cell;
    Cell c;
    c.low = vec4(texelFetch(mediumAtlas, texel, 0).r, texelFetch(mediumAtlas, texel + ivec3(1, 0, 0), 0).r,
                 texelFetch(mediumAtlas, texel + ivec3(0, 1, 0), 0).r, texelFetch(mediumAtlas, texel + ivec3(1, 1, 0), 0).r);
    c.high = vec4(texelFetch(mediumAtlas, texel + ivec3(0, 0, 1), 0).r, texelFetch(mediumAtlas, texel + ivec3(1, 0, 1), 0).r,
                  texelFetch(mediumAtlas, texel + ivec3(0, 1, 1), 0).r, texelFetch(mediumAtlas, texel + ivec3(1, 1, 1), 0).r);
    return c;
}

/// Trilinear in single precision; texture filtering has 8-bit weights on some hardware.
float interpolate(Cell c, vec3 f) {
    f = clamp(f, 0.0, 1.0);
    vec4 v = mix(c.low, c.high, f.z);
    vec2 w = mix(v.xy, v.zw, f.y);
    return mix(w.x, w.y, f.x);
}

/// Density inside brick `slot` at `p` in cells from the brick's corner, through the texture unit.
float filteredSample(uint slot, vec3 p) {
    vec3 texel = vec3(atlasTexel(slot)) + clamp(p, 0.0, 8.0) + 0.5;
    return textureLod(mediumAtlas, texel / vec3(textureSize(mediumAtlas, 0)), 0.0).r;
}

/// The grid of brick table `table` at `p` in cells from its corner; 0 outside.
float sampleGrid(ivec4 table, vec3 p) {
    ivec3 brick = ivec3(floor(p * 0.125));
    if (any(lessThan(brick, ivec3(0))) || any(greaterThanEqual(brick, table.xyz))) return 0.0;
    BrickData data = brickAt(table, brick);
    if (data.slot == kNoSlot) return data.maximum;
    vec3 local = p - vec3(8 * brick);
    if (!mediaExact()) return filteredSample(data.slot, local);
    ivec3 cell = clamp(ivec3(floor(local)), ivec3(0), ivec3(7));
    return interpolate(fetchCell(data.slot, cell), local - vec3(cell));
}

/// Density of a height medium at `y` metres above its origin.
float heightDensity(float y, float scaleHeight) {
    return exp(-max(y, 0.0) / scaleHeight);
}

/// Density of medium `m` at a point of render space.
float mediumDensity(uint m, vec3 position) {
    vec3 p = (media[m].localFromRender * vec4(position, 1.0)).xyz;
    if (isGrid(m)) return sampleGrid(media[m].gridBricks, p);
    uint kind = media[m].kind;
    if (kind == kMediumBox) return all(lessThan(abs(p), vec3(0.5))) ? 1.0 : 0.0;
    if (kind == kMediumSphere) return dot(p, p) < 1.0 ? 1.0 : 0.0;
    if (kind == kMediumHeight) return heightDensity(p.y, media[m].extinction.w);
    return 1.0;
}

#endif
