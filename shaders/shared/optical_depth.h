// Light-space optical depth of the grid media: storage buffer `OpticalDepthViews`, one entry a light, in the order of `Lights`.
#ifndef TYNDALL_SHARED_OPTICAL_DEPTH_H
#define TYNDALL_SHARED_OPTICAL_DEPTH_H
#include "shared/types.h"
TYNDALL_SHARED_BEGIN

TYNDALL_CONST uint kDepthViewNone = 0u;       // no grid can lie between this light and what it lights
TYNDALL_CONST uint kDepthViewParallel = 1u;   // a box along the light's direction
TYNDALL_CONST uint kDepthViewCone = 2u;       // a square cone from the light around the grids
TYNDALL_CONST uint kDepthViewOctahedral = 3u; // all directions from the light
TYNDALL_CONST uint kDepthViewMarch = 4u;      // no volume: march through the grids

struct OpticalDepthView {
    mat4 volumeFromRender; // parallel: to [0,1]³, z away from the light; cone: directions to (x,y)/z in [-1,1]
    mat4 renderFromVolume;
    vec4 origin;           // the light (cone, octahedral); w: 1 / (farthest - nearest)
    vec4 radial;           // nearest and farthest distance that the slices cover, metres; z, w unused
    ivec4 block;           // first texel of its cube in the volume texture; w: texels along the cube's edges
    uint kind;
    uint padding0;
    uint padding1;
    uint padding2;
};

struct OpticalDepthParams {
    uint light;
    uint padding0;
    uint padding1;
    uint padding2;
};

TYNDALL_SHARED_END
#endif
