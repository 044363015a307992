// The lattices' light at a point.
#ifndef TYNDALL_GI_LPV_LOOKUP
#define TYNDALL_GI_LPV_LOOKUP
#include "gi/lpv/sides.glsl"

layout(std140) uniform Levels { LpvLevels levels; };
uniform sampler3D redLight;
uniform sampler3D greenLight;
uniform sampler3D blueLight;

const float kFade = 2.0; // cells from its border in which a lattice blends into the next coarser one

/// xyz: vector flux, w: fluence, W/m², of each channel.
struct LatticeLight {
    vec4 red;
    vec4 green;
    vec4 blue;
};

LatticeLight cellLight(LpvGrid grid, ivec3 cell) {
    ivec3 at = cell + ivec3(0, 0, grid.place.x);
    return LatticeLight(texelFetch(redLight, at, 0), texelFetch(greenLight, at, 0), texelFetch(blueLight, at, 0));
}

void addLight(inout LatticeLight sum, float weight, LatticeLight light) {
    sum.red += weight * light.red;
    sum.green += weight * light.green;
    sum.blue += weight * light.blue;
}

/// Of one lattice around `place` (cells from its corner): linear between the cells that are open to the one on whose side it is.
LatticeLight gridLight(LpvGrid grid, vec3 place) {
    ivec3 own = cellOnSide(grid, place);
    uint blocked = links[uint(grid.place.y) + kLpvBlocked * cellCount(grid) + cellIndex(grid, own)];
    if (blocked == 0u) {
        // The lattices lie one behind the other in the textures.
        vec3 at = clamp(place, vec3(0.5), vec3(grid.size.xyz) - 0.5) + vec3(0.0, 0.0, float(grid.place.x));
        vec3 uvw = at / vec3(textureSize(redLight, 0));
        return LatticeLight(textureLod(redLight, uvw, 0.0), textureLod(greenLight, uvw, 0.0), textureLod(blueLight, uvw, 0.0));
    }
    ivec3 last = grid.size.xyz - 1;
    vec3 low = floor(place - 0.5);
    vec3 f = place - 0.5 - low;
    LatticeLight sum = LatticeLight(vec4(0.0), vec4(0.0), vec4(0.0));
    float total = 0.0;
    for (int k = 0; k < 8; ++k) {
        ivec3 corner = ivec3(k & 1, (k >> 1) & 1, k >> 2);
        ivec3 cell = clamp(ivec3(low) + corner, ivec3(0), last);
        vec3 share = mix(1.0 - f, f, vec3(corner));
        if (!areOpen(blocked, own, cell)) continue;
        // At least a little, so that a cell that is alone on its side counts in full.
        float weight = share.x * share.y * share.z + 1e-4;
        addLight(sum, weight, cellLight(grid, cell));
        total += weight;
    }
    if (!(total > 0.0)) return cellLight(grid, own);
    return LatticeLight(sum.red / total, sum.green / total, sum.blue / total);
}

/// Weight of a lattice at `place`: 1 inside, down to 0 at borders beyond which there is a coarser one.
float gridShare(LpvGrid grid, vec3 place) {
    vec3 inside = min(place, vec3(grid.size.xyz) - place);
    bvec3 goesOn = bvec3(grid.place.z & 1, grid.place.z & 2, grid.place.z & 4);
    return clamp(minimumOf(mix(vec3(kFade), inside, goesOn)) / kFade, 0.0, 1.0);
}

/// At `position` (render space), moved by `offset` cells of the lattice whose light it is.
LatticeLight latticeLight(vec3 position, vec3 offset) {
    LatticeLight sum = LatticeLight(vec4(0.0), vec4(0.0), vec4(0.0));
    float left = 1.0;
    for (int i = 0; i < levels.count.x && left > 0.0; ++i) {
        vec3 place = latticePosition(levels.grids[i], position) + offset;
        float share = left * (i + 1 < levels.count.x ? gridShare(levels.grids[i], place) : 1.0);
        if (share > 0.0) addLight(sum, share, gridLight(levels.grids[i], place));
        left -= share;
    }
    return sum;
}

/// Transport extinction times a cell's edge, and albedo, of the medium there, in the lattice that gives most of the light.
vec2 latticeMedium(vec3 position, vec3 offset) {
    int i = 0;
    while (i + 1 < levels.count.x && gridShare(levels.grids[i], latticePosition(levels.grids[i], position) + offset) < 0.5) ++i;
    LpvGrid grid = levels.grids[i];
    ivec3 cell = cellOnSide(grid, latticePosition(grid, position) + offset);
    return unpackHalf2x16(links[uint(grid.place.y) + kLpvCellMedium * cellCount(grid) + cellIndex(grid, cell)]);
}

vec3 fluence(LatticeLight light) { return vec3(light.red.w, light.green.w, light.blue.w); }

/// Vector flux along `direction`.
vec3 fluxAlong(LatticeLight light, vec3 direction) {
    return vec3(dot(light.red.xyz, direction), dot(light.green.xyz, direction), dot(light.blue.xyz, direction));
}

#endif
