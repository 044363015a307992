// Shadows: how much of a light a point sees past the surfaces.
//
// Three ways, chosen by the view's flags and the light:
// - averaged frames (kViewConverge): one hard lookup. The map was drawn from this frame's point on the light with this frame's
//   offset of its texel grid, so the average over frames is the light's true, soft, anti-aliased shadow;
// - a light without size: a small kernel of bilinear comparisons;
// - a light with size: what stands in the way is looked for first, and its distance sets the width of the penumbra
//   (after Fernando, "Percentage-Closer Soft Shadows", 2005).
//
// Bias. A point on a surface is compared, at every texel, with the depth that its own tangent plane has at that texel's
// centre: on a plane that is exact, whatever the tilt, so only a small part of a texel is left as bias and shadows touch
// what casts them. All biases are measured in texels at the point's distance, so the picture does not depend on the scene's scale.
// A point in a medium has no plane: it counts as lit where it is one and a half texels before what the map holds (light
// must not leak through walls), except in averaged frames, where no bias is the unbiased choice.
#ifndef TYNDALL_LIGHTING_SHADOW_GLSL
#define TYNDALL_LIGHTING_SHADOW_GLSL
#include "common/view.glsl"
#include "lighting/light.glsl"
#include "shared/shadow.h"

// A shader that takes many lookups defines SOFT_SHADOWS as 0 where the frame has none: LightResources.softShadows.
#ifndef SOFT_SHADOWS
#define SOFT_SHADOWS 1
#endif

layout(std430) readonly buffer ShadowViews { ShadowView shadowViews[]; };
uniform sampler2DArray shadowAtlas;

const float kSurfaceBiasTexels = 0.2;   // what rounding and facets need, on top of the tangent plane
const float kSurfaceBiasOfSlope = 0.1;  // of the depth that the plane spans within a texel: vertices snap to a fraction of a texel
const float kSteepestSlope = 24.0;      // depth over width; beyond it hardly any light arrives, and planes seen edge-on explode
const float kMediumBiasTexels = 1.5;
const float kSmallKernelTexels = 1.25;  // radius of the kernel for lights without size
const int kPenumbraTaps = 4;            // times as many lookups where some of the light may be seen and some not
const float kNearestBlocker = 0.25;     // casters are looked for beyond this part of the way from the light to the point

/// A point as one view of the atlas sees it.
struct ShadowPoint {
    ivec2 corner;
    int side;
    int layer;
    vec2 texel;      // continuous, texel centres at +0.5
    float depth;
    vec2 gradient;   // of the tangent plane's depth, per texel
    float oneTexel;  // depth change of moving a texel's width along the light
    float perspective;
    float range;     // or near distance
    float texelSize; // see ShadowView.bias.x
};

float shadowDistance(float depth, float perspective, float range) {
    return perspective > 0.0 ? range / max(depth, 1e-30) : (1.0 - depth) * range;
}

/// The view of `light` that holds `position`, or -1 where no view does: nothing can stand between it and the light.
int shadowViewOf(uint light, vec3 position) {
    int first = lights[light].shadowIndex;
    int count = shadowViews[first].count;
    if (count == 1) return first;
    if (lights[light].type == kLightDirectional) {
        for (int i = 0; i < count; ++i) {
            vec3 t = (shadowViews[first + i].shadowFromRender * vec4(position, 1.0)).xyz;
            float border = shadowViews[first + i].bias.w / shadowViews[first + i].atlas.z;
            if (all(greaterThanEqual(t.xy, vec2(border))) && all(lessThanEqual(t.xy, vec2(1.0 - border)))) return first + i;
        }
        return -1;
    }
    vec3 d = position - (lights[light].samplePoint.w > 0.0 ? lights[light].samplePoint.xyz : lights[light].position.xyz);
    vec3 a = abs(d);
    int axis = a.x >= a.y && a.x >= a.z ? 0 : (a.y >= a.z ? 1 : 2);
    return first + 2 * axis + (d[axis] < 0.0 ? 1 : 0);
}

