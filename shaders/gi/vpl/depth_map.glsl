// The layout of a virtual light's map of optical depth, for the passes that make it and that read it.
#ifndef TYNDALL_GI_VPL_DEPTH_MAP
#define TYNDALL_GI_VPL_DEPTH_MAP
#include "common/octahedral.glsl"
#include "lighting/brdf.glsl"
#include "shared/vpl.h"

/// Metres from a light to where the first grid may begin, and to beyond the last one.
vec2 vplDepthRange(vec3 position, VplParams params) {
    vec3 low = params.gridsMinimum.xyz - position;
    vec3 high = position - params.gridsMaximum.xyz;
    return vec2(length(max(max(low, high), vec3(0.0))), length(max(abs(low), abs(high))));
}

/// Where step number `step` begins, over the range. Steps near the light are short: they attenuate everything behind them.
float vplDepthStart(uint step) {
    float part = float(step) / float(kVplDepthSteps);
    return part * part;
}

/// The step within which a place of the range lies, and how far within.
uint vplDepthStep(float place, out float part) {
    uint step = min(uint(sqrt(place) * float(kVplDepthSteps)), kVplDepthSteps - 1u);
    float start = vplDepthStart(step);
    part = (place - start) / (vplDepthStart(step + 1u) - start);
    return step;
}

const float kVplFarFromGrids = 1.3; // radii of the ball around the grids' box

/// A light that is farther from the grids maps the cone in which they lie, another one all directions. False: the latter.
/// `slope`: tangent of the cone's angle.
bool vplDepthCone(vec3 position, VplParams params, out mat3 frame, out float slope) {
    vec3 away = 0.5 * (params.gridsMinimum.xyz + params.gridsMaximum.xyz) - position;
    float radius = 0.5 * length(params.gridsMaximum.xyz - params.gridsMinimum.xyz);
    float distance = length(away);
    frame = mat3(1.0);
    slope = 1.0;
    if (distance <= kVplFarFromGrids * radius) return false;
    frame = frameAround(away / distance);
    slope = max(radius, 1e-6 * distance) / sqrt(distance * distance - radius * radius);
    return true;
}

/// Place of a unit direction in the map, [0,1]².
vec2 vplDepthPlace(vec3 position, vec3 direction, VplParams params) {
    mat3 frame;
    float slope;
    if (!vplDepthCone(position, params, frame, slope)) return octahedralEncode(direction) * 0.5 + 0.5;
    vec3 local = direction * frame;
    if (local.z <= 0.0) return vec2(1.0); // the square's corners lie outside the cone, where there is no grid
    return clamp(local.xy / (local.z * slope) * 0.5 + 0.5, 0.0, 1.0);
}

vec3 vplDepthDirection(vec3 position, vec2 place, VplParams params) {
    mat3 frame;
    float slope;
    vec2 square = place * 2.0 - 1.0;
    if (!vplDepthCone(position, params, frame, slope)) return octahedralDecode(square);
    return normalize(frame * vec3(square * slope, 1.0));
}

#endif
