// Drawn things as shaders see them: storage buffer `Objects`, one struct for each mesh of each node and instance. A draw covers
// consecutive objects: `objects[firstObject + gl_InstanceID]`.
#ifndef TYNDALL_SHARED_OBJECT_H
#define TYNDALL_SHARED_OBJECT_H
#include "shared/types.h"
TYNDALL_SHARED_BEGIN

TYNDALL_CONST uint kObjectMirrored = 1u;    // the transform turns right hands into left ones
TYNDALL_CONST uint kObjectHasNormals = 2u;  // else drawn unlit
TYNDALL_CONST uint kObjectHasTangents = 4u;
TYNDALL_CONST uint kObjectHasColors = 8u;

struct ObjectData {
    mat4 renderFromLocal;
    vec4 normalX;           // columns of the matrix for normals (inverse transpose); w unused
    vec4 normalY;
    vec4 normalZ;
    uint material;          // of `Materials`
    uint flags;             // kObject…
    uint padding0;
    uint padding1;
};

TYNDALL_SHARED_END
#endif
