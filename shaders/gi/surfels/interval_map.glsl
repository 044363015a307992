// The transmittance interval map: each eye ray's way through the media, cut into intervals that take equal parts of the light. An interval has a point that stands
// for it and the light that it would send to the eye were the light from all around 1/p: ∫ T σs dt of each phase function. The sums of these are exact; 16 bits
// say how an interval shares in them, and where its point is.
#ifndef TYNDALL_GI_SURFELS_INTERVAL_MAP
#define TYNDALL_GI_SURFELS_INTERVAL_MAP
#include "shared/surfels.h"

layout(std140) uniform IntervalMap { SurfelMapParams map; };

// Distances are 16-bit codes c: start + nearest · ((1 + length/nearest)^(c/65535) − 1), nearest = length/10⁴: a ten-thousandth of the way is resolved to 10⁻⁸ of it,
// and farther away a step is 1.4·10⁻⁴ of the distance.
const float kCodeRatio = 1e4;
const float kCodeBits = 13.28785616; // log2(1 + kCodeRatio)
const float kCodes = 65535.0;

#ifndef INTERVAL_PLACES
#define INTERVAL_PLACES readonly
#endif

// PAPER: codes are steps of a march, whose length is in the place of the way's; a ray also has its largest coefficient.
#ifndef PAPER
#define PAPER 0
#endif

struct RayWay {
    float start;   // metres
    float length;  // metres; 0: no medium that scatters
    float opacity; // mean of the channels, of all of the way; PAPER: transmittance
    float largest; // PAPER: scattering coefficient, per metre
};

RayWay rayWay(vec4 texel) { return RayWay(texel.x, texel.y, texel.z, texel.w); }

float distanceOfCode(RayWay way, float code) {
    if (PAPER != 0) return way.start + way.length * code;
    return way.start + way.length * ((exp2(code * (kCodeBits / kCodes)) - 1.0) / kCodeRatio);
}

/// Continuous; 0 before the start and 65536 behind the end.
float codeOfDistance(RayWay way, float distance) {
    float along = (distance - way.start) / way.length;
    if (PAPER != 0) return along;
    if (!(along > 0.0)) return 0.0;
    return along > 1.0 ? kCodes + 1.0 : log2(1.0 + kCodeRatio * along) * (kCodes / kCodeBits);
}

/// Codes of a ray's points, two in a word.
layout(std430) INTERVAL_PLACES buffer IntervalPlaces { uint intervalPlaces[]; };

uint placesOf(ivec2 ray) { return uint(ray.y * map.size.x + ray.x) * (map.intervals / 2u); }

uint placeCode(uint places, uint interval) {
    return intervalPlaces[places + interval / 2u] >> (16u * (interval & 1u)) & 0xffffu;
}

int intervalLayer(uint interval, uint group) { return int(interval * map.groups + group); }

#endif
