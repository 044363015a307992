// Visibility maps from points of surfaces: imperfect shadow maps (Ritschel et al. 2008). A work group makes one light's map: each point of the
// light's set is splatted as a disc in its triangle's plane, the nearest wins its texel, and gaps between points are filled from a pyramid of
// the nearest ones. The result does not depend on the order of threads.
#include "common/octahedral.glsl"
#include "gi/vpl/map_texel.glsl"
#include "shared/traced.h"

layout(local_size_x = 256) in;

layout(std140) uniform Points { VplPointParams points; };
layout(std430) readonly buffer VplPlaces { VplPlace vplPlaces[]; };
layout(std430) readonly buffer TracedTriangles { TracedTriangle tracedTriangles[]; };
layout(std430) readonly buffer VplPoints { VplPoint vplPoints[]; };
layout(std430) coherent buffer VplMaps { uint vplMaps[]; }; // numbers of points until the last step

const uint kNothing = kNoTriangle; // no triangle, and no point
const uint kThreads = 256u;
const int kSmallSplat = 3;      // texels that a thread's own splat reaches to each side of the middle
const uint kMostLarge = 256u;   // larger splats that all threads share
const uint kFinestCells = 64u;  // along an edge of the pyramid's finest level
const float kFarthest = 1e30;
const float kHole = 3.0;        // radii: farther from a point nothing is filled with it
const float kSeam = 1e-3;       // barycentric: neighbours overlap
const float kOwnPlane = 1e-4;   // of distances and coordinates: so near to the light's own plane a point blocks nothing

/// The disc that a point is splatted as.
struct Disc {
    vec3 way; // from the light to the point
    float toPlane; // dot(normal, way)
    vec3 normal;
    float radius;
    float near, far; // distances that it may have
};

shared uint cells[kFinestCells * kFinestCells * 4u / 3u + 8u]; // the pyramid, finest level first
shared uint large[kMostLarge];
shared uint largeCount;
shared uint nearestBits;

uint mapStart;
vec3 origin;

float radiusOf(vec3 position) {
    vec3 off = position - points.around.xyz;
    return points.spread * sqrt(dot(off, off) + points.around.w);
}

vec3 directionOf(uint texel) {
    vec2 at = vec2(texel % vpl.mapSide, texel / vpl.mapSide) + 0.5;
    return octahedralDecode(at * (2.0 / float(vpl.mapSide)) - 1.0);
}


Disc discOf(uint point) {
    Disc disc;
    vec3 position = vplPoints[point].position;
    disc.way = position - origin;
    disc.normal = tracedTriangles[vplPoints[point].triangle].plane.xyz;
    disc.toPlane = dot(disc.normal, disc.way);
    disc.radius = radiusOf(position);
    disc.near = length(disc.way) - disc.radius;
    disc.far = disc.near + 2.0 * disc.radius;
    return disc;
}

/// Metres to the disc; from outside of it to its plane, as far as its radius allows.
float distanceAlong(Disc disc, vec3 direction) {
    float distance = disc.toPlane / dot(disc.normal, direction); // infinite or no number along the plane
    return distance > 0.0 ? clamp(distance, disc.near, disc.far) : disc.far;
}

float distanceAlong(uint point, vec3 direction) { return distanceAlong(discOf(point), direction); }

/// The nearer of two points in a direction; of equals that of lesser number.
uint nearer(uint one, uint other, vec3 direction) {
    if (one == kNothing || one == other) return other;
    if (other == kNothing) return one;
    float here = distanceAlong(one, direction);
    float there = distanceAlong(other, direction);
    return here < there || (here == there && one < other) ? one : other;
}

void offer(uint texel, uint point, float distance, vec3 direction) {
    uint current = vplMaps[mapStart + texel];
    // Each round more means that another point, nearer than the last, took the texel.
    for (;;) {
        if (current != kNothing) {
            float there = distanceAlong(current, direction);
            if (there < distance || (there == distance && current <= point)) return;
        }
        uint found = atomicCompSwap(vplMaps[mapStart + texel], current, point);
        if (found == current) return;
        current = found;
    }
}

