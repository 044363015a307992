// The march: along a ray, through all media at once, up to a distance. Segments end where a medium begins or ends, at the
// borders of bricks, and after the steps that the settings ask for. Inside a segment everything is a closed form: the
// light that a constant source sends is the same for any number of steps, from optical depth 0 to opaque.
//
// Single scattering takes one point a segment and light, several right beside a light. Close to a local light they are
// chosen evenly in angle as seen from the light (Kulla and Fajardo 2012, "Importance Sampling Techniques for Path Tracing in
// Participating Media", section 4), so that the inverse square cancels; elsewhere evenly in what the segment scatters. Both
// are unbiased.
//
// Before including this, a shader may define MARCH_PHASE_GROUPS (1 to 8: at least MediaHeader.phaseGroupCount), and
// MARCH_OCTAVES to replace single scattering by the octaves of `marchOctaves`. MARCH_GATHERS 0: no light is gathered, and the
// lights' buffers are not even declared, for drivers count those as used.
#ifndef TYNDALL_MEDIA_MARCH
#define TYNDALL_MEDIA_MARCH
#ifndef MARCH_GATHERS
#define MARCH_GATHERS 1
#endif
#include "common/phase_function.glsl"
#include "common/random.glsl"
#include "common/view.glsl"
#if MARCH_GATHERS
#include "lighting/light.glsl"
#include "lighting/rect_irradiance.glsl"
#include "lighting/shadow.glsl"
#include "media/near_glow.glsl"
#endif
#include "media/march_loop.glsl"
#include "shared/march.h"

#ifdef MARCH_OCTAVES
/// Multiple scattering by octaves (Wrenninge, Kulla and Lundqvist 2013, "Oz: The Great and Volumetric"): octave i lets light
/// through extinction·extinctionFactor^i, scatters scattering·scatteringFactor^i of it, with g·phaseFactor^i.
struct MarchOctaves {
    uint first;
    uint last; // inclusive
    float scatteringFactor;
    float extinctionFactor;
    float phaseFactor;
};
MarchOctaves marchOctaves;
#endif

struct MarchResult {
    vec3 opticalDepth; // of the whole way
    vec3 inScatter;    // nits that single scattering (or the octaves) sends back along the ray
    vec3 fromGrids;    // the part of that from segments that hold a grid
    vec3 emission;     // nits that the media's own emission sends back along the ray
};

const float kPointsPerRadian = 2.5; // at which light is gathered, as the light sees them

// ---- inside a segment ------------------------------------------------------------------------------------------

/// Light that blackbodies in the segment send back along the ray, seen from the segment's start. A flame's radiance changes tenfold
/// from voxel to voxel: no one point stands for a segment. Averaged frames take a point anywhere in it (`u`: 0..1), which is
/// unbiased; a single one takes the two of Gauss and Legendre.
vec3 blackbodyLight(Ray ray, Segment s, float u) {
    vec3 sum = vec3(0.0);
    int points = viewConverges() ? 1 : 2;
    for (int i = 0; i < points; ++i) {
        float x = points == 1 ? u : (i == 0 ? 0.21132487 : 0.78867513);
        sum += exp(-s.depth * depthFraction(s, x)) * blackbodyEmission(ray.origin + ray.direction * (s.start + s.size * x));
    }
    return sum * (s.size / float(points));
}

#if MARCH_GATHERS
// ---- where in a segment light is gathered ----------------------------------------------------------------------

/// A point of a segment, as the fraction of its length, and the segment's scattered light per scattering coefficient
/// times length and per light at that point.
struct GatherPoint {
    float fraction;
    vec3 weight;
};

