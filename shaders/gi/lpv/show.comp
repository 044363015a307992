// A slice of the finest lattice, drawn into the picture: fluence, directions of light, medium, surfaces, change of the last step, absorbed
// power.
#include "common/view.glsl"
#include "gi/lpv/gather.glsl" // LpvFlux: before the last step

layout(local_size_x = 8, local_size_y = 8) in;

layout(std140) uniform Show { LpvShowParams show; };
layout(std430) readonly buffer LpvMedium { vec4 medium[]; };
layout(std430) readonly buffer LpvSent { float sent[]; }; // after it
uniform sampler2D depth;
uniform sampler2D color;
uniform sampler3D redLight;
uniform sampler3D greenLight;
uniform sampler3D blueLight;
layout(rgba32f) writeonly uniform image2D shown;

/// Black, purple, orange, near white for 0..1.
vec3 heat(float x) {
    float v = clamp(x, 0.0, 1.0);
    return vec3(smoothstep(0.0, 0.7, v), smoothstep(0.4, 1.0, v), 0.5 * sin(kPi * min(1.3 * v, 1.0)) + 0.7 * smoothstep(0.75, 1.0, v));
}

vec3 fluenceOf(ivec3 cell) {
    ivec3 at = cell + ivec3(0, 0, params.grid.place.x);
    return vec3(texelFetch(redLight, at, 0).w, texelFetch(greenLight, at, 0).w, texelFetch(blueLight, at, 0).w);
}

vec3 vectorFluxOf(ivec3 cell) { // of the three channels together
    ivec3 at = cell + ivec3(0, 0, params.grid.place.x);
    return texelFetch(redLight, at, 0).xyz + texelFetch(greenLight, at, 0).xyz + texelFetch(blueLight, at, 0).xyz;
}

/// Polar plot of radiance (Φ + 3 F·ω)/4π in the plane of the slice, the largest value at the cell's rim.
vec3 glyph(ivec3 cell, vec3 within, int axis) {
    vec3 fluence = fluenceOf(cell);
    float all = fluence.r + fluence.g + fluence.b;
    vec3 flux = vectorFluxOf(cell);
    vec3 from = within - 0.5;
    from[axis] = 0.0;
    float radius = length(from);
    float largest = all + 3.0 * length(flux);
    float here = max(all + 3.0 * dot(flux, from / max(radius, 1e-6)), 0.0);
    if (!(largest > 0.0) || radius > 0.48 * here / largest) return vec3(0.0);
    return show.white * fluence / max(max(fluence.r, fluence.g), max(fluence.b, 1e-30));
}

vec3 valueOf(ivec3 cell, vec3 within, int axis) {
    uint cells = cellCount();
    uint self = cellIndex(cell);
    if (show.what == kLpvShowLight) return fluenceOf(cell) / (4.0 * kPi);
    if (show.what == kLpvShowDirections) return glyph(cell, within, axis);
    if (show.what == kLpvShowMedium) return show.white * heat(0.5 * maximumOf(medium[kLpvDepth * cells + self].rgb));
    if (show.what == kLpvShowSurfaces) {
        uint blocked = links[kLpvBlocked * cells + self];
        vec3 sum = vec3(0.0);
        for (uint j = 0u; j < kLpvDirections; ++j) sum += (blocked & (1u << j)) != 0u ? 0.02 + reflectance(self, cells, j) : vec3(0.0);
        return show.white * sum / float(kLpvDirections);
    }
    float before = 0.0;
    float after = 0.0;
    float change = 0.0;
    float lost = 0.0;
    for (uint j = 0u; j < kLpvDirections; ++j) {
        vec3 old = fluxOf(self, cells, j);
        vec3 now = vec3(sent[(3u * j) * cells + self], sent[(3u * j + 1u) * cells + self], sent[(3u * j + 2u) * cells + self]);
        before += dot(vec3(1.0), old);
        after += dot(vec3(1.0), now);
        change += dot(vec3(1.0), abs(now - old));
        if ((links[kLpvBlocked * cells + self] & (1u << j)) != 0u) lost += dot(1.0 - reflectance(self, cells, j), now);
    }
    if (!(after > 0.0)) return vec3(0.0);
    // From a millionth to a tenth, by powers of ten.
    if (show.what == kLpvShowResidual) return show.white * heat(log(max(change / after, 1e-6) * 1e6) / log(1e5));
    Arrival a = gatherLight(cell, cells);
    float arrives = dot(vec3(1.0), arrivingPower(a) + sources[kLpvEmission * cells + self].rgb);
    lost += max(arrives - after, 0.0); // absorbed by media
    return show.white * heat(lost / max(arrives, 1e-30));
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(shown)))) return;
    vec2 centre = vec2(pixel) + 0.5;
    vec4 picture = texelFetch(color, pixel, 0);
    Ray ray = cameraRay(centre);
    int axis = show.axis;
    vec3 origin = latticePosition(ray.origin);
    vec3 direction = ray.direction / params.grid.lowest.w;
    float t = (float(show.layer) + 0.5 - origin[axis]) / direction[axis];
    vec3 place = origin + t * direction;
    place[axis] = float(show.layer) + 0.5;
    ivec3 cell = ivec3(floor(place));
    if (!(t > 0.0) || t > kInfiniteDistance || !isInside(cell)) {
        imageStore(shown, pixel, picture);
        return;
    }
    vec3 within = place - vec3(cell);
    vec3 rim = min(within, 1.0 - within);
    rim[axis] = 1.0;
    vec3 value = valueOf(cell, within, axis) + (minimumOf(rim) < 0.03 ? vec3(0.05 * show.white) : vec3(0.0));
    // Faintly where a surface is before it.
    float opacity = t < rayDistanceFromDepth(centre, texelFetch(depth, pixel, 0).r) ? 0.9 : 0.3;
    imageStore(shown, pixel, vec4(mix(picture.rgb, value, opacity), picture.a));
}
