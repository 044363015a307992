// Surfels: points that stand for parts of the scene's surfaces, and the light that they send to intervals of eye rays.
#ifndef TYNDALL_SHARED_SURFELS_H
#define TYNDALL_SHARED_SURFELS_H
#include "shared/types.h"
TYNDALL_SHARED_BEGIN

TYNDALL_CONST uint kSurfelMostLevel = 8u;     // of tessellation of a patch: software drivers take long for higher ones
TYNDALL_CONST uint kSurfelMostLevels = 6u;    // of the framebuffer
TYNDALL_CONST uint kSurfelMostIntervals = 32u;
TYNDALL_CONST uint kSurfelTile = 64u;         // pixels along an edge of the tile that assigns pixels to sub-buffers

/// A part of a triangle that is tessellated at once: buffer `SurfelPatches`.
struct SurfelPatch {
    vec4 corners;     // barycentric coordinates of the first two corners in the triangle: of its second and third corner
    vec2 lastCorner;  // of the third corner
    uint triangle;    // of the object
    uint level;       // of tessellation, on all edges and inside
    float area;       // m², that its surfels share
    uint firstSurfel;
    uint padding0;
    uint padding1;
};

/// Buffer `Surfels`, in the order of patches.
struct Surfel {
    vec4 position; // render space; w: m²
    vec4 normal;   // unit, on either side: both sides reflect; w: padding
    vec4 base;     // base colour; w: metallic
    vec4 surface;  // x: weight of the dielectric's coat (specular), y: 1 where the surface reflects, z: roughness; w: padding
};

/// Buffer `LitSurfels`.
struct LitSurfel {
    vec4 position; // render space; w: m²
    vec4 normal;   // unit; w: the largest channel of both sides' radiance
    vec4 front;    // nits that leave the side of the normal; w: padding
    vec4 back;     // nits that leave the other side
};

/// Uniform block `Set`: the triangles of one object.
struct SurfelSet {
    uvec4 uvFloats;   // from a vertex's beginning to its UV sets, floats; 0: it has none
    uint strideFloats;
    uint colorFloats; // to its colour; 0: it has none
    uint object;
    uint firstPatch;
    uint patchCount;
    uint padding0;
    uint padding1;
    uint padding2;
};

/// Uniform block `Lighting`.
struct SurfelLightParams {
    uint surfelCount;
    uint lightCount;
    uint padding0;
    uint padding1;
};

/// Buffer `SurfelBrightness`: of all lit surfels.
struct SurfelBrightness {
    float weighted; // sum of area times the square of radiance
    float total;    // sum of area times radiance
    float padding0;
    float padding1;
};

/// Uniform block `IntervalMap`.
struct SurfelMapParams {
    uint intervals;
    uint groups;   // phase functions
    uint jitter;   // 1: thresholds differ from ray to ray
    uint mode;     // kSurfelEncodingCorrected, kSurfelEncodingPaper
    ivec2 size;    // rays
    float step;    // metres, kSurfelEncodingPaper
    float densest; // per metre, kSurfelEncodingPaper: largest scattering coefficient
};

TYNDALL_CONST uint kSurfelEncodingCorrected = 0u;
TYNDALL_CONST uint kSurfelEncodingPaper = 1u;

/// Uniform block `Splat`.
struct SurfelSplatParams {
    vec4 mediaMinimum;  // of the box around the media, render space
    vec4 mediaMaximum;
    vec4 anchor;        // a point that moves with the scene, render space
    vec4 focal;         // x, y: clip coordinates per slope, of the view; perspective
    ivec2 size;         // rays
    ivec2 textureSize;  // texels of a level
    uint level;
    uint levels;
    uint surfelCount;
    float threshold;    // ε
    uint mode;          // kSurfelEncodingPaper: radius and range as printed
    uint attenuation;   // 1: media take light away between surfels and intervals
    uint visibility;    // 1: surfaces block light between surfels and intervals
    float nearest;      // δ of the printed kernel, m²
    uint seed;          // of the frame's chances
    uint tail;          // 1: the last level reaches to infinity
    uint factor;        // pixels along an edge of the square that a ray stands for
    uint padding0;
};

/// Uniform block `Collect`.
struct SurfelCollectParams {
    ivec2 size;
    int level;
    int spacing; // pixels between the filter's taps; 0: no filter
    uint hasCoarser; // 1: there is a sum of coarser levels
    uint hasOwn;     // 1: the level's own light is added
    uint last;       // 1: the result is light, not light over scattering
    uint plain;      // 1: all rays count alike
};

TYNDALL_CONST uint kSurfelShowDisks = 1u;
TYNDALL_CONST uint kSurfelShowLevels = 2u;
TYNDALL_CONST uint kSurfelShowUnshuffled = 3u;
TYNDALL_CONST uint kSurfelShowIntervals = 4u;

/// Uniform block `Show`.
struct SurfelShowParams {
    uint what;
    float white;    // nits that the picture shows white
    float nearest;  // metres that are shown black,
    float farthest; // and white
};

TYNDALL_SHARED_END
#endif
