// Vertices of a mesh, and the object that is drawn. Attributes that a mesh lacks are left at GL's default: ask the object's flags.
#ifndef TYNDALL_GBUFFER_MESH_VERTEX
#define TYNDALL_GBUFFER_MESH_VERTEX
#include "shared/object.h"

layout(location = 0) in vec3 positionLocal;
layout(location = 1) in vec3 normalLocal;
layout(location = 2) in vec4 tangentLocal; // w: handedness
layout(location = 3) in vec2 uvSet0;
layout(location = 4) in vec2 uvSet1;
layout(location = 5) in vec2 uvSet2;
layout(location = 6) in vec2 uvSet3;
layout(location = 7) in vec4 vertexColor; // linear

layout(std430) readonly buffer Objects {
    ObjectData objects[];
};
uniform int firstObject;

uint drawnObject() {
    return uint(firstObject + gl_InstanceID);
}

#endif
