// Light of virtual point lights on a surface.
// MEDIA: 0: there are none; 1: they attenuate it. COMPENSATION: 2: clamped light of media near by is compensated for by a traced step.
#if MEDIA
#include "gi/vpl/compensation.glsl"
#else
#include "common/random.glsl"
#include "gi/vpl/visibility.glsl"
#endif
#include "gi/shared/surface_light.glsl"

void addLight(inout SurfaceLight sum, Receiver r, vec3 direction, vec3 irradiance) {
    float viewDotHalf;
    vec3 reflected = irradiance * microfacetReflection(r.brdf, r.normal, r.toEye, direction, viewDotHalf);
    float grazing = schlickWeight(viewDotHalf);
    sum.diffuse += irradiance * ((1.0 - dielectricFresnel(r.brdf, viewDotHalf)) / kBrdfPi);
    sum.specular += reflected * (1.0 - grazing);
    sum.grazing += reflected * grazing;
}

void addLightFrom(inout SurfaceLight sum, uint light, Receiver r) {
    vec3 way = vplLights[light].position.xyz - r.position;
    float squared = dot(way, way);
    float distance = sqrt(squared);
    vec3 direction = way / max(distance, 1e-30);
    float facing = dot(r.facet, direction);
    float cosine = dot(r.normal, direction);
    if (!(facing > 0.0) || !(cosine > 0.0)) return;
    vec3 intensity = vplIntensity(light, -direction);
    if (!(maximumOf(intensity) > 0.0) || !vplSees(light, r.position, -direction, distance)) return;
    bool onSurface = vplLights[light].position.w < 0.0;
    float cosines = facing * (onSurface ? dot(vplLights[light].normal.xyz, -direction) : 1.0);
    float clampSquared = vplClampScale(r.position) * (onSurface ? vpl.surfaceClampSquared : vpl.clampSquared);
    vec3 irradiance = intensity * (cosine * vplInverseSquare(squared, cosines, clampSquared));
#if MEDIA
    irradiance *= exp(-vplOpticalDepth(light, r.position, direction, distance));
#endif
    addLight(sum, r, direction, irradiance);
}

/// Of the walks from `number` on, every `stride`-th.
SurfaceLight gatherSurface(Receiver r, uint number, uint stride, uvec2 pixel) {
    SurfaceLight sum = kDark;
    for (uint walk = number; walk < vpl.walkCount; walk += stride)
        for (uint light = vplWalks[walk]; light < vplWalks[walk + 1u]; ++light)
            if (vplCounts(light, vpl.surfaceTerms)) addLightFrom(sum, light, r);
    sum.diffuse *= float(stride);
    sum.specular *= float(stride);
    sum.grazing *= float(stride);
#if MEDIA && COMPENSATION == 2
    // In proportion to irradiance; the clamping distance shrinks with the root of the cosine.
    vec4 u = pixelRandom(pixel, 13u);
    float z = sqrt(1.0 - u.x);
    float angle = 2.0 * kPi * u.y;
    vec3 direction = frameAround(r.facet) * vec3(sqrt(u.x) * cos(angle), sqrt(u.x) * sin(angle), z);
    float cosine = dot(r.normal, direction);
    if (cosine > 0.0) {
        vec4 noise = pixelRandom(pixel, 14u);
        float widest = sqrt(vplClampScale(r.position) * vpl.clampSquared);
        float reach = widest * sqrt(z);
        float t;
        Segment there;
        vec3 near = vec3(0.0);
        if (drawNearPoint(r.position, direction, reach, noise.w, t, there)) {
            uint number = uint(u.z * float(vpl.subsets));
            near = walksInMedium(number, r.position + direction * t, direction, there, relaxedClampSquared(widest), vplTermsOneStepOn(vpl.surfaceTerms)); // not `reach`, which is 0 for grazing directions
            if ((vpl.surfaceTerms & (1u << kVplOfMedia)) != 0u) near += segmentInScatter(Ray(r.position, direction), there, vpl.lightsOfScene, noise.xyz, number);
            near *= nearPointWeight(r.position, direction, reach, t);
        }
        addLight(sum, r, direction, near * (kPi * cosine / max(z, 1e-3)));
    }
#endif
    return sum;
}
