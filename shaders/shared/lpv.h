// The light propagation lattice for shaders. Cells go along x fastest, then y, then z. An array holds one value of all cells,
// then the next value of all cells: plane after plane, `array[plane * cellCount + cell]`.
#ifndef TYNDALL_SHARED_LPV_H
#define TYNDALL_SHARED_LPV_H
#include "shared/types.h"
TYNDALL_SHARED_BEGIN

TYNDALL_CONST uint kLpvDirections = 26u; // x fastest, from -1 to 1
TYNDALL_CONST uint kLpvClasses = 3u;     // of directions: across a face, an edge, a corner

// The part of the light from its neighbours that joins a cell's lobe of two bands; the rest goes straight
// on. With 1 a cell forgets from how many sides light came; with 0 light stays on 26 rays (docs/measured/lpv-laws.md).
TYNDALL_CONST float kLpvMixed = 0.65;

// LpvFlux, floats: power that a cell sends in direction j in a step, of channel c: plane 3 j + c.
TYNDALL_CONST uint kLpvFluxPlanes = 78u;

// LpvLit: 1 for each block of cells that has sent light since steps began; the others, and what they would send, are dark.
TYNDALL_CONST uint kLpvBlockX = 8u; // cells; a workgroup of a step
TYNDALL_CONST uint kLpvBlockY = 4u;
TYNDALL_CONST uint kLpvBlockZ = 2u;

// LpvMedium
TYNDALL_CONST uint kLpvPassed = 0u; // 3, rgb of each class: e^(-σ l), the part that crosses the cell
TYNDALL_CONST uint kLpvDepth = 3u;  // rgb: transport extinction times the cell's edge
TYNDALL_CONST uint kLpvAlbedo = 4u; // rgb: transport scattering over transport extinction
TYNDALL_CONST uint kLpvTrueDepth = 5u;  // rgb: extinction times the cell's edge; w: mean cosine of the phase functions
TYNDALL_CONST uint kLpvTrueAlbedo = 6u; // rgb: scattering over extinction
TYNDALL_CONST uint kLpvMediumVectors = 7u;

// LpvSources, a step
TYNDALL_CONST uint kLpvEntering = 0u; // 3, of red, green, blue; xyz: first moment, w: power of light that enters the cell
TYNDALL_CONST uint kLpvEmission = 3u; // rgb: power sent out from within the cell to all sides
TYNDALL_CONST uint kLpvSourceVectors = 4u;

// LpvDeposits, integers: the same in fixed point, plane 4 c + 0…2: first moment, 4 c + 3: power of channel c; 12 + c: emission
TYNDALL_CONST uint kLpvDepositPlanes = 15u;

// LpvLinks
TYNDALL_CONST uint kLpvBlocked = 0u;     // bit j: a surface blocks the link to the neighbour in direction j
TYNDALL_CONST uint kLpvNearest = 1u;     // 6, of the first surface towards +x -x +y -y +z -z before the next cell: 4096 less its distance in
                                         // 4095ths of a cell << 20, and its normal, octahedral, 10 bits each; 0: none
TYNDALL_CONST uint kLpvSidePlanes = 7u;  // those before: they decide on which side a point lies
TYNDALL_CONST uint kLpvSurface = 7u;     // 26, of the first surface on the link in each direction: reflectance, 8 bits a channel, red the lowest, and above
                                         // them 255 less its distance in 255ths of the link, at least 1; 0: none
TYNDALL_CONST uint kLpvLinkPlanes = 33u;

// LpvSides, the parts of LpvLinks and LpvMedium that look-ups need: the links' first planes, and
TYNDALL_CONST uint kLpvCellMedium = 7u; // transport extinction times the cell's edge and albedo, means of the channels, as two halves
TYNDALL_CONST uint kLpvLookupPlanes = 8u;

struct LpvDirection {
    vec4 unit;    // w: weight in a mean over the sphere
    ivec4 offset; // w: class
};

/// One lattice.
struct LpvGrid {
    ivec4 size;  // cells along each axis; w: bit a: light that leaves along axis a enters again on the other side
    vec4 lowest; // corner of the lattice, render space; w: edge of a cell, metres
    ivec4 place; // among several: x: first layer of the light's textures, y: first element of the links, z: bit a: along axis a the next coarser
                 // lattice goes on, w: 1: a step takes all cells, dark or not
};

/// The lattices of look-ups, the finest first.
TYNDALL_CONST uint kLpvMostLevels = 4u;
struct LpvLevels {
    LpvGrid grids[4];
    ivec4 count; // x
};

struct LpvParams {
    LpvGrid grid;
    vec4 classWeights; // of all directions of a class together
    float onward; // 1; 0: light ends at the first medium or surface
    float padding0;
    float padding1;
    float padding2;
    LpvDirection directions[26];
};

/// Progress and energy balance of a lattice: LpvControl has one for each lattice. Powers are watts a step, of the three channels
/// together.
struct LpvControl {
    uint groups[3]; // of the next step; none where the light is settled
    float steps;    // since it began
    float residual; // of the last step: change of all powers over all powers
    float error;    // estimate of the remaining power, over all powers; -1: unknown
    float stored;   // power being propagated
    uint settled;
    // The last step's energy balance: power stored before and injected is absorbed, escapes, is blocked, or is stored after.
    float injected;
    float absorbed;  // by media
    float escaped;   // out of the lattice
    float blocked;   // by surfaces
    float change;    // of what is stored
    float imbalance; // of all that over what is stored
    uint padding0;
    uint padding1;
};

/// Of one look at a lattice's residual.
struct LpvMeasureParams {
    uint lattice;    // whose LpvControl it is
    uint groups;     // that have left partial sums
    float steps;     // since the last look
    float tolerance; // error below which light is settled
};

TYNDALL_CONST float kLpvOne = 3.5449077f; // <L|1> over the coefficient of the first harmonic: 2 sqrt(π)

/// The printed scheme's transfer functions (volumetric_gi/lpv/lattice_directions.h).
struct LpvTransfer {
    vec4 harmonics[26]; // Γ_j in 1, y, z, x
    vec4 share[7];      // γ_j, four to a vector
    float meanLength;   // of the links to the neighbours, in cells
    float padding0;
    float padding1;
    float padding2;
};

TYNDALL_CONST uint kLpvShowLight = 1u;
TYNDALL_CONST uint kLpvShowDirections = 2u;
TYNDALL_CONST uint kLpvShowMedium = 3u;
TYNDALL_CONST uint kLpvShowSurfaces = 4u;
TYNDALL_CONST uint kLpvShowResidual = 5u;
TYNDALL_CONST uint kLpvShowLosses = 6u;

/// A slice of a lattice in the picture.
struct LpvShowParams {
    uint what;
    int axis;
    int layer;
    float white; // nits that are shown white
};

/// Of one object's triangles.
struct LpvTriangles {
    uint strideFloats;
    uint count;
    uint object;
    uint padding0;
};

/// Of one reflective shadow map.
struct LpvInjectParams {
    vec4 scale;      // rgb: fixed-point units for a unit of power
    uint light;      // index into `Lights`
    float share;     // part of the light's power that this map's point represents
    float texelArea; // m², parallel views; 0: a perspective view, whose texels have solid angles
    uint padding0;
};

TYNDALL_SHARED_END
#endif
