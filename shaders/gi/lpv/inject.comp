// Injection by the texels of a reflective shadow map. A texel is a ray from the light. In every cell that it crosses it injects the power that the
// media scatter; where it ends it injects the power that the surface reflects, by Lambert's law.
//
// Powers are closed forms of the ray's optical depth, so that their sum over a ray is exact however coarse the lattice. They are added in
// fixed point: the same bits in any order of texels. Rounding errors carry over to the ray's next cell.
#include "common/receiver.glsl"
#include "gi/lpv/reflection.glsl"
#include "gi/lpv/lattice.glsl"
#include "gi/lpv/sides.glsl"
#include "lighting/light.glsl"
#if MEDIA
#include "media/optical_depth.glsl"
#endif

layout(local_size_x = 8, local_size_y = 8) in;

layout(std140) uniform Inject { LpvInjectParams inject; };
layout(std430) readonly buffer LpvMedium { vec4 medium[]; };
layout(std430) buffer LpvDeposits { int deposits[]; };

const int kMostCells = 1024; // along a ray; a limit in case its coordinates overflow

/// Area of [0,x] × [0,y] of the plane at distance 1, as a solid angle.
float cornerAngle(vec2 p) { return atan(p.x * p.y, sqrt(1.0 + dot(p, p))); }

/// Solid angle of a texel of a perspective view.
float texelAngle(ivec2 texel) {
    // Half the width of the picture at distance 1, from the direction of a corner's ray.
    Ray corner = cameraRay(view.size.xy);
    vec3 v = mat3(view.viewFromRender) * corner.direction;
    vec2 tangent = v.xy / -v.z;
    vec2 low = (vec2(texel) * view.size.zw * 2.0 - 1.0) * tangent;
    vec2 high = (vec2(texel + 1) * view.size.zw * 2.0 - 1.0) * tangent;
    return abs(cornerAngle(high) - cornerAngle(vec2(high.x, low.y)) - cornerAngle(vec2(low.x, high.y)) + cornerAngle(low));
}

/// Power that leaves the light through the texel.
vec3 texelPower(ivec2 texel, Ray ray) {
    uint light = inject.light;
    vec3 intensity = lights[light].intensity.rgb * inject.share;
    uint type = lights[light].type;
    if (type == kLightDirectional) return intensity * inject.texelArea;
    float angle = texelAngle(texel);
    if (type == kLightRect) return intensity * lights[light].intensity.w * max(dot(lights[light].direction.xyz, ray.direction), 0.0) * angle;
    return intensity * angle * (type == kLightSpot ? coneAttenuation(light, ray.direction) : 1.0);
}

/// Adds `amount` units; the fractional part stays in `rest`.
void deposit(uint plane, uint cell, uint cells, float amount, inout float rest) {
    float units = amount + rest;
    float whole = floor(units + 0.5);
    rest = units - whole;
    if (whole != 0.0) atomicAdd(deposits[plane * cells + cell], int(whole));
}

struct Rests {
    vec4 entering[3];
    vec3 emission;
};

void depositEntering(uint cell, uint cells, vec3 power, vec3 moment, inout Rests rests) {
    for (uint c = 0u; c < 3u; ++c) {
        vec4 amount = power[c] * vec4(moment, 1.0);
        for (uint k = 0u; k < 4u; ++k) deposit(4u * c + k, cell, cells, amount[k], rests.entering[c][k]);
    }
}

/// The part of [t0,t1] of the ray that lies in the lattice; lattice coordinates, the parameter in metres.
bool clipToLattice(vec3 origin, vec3 direction, inout float t0, inout float t1) {
    vec3 safe = mix(direction, vec3(1e-20), lessThan(abs(direction), vec3(1e-20)));
    vec3 a = -origin / safe;
    vec3 b = (vec3(params.grid.size.xyz) - origin) / safe;
    t0 = max(t0, maximumOf(min(a, b)));
    t1 = min(t1, minimumOf(max(a, b)));
    return t0 < t1;
}

vec3 depthBetween(Ray ray, float t0, float t1) {
#if MEDIA
    return opticalDepthBetween(ray.origin, ray.direction, t0, t1);
#else
    return vec3(0.0);
#endif
}

/// Optical depth from the light to `t`. A light at infinity is before all of the ray.
vec3 depthBefore(Ray ray, float t) {
#if MEDIA
    if (viewIsOrthographic()) return opticalDepthAlong(ray.origin + ray.direction * t, -ray.direction, kInfiniteDistance);
#endif
    return depthBetween(ray, 0.0, t);
}

