// The change of the last step of a lattice, and (LEDGER) the energy balance: sums over workgroups.
#include "gi/lpv/gather.glsl" // LpvFlux: before the step
#include "gi/lpv/workgroup_sums.glsl"

layout(local_size_x = kLpvBlockX, local_size_y = kLpvBlockY, local_size_z = kLpvBlockZ) in;

layout(std430) readonly buffer LpvMedium { vec4 medium[]; };
layout(std430) readonly buffer LpvSent { float sent[]; }; // after the step
#if LEDGER
/// Powers of the step in a cell: injected, absorbed by media, escaped from the lattice, absorbed by surfaces.
vec4 ledger(ivec3 at, uint cells) {
    uint self = cellIndex(at);
    Arrival a = gatherLight(at, cells);
    vec4 arrivals[3] = vec4[3](a.red, a.green, a.blue);
    vec3 emission = sources[kLpvEmission * cells + self].rgb;
    vec3 depth = medium[kLpvDepth * cells + self].rgb;
    vec3 albedo = medium[kLpvAlbedo * cells + self].rgb;
    vec4 result = vec4(0.0);
    for (uint c = 0u; c < 3u; ++c) {
        vec3 classes;
        makeLobe(arrivals[c].w, arrivals[c].xyz, classes);
        float collided;
        emittedInside(classes + straightClasses(a, c), depth[c], albedo[c], emission[c], collided);
        result.x += emission[c] + sources[(kLpvEntering + c) * cells + self].w;
        result.y += (1.0 - albedo[c]) * collided;
    }
    uint blocked = links[kLpvBlocked * cells + self];
    for (uint j = 0u; j < kLpvDirections; ++j) {
        vec3 power = fluxOf(self, cells, j);
        ivec3 to = at + params.directions[j].offset.xyz;
        if ((blocked & (1u << j)) != 0u)
            result.w += dot(1.0 - reflectance(self, cells, j), power);
        else if (!wrapCell(to))
            result.z += dot(vec3(1.0), power);
    }
    return result;
}
#endif

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    uint cells = cellCount();
    float values[kSums];
    for (uint i = 0u; i < kSums; ++i) values[i] = 0.0;
    if (isInside(at)) {
        uint self = cellIndex(at);
        for (uint p = 0u; p < kLpvFluxPlanes; ++p) {
            float old = flux[p * cells + self];
            float now = sent[p * cells + self];
            values[0] += abs(now - old);
            values[1] += now;
#if LEDGER
            values[2] += old;
#endif
        }
#if LEDGER
        vec4 ways = ledger(at, cells);
        for (uint i = 0u; i < 4u; ++i) values[3u + i] = ways[i];
#endif
    }
    leaveSums(values);
}
