// Media as shaders see them: storage buffer `Media` (a header, then one struct a medium). Grids lie in bricks of 9³
// samples in one 3D texture (see engine/media/brick_grid.h); `Bricks` holds the brick tables of all grids one after another.
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

TYNDALL_CONST uint kMostBrickSteps = 64u; // that optical depth takes through a brick

TYNDALL_CONST uint kMaxPhaseGroups = 8u; // different phase functions that a ray's media may have

// The define MEDIA_KINDS: what a frame's media are made of.
TYNDALL_CONST uint kMediaShapes = 1u; // some without a grid
TYNDALL_CONST uint kMediaGrids = 2u;  // some with one
TYNDALL_CONST uint kMediaExactGrids = 4u; // grids are integrated cell by cell (kMediaExact is set)
TYNDALL_CONST uint kMediaSingle = 8u;     // there is one medium
TYNDALL_CONST uint kMediaLightVolumes = 16u; // every light that shines through grids has a volume of their optical depth

// MediaHeader.flags
TYNDALL_CONST uint kMediaExact = 1u;            // integrate grids cell by cell instead of by steps
TYNDALL_CONST uint kMediaLightDepthVolume = 2u; // grids' optical depth towards lights comes from the light-space volume

struct MediaHeader {
    vec4 phases[8];          // of each phase group; x: the kind as a number, y: g
    uint mediumCount;
    uint gridCount;          // the grids are the last ones
    uint phaseGroupCount;
    uint flags;
    float stepVoxels;        // length of a step through a grid, in voxels
    uint analyticSteps;      // steps through a medium without a grid
    float minTransmittance;  // where a march ends
    uint environmentFirst;   // number of the first of the lights that stand for the environment; they are neighbours
    uint environmentLights;  // how many they are
    uint environmentStride;  // a segment of a march gathers from every so many-th of them, perhaps of none; 0 as 1
    float nearGlow;          // metres: closer than this, glowing media light by shaders/media/near_glow.glsl; 0: they do not
    uint padding0;
};
#ifdef __cplusplus
static_assert(sizeof(MediaHeader) % 16 == 0, "the media follow it in one buffer");
#endif

struct MediumData {
    mat4 localFromRender;       // box: the unit cube [-½,½]³; sphere: the unit ball; height: y in world metres above the origin;
                                // grid: cells from the corner of its first brick (voxel index - lowest index)
    mat4 temperatureFromRender; // grid with temperature: the same for its temperature grid
    vec4 scattering;            // per metre; w: g
    vec4 extinction;            // per metre; w: scale height in metres
    vec4 emission;              // nits per metre; w: scale of the blackbody emission, 0: none
    ivec4 gridBricks;           // bricks along each axis; w: first brick in `Bricks`
    ivec4 temperatureBricks;    // the same for the temperature grid
    uint kind;
    uint phase;
    uint phaseGroup;
    float voxelSize;            // smallest edge of a voxel, metres; 0 for the others
    uint set;                   // its kind as techniques tell media apart: a bit of MediaSet (transport/media_kinds.h)
    uint padding0;
    uint padding1;
    uint padding2;
};

struct BrickData {
    float minimum;
    float maximum;
    uint slot;                  // place in the atlas, in bricks: x | y << 10 | z << 20; kNoSlot: constant
    uint padding0;
};

TYNDALL_SHARED_END
#endif