void scatterAlong(Ray ray, vec3 power, float end, inout Rests rests, inout vec3 depth) {
    uint cells = cellCount();
    vec3 origin = latticePosition(ray.origin);
    vec3 direction = ray.direction / params.grid.lowest.w;
    float t = 0.0;
    float last = end;
    if (!clipToLattice(origin, direction, t, last)) return;
    depth = depthBefore(ray, t);
    vec3 safe = mix(direction, vec3(1e-20), lessThan(abs(direction), vec3(1e-20)));
    vec3 towards = step(0.0, safe);
    ivec3 cell = clamp(ivec3(floor(origin + direction * t)), ivec3(0), params.grid.size.xyz - 1);
    for (int i = 0; i < kMostCells && t < last; ++i) {
        vec3 planes = (vec3(cell) + towards - origin) / safe;
        float next = clamp(minimumOf(planes), t, last);
        uint index = cellIndex(cell);
        vec4 cellDepth = medium[kLpvTrueDepth * cells + index];
        if (maximumOf(cellDepth.rgb) > 0.0 && next > t) {
            vec3 across = depthBetween(ray, t, next);
            float middle = 0.5 * (t + next);
            float window = lights[inject.light].type == kLightDirectional ? 1.0 : rangeWindow(lights[inject.light].position.w, middle);
            vec3 scattered = power * window * exp(-depth) * across * oneMinusExpOverX(across) * medium[kLpvTrueAlbedo * cells + index].rgb;
            // A mean cosine of g: the part |g| goes forwards (or backwards), the rest evenly.
            float g = cellDepth.w;
            uint target = cellIndex(cellOnSide(params.grid, origin + direction * middle));
            for (uint c = 0u; c < 3u; ++c) deposit(12u + c, target, cells, scattered[c] * (1.0 - abs(g)), rests.emission[c]);
            if (g != 0.0) depositEntering(target, cells, scattered * abs(g), ray.direction * sign(g), rests);
            depth += across;
        }
        if (planes.x <= next) cell.x += safe.x > 0.0 ? 1 : -1;
        if (planes.y <= next) cell.y += safe.y > 0.0 ? 1 : -1;
        if (planes.z <= next) cell.z += safe.z > 0.0 ? 1 : -1;
        if (!isInside(cell)) break;
        t = next;
    }
}

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, ivec2(view.size.xy)))) return;
    vec2 pixel = vec2(texel) + 0.5;
    Ray ray = cameraRay(pixel);
    vec3 power = texelPower(texel, ray) * inject.scale.rgb;
    if (!(maximumOf(power) > 0.0)) return;
    float surface = rayDistanceFromDepth(pixel, texelFetch(gbufferDepth, texel, 0).r);
    Rests rests = Rests(vec4[3](vec4(0.0), vec4(0.0), vec4(0.0)), vec3(0.0));
    vec3 depth = vec3(0.0);
#if MEDIA && SCATTER
    scatterAlong(ray, power, min(surface, kInfiniteDistance), rests, depth);
#endif
#if REFLECT
    Receiver r;
    if (!receiverAt(texel, r)) return;
    vec3 place = latticePosition(r.position) + kOffSurface * r.facet;
    if (any(lessThan(place, vec3(0.0))) || any(greaterThanEqual(place, vec3(params.grid.size.xyz)))) return;
    ivec3 cell = cellOnSide(params.grid, place);
    Reflection reflected = reflectionOf(r.brdf, r.roughness);
    float window = lights[inject.light].type == kLightDirectional ? 1.0 : rangeWindow(lights[inject.light].position.w, surface);
    depth = depthBefore(ray, surface);
    Rests none = Rests(vec4[3](vec4(0.0), vec4(0.0), vec4(0.0)), vec3(0.0));
    vec3 arriving = power * window * exp(-depth);
    // One deposit: of entering light a cell holds the power and the first moment alone.
    vec3 mirror = reflect(ray.direction, r.facet);
    vec3 along = meanOfLobe(mirror, r.facet, r.roughness);
    vec3 all = reflected.even + reflected.mirrored;
    float share = meanOf(reflected.mirrored) / max(meanOf(all), 1e-6);
    depositEntering(cellIndex(cell), cellCount(), arriving * all, mix((2.0 / 3.0) * r.facet, along, share), none);
#endif
}
