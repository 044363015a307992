// The transmittance interval map as printed (section 4.1): marched twice by steps of equal length; distances are counted in steps, 8 bits from point to point, coefficients
// have 8 bits over the ray's largest, and that one 8 bits over the largest of all media. With the printed thresholds the last point is never reached.
#include "common/random.glsl"
#include "common/view.glsl"
#define INTERVAL_PLACES
#include "gi/surfels/interval_map.glsl"
#include "media/density.glsl"
#include "media/nearest_rays.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std140) uniform Params { MarchParams params; };
uniform sampler2D depth;
layout(rgba32f) writeonly uniform image2D ways;
layout(rgba32f) writeonly uniform image2DArray totals;
layout(rgba16) writeonly uniform image2DArray shares;

const uint kMostSteps = 512u; // n_max: two and a half times through the scene

struct Medium {
    vec3 scattering; // per metre
    float extinction;
};

Medium mediumAt(vec3 position) {
    Medium sum = Medium(vec3(0.0), 0.0);
    for (uint m = 0u; m < mediumCount(); ++m) {
        float density = mediumDensity(m, position);
        sum.scattering += density * media[m].scattering.rgb;
        sum.extinction += density * meanOf(media[m].extinction.rgb);
    }
    return sum;
}

void main() {
    ivec2 number = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(number, map.size))) return;
    ivec2 pixel = marchedPixel(number, params, textureSize(depth, 0));
    vec2 centre = vec2(pixel) + 0.5;
    Ray ray = cameraRay(centre);
    float distance = rayDistanceFromDepth(centre, texelFetch(depth, pixel, 0).r);
    float jitter = map.jitter != 0u ? unitFloat(pixelOffset(uvec2(number), 0u)) : 0.5;
    uint steps = uint(min(ceil(max(distance / map.step - jitter, 0.0)), float(kMostSteps)));

    float opticalDepth = 0.0;
    uint first = steps; // d1, in steps
    vec3 colour = vec3(0.0);
    for (uint k = 0u; k < steps; ++k) {
        Medium here = mediumAt(ray.origin + ray.direction * ((float(k) + jitter) * map.step));
        if (opticalDepth == 0.0 && here.extinction > 0.0) first = k;
        colour += exp(-opticalDepth) * here.scattering;
        opticalDepth += here.extinction * map.step;
    }
    float least = exp(-opticalDepth); // τ_min
    bool empty = 1.0 - least < 1e-4 || !(maximumOf(colour) > 0.0);
    imageStore(totals, ivec3(number, 0), vec4(colour / max(maximumOf(colour), 1e-30), 0.0));
    // Distance and coefficient of each point; the first is d1 itself.
    float largest = 0.0;
    uint at[kSurfelMostIntervals];
    float coefficient[kSurfelMostIntervals];
    uint i = 1u;
    at[0] = first;
    coefficient[0] = 0.0;
    opticalDepth = 0.0;
    for (uint k = first; k < steps && i < map.intervals && !empty; ++k) {
        Medium here = mediumAt(ray.origin + ray.direction * ((float(k) + jitter) * map.step));
        opticalDepth += here.extinction * map.step;
        float shift = map.jitter != 0u ? unitFloat(pixelOffset(uvec2(number), 1u)) : 0.0;
        // In the paper points count from 1: this one is number i + 1.
        while (i < map.intervals && exp(-opticalDepth) < 1.0 - (float(i + 1u) - shift) * (1.0 - least) / float(map.intervals - 1u)) {
            at[i] = min(k + 1u, at[i - 1u] + 255u);
            coefficient[i] = maximumOf(here.scattering);
            largest = max(largest, coefficient[i]);
            ++i;
        }
    }
    for (; i < map.intervals; ++i) {
        at[i] = at[i - 1u];
        coefficient[i] = 0.0;
    }
    float ofAll = ceil(largest / map.densest * 255.0) / 255.0 * map.densest;
    for (i = 0u; i < map.intervals; ++i) {
        float length = i > 0u ? float(at[i] - at[i - 1u]) : 0.0;
        float code = round(coefficient[i] / max(ofAll, 1e-30) * 255.0);
        imageStore(shares, ivec3(number, int(i)), vec4(length, code, 0.0, 0.0) / kCodes);
        if ((i & 1u) != 0u) intervalPlaces[placesOf(number) + i / 2u] = at[i - 1u] | at[i] << 16u;
    }
    imageStore(ways, number, vec4((jitter - 1.0) * map.step, empty ? 0.0 : map.step, least, ofAll));
}