/// Evenly in scattered light, as for a light that is the same all along the segment: then the weight is the closed form, and
/// exact. With coloured extinction, averaged frames sample each channel's own distribution, which is unbiased for
/// any light; a single frame keeps the closed form, which has no noise.
GatherPoint gatherBySegment(Segment s, float u) {
    bool coloured = maximumOf(s.depth) - minimumOf(s.depth) > 1e-3 * maximumOf(s.depth);
    if (!coloured || !viewConverges()) {
        float x = truncatedExponential(meanOf(s.depth), u);
        return GatherPoint(fractionAtDepth(s, x), oneMinusExpOverX(s.depth));
    }
    float channel = min(floor(3.0 * u), 2.0);
    float tau = channel < 1.0 ? s.depth.r : (channel < 2.0 ? s.depth.g : s.depth.b);
    float x = truncatedExponential(tau, 3.0 * u - channel);
    vec3 density = exp(-s.depth * x);
    return GatherPoint(fractionAtDepth(s, x), density / max(meanOf(density / oneMinusExpOverX(s.depth)), 1e-30));
}

/// A segment as a local light sees it: the light is `height` metres away from the ray, and the segment goes from `from` to `to`,
/// metres along the ray from where the light is abreast. `angle`: that it spans.
struct Sight {
    float height;
    float from;
    float to;
    float angle;
};

/// Evenly in angle from the light.
GatherPoint gatherByAngle(Segment s, Sight sight, float u) {
    float height = sight.height;
    float from = sight.from;
    float to = sight.to;
    float c = cos(u * sight.angle);
    float sn = sin(u * sight.angle);
    float t = clamp(height * (from * c + height * sn) / max(height * c - from * sn, 1e-30), from, to);
    float x = clamp((t - from) / (to - from), 0.0, 1.0);
    // A narrow angle is its tangent: the quotient angle/height stays exact however far away the light is.
    float along = height * height + from * to;
    float anglePerHeight = height * (to - from) < 1e-3 * along ? (to - from) / along : sight.angle / height;
    float sum = s.extinctionStart + s.extinctionEnd;
    float density = sum > 0.0 ? 2.0 * mix(s.extinctionStart, s.extinctionEnd, x) / sum : 1.0;
    vec3 through = exp(-s.depth * depthFraction(s, x));
    return GatherPoint(x, through * (density * anglePerHeight * (height * height + t * t) / (to - from)));
}

/// How the light is gathered from the segment: 0: it does not reach it; 1: one point, gatherBySegment; -n: n points, gatherByAngle.
int chooseGather(uint light, Ray ray, Segment s, out Sight sight) {
    sight = Sight(0.0, 0.0, 0.0, 0.0);
    if (lights[light].type == kLightDirectional) return 1;
    vec3 pivot = lights[light].samplePoint.w > 0.0 ? lights[light].samplePoint.xyz : lights[light].position.xyz;
    float abreast = dot(pivot - ray.origin, ray.direction);
    float height = length(pivot - ray.origin - ray.direction * abreast);
    float from = s.start - abreast;
    float to = from + s.size;
    float nearest = from > 0.0 ? from : (to < 0.0 ? -to : 0.0);
    float farthest = max(abs(from), abs(to));
    float range = lights[light].position.w;
    float extent = lights[light].type == kLightRect ? length(lights[light].axisX.xyz) + length(lights[light].axisY.xyz) : 0.0;
    if (range > 0.0 && length(vec2(height, nearest)) > range + extent) return 0;
    // Which varies more along the segment: the light's inverse square or the transmittance?
    float low = max(height * height + nearest * nearest, 1e-12 * farthest * farthest);
    if (log((height * height + farthest * farthest) / low) <= meanOf(s.depth)) return 1;
    height = max(height, 1e-5 * (to - from));
    // Of the segment as the light sees it: no difference of two large angles.
    sight = Sight(height, from, to, atan(height * (to - from), height * height + from * to));
    // Right beside a light the phase function goes from one end to the other within a segment, where the picture is brightest.
    // All of a ray spans at most half a turn: these are at most nine points more for each light.
    return -int(ceil(clamp(sight.angle * kPointsPerRadian, 1.0, 8.0)));
}

// ---- rectangles in single frames ---------------------------------------------------------------------------------

