// The lattice: its arrays, its neighbours, and the lobe of the light that leaves a cell.
#ifndef TYNDALL_GI_LPV_LATTICE
#define TYNDALL_GI_LPV_LATTICE
#include "gi/lpv/grid.glsl"

layout(std140) uniform Params { LpvParams params; };

uint cellCount() { return cellCount(params.grid); }
uint cellIndex(ivec3 at) { return cellIndex(params.grid, at); }
vec3 latticePosition(vec3 position) { return latticePosition(params.grid, position); }

/// Render space.
vec3 cellMiddle(ivec3 at) { return params.grid.lowest.xyz + (vec3(at) + 0.5) * params.grid.lowest.w; }

bool isInside(ivec3 at) { return all(lessThan(uvec3(at), uvec3(params.grid.size.xyz))); }

/// The cell `at`, wrapped along axes that repeat; false if there is none.
bool wrapCell(inout ivec3 at) {
    ivec3 size = params.grid.size.xyz;
    bvec3 repeats = bvec3(params.grid.size.w & 1, params.grid.size.w & 2, params.grid.size.w & 4);
    bvec3 outside = bvec3(uvec3(greaterThanEqual(uvec3(at), uvec3(size))));
    if (any(outside) && any(bvec3(outside.x && !repeats.x, outside.y && !repeats.y, outside.z && !repeats.z))) return false;
    at = at + size * ivec3(lessThan(at, ivec3(0))) - size * ivec3(greaterThanEqual(at, size));
    return true;
}

/// Part of a lobe that leaves in direction `unit`, over the direction's weight.
float lobeTowards(vec4 lobe, vec3 unit) { return max(dot(lobe.xyz, unit) + lobe.w, 0.0); }

/// Sums over the directions of a lobe's power, and of its power in each class.
struct LobeSums {
    float power;
    vec3 moment;
    vec3 classes;
    float used; // weight of the directions that get light
};

LobeSums sumLobe(vec4 lobe) {
    LobeSums s = LobeSums(0.0, vec3(0.0), vec3(0.0), 0.0);
    for (uint j = 0u; j < kLpvDirections; ++j) {
        vec4 d = params.directions[j].unit;
        float f = d.w * lobeTowards(lobe, d.xyz);
        s.moment += f * d.xyz;
        s.used += f > 0.0 ? d.w : 0.0;
        s.classes[params.directions[j].offset.w] += f;
    }
    s.power = s.classes.x + s.classes.y + s.classes.z;
    return s;
}

const float kLeastPower = 1e-30;   // less counts as 0, so that quotients stay finite
const float kNarrowestLobe = 0.88; // 26 directions cannot represent a narrower one evenly

/// The lobe of light of this power and first moment. Linear in the cosine while that is nowhere negative; then the part of a line above
/// 0 that has the same first moment: exactly on the sphere, and after two steps of Newton's method nearly so among 26 directions. If a
/// lobe comes out too narrow, more directions are added, so that it does not sharpen from step to step (LatticeModel::lobe).
vec4 makeLobe(float power, vec3 moment, out vec3 classes) {
    classes = vec3(0.0);
    if (!(power > kLeastPower)) return vec4(0.0);
    vec3 mean = moment / power; // squares of small moments would underflow
    float r = length(mean);
    bool linear = r <= 1.0 / 3.0;
    float narrow = min(r, kNarrowestLobe);
    vec3 along = r > 0.0 ? mean / r : vec3(0.0);
    vec4 lobe = linear ? vec4(mean * 3.0, 1.0) : vec4(along, 2.0 - 3.0 * narrow);
    LobeSums s = sumLobe(lobe);
    // A loop rather than a condition: drivers that run both sides of conditions can leave a loop early.
    int passes = linear ? 0 : 2;
    for (int pass = 0; pass < passes; ++pass) {
        vec3 missing = narrow * s.power * along - s.moment;
        lobe.xyz += 3.0 / s.used * missing;
        lobe.w += 2.0 * max(-dot(missing, along) / s.power, 0.0);
        s = sumLobe(lobe);
    }
    float scale = power / s.power;
    classes = s.classes * scale;
    return lobe * scale;
}

#endif
