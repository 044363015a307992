// One step of the lattice: each cell gathers what its neighbours sent its way, adds what enters it, and sends it on.
//
// Light enters a cell, crosses it (e^(-σ l), l the way to the next cell in its direction) or collides; what is scattered, and what a
// source emits inside, leaves evenly to all sides with the part that does not collide again on its way out ((1 - e^(-σ l))/(σ l)), and
// the rest is scattered again: that series is summed in closed form. Power is kept to rounding at every optical depth.
//
// A cell reads 78 powers, each once, and 10 vectors of its own, and writes 78 powers: 780 bytes. It gathers in 26 · 3 · 4 operations,
// sums 3 lobes in 26 · 16 (three times as many where light is directed) and sends in 26 · 3 · 6: 2,000 to 4,500 flops.
#include "gi/lpv/gather.glsl"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;

layout(std430) readonly buffer LpvMedium { vec4 medium[]; };
layout(std430) writeonly buffer LpvSent { float sent[]; };

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    if (!isInside(at)) return;
    uint cells = cellCount();
    uint self = cellIndex(at);
    Arrival a = gatherLight(at, cells);
    vec3 redClasses, greenClasses, blueClasses; // power that goes on in each class of directions
    vec4 red = makeLobe(a.red.w, a.red.xyz, redClasses);
    vec4 green = makeLobe(a.green.w, a.green.xyz, greenClasses);
    vec4 blue = makeLobe(a.blue.w, a.blue.xyz, blueClasses);

    vec3 depth = medium[kLpvDepth * cells + self].rgb;
    vec3 albedo = medium[kLpvAlbedo * cells + self].rgb;
    vec3 passed[3], leaving[3]; // of what crosses the cell, and of what is emitted inside
    vec3 collided = vec3(0.0);
    vec3 escape = vec3(0.0);
    for (uint c = 0u; c < kLpvClasses; ++c) {
        passed[c] = medium[(kLpvPassed + c) * cells + self].rgb;
        collided += vec3(redClasses[c], greenClasses[c], blueClasses[c]) * (1.0 - passed[c]);
        leaving[c] = oneMinusExpOverX(depth * sqrt(float(c + 1u)));
        escape += params.classWeights[c] * leaving[c];
    }
    vec3 emitted = (sources[kLpvEmission * cells + self].rgb + albedo * collided) / (1.0 - albedo + albedo * escape);
    for (uint c = 0u; c < kLpvClasses; ++c) leaving[c] *= emitted;
    for (uint j = 0u; j < kLpvDirections; ++j) {
        vec4 d = params.directions[j].unit;
        uint c = uint(params.directions[j].offset.w);
        vec3 crossing = vec3(lobeTowards(red, d.xyz), lobeTowards(green, d.xyz), lobeTowards(blue, d.xyz));
        vec3 power = d.w * (crossing * passed[c] + leaving[c]);
        sent[(3u * j + 0u) * cells + self] = power.r;
        sent[(3u * j + 1u) * cells + self] = power.g;
        sent[(3u * j + 2u) * cells + self] = power.b;
    }
}