/// False where the view cannot hold the point: behind a spot, outside of its cone, in a direction that gets no light.
bool shadowProject(int index, vec3 position, out ShadowPoint point) {
    ShadowView v = shadowViews[index];
    vec4 t = v.shadowFromRender * vec4(position, 1.0);
    point = ShadowPoint(ivec2(v.atlas.xy), int(v.atlas.z), v.layer, vec2(0.0), 0.0, vec2(0.0), 0.0, v.bias.y, v.bias.z, v.bias.x);
    if (v.atlas.z <= 0.0 || t.w <= 0.0) return false;
    t.xyz /= t.w;
    if (any(lessThan(t.xy, vec2(0.0))) || any(greaterThan(t.xy, vec2(1.0)))) return false;
    point.texel = t.xy * v.atlas.z;
    point.depth = t.z;
    // Perspective: depth = near/distance, and a texel is bias.x·distance wide, so a texel's width changes depth by bias.x·depth.
    point.oneTexel = v.bias.y > 0.0 ? v.bias.x * t.z : v.bias.x / v.bias.z;
    return true;
}

/// Depth gradient of the plane through `position` with this normal: a plane's depth is affine over the view's texels,
/// perspective or not. Solved from two directions that span the plane.
void shadowPlane(int index, vec3 position, vec3 normal, inout ShadowPoint point) {
    mat4 m = shadowViews[index].shadowFromRender;
    vec3 tangent = normalize(abs(normal.y) < 0.9 ? cross(normal, vec3(0, 1, 0)) : cross(normal, vec3(1, 0, 0)));
    vec4 c = m * vec4(position, 1.0);
    vec4 a = m * vec4(tangent, 0.0);
    vec4 b = m * vec4(cross(normal, tangent), 0.0);
    // Derivatives of (x, y, z)/w along both, times w.
    vec3 da = a.xyz - (c.xyz / c.w) * a.w;
    vec3 db = b.xyz - (c.xyz / c.w) * b.w;
    float determinant = da.x * db.y - da.y * db.x;
    vec2 gradient = vec2(da.z * db.y - db.z * da.y, db.z * da.x - da.z * db.x);
    float limit = kSteepestSlope * point.oneTexel;
    gradient /= float(point.side);
    float steepness = length(gradient);
    // Compared before the division: a plane seen edge-on has determinant 0.
    if (steepness > limit * abs(determinant)) gradient *= limit / max(steepness, 1e-37) * (determinant < 0.0 ? -1.0 : 1.0);
    else gradient /= determinant;
    point.gradient = steepness > 0.0 ? gradient : vec2(0.0);
}

float shadowFetch(ShadowPoint point, ivec2 texel) {
    texel = clamp(texel, ivec2(0), ivec2(point.side - 1));
    return texelFetch(shadowAtlas, ivec3(point.corner + texel, point.layer), 0).r;
}

/// 1 where the map holds nothing nearer to the light than the plane at the texel that the point falls into.
float shadowHard(ShadowPoint point, float bias) {
    vec2 texel = floor(point.texel);
    float held = shadowFetch(point, ivec2(texel));
    float own = point.depth + dot(point.gradient, texel + 0.5 - point.texel) + bias;
    return held <= 0.0 || own >= held ? 1.0 : 0.0;
}

/// The same at the four texels around `at`, weighted bilinearly.
float shadowBilinear(ShadowPoint point, vec2 at, float bias) {
    at = clamp(at, 1.0, float(point.side) - 1.0); // nothing of the neighbouring squares
    vec2 low = floor(at - 0.5);
    vec2 f = at - 0.5 - low;
    // Gathered at the corner that the four share: there rounding cannot choose others.
    vec2 size = vec2(textureSize(shadowAtlas, 0).xy);
    vec4 held = textureGather(shadowAtlas, vec3((vec2(point.corner) + low + 1.0) / size, float(point.layer)));
    float own = point.depth + dot(point.gradient, low + 0.5 - point.texel) + bias;
    vec2 g = point.gradient;
    vec4 planes = own + vec4(g.y, g.x + g.y, g.x, 0.0); // in textureGather's order: upper left, upper right, lower right, lower left
    vec4 lit = max(vec4(lessThanEqual(held, vec4(0.0))), vec4(greaterThanEqual(planes, held)));
    vec2 rows = mix(lit.xw, lit.yz, f.x);
    return mix(rows.y, rows.x, f.y);
}

