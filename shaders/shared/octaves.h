// Parameters of the octaves technique.
#ifndef TYNDALL_SHARED_OCTAVES_H
#define TYNDALL_SHARED_OCTAVES_H
#include "shared/types.h"
TYNDALL_SHARED_BEGIN

// Uniform block `Technique`.
struct OctavesParams {
    uint last;               // octaves 1 to `last`; octave 0 is single scattering, which the engine's own march computes
    float scatteringFactor;
    float extinctionFactor;
    float phaseFactor;
};

TYNDALL_SHARED_END
#endif
