// Media as shaders see them: storage buffer `Media`. Grids lie in bricks of 9³ samples in one 3D texture (see
// engine/media/brick_grid.h); `Bricks` holds the brick tables of all grids one after another.
#ifndef TYNDALL_SHARED_MEDIUM_H
#define TYNDALL_SHARED_MEDIUM_H
#include "shared/types.h"
TYNDALL_SHARED_BEGIN

TYNDALL_CONST uint kMediumEverywhere = 0u;
TYNDALL_CONST uint kMediumBox = 1u;
TYNDALL_CONST uint kMediumSphere = 2u;
TYNDALL_CONST uint kMediumHeight = 3u;
TYNDALL_CONST uint kMediumGrid = 4u;

TYNDALL_CONST uint kPhaseHenyeyGreenstein = 0u;
TYNDALL_CONST uint kPhaseRayleigh = 1u;
TYNDALL_CONST uint kPhaseCornetteShanks = 2u;

TYNDALL_CONST uint kNoSlot = 0xffffffffu;

struct MediumData {
    mat4 localFromRender;       // box: the unit cube [-½,½]³; sphere: the unit ball; height: y in world metres above the origin; grid: voxel index
    mat4 temperatureFromRender; // grid with temperature: its voxel index
    vec4 scattering;            // per metre; w: g
    vec4 extinction;            // per metre; w: scale height in metres
    vec4 emission;              // nits per metre; w: scale of the blackbody emission, 0: none
    ivec4 gridOrigin;           // index of the lowest voxel; w: first brick in `Bricks`
    ivec4 gridBricks;           // bricks along each axis; w unused
    ivec4 temperatureOrigin;
    ivec4 temperatureBricks;
    uint kind;
    uint phase;
    float densityMaximum;       // of the grid; 1 for the others
    float voxelSize;            // smallest edge of a voxel, metres; 0 for the others
};

struct BrickData {
    float minimum;
    float maximum;
    uint slot;                  // kNoSlot: constant
    uint padding0;
};

TYNDALL_SHARED_END
#endif