/// Steps of the spiral that spreads points evenly over a disc (Vogel): a turn by the golden angle.
const mat2 kSpiral = mat2(-0.73736888, 0.67549029, -0.67549029, -0.73736888);

vec2 shadowSpiralStart(float turn) { return vec2(cos(6.28318531 * turn), sin(6.28318531 * turn)); }

float shadowSurfaceBias(ShadowPoint point) {
    return kSurfaceBiasTexels * point.oneTexel + kSurfaceBiasOfSlope * (abs(point.gradient.x) + abs(point.gradient.y));
}

/// Two vectors from the light's centre that span it as `position` sees it: metres, for directional lights metres per metre.
/// `square`: the light is the parallelogram between ±both, else the ellipse inside.
void shadowLightExtent(uint light, vec3 position, out vec3 x, out vec3 y, out bool square) {
    square = lights[light].type == kLightRect;
    if (square) {
        x = lights[light].axisX.xyz;
        y = lights[light].axisY.xyz;
        return;
    }
    vec3 axis = lights[light].type == kLightDirectional ? lights[light].direction.xyz : position - lights[light].position.xyz;
    float size = lights[light].type == kLightDirectional ? tan(lights[light].direction.w) : lights[light].direction.w;
    vec3 side = abs(axis.y) < 0.9 * length(axis) ? cross(axis, vec3(0, 1, 0)) : cross(axis, vec3(1, 0, 0));
    x = size * side / max(length(side), 1e-30);
    y = cross(axis, x) / max(length(axis), 1e-30);
}

/// Where the segment from `position` to the point `onLight` (relative to the light's centre) is, `part` (0..1) of the way
/// from the light; seen from the light's centre that is where a caster of this point's shadow would be drawn.
vec3 shadowOnWay(uint light, vec3 position, vec3 onLight, float part, float reach) {
    if (lights[light].type == kLightDirectional) return position + (onLight - lights[light].direction.xyz) * ((1.0 - part) * reach);
    return mix(lights[light].position.xyz + onLight, position, part);
}

/// `at` moved along its ray from the light onto the plane through `position`; without a plane, to the same distance from the light: a plane that no surface
/// has would go on through walls, right beside a lamp that is larger than its distance.
vec3 shadowOntoPlane(uint light, vec3 at, vec3 position, vec3 normal, bool hasPlane) {
    bool parallel = lights[light].type == kLightDirectional;
    vec3 ray = parallel ? lights[light].direction.xyz : at - lights[light].position.xyz;
    vec3 plane = hasPlane ? normal : lights[light].direction.xyz;
    float along = dot(ray, plane);
    if ((!hasPlane && !parallel) || abs(along) <= length(ray) / kSteepestSlope) return parallel ? at : lights[light].position.xyz + normalize(ray) * distance(position, lights[light].position.xyz);
    return at + ray * (dot(position - at, plane) / along);
}

/// Depth that a point's own plane spans, over a texel's width: for lookups at texel centres near the point.
float shadowSlope(uint light, vec3 position, vec3 normal) {
    vec3 ray = lights[light].type == kLightDirectional ? lights[light].direction.xyz : position - lights[light].position.xyz;
    float cosine = max(abs(dot(ray, normal)) / max(length(ray), 1e-30), 1.0 / kSteepestSlope);
    return sqrt(max(0.0, 1.0 - cosine * cosine)) / cosine;
}

