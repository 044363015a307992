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

/// Light that both sides reflect, lux.
struct SidesLight {
    vec3 front;
    vec3 back;
};

float random(uint surfel, uint use) {
    uint frame = viewConverges() ? view.frameIndex : 0u;
    return unitFloat(hashUint(surfel + hashUint(use + hashUint(frame + view.seed * 0x9e3779b9u))));
}

const float kDiffuseLoss = 0.045; // of a dielectric: Schlick's reflectance at half the angle between two directions, of which one is Lambert's

/// The part of light from this angle that microfacets reflect to all sides, as x · F0 + y (Karis 2014, "Physically Based Shading on Mobile").
vec2 specularAlbedo(float cosine, float roughness) {
    vec4 r = roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
    float a = min(r.x * r.x, exp2(-9.28 * cosine)) * r.x + r.y;
    return vec2(-1.04, 1.04) * a + r.zw;
}

/// The part of light from this angle that is reflected to all sides. Where it goes is left to Lambert.
vec3 reflected(Surfel s, float cosine) {
    vec2 albedo = specularAlbedo(cosine, s.surface.z);
    vec3 dielectric = s.base.rgb * (1.0 - s.surface.x * kDiffuseLoss) + s.surface.x * (kDielectricF0 * albedo.x + albedo.y);
    return mix(dielectric, s.base.rgb * albedo.x + albedo.y, s.base.w);
}

void addLight(uint light, uint surfel, Surfel s, inout SidesLight sum) {
    vec3 position = s.position.xyz;
    vec3 normal = s.normal.xyz;
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
    vec3 through = visible * reflected(s, abs(dot(normal, arriving.direction)));
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
    uint number = gl_GlobalInvocationID.x;
    if (number >= lighting.surfelCount) return;
    Surfel s = surfels[number];
    SidesLight sum = SidesLight(vec3(0.0), vec3(0.0));
    if (s.surface.y * s.position.w > 0.0) {
        for (uint light = 0u; light < lighting.lightCount; ++light) addLight(light, number, s, sum);
#if MEDIA
        if (mediaHeader.nearGlow > 0.0) {
            vec3 u = vec3(random(number, 0u), random(number, 1u), random(number, 0xffffu));
            sum.front += reflected(s, 2.0 / 3.0) * nearGlowOn(s.position.xyz, s.normal.xyz, u);
            sum.back += reflected(s, 2.0 / 3.0) * nearGlowOn(s.position.xyz, -s.normal.xyz, u);
        }
#endif
    }
    vec3 front = sum.front * (1.0 / kSurfelPi);
    vec3 back = sum.back * (1.0 / kSurfelPi);
    float brightest = max(max(max(front.r, front.g), front.b), max(max(back.r, back.g), back.b));
    lit[number] = LitSurfel(s.position, vec4(s.normal.xyz, brightest), vec4(front, 0.0), vec4(back, 0.0));
}
