// Light that surfels reflect, on both of their sides: every light that reaches them, shadowed, through the media.
#define MARCH_PHASE_GROUPS 1
#include "common/random.glsl"
#include "common/view.glsl"
#include "lighting/brdf.glsl"
#include "lighting/light.glsl"
#include "lighting/rect_irradiance.glsl"
#include "lighting/shadow.glsl"
#if MEDIA
#include "media/near_glow.glsl"
#include "media/optical_depth.glsl"
#endif
#include "shared/surfels.h"

layout(local_size_x = 64) in;
layout(std140) uniform Lighting { SurfelLightParams lighting; };
layout(std430) readonly buffer Surfels { Surfel surfels[]; };
layout(std430) writeonly buffer LitSurfels { LitSurfel lit[]; };

const float kSurfelPi = 3.14159265358979;

/// Irradiance of both sides, lux.
struct SidesLight {
    vec3 front;
    vec3 back;
};

float random(uint surfel, uint use) {
    uint frame = viewConverges() ? view.frameIndex : 0u;
    return unitFloat(hashUint(surfel + hashUint(use + hashUint(frame + view.seed * 0x9e3779b9u))));
}

void addLight(uint light, uint surfel, vec3 position, vec3 normal, inout SidesLight sum) {
    vec2 u = vec2(random(surfel, 2u * light + 2u), random(surfel, 2u * light + 3u));
    LightSample arriving = sampleLight(light, position, u);
    vec3 front = arriving.illuminance * max(dot(normal, arriving.direction), 0.0);
    vec3 back = arriving.illuminance * max(-dot(normal, arriving.direction), 0.0);
    if (lights[light].type == kLightRect && !viewConverges()) {
        // Of all of its area, in closed form.
        vec3 centre = lights[light].position.xyz - position;
        front = lights[light].intensity.rgb * rectIrradiance(centre, lights[light].axisX.xyz, lights[light].axisY.xyz, lights[light].direction.xyz, normal);
        back = lights[light].intensity.rgb * rectIrradiance(centre, lights[light].axisX.xyz, lights[light].axisY.xyz, lights[light].direction.xyz, -normal);
    }
    if (!(max(max(front.r, front.g), front.b) + max(max(back.r, back.g), back.b) > 0.0)) return;
    float visible = shadowVisibility(light, position, normal, u);
    if (!(visible > 0.0)) return;
    vec3 through = vec3(visible);
#if MEDIA
    through *= exp(-opticalDepthToLight(light, position, arriving.direction, arriving.distance));
#endif
    sum.front += through * front;
    sum.back += through * back;
}

#if MEDIA
/// Of glowing media that the surfel lies in, by one direction.
vec3 nearGlowOn(vec3 position, vec3 normal, vec3 u) {
    float turn = 2.0 * kSurfelPi * u.y;
    vec3 direction = frameAround(normal) * vec3(sqrt(u.x) * vec2(cos(turn), sin(turn)), sqrt(1.0 - u.x));
    return kSurfelPi * nearGlow(position, direction, u.z);
}
#endif

void main() {
    uint number = lighting.first + gl_GlobalInvocationID.x;
    if (number >= lighting.surfelCount) return;
    vec3 position = surfels[number].position.xyz;
    vec3 normal = surfels[number].normal.xyz;
    vec3 albedo = surfels[number].albedo.rgb;
    SidesLight sum = SidesLight(vec3(0.0), vec3(0.0));
    if (max(max(albedo.r, albedo.g), albedo.b) > 0.0 && surfels[number].position.w > 0.0) {
        for (uint light = 0u; light < lighting.lightCount; ++light) addLight(light, number, position, normal, sum);
#if MEDIA
        if (mediaHeader.nearGlow > 0.0) {
            vec3 u = vec3(random(number, 0u), random(number, 1u), random(number, 0xffffu));
            sum.front += nearGlowOn(position, normal, u);
            sum.back += nearGlowOn(position, -normal, u);
        }
#endif
    }
    vec3 front = sum.front * albedo * (1.0 / kSurfelPi);
    vec3 back = sum.back * albedo * (1.0 / kSurfelPi);
    float brightest = max(max(max(front.r, front.g), front.b), max(max(back.r, back.g), back.b));
    lit[number] = LitSurfel(surfels[number].position, vec4(normal, brightest), vec4(front, 0.0), vec4(back, 0.0));
}
