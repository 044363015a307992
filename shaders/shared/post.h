// Parameters of the passes that turn light into a picture.
#ifndef TYNDALL_SHARED_POST_H
#define TYNDALL_SHARED_POST_H
#include "shared/types.h"
TYNDALL_SHARED_BEGIN

TYNDALL_CONST uint kToneLinear = 0u;
TYNDALL_CONST uint kToneAces = 1u;
TYNDALL_CONST uint kToneAgx = 2u;
TYNDALL_CONST uint kToneNeutral = 3u;

struct TonemapParams {
    float exposure;   // display white per nit: 1 / (1.2 · 2^EV100)
    uint curve;       // kTone…
    uint dither;      // 1: triangular noise of ±1 step of 8 bits before rounding
    uint seed;
};

struct AccumulateParams {
    float weight;     // of the new frame: 1/n
    uint frame;       // n, counted from 1
    uint padding0;
    uint padding1;
};

struct SumParams {
    uint base;        // number of the first term image of this pass
    uint before;      // 1: image0 is the sum of those before
    uint frame;       // counted from 1
    uint padding0;
};

TYNDALL_CONST uint kInspect2D = 0u;
TYNDALL_CONST uint kInspectArray = 1u;
TYNDALL_CONST uint kInspect3D = 2u;

struct InspectParams {
    float minimum;    // shown black
    float maximum;    // shown white
    uint channel;     // 0: RGB, 1: R, 2: G, 3: B, 4: A
    int slice;        // of an array or 3D texture
    int mip;
    uint padding0;
    uint padding1;
    uint padding2;
};

TYNDALL_SHARED_END
#endif