#if SOFT_SHADOWS
/// One loop over all lookups, and little code in it: loops that are unrolled, and calls that are repeated, take software drivers
/// seconds to compile.
float shadowSoft(uint light, ShadowPoint centre, vec3 position, vec3 normal, bool hasPlane, int taps, int searchTaps, vec2 u) {
    vec3 x, y;
    bool square;
    shadowLightExtent(light, position, x, y, square);
    float reach = shadowDistance(centre.depth, centre.perspective, centre.range);
    // Three quarters of a texel of the plane's slope: lookups are at the texel's centre, not at the point.
    float biasTexels = hasPlane ? kSurfaceBiasTexels + 0.75 * shadowSlope(light, position, normal) : -kMediumBiasTexels;
    float sum = 0.0;   // of where casters are, as parts of the way from the light
    float found = 0.0; // casters
    float lit = 0.0;
    float part = kNearestBlocker;
    vec2 spiral = shadowSpiralStart(u.x);
    // First look for casters anywhere on the way, then along the ways past where they are on average.
    for (int i = 0; i < searchTaps + taps; ++i) {
        if (i == searchTaps) {
            if (found == 0.0) return 1.0;
            // Some ways are free and some are not: a penumbra, where few lookups show as dots.
            if (hasPlane && found < float(searchTaps)) taps *= kPenumbraTaps;
            part = clamp(sum / found, 0.05, 1.0);
            spiral = shadowSpiralStart(u.y);
        }
        bool searching = i < searchTaps;
        float along = searching ? (float(i) + 0.5) / float(searchTaps) : (float(i - searchTaps) + 0.5) / float(taps);
        vec2 onLight = square ? 2.0 * fract(u + float(i + 1) * vec2(0.75487767, 0.56984029)) - 1.0 : sqrt(along) * spiral;
        spiral = kSpiral * spiral;
        vec3 at = shadowOnWay(light, position, x * onLight.x + y * onLight.y, part, reach);
        vec3 onPlane = shadowOntoPlane(light, at, position, normal, hasPlane);
        int index = shadowViewOf(light, onPlane);
        ShadowPoint point;
        bool free = index < 0 || !shadowProject(index, onPlane, point);
        if (!free) {
            float held = shadowFetch(point, ivec2(point.texel));
            free = held <= 0.0 || point.depth + biasTexels * point.oneTexel >= held;
            if (!free && searching) {
                sum += shadowDistance(held, point.perspective, point.range) / max(shadowDistance(point.depth, point.perspective, point.range), 1e-30);
                found += 1.0;
            }
        }
        if (free && !searching) lit += 1.0;
    }
    return lit / float(taps);
}
#endif

/// 0..1: the part of `light` that `position` (render space) sees past opaque surfaces. `offsetNormal`: the geometric normal of
/// the surface that the point lies on, unit, either side; vec3(0) for points in media. `u` (0..1) turns the filter.
float shadowVisibility(uint light, vec3 position, vec3 offsetNormal, vec2 u) {
    if (lights[light].shadowIndex < 0) return 1.0;
    int index = shadowViewOf(light, position);
    ShadowPoint point;
    if (index < 0 || !shadowProject(index, position, point)) return 1.0;
    bool onSurface = dot(offsetNormal, offsetNormal) > 0.0;
    if (onSurface) shadowPlane(index, position, offsetNormal, point);
    if (viewConverges()) return shadowHard(point, onSurface ? shadowSurfaceBias(point) : 0.0);
    int searchTaps = shadowViews[index].searchTaps;
    int taps = shadowViews[index].taps;
    // A ray gathers light at many points, each with its own `u`: together they take more lookups than a point on a surface.
    if (!onSurface) {
        searchTaps = (searchTaps + 3) / 4;
        taps = (taps + 3) / 4;
    }
#if SOFT_SHADOWS
    if (searchTaps > 0) return shadowSoft(light, point, position, offsetNormal, onSurface, taps, searchTaps, u);
#endif
    if (!onSurface) return shadowBilinear(point, point.texel, -kMediumBiasTexels * point.oneTexel);
    float bias = shadowSurfaceBias(point);
    float lit = 0.0;
    vec2 spiral = shadowSpiralStart(u.x);
    for (int tap = 0; tap < taps; ++tap) {
        float radius = taps > 1 ? kSmallKernelTexels * sqrt((float(tap) + 0.5) / float(taps)) : 0.0;
        lit += shadowBilinear(point, point.texel + radius * spiral, bias);
        spiral = kSpiral * spiral;
    }
    return lit / float(taps);
}

#endif
