// What the media do to the light on its way from the surfaces to the eye: how much gets through, what they scatter towards the
// eye, and what they emit. At full resolution, or one ray for 2×2 or 4×4 pixels, to be upsampled by upsample.comp.
//
// With many lights, each group of 8×8 rays first makes a list of those that reach any of its rays: the same for all, and in
// order, so that the sums are the same as without lists.
//
// IN_SCATTER: 0: no light is gathered; 1: of few lights; 2: of many, from lists.
#define MARCH_PHASE_GROUPS PHASE_GROUPS
#define MARCH_GATHERS (IN_SCATTER != 0)
#if IN_SCATTER == 2
#define MARCH_TILE_LIGHTS
#endif
#include "media/march.glsl"
#include "media/nearest_rays.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std140) uniform Params { MarchParams params; };
uniform sampler2D depth;
layout(rgba32f) uniform writeonly image2D transmittance;
#if IN_SCATTER
layout(rgba32f) uniform image2D inScatter; // from turn to turn light comes to it
#endif
#if EMISSION
layout(rgba32f) uniform image2D emission;
#endif

// Known when compiling: what is not wanted costs nothing.
const uint kWanted = (IN_SCATTER > 0 ? kMarchInScatter : 0u) | (EMISSION == 1 ? kMarchEmission : 0u);

ivec2 fullPixel(ivec2 pixel) { return marchedPixel(pixel, params, textureSize(depth, 0)); }

#if IN_SCATTER == 2
const uint kListedLights = 1024u; // lights after these are in no list: they always count
shared uint tileMask[kListedLights / 32u];
shared uint tileList[kListedLights];
shared uint tileCount;
shared uint tileDistance; // bits of the farthest end of a ray: positive floats are in the order of their bits

/// Can the light reach a ray of the group? Its rays lie in a cone around `axis` whose apex is `spread` wide.
bool reachesTile(uint light, Ray axis, float spread, float halfAngle, float farthest) {
    float range = lights[light].position.w;
    if (lights[light].type == kLightDirectional || range <= 0.0) return true;
    float extent = lights[light].type == kLightRect ? length(lights[light].axisX.xyz) + length(lights[light].axisY.xyz) : lights[light].direction.w;
    float radius = (range + extent + spread) * 1.001;
    vec3 toLight = lights[light].position.xyz - axis.origin;
    float distance = length(toLight);
    if (distance <= radius) return true;
    if (distance - radius > farthest) return false;
    return acos(clamp(dot(toLight, axis.direction) / distance, -1.0, 1.0)) <= halfAngle + asin(radius / distance) + 1e-3;
}

void makeTileList(float distance) {
    uint self = gl_LocalInvocationIndex;
    if (self < kListedLights / 32u) tileMask[self] = 0u;
    if (self == 0u) tileDistance = 0u;
    barrier();
    atomicMax(tileDistance, floatBitsToUint(distance));
    barrier();
    ivec2 corner = ivec2(gl_WorkGroupID.xy) * 8;
    Ray axis = cameraRay(vec2(fullPixel(corner) + fullPixel(corner + 7)) * 0.5 + 0.5);
    float spread = 0.0;
    float halfAngle = 0.0;
    for (int i = 0; i < 4; ++i) {
        Ray edge = cameraRay(vec2(fullPixel(corner + 7 * ivec2(i & 1, i >> 1))) + 0.5);
        spread = max(spread, length(edge.origin - axis.origin));
        halfAngle = max(halfAngle, acos(clamp(dot(edge.direction, axis.direction), -1.0, 1.0)));
    }
    uint listed = min(sceneLights(params.lightCount), kListedLights);
    for (uint light = self; light < listed; light += 64u)
        if (reachesTile(sceneLight(light), axis, spread, halfAngle, uintBitsToFloat(tileDistance))) atomicOr(tileMask[light >> 5u], 1u << (light & 31u));
    barrier();
    if (self == 0u) {
        tileCount = 0u;
        for (uint light = 0u; light < listed; ++light)
            if ((tileMask[light >> 5u] & (1u << (light & 31u))) != 0u) tileList[tileCount++] = light;
    }
    barrier();
}

uint marchLightSlots(uint lightCount) { return tileCount + max(sceneLights(lightCount), kListedLights) - kListedLights; }
uint marchLight(uint slot) { return sceneLight(slot < tileCount ? tileList[slot] : kListedLights + slot - tileCount); }
#endif

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 full = fullPixel(pixel);
    vec2 centre = vec2(full) + 0.5;
    float distance = rayDistanceFromDepth(centre, texelFetch(depth, full, 0).r);
#if IN_SCATTER == 2
    makeTileList(distance);
#endif
    if (any(greaterThanEqual(pixel, imageSize(transmittance)))) return;
    marchFirstSegment = params.firstSegment;
    marchEndSegment = params.endSegment;
    bool begun = params.firstSegment > 0u;
    MarchResult march = marchMedia(cameraRay(centre), distance, kWanted, params.lightCount, uvec2(pixel));
    imageStore(transmittance, pixel, vec4(exp(-march.opticalDepth), 1.0));
#if IN_SCATTER
    vec4 before = begun ? imageLoad(inScatter, pixel) : vec4(0.0);
    vec3 light = before.rgb + march.inScatter;
    // smooth.comp leaves light from grids alone: their share of it.
    float fromGrids = before.w * meanOf(before.rgb) + meanOf(march.fromGrids);
    imageStore(inScatter, pixel, vec4(light, fromGrids / max(meanOf(light), 1e-30)));
#endif
#if EMISSION
    imageStore(emission, pixel, vec4(march.emission + (begun ? imageLoad(emission, pixel).rgb : vec3(0.0)), 1.0));
#endif
}
