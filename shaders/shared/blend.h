// Blended surfaces: vertices of all blended meshes one after another (storage buffer `BlendVertices`), and what to draw in
// order, from far to near (`BlendOrder`: for every vertex of every primitive its place in BlendVertices and its object).
#ifndef TYNDALL_SHARED_BLEND_H
#define TYNDALL_SHARED_BLEND_H
#include "shared/types.h"
TYNDALL_SHARED_BEGIN

struct BlendVertex {
    vec4 position; // local; w unused
    vec4 normal;   // local; w unused
    vec4 tangent;  // local; w: handedness
    vec4 uvSets01;
    vec4 uvSets23;
    vec4 color;    // linear
};

// Uniform block `Blend`.
struct BlendParams {
    uint marchFlags; // kMarchInScatter, kMarchEmission
    uint lightCount;
    uint direct;     // 1: LSE is rendered
    uint inMedia;    // attenuation of an image of indirect light: 1 where the light comes from media, 0 from surfaces
};

TYNDALL_SHARED_END
#endif
