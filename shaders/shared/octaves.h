// Parameters of the octaves technique.
#ifndef TYNDALL_SHARED_OCTAVES_H
#define TYNDALL_SHARED_OCTAVES_H
#include "shared/types.h"
TYNDALL_SHARED_BEGIN

struct OctavesParams {
    uint lightCount;
    uint last;               // octaves 1 to `last`; octave 0 is single scattering, which the engine's own march computes
    float scatteringFactor;
    float extinctionFactor;
    float phaseFactor;
    uint media; // as MarchParams.media
    uint padding0;
    uint padding1;
};

TYNDALL_SHARED_END
#endif
