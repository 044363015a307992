// Parameters of the passes that march through the media from the camera.
#ifndef TYNDALL_SHARED_MARCH_H
#define TYNDALL_SHARED_MARCH_H
#include "shared/types.h"
TYNDALL_SHARED_BEGIN

TYNDALL_CONST uint kMarchInScatter = 1u; // light scattered once is wanted
TYNDALL_CONST uint kMarchEmission = 2u;  // emission of the media is wanted
TYNDALL_CONST uint kMarchRefine = 4u;    // upsampling marches again where no coarse sample fits
TYNDALL_CONST uint kMarchFill = 8u;      // this pass does that, for pixels that upsampling left open
TYNDALL_CONST uint kMarchSmooth = 16u;   // single frames average the light of neighbouring rays

TYNDALL_CONST uint kMarchAllSegments = 0xffffffffu;

struct MarchParams {
    uint lightCount;
    uint flags;
    uint factor;            // full pixels per marched pixel along an axis: 1, 2, 4
    float depthTolerance;   // upsampling: relative difference of distance that halves a weight
    float transmittanceTolerance; // upsampling: difference of transmittance that halves a weight
    float refineWeight;     // upsampling: below this best weight a pixel is marched again
    uint media;             // a bit for each kind (MediumData.set) of which the scattering counts: for techniques
    uint firstSegment;      // of a ray's segments, those at which this turn gathers: what earlier turns found is in the picture
    uint endSegment;        // kMarchAllSegments: this is the last turn
    uint padding0, padding1, padding2;
};

TYNDALL_SHARED_END
#endif
