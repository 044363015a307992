// Fluence and vector flux of each cell, W/m², from the sent power and the path lengths of light through the cell. Beside them it
// stores the planes that decide on which side of surfaces a point lies, and the cell's density: all that look-ups need.
#include "gi/lpv/gather.glsl"

layout(local_size_x = kLpvBlockX, local_size_y = kLpvBlockY, local_size_z = kLpvBlockZ) in;

layout(std430) readonly buffer LpvMedium { vec4 medium[]; };
layout(std430) writeonly buffer LpvSides { uint sides[]; };
// xyz: vector flux, w: fluence, of a channel
layout(rgba32f) writeonly uniform image3D redLight;
layout(rgba32f) writeonly uniform image3D greenLight;
layout(rgba32f) writeonly uniform image3D blueLight;

/// (1 - (1 - e^-x)/x)/x: mean length of paths that begin anywhere on a link of optical depth x and end where it ends.
float meanOfInnerWays(float x) { return x < 0.02 ? 0.5 - x * (1.0 / 6.0 - x * (1.0 / 24.0)) : (1.0 - oneMinusExpOverX(x)) / x; }

/// Of power that crosses the cell and of power emitted inside, in direction j: times the mean path length, in cells.
vec3 onTheWay(vec3 crossing, vec3 emitted, vec3 depth, uint j) {
    vec3 way = depth * sqrt(float(params.directions[j].offset.w + 1));
    vec3 inner = vec3(meanOfInnerWays(way.r), meanOfInnerWays(way.g), meanOfInnerWays(way.b));
    return (crossing * oneMinusExpOverX(way) + params.directions[j].unit.w * emitted * inner) * sqrt(float(params.directions[j].offset.w + 1));
}

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    if (!isInside(at)) return;
    uint cells = cellCount();
    uint self = cellIndex(at);
    Arrival a = gatherLight(at, cells);
    vec4 arrivals[3] = vec4[3](a.red, a.green, a.blue);
    vec3 depth = medium[kLpvDepth * cells + self].rgb;
    vec3 albedo = medium[kLpvAlbedo * cells + self].rgb;
    vec3 emission = sources[kLpvEmission * cells + self].rgb;
    uint lookups = uint(params.grid.place.y) + self;
    for (uint p = 0u; p < kLpvSidePlanes; ++p) sides[lookups + p * cells] = links[p * cells + self];
    sides[lookups + kLpvCellMedium * cells] = packHalf2x16(vec2(min(meanOf(depth), 6e4), meanOf(albedo)));
    vec4 lobes[3];
    vec3 emitted;
    for (uint c = 0u; c < 3u; ++c) {
        vec3 classes;
        float collided;
        lobes[c] = makeLobe(arrivals[c].w, arrivals[c].xyz, classes);
        emitted[c] = emittedInside(classes + straightClasses(a, c), depth[c], albedo[c], emission[c], collided);
    }
    uint blocked = links[kLpvBlocked * cells + self];
    vec4 red = vec4(0.0);
    vec4 green = vec4(0.0);
    vec4 blue = vec4(0.0);
    for (uint j = 0u; j < kLpvDirections; ++j) {
        vec4 d = params.directions[j].unit;
        vec3 crossing = d.w * vec3(lobeTowards(lobes[0], d.xyz), lobeTowards(lobes[1], d.xyz), lobeTowards(lobes[2], d.xyz));
        vec3 power = onTheWay(crossing + straightPower(at, cells, blocked, j), emitted, depth, j);
        red += power.r * vec4(d.xyz, 1.0);
        green += power.g * vec4(d.xyz, 1.0);
        blue += power.b * vec4(d.xyz, 1.0);
    }
    // Power times length in cells, over the cell's volume.
    float unit = 1.0 / (params.grid.lowest.w * params.grid.lowest.w);
    ivec3 to = at + ivec3(0, 0, params.grid.place.x);
    imageStore(redLight, to, unit * red);
    imageStore(greenLight, to, unit * green);
    imageStore(blueLight, to, unit * blue);
}