/// Is a place within so many radii of the disc's middle, and on its triangle? Triangles that are smaller than discs count as going on: not all of their
/// neighbours have a point. `at`: from the light.
bool onDisc(uint point, Disc disc, vec3 at, float radii) {
    vec3 off = at - disc.way;
    float reach = radii * disc.radius;
    if (dot(off, off) > reach * reach) return false;
    TracedTriangle triangle = tracedTriangles[vplPoints[point].triangle];
    // The inverse of the radius of the circle in a triangle is the sum of the inverses of its heights.
    float inverse = length(triangle.second) + length(triangle.third) + length(triangle.second + triangle.third);
    if (disc.radius * inverse > 1.0) return true;
    vec3 place = at + origin - triangle.corner.xyz;
    float second = dot(triangle.second, place);
    float third = dot(triangle.third, place);
    return min(second, third) >= -kSeam && second + third <= 1.0 + kSeam;
}

/// Rays may pass its triangle: only the point itself blocks.
bool veils(uint point) { return tracedTriangles[vplPoints[point].triangle].corner.w == 0.0; }

ivec2 texelOf(Disc disc) {
    vec2 at = octahedralEncode(normalize(disc.way)) * 0.5 + 0.5;
    return ivec2(min(at * float(vpl.mapSide), float(vpl.mapSide) - 0.5));
}

/// Texels to each side of the middle that a disc may cover: an octahedron's are nowhere wider than at its corners.
int reachOf(Disc disc) {
    float side = float(vpl.mapSide);
    return int(min(disc.radius / (disc.near + disc.radius) * 0.5 * side + 0.5, 0.5 * side));
}

/// Of the disc around `middle`, what falls on one texel. The middle is the point's own, however small it is.
void splatOn(uint point, Disc disc, ivec2 middle, ivec2 off) {
    uint texel = vplTexelAt(middle + off);
    vec3 direction = directionOf(texel);
    float along = distanceAlong(disc, direction);
    if (off == ivec2(0) || onDisc(point, disc, along * direction, 1.0)) offer(texel, point, along, direction);
}

void splat(uint point, vec3 normal, bool onSurface) {
    if (vplPoints[point].triangle == kNothing) return;
    Disc disc = discOf(point);
    if (abs(disc.toPlane) <= kOwnPlane * (length(disc.way) + length(origin))) return;
    if (onSurface && dot(normal, disc.way) < -disc.radius) return;
    atomicMin(nearestBits, floatBitsToUint(max(disc.near, 0.0)));
    ivec2 middle = texelOf(disc);
    int reach = veils(point) ? 0 : reachOf(disc);
    if (reach > kSmallSplat) {
        uint place = atomicAdd(largeCount, 1u);
        if (place < kMostLarge) {
            large[place] = point;
            return;
        }
    }
    for (int y = -reach; y <= reach; ++y)
        for (int x = -reach; x <= reach; ++x) splatOn(point, disc, middle, ivec2(x, y));
}

/// All threads together, texel by texel.
void splatLarge() {
    uint count = min(largeCount, kMostLarge);
    for (uint i = 0u; i < count; ++i) {
        Disc disc = discOf(large[i]);
        int reach = reachOf(disc);
        uint width = uint(2 * reach + 1);
        ivec2 middle = texelOf(disc);
        for (uint k = gl_LocalInvocationIndex; k < width * width; k += kThreads)
            splatOn(large[i], disc, middle, ivec2(k % width, k / width) - reach);
    }
}

/// Of the texels of a cell of the finest level.
uint nearestIn(uvec2 cell, uint width) {
    uint found = kNothing;
    for (uint y = cell.y * width; y < min((cell.y + 1u) * width, vpl.mapSide); ++y)
        for (uint x = cell.x * width; x < min((cell.x + 1u) * width, vpl.mapSide); ++x) {
            uint texel = y * vpl.mapSide + x;
            uint point = vplMaps[mapStart + texel];
            if (point != kNothing && !veils(point)) found = nearer(found, point, directionOf(texel));
        }
    return found;
}