/// Does the light's area count in this frame, not one point that was chosen on it?
bool isWholeRect(uint light) { return lights[light].type == kLightRect && lights[light].samplePoint.w <= 0.0; }

/// What a rectangle sends through a point from all its area, lux. A single point's inverse square has no bound right beside the rectangle, and shows as
/// specks; the point still tells the direction and what is in the way.
vec3 rectFluence(uint light, vec3 position) {
    return lights[light].intensity.rgb *
           rectSolidAngle(lights[light].position.xyz - position, lights[light].axisX.xyz, lights[light].axisY.xyz, lights[light].direction.xyz);
}

// ---- light scattered in a segment -------------------------------------------------------------------------------

vec3 scatteredLight(Segment s, float cosTheta, vec3 depthToLight) {
    vec3 sum = vec3(0.0);
#ifdef MARCH_OCTAVES
    for (uint i = marchOctaves.first; i <= marchOctaves.last; ++i) {
        vec3 mixture = vec3(0.0);
        for (uint g = 0u; g < min(mediaHeader.phaseGroupCount, uint(MARCH_PHASE_GROUPS)); ++g)
            mixture += s.scattering[g] * phaseFunction(uint(mediaHeader.phases[g].x), mediaHeader.phases[g].y * pow(marchOctaves.phaseFactor, float(i)), cosTheta);
        sum += mixture * pow(marchOctaves.scatteringFactor, float(i)) * exp(-depthToLight * pow(marchOctaves.extinctionFactor, float(i)));
    }
#elif MARCH_PHASE_GROUPS == 1
    sum = s.scattering[0] * (phaseFunction(uint(mediaHeader.phases[0].x), mediaHeader.phases[0].y, cosTheta) * exp(-depthToLight));
#else
    for (uint g = 0u; g < min(mediaHeader.phaseGroupCount, uint(MARCH_PHASE_GROUPS)); ++g)
        sum += s.scattering[g] * phaseFunction(uint(mediaHeader.phases[g].x), mediaHeader.phases[g].y, cosTheta);
    sum *= exp(-depthToLight);
#endif
    return sum;
}

/// Light of one lamp that the segment scatters back along the ray, seen from the segment's start. `noise`: 0..1, along the
/// segment and over the light's area.
vec3 segmentLight(uint light, Ray ray, Segment s, vec3 noise) {
    Sight sight;
    int points = chooseGather(light, ray, s, sight);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < abs(points); ++i) {
        GatherPoint point = points > 0 ? gatherBySegment(s, noise.x) : gatherByAngle(s, sight, (float(i) + noise.x) / float(-points));
        vec3 position = ray.origin + ray.direction * (s.start + s.size * point.fraction);
        LightSample arriving = sampleLight(light, position, noise.yz);
        if (isWholeRect(light)) arriving.illuminance = rectFluence(light, position);
        if (!(maximumOf(arriving.illuminance) > 0.0)) continue;
        float visible = shadowVisibility(light, position, vec3(0.0), noise.yz);
        if (visible <= 0.0) continue;
        vec3 depth = opticalDepthToLight(light, position, arriving.direction, arriving.distance);
        sum += point.weight * scatteredLight(s, dot(arriving.direction, ray.direction), depth) * arriving.illuminance * visible;
    }
    return points == 0 ? sum : sum / float(abs(points));
}

/// What glowing media send to the segment from close by.
vec3 segmentNearGlow(Ray ray, Segment s, vec3 noise) {
    GatherPoint point = gatherBySegment(s, noise.x);
    vec3 direction = directionOnSphere(noise.yz);
    vec3 radiance = nearGlow(ray.origin + ray.direction * (s.start + s.size * point.fraction), direction, unitFloat(hashUint(floatBitsToUint(noise.x))));
    return 4.0 * kPi * point.weight * scatteredLight(s, dot(direction, ray.direction), vec3(0.0)) * radiance;
}

/// How many of `lightCount` lights do not stand for the environment, and the number of the i-th of them.
uint sceneLights(uint lightCount) { return lightCount - min(mediaHeader.environmentLights, lightCount); }
uint sceneLight(uint i) { return i < mediaHeader.environmentFirst ? i : i + mediaHeader.environmentLights; }

