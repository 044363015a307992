// Direct light on a point of a surface: every light that reaches it, shadowed, through the media, times the BRDF.
//
// The environment's light is split so that nothing is counted twice. Its directional lights (kLightFromEnvironment) give all
// of the diffuse part, and the specular part of rough surfaces. The map gives the specular part of smooth surfaces, whose
// lobes a few lights would show as spots; no shadow ray follows those directions, so what the lights saw
// of the environment, weighted by how close they lie to the lobe, stands in for their visibility.
//
// MEDIA: 1 where media attenuate light. ENVIRONMENT: 1 where there is an environment map.
#ifndef TYNDALL_LIGHTING_SURFACE_LIGHT
#define TYNDALL_LIGHTING_SURFACE_LIGHT
#include "common/random.glsl"
#include "common/view.glsl"
#include "lighting/brdf.glsl"
#include "lighting/clusters.glsl"
#include "lighting/light.glsl"
#include "lighting/rect_irradiance.glsl"
#include "lighting/shadow.glsl"
#include "shared/deferred.h"
#if ENVIRONMENT
#include "lighting/environment.glsl"
#endif
#if MEDIA
#include "media/near_glow.glsl"
#include "media/optical_depth.glsl"
#endif

layout(std140) uniform Surfaces {
    SurfaceLightParams surfaceLight;
};

struct LitPoint {
    vec3 position;        // render space
    vec3 normal;          // unit, shading
    vec3 geometricNormal; // unit, towards the eye
    vec3 toEye;           // unit
    Brdf brdf;
    float occlusion;
    uvec2 pixel;
};

// What the environment's lights know about how much of the environment is seen.
struct EnvironmentVisibility {
    vec3 seen;    // sum of weight · visibility · transmittance
    float weight;
};

const float kBlurAlpha = 0.25; // lobes narrower than this are widened where lights vote on the environment's visibility

vec3 transmittanceToLight(uint light, vec3 position, LightSample incoming) {
#if MEDIA
    return exp(-opticalDepthToLight(light, position, incoming.direction, incoming.distance));
#else
    return vec3(1.0);
#endif
}

// Light of one lamp. From a point (or what stands for one) it is that point's; a rectangle in a frame of its own has its
// irradiance in closed form, and samples for the lobe and for how Fresnel and media weigh its parts. One loop serves all kinds,
// because every call of a shadow or a medium is compiled where it stands.
vec3 lightOf(uint light, LitPoint point, vec2 u, float lightsShare, inout EnvironmentVisibility seen) {
    bool fromEnvironment = (lights[light].flags & kLightFromEnvironment) != 0u;
    bool area = lights[light].type == kLightRect && !viewConverges();
    float irradiance = 0.0;
    uint count = 1u;
    if (area) {
        irradiance = rectIrradiance(lights[light].position.xyz - point.position, lights[light].axisX.xyz, lights[light].axisY.xyz, lights[light].direction.xyz, point.normal);
        if (!(irradiance > 0.0)) return vec3(0.0);
        count = max(surfaceLight.rectSamples, 1u);
    }
    float visibility = -1.0; // not looked up yet
    vec3 specular = vec3(0.0);
    vec3 diffuse = vec3(0.0);
    float weights = 0.0;
    for (uint i = 0u; i < count; ++i) {
        // The plastic-number sequence covers a rectangle evenly for every count.
        LightSample incoming = sampleLight(light, point.position, area ? fract(u + float(i) * vec2(0.7548776662, 0.5698402910)) : u);
        float cosine = dot(point.normal, incoming.direction);
        float power = max(incoming.illuminance.r, max(incoming.illuminance.g, incoming.illuminance.b));
        // An opaque surface is not lit from the side that is not seen, whatever its shading normal says.
        if (!(cosine > 0.0) || !(dot(point.geometricNormal, incoming.direction) > 0.0) || !(power > 0.0)) continue;
        if (visibility < 0.0) visibility = shadowVisibility(light, point.position, point.geometricNormal, u);
        vec3 transmittance = vec3(0.0);
        if (visibility > 0.0) {
            transmittance = transmittanceToLight(light, point.position, incoming);
            BrdfValue value = evaluateBrdf(point.brdf, point.normal, point.toEye, incoming.direction);
            vec3 arriving = transmittance * incoming.illuminance * cosine;
            specular += arriving * value.specular;
            diffuse += (area ? transmittance * (cosine * power) : arriving) * value.diffuse;
            weights += cosine * power;
        }
        if (ENVIRONMENT == 1 && fromEnvironment) {
            vec3 halfway = normalize(point.toEye + incoming.direction + 1e-4 * point.normal);
            float vote = power * cosine * ggxDistribution(max(point.brdf.alpha, kBlurAlpha), point.normal, halfway);
            seen.seen += vote * visibility * transmittance;
            seen.weight += vote;
        }
    }
    if (!(visibility > 0.0)) return vec3(0.0);
    if (area) diffuse *= lights[light].intensity.rgb * (irradiance / weights);
    return visibility * (diffuse + (fromEnvironment ? lightsShare : 1.0) / float(count) * specular);
}