/// The same of four cells, by what is nearest as a whole.
uint nearestOf(uint one, uint other) {
    if (one == kNothing) return other;
    return nearer(one, other, normalize(vplPoints[one].position - origin));
}

/// Levels of the pyramid up to a single cell, and down again: a cell without a point takes that of the cell around it.
void pullAndPush(uint cellWidth) {
    uint side = (vpl.mapSide + cellWidth - 1u) / cellWidth;
    for (uint i = gl_LocalInvocationIndex; i < side * side; i += kThreads) cells[i] = nearestIn(uvec2(i % side, i / side), cellWidth);
    barrier();
    uint start = 0u;
    while (side > 1u) {
        uint above = start + side * side;
        uint coarse = (side + 1u) / 2u;
        for (uint i = gl_LocalInvocationIndex; i < coarse * coarse; i += kThreads) {
            uvec2 low = uvec2(i % coarse, i / coarse) * 2u;
            uvec2 high = min(low + 1u, side - 1u);
            uint found = nearestOf(cells[start + low.y * side + low.x], cells[start + low.y * side + high.x]);
            found = nearestOf(found, cells[start + high.y * side + low.x]);
            cells[above + i] = nearestOf(found, cells[start + high.y * side + high.x]);
        }
        barrier();
        start = above;
        side = coarse;
    }
    // Sides on the way down are those on the way up, which halving from the finest tells.
    while (start > 0u) {
        uint fine = (vpl.mapSide + cellWidth - 1u) / cellWidth;
        uint below = 0u;
        while (below + fine * fine < start) {
            below += fine * fine;
            fine = (fine + 1u) / 2u;
        }
        for (uint i = gl_LocalInvocationIndex; i < fine * fine; i += kThreads)
            if (cells[below + i] == kNothing) cells[below + i] = cells[start + (i / fine / 2u) * ((fine + 1u) / 2u) + (i % fine) / 2u];
        barrier();
        start = below;
    }
}

void finish(uint texels, uint cellWidth) {
    uint side = (vpl.mapSide + cellWidth - 1u) / cellWidth;
    for (uint texel = gl_LocalInvocationIndex; texel < texels; texel += kThreads) {
        uint point = vplMaps[mapStart + texel];
        if (point == kNothing) {
            point = cells[texel / vpl.mapSide / cellWidth * side + texel % vpl.mapSide / cellWidth];
            if (point != kNothing) {
                // Farther away there is more likely no surface than one without points.
                Disc disc = discOf(point);
                vec3 direction = directionOf(texel);
                if (!onDisc(point, disc, distanceAlong(disc, direction) * direction, kHole)) point = kNothing;
            }
        }
        vplMaps[mapStart + texel] = point == kNothing ? kNothing : vplPoints[point].triangle;
    }
}

void main() {
    uint light = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (light >= vpl.lightCount) return;
    uint texels = vpl.mapSide * vpl.mapSide;
    mapStart = vplMapStart(light);
    origin = vplPlaces[light].position.xyz;
    for (uint i = gl_LocalInvocationIndex; i < texels; i += kThreads) vplMaps[mapStart + i] = kNothing;
    if (gl_LocalInvocationIndex == 0u) {
        largeCount = 0u;
        nearestBits = floatBitsToUint(kFarthest);
    }
    memoryBarrierBuffer();
    barrier();
    uint first = light % points.setCount * points.setSize;
    for (uint i = gl_LocalInvocationIndex; i < points.setSize; i += kThreads)
        splat(first + i, vplPlaces[light].normal.xyz, vplPlaces[light].position.w < 0.0);
    memoryBarrierBuffer();
    barrier();
    splatLarge();
    memoryBarrierBuffer();
    barrier();
    uint cellWidth = max(2u, (vpl.mapSide + kFinestCells - 1u) / kFinestCells);
    pullAndPush(cellWidth);
    finish(texels, cellWidth);
    // Between points there may be a nearer surface, but not by much.
    if (gl_LocalInvocationIndex == 0u) vplMaps[vplNearestAt(light)] = floatBitsToUint(0.5 * uintBitsToFloat(nearestBits));
}