#ifndef MARCH_TILE_LIGHTS
/// Lights of the scene itself that can reach the ray: here all of them. A shader with a list of its own defines
/// MARCH_TILE_LIGHTS and both functions.
uint marchLightSlots(uint lightCount) { return sceneLights(lightCount); }
uint marchLight(uint slot) { return sceneLight(slot); }
#else
uint marchLightSlots(uint lightCount);
uint marchLight(uint slot);
#endif

/// `turn` chooses among the environment's lights: each segment takes every environmentStride-th of them for all, and the
/// next segment others. They are about equally strong, and a ray has many segments.
vec3 segmentInScatter(Ray ray, Segment s, uint lightCount, vec3 noise, uint turn) {
    vec3 sum = vec3(0.0);
    if (mediaHeader.nearGlow > 0.0) sum += segmentNearGlow(ray, s, noise);
    uint slots = marchLightSlots(lightCount);
    uint stride = max(mediaHeader.environmentStride, 1u);
    uint skipped = turn % stride;
    uint chosen = (max(min(mediaHeader.environmentLights, lightCount), skipped) - skipped + stride - 1u) / stride;
    for (uint slot = 0u; slot < slots + chosen; ++slot) {
        bool fromEnvironment = slot >= slots;
        uint light = fromEnvironment ? mediaHeader.environmentFirst + skipped + (slot - slots) * stride : marchLight(slot);
        vec3 arriving = segmentLight(light, ray, s, noise);
        sum += fromEnvironment ? arriving * float(stride) : arriving;
    }
    return sum;
}

#endif
// ---- the march --------------------------------------------------------------------------------------------------

// Of a ray's segments those that add light in this turn (MarchParams.firstSegment, endSegment). A turn that is not the last ends behind its own.
uint marchFirstSegment = 0u;
uint marchEndSegment = kMarchAllSegments;

/// From ray.origin over `distance` metres (1e30: endless). `flags`: kMarchInScatter, kMarchEmission. `pixel` seeds the noise.
MarchResult marchMedia(Ray ray, float distance, uint flags, uint lightCount, uvec2 pixel) {
    MarchResult result = MarchResult(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
    March march;
    if (!beginMarch(ray, distance, march)) {
        // Nothing to gather light from; what is out there may still absorb.
        result.opticalDepth = opticalDepthAlong(ray.origin, ray.direction, distance);
        return result;
    }
    vec3 noise = vec3(pixelNoise(pixel, 0u), pixelNoise2(pixel, 1u));
    uint turn = uint(pixelNoise(pixel, 3u) * float(mediaHeader.environmentStride));
    Segment s;
    for (uint number = 0u; number < marchEndSegment && nextSegment(ray, march, s); ++number) {
        vec3 transmittance = exp(-march.before);
        bool ours = number >= marchFirstSegment;
#if MARCH_GATHERS
        if (ours && (flags & kMarchInScatter) != 0u && s.scatters) {
            vec3 light = transmittance * segmentInScatter(ray, s, lightCount, noise, turn);
            result.inScatter += light;
            if (s.inGrid) result.fromGrids += light;
        }
#endif
        if (ours && (flags & kMarchEmission) != 0u)
            result.emission += transmittance * (s.emission * oneMinusExpOverX(s.depth) + (s.glows ? blackbodyLight(ray, s, noise.x) : vec3(0.0)));
        // Golden ratio and its generalisation to two dimensions: neighbouring segments differ as much as they can.
        noise = fract(noise + vec3(0.61803399, 0.75487767, 0.56984029));
        ++turn;
    }
    result.opticalDepth = march.before;
    if (marchEndSegment == kMarchAllSegments && march.next < distance)
        result.opticalDepth = min(result.opticalDepth + opticalDepthBetween(ray.origin, ray.direction, march.next, distance), vec3(kOpaque));
    return result;
}

#endif