#if ENVIRONMENT
// The specular part from the map: directions drawn from the lobe, each looked up at the width of its share of the lobe.
vec3 environmentReflection(LitPoint point) {
    mat3 frame = frameAround(point.normal);
    vec3 toEye = point.toEye * frame;
    toEye.z = max(abs(toEye.z), 1e-4);
    uint count = max(surfaceLight.environmentSamples, 1u);
    // Averaged frames draw new directions in each; a single frame uses the same in all pixels, so that it has no noise.
    vec2 start = viewConverges() ? pixelNoise2(point.pixel, 7u) : vec2(0.5 / float(count), 0.5);
    float alpha = point.brdf.alpha;
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < count; ++i) {
        vec2 u = vec2(fract(start.x + float(i) / float(count)), fract(start.y + float(i) * 0.6180339887));
        vec3 halfway = sampleVisibleNormal(alpha, toEye, u);
        float viewDotHalf = dot(toEye, halfway);
        vec3 local = 2.0 * viewDotHalf * halfway - toEye;
        if (!(local.z > 0.0)) continue;
        vec3 direction = frame * local;
        if (!(dot(direction, point.geometricNormal) > 0.0)) continue;
        vec3 radiance;
        if (viewConverges()) {
            radiance = environmentRadiance(direction, 0.0);
        } else {
            // G₁(eye)/(4 eye.z) = smithVisibility / 2
            float density = 0.5 * smithVisibility(alpha, toEye.z) * ggxDistribution(alpha, vec3(0.0, 0.0, 1.0), halfway);
            radiance = environmentRadianceOver(direction, 1.0 / (float(count) * max(density, 1e-6)));
        }
        float shadowing = 2.0 * local.z * smithVisibility(alpha, local.z);
        sum += radiance * specularFresnel(point.brdf, viewDotHalf) * shadowing;
    }
    return sum / float(count);
}
#endif

#if MEDIA
// Of glowing media that the surface lies in: a direction in proportion to its cosine.
vec3 lightOfNearGlow(LitPoint point) {
    vec2 u = pixelNoise2(point.pixel, 8u);
    float turn = 2.0 * kPi * u.y;
    vec3 direction = frameAround(point.normal) * vec3(sqrt(u.x) * vec2(cos(turn), sin(turn)), sqrt(1.0 - u.x));
    if (!(dot(direction, point.geometricNormal) > 0.0)) return vec3(0.0);
    vec3 radiance = nearGlow(point.position, direction, pixelNoise(point.pixel, 9u));
    if (!(maximumOf(radiance) > 0.0)) return vec3(0.0);
    BrdfValue value = evaluateBrdf(point.brdf, point.normal, point.toEye, direction);
    return kPi * (value.diffuse + value.specular) * radiance;
}
#endif

// Radiance towards the eye, nits: LSE before the media between the surface and the eye.
vec3 directLight(LitPoint point) {
    vec3 sum = vec3(0.0);
    vec3 fromEnvironment = vec3(0.0);
    EnvironmentVisibility seen = EnvironmentVisibility(vec3(0.0), 0.0);
    float lightsShare = 1.0;
#if ENVIRONMENT
    lightsShare = smoothstep(surfaceLight.roughnessOfMap, surfaceLight.roughnessOfLights, sqrt(point.brdf.alpha));
#endif
    uint cluster = clusterOfPosition(point.position);
    uint count = clusterLightCount(cluster);
    for (uint i = 0u; i < count; ++i) {
        uint light = clusterLight(cluster, i);
        vec2 u = pixelNoise2(point.pixel, 16u + i);
        vec3 radiance = lightOf(light, point, u, lightsShare, seen);
        if ((lights[light].flags & kLightFromEnvironment) != 0u) fromEnvironment += radiance;
        else sum += radiance;
    }
#if ENVIRONMENT
    if (lightsShare < 1.0 && (point.brdf.specular > 0.0 || point.brdf.metallic > 0.0)) {
        vec3 visible = seen.weight > 0.0 ? seen.seen / seen.weight : vec3(1.0);
        fromEnvironment += (1.0 - lightsShare) * visible * environmentReflection(point);
    }
#endif
#if MEDIA
    if (mediaHeader.nearGlow > 0.0) sum += lightOfNearGlow(point);
#endif
    return sum + fromEnvironment * (surfaceLight.materialOcclusion != 0u ? point.occlusion : 1.0);
}

#endif
