// The light that there is in each cell, from what is sent: fluence and vector flux, W/m², by the length of its ways through the cell. With it
// goes what tells on which side of surfaces a point lies: look-ups need no more.
#include "gi/lpv/gather.glsl"

layout(local_size_x = kLpvBlockX, local_size_y = kLpvBlockY, local_size_z = kLpvBlockZ) in;

layout(std430) readonly buffer LpvMedium { vec4 medium[]; };
// xyz: vector flux, w: fluence, of a channel
layout(std430) writeonly buffer LpvSides { uint sides[]; };
layout(rgba32f) writeonly uniform image3D redLight;
layout(rgba32f) writeonly uniform image3D greenLight;
layout(rgba32f) writeonly uniform image3D blueLight;

/// (1 - (1 - e^-x)/x)/x: mean length of ways that begin anywhere on a way of optical depth x and end where it ends.
float meanOfInnerWays(float x) { return x < 0.02 ? 0.5 - x * (1.0 / 6.0 - x * (1.0 / 24.0)) : (1.0 - oneMinusExpOverX(x)) / x; }

vec4 channelLight(vec4 arrival, float depth, float albedo, float emission) {
    vec3 classes;
    vec4 lobe = makeLobe(arrival.w, arrival.xyz, classes);
    float collided;
    float emitted = emittedInside(classes, depth, albedo, emission, collided);
    vec4 sum = vec4(0.0);
    for (uint j = 0u; j < kLpvDirections; ++j) {
        vec4 d = params.directions[j].unit;
        float size = sqrt(float(params.directions[j].offset.w + 1));
        float way = depth * size;
        float power = d.w * (lobeTowards(lobe, d.xyz) * oneMinusExpOverX(way) + emitted * meanOfInnerWays(way));
        sum += power * size * vec4(d.xyz, 1.0);
    }
    return sum;
}

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    if (!isInside(at)) return;
    uint cells = cellCount();
    uint self = cellIndex(at);
    for (uint p = 0u; p < kLpvSidePlanes; ++p) sides[uint(params.grid.place.y) + p * cells + self] = links[p * cells + self];
    Arrival a = gatherLight(at, cells);
    vec3 depth = medium[kLpvDepth * cells + self].rgb;
    vec3 albedo = medium[kLpvAlbedo * cells + self].rgb;
    vec3 emission = sources[kLpvEmission * cells + self].rgb;
    // Power times length in cells, over the cell's volume.
    float unit = 1.0 / (params.grid.lowest.w * params.grid.lowest.w);
    ivec3 to = at + ivec3(0, 0, params.grid.place.x);
    imageStore(redLight, to, unit * channelLight(a.red, depth.r, albedo.r, emission.r));
    imageStore(greenLight, to, unit * channelLight(a.green, depth.g, albedo.g, emission.g));
    imageStore(blueLight, to, unit * channelLight(a.blue, depth.b, albedo.b, emission.b));
}
