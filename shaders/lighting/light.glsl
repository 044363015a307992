// Lights: what one of them sends to a point, without shadows and without media.
#ifndef TYNDALL_LIGHTING_LIGHT_GLSL
#define TYNDALL_LIGHTING_LIGHT_GLSL
#include "shared/light.h"

layout(std430) readonly buffer Lights { LightData lights[]; };

struct LightSample {
    vec3 direction;   // unit, from the point to the light
    float distance;   // metres; 1e30 for directional
    vec3 illuminance; // lux on a facing surface, unshadowed, in vacuum; range, cone and the light's own cosine included
};

/// KHR_lights_punctual: a window that takes the inverse square to 0 at the range; 1 for unbounded lights (range 0).
float rangeWindow(float range, float distance) {
    if (range <= 0.0) return 1.0;
    float x = distance / range;
    return clamp(1.0 - x * x * x * x, 0.0, 1.0);
}

/// KHR_lights_punctual, "Inner and Outer Cone Angles": the extension's formula, quadratic fall-off included.
float coneAttenuation(uint light, vec3 travel) {
    float outer = lights[light].axisY.w;
    float scale = 1.0 / max(0.001, lights[light].axisX.w - outer);
    float attenuation = clamp((dot(lights[light].direction.xyz, travel) - outer) * scale, 0.0, 1.0);
    return attenuation * attenuation;
}

// Lights are read where they are needed, field by field: loads of whole structs are what costs in a loop over many.

LightSample sampleDirectional(uint light) {
    vec3 travel = lights[light].samplePoint.w > 0.0 ? lights[light].samplePoint.xyz : lights[light].direction.xyz;
    return LightSample(-travel, 1e30, lights[light].intensity.rgb);
}

/// Point and spot. A radius makes it a Lambertian ball of the same intensity: seen whole, it sends I/d² to a facing surface,
/// d from its centre. Where a point in the ball is given, that point alone stands for all of it; over many frames the points
/// are spread so that together they are the ball (pointInBall in light_system.cpp).
LightSample samplePunctual(uint light, vec3 position) {
    bool sampled = lights[light].samplePoint.w > 0.0;
    float radius = lights[light].direction.w;
    vec3 from = sampled ? lights[light].samplePoint.xyz : lights[light].position.xyz;
    vec3 toLight = from - position;
    float distance = length(toLight);
    float nearest = lights[light].intensity.w; // a tiny fraction of the scene
    vec3 direction = distance > 0.0 ? toLight / distance : -lights[light].direction.xyz;
    // Inside the ball no more light arrives than on its surface.
    float counted = max(distance, sampled ? nearest : max(nearest, radius));
    float factor = rangeWindow(lights[light].position.w, distance) / (counted * counted);
    if (lights[light].type == kLightSpot) factor *= coneAttenuation(light, -direction);
    return LightSample(direction, distance, lights[light].intensity.rgb * factor);
}

/// One point of the rectangle stands for all of it: radiance · cosθ · area / d². One-sided, Lambertian.
LightSample sampleRect(uint light, vec3 position, vec2 u) {
    vec3 from = lights[light].samplePoint.w > 0.0
                    ? lights[light].samplePoint.xyz
                    : lights[light].position.xyz + lights[light].axisX.xyz * (2.0 * u.x - 1.0) + lights[light].axisY.xyz * (2.0 * u.y - 1.0);
    vec3 toLight = from - position;
    float distance = length(toLight);
    vec3 direction = distance > 0.0 ? toLight / distance : -lights[light].direction.xyz;
    float area = lights[light].intensity.w;
    float cosine = max(0.0, -dot(lights[light].direction.xyz, direction));
    // Closer to the sampled point than a ten-thousandth of the light's size, one sample says nothing: keep it finite.
    float squared = max(distance * distance, 1e-8 * area);
    return LightSample(direction, distance, lights[light].intensity.rgb * (cosine * area / squared));
}

/// What light number `light` sends to `position` (render space). `u` (0..1) chooses the point on a rect; in converge mode that
/// point is the frame's own, as it is for balls and for suns with a disc. Finite everywhere.
LightSample sampleLight(uint light, vec3 position, vec2 u) {
    uint type = lights[light].type;
    if (type == kLightDirectional) return sampleDirectional(light);
    if (type == kLightRect) return sampleRect(light, position, u);
    return samplePunctual(light, position);
}

#endif
