// One step of the lattice: each cell gathers the light that its neighbours sent to it, adds its sources, and sends light on.
//
// Light enters a cell, joins its lobe or goes straight on, and crosses the cell (e^(-σ l), l: length of the link to the next cell) or collides. Scattered light, and light that a
// source emits inside, leaves isotropically with the part that does not collide again ((1 - e^(-σ l))/(σ l));
// the rest scatters again, and that series is summed in closed form. Power is conserved to rounding at every optical depth.
//
// A dark block of cells among dark blocks stays dark and costs a few loads (LpvLit).
//
// A cell reads 78 powers (a second time, from the cache, where it sends on what goes straight) and 10 vectors of its own, and writes 78
// powers: 780 bytes. It gathers in 26 · 3 · 5 operations, sums 3 lobes in 26 · 16 (three times as many where light is directed) and sends in
// 26 · 3 · 8: 2,200 to 4,700 flops.
#include "gi/lpv/gather.glsl"

layout(local_size_x = kLpvBlockX, local_size_y = kLpvBlockY, local_size_z = kLpvBlockZ) in;

layout(std430) readonly buffer LpvMedium { vec4 medium[]; };
layout(std430) writeonly buffer LpvSent { float sent[]; };
layout(std430) buffer LpvLit { uint lit[]; };

uint blockIndex(ivec3 block, ivec3 blocks) { return uint(block.x + blocks.x * (block.y + blocks.y * block.z)); }

/// Whether light may be in a block or arrive there. Flags are only ever set. It makes no difference whether a neighbour's flag is read in the step in
/// which it is set, since the neighbour sent nothing before.
bool mayBeLit(ivec3 block, ivec3 blocks) {
    if (params.grid.place.w != 0 || params.grid.size.w != 0 || lit[blockIndex(block, blocks)] != 0u) return true;
    for (int i = 0; i < 27; ++i) {
        ivec3 other = block + ivec3(i % 3, i / 3 % 3, i / 9) - 1;
        if (any(greaterThanEqual(uvec3(other), uvec3(blocks)))) continue;
        if (lit[blockIndex(other, blocks)] != 0u) return true;
    }
    return false;
}

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    if (!isInside(at)) return;
    ivec3 blocks = ivec3(gl_NumWorkGroups);
    ivec3 block = ivec3(gl_WorkGroupID);
    if (!mayBeLit(block, blocks)) return;
    uint cells = cellCount();
    uint self = cellIndex(at);
    Arrival a = gatherLight(at, cells);
    vec3 redClasses, greenClasses, blueClasses; // power that goes on in each class of directions
    uint blocked = links[kLpvBlocked * cells + self];
    vec4 red = makeLobe(a.red.w, a.red.xyz, redClasses);
    vec4 green = makeLobe(a.green.w, a.green.xyz, greenClasses);
    vec4 blue = makeLobe(a.blue.w, a.blue.xyz, blueClasses);

    vec3 depth = medium[kLpvDepth * cells + self].rgb;
    vec3 albedo = medium[kLpvAlbedo * cells + self].rgb;
    vec3 passed[3], leaving[3]; // of light that crosses the cell, and of light emitted inside
    vec3 collided = vec3(0.0);
    vec3 escape = vec3(0.0);
    for (uint c = 0u; c < kLpvClasses; ++c) {
        passed[c] = medium[(kLpvPassed + c) * cells + self].rgb;
        collided += (vec3(redClasses[c], greenClasses[c], blueClasses[c]) + a.straight[c]) * (1.0 - passed[c]);
        leaving[c] = oneMinusExpOverX(depth * sqrt(float(c + 1u)));
        escape += params.classWeights[c] * leaving[c];
    }
    vec3 emitted = (sources[kLpvEmission * cells + self].rgb + albedo * collided) / (1.0 - albedo + albedo * escape);
    for (uint c = 0u; c < kLpvClasses; ++c) leaving[c] *= emitted;
    if (dot(vec3(1.0), arrivingPower(a) + emitted) > 0.0) lit[blockIndex(block, blocks)] = 1u;
    for (uint j = 0u; j < kLpvDirections; ++j) {
        vec4 d = params.directions[j].unit;
        uint c = uint(params.directions[j].offset.w);
        vec3 crossing = vec3(lobeTowards(red, d.xyz), lobeTowards(green, d.xyz), lobeTowards(blue, d.xyz));
        vec3 power = d.w * (crossing * passed[c] + leaving[c]) + straightPower(at, cells, blocked, j) * passed[c];
        sent[(3u * j + 0u) * cells + self] = power.r;
        sent[(3u * j + 1u) * cells + self] = power.g;
        sent[(3u * j + 2u) * cells + self] = power.b;
    }
}
