// The environment: radiance from infinity in every direction, a latitude-longitude map with mip levels. -Z is at the map's
// centre, +X at u = 0.75, +Y at the top, where v = 0; `rotation` turns it right-handed about +Y.
#ifndef TYNDALL_LIGHTING_ENVIRONMENT
#define TYNDALL_LIGHTING_ENVIRONMENT
#include "common/view.glsl"
#include "shared/deferred.h"

layout(std140) uniform Environment {
    EnvironmentData environment;
};
uniform sampler2D environmentMap; // nits; repeats in u

const float kEnvironmentPi = 3.14159265358979;

vec2 environmentUv(vec3 direction) {
    float c = environment.rotation.x;
    float s = environment.rotation.y;
    vec3 d = vec3(c * direction.x - s * direction.z, direction.y, s * direction.x + c * direction.z);
    // atan2 of two zeros is undefined: straight up and down any u will do.
    float u = abs(d.x) + abs(d.z) > 0.0 ? 0.5 + atan(d.x, -d.z) / (2.0 * kEnvironmentPi) : 0.5;
    return vec2(u, acos(clamp(d.y, -1.0, 1.0)) / kEnvironmentPi);
}

vec3 environmentRadiance(vec3 direction, float level) {
    return textureLod(environmentMap, environmentUv(direction), clamp(level, 0.0, environment.levels.x)).rgb;
}

// Mean radiance over about `solidAngle` steradians around `direction`: the level whose texels are that large there.
vec3 environmentRadianceOver(vec3 direction, float solidAngle) {
    vec2 texels = environment.rotation.zw;
    float sine = sqrt(max(1.0 - direction.y * direction.y, 1.0 / (texels.y * texels.y)));
    float texel = 2.0 * kEnvironmentPi * kEnvironmentPi * sine / (texels.x * texels.y);
    return environmentRadiance(direction, 0.5 * log2(max(solidAngle / texel, 1e-12)));
}

// What the camera sees behind everything.
vec3 environmentBackground(vec2 pixel) {
    vec3 direction = cameraRay(pixel).direction;
    if (viewConverges()) return environmentRadiance(direction, 0.0);
    vec3 right = cameraRay(pixel + vec2(1.0, 0.0)).direction - direction;
    vec3 up = cameraRay(pixel + vec2(0.0, 1.0)).direction - direction;
    return environmentRadianceOver(direction, length(right) * length(up));
}

#endif
