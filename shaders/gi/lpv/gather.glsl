// Light that arrives in a cell of the lattice in a step: from its neighbours, from the surfaces around it, and from sources.
#ifndef TYNDALL_GI_LPV_GATHER
#define TYNDALL_GI_LPV_GATHER
#include "gi/lpv/lattice.glsl"

layout(std430) readonly buffer LpvSources { vec4 sources[]; };
layout(std430) readonly buffer LpvLinks { uint links[]; };
layout(std430) readonly buffer LpvFlux { float flux[]; };

/// Light of three channels.
struct Arrival {
    vec4 red; // light that joins the cell's lobe; xyz: first moment (power times mean direction), w: power
    vec4 green;
    vec4 blue;
    vec3 straight[kLpvClasses]; // power that goes straight on, in each class of directions
};

vec3 fluxOf(uint cell, uint cells, uint j) {
    return vec3(flux[(3u * j) * cells + cell], flux[(3u * j + 1u) * cells + cell], flux[(3u * j + 2u) * cells + cell]);
}

void addLight(inout Arrival a, vec3 power, vec3 direction) {
    a.red += power.r * vec4(direction, 1.0);
    a.green += power.g * vec4(direction, 1.0);
    a.blue += power.b * vec4(direction, 1.0);
}

/// Of the first surface on a cell's link in direction j.
vec3 reflectance(uint cell, uint cells, uint j) { return unpackUnorm4x8(links[(kLpvSurface + j) * cells + cell]).rgb; }

/// Power sent out from within a cell (`emission`, and the scattered part of light that has `classes`), and all power that collides in it
/// (LatticeModel::send).
float emittedInside(vec3 classes, float depth, float albedo, float emission, out float collided) {
    collided = 0.0;
    float escape = 0.0;
    for (uint c = 0u; c < kLpvClasses; ++c) {
        float way = depth * sqrt(float(c + 1u));
        collided += classes[c] * oneMinusExp(way);
        escape += params.classWeights[c] * oneMinusExpOverX(way);
    }
    float emitted = (emission + albedo * collided) / (1.0 - albedo + albedo * escape);
    collided += emitted * (1.0 - escape);
    return emitted;
}

/// All that arrives.
vec3 arrivingPower(Arrival a) { return vec3(a.red.w, a.green.w, a.blue.w) + a.straight[0] + a.straight[1] + a.straight[2]; }

/// Power that comes to a cell along direction j from its neighbour. `blocked`: the cell's blocked links.
vec3 powerAlong(ivec3 at, uint cells, uint blocked, uint j) {
    // Direction 25 - j is the opposite one: a surface between two cells blocks both directions.
    ivec3 from = at - params.directions[j].offset.xyz;
    if ((blocked & (1u << (25u - j))) != 0u || !wrapCell(from)) return vec3(0.0);
    return fluxOf(cellIndex(from), cells, j);
}

/// The part of it that goes straight on.
vec3 straightPower(ivec3 at, uint cells, uint blocked, uint j) { return (1.0 - kLpvMixed) * powerAlong(at, cells, blocked, j); }

/// The part of a channel's arrivals that goes straight on, in each class.
vec3 straightClasses(Arrival a, uint channel) { return vec3(a.straight[0][channel], a.straight[1][channel], a.straight[2][channel]); }

Arrival gatherLight(ivec3 at, uint cells) {
    uint self = cellIndex(at);
    Arrival a = Arrival(sources[(kLpvEntering + 0u) * cells + self], sources[(kLpvEntering + 1u) * cells + self],
                        sources[(kLpvEntering + 2u) * cells + self], vec3[kLpvClasses](vec3(0.0), vec3(0.0), vec3(0.0)));
    uint blocked = links[kLpvBlocked * cells + self];
    vec3 back = vec3(0.0);   // power that surfaces around the cell reflect back
    vec3 normal = vec3(0.0); // of these, from the directions that they block
    for (uint j = 0u; j < kLpvDirections; ++j) {
        vec4 d = params.directions[j].unit;
        if ((blocked & (1u << j)) != 0u) {
            back += fluxOf(self, cells, j) * reflectance(self, cells, j);
            normal -= d.w * d.xyz;
        }
        vec3 power = powerAlong(at, cells, blocked, j);
        addLight(a, kLpvMixed * power, d.xyz);
        a.straight[params.directions[j].offset.w] += (1.0 - kLpvMixed) * power;
    }
    if (blocked != 0u) {
        float size = length(normal);
        // Lambert's mean direction; none where surfaces on opposite sides cancel.
        addLight(a, back, size > 1e-6 ? normal * (2.0 / 3.0 / size) : vec3(0.0));
    }
    return a;
}

#endif
