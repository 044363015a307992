// Blended surfaces, sorted: vertices are fetched by number, so that primitives of different meshes can follow each other.
#include "common/view.glsl"
#include "gbuffer/vertex_frame.glsl"
#include "shared/blend.h"
#include "shared/object.h"

layout(std430) readonly buffer BlendVertices {
    BlendVertex blendVertices[];
};
layout(std430) readonly buffer BlendOrder {
    uvec2 blendOrder[];
};
layout(std430) readonly buffer Objects {
    ObjectData objects[];
};

out vec3 fromEye;
out vec3 normalRender;
out vec4 tangentRender;
out vec4 uvSets01;
out vec4 uvSets23;
out vec4 color;
flat out uint objectIndex;

void main() {
    uvec2 entry = blendOrder[gl_VertexID];
    BlendVertex vertex = blendVertices[entry.x];
    objectIndex = entry.y;
    ObjectData object = objects[objectIndex];
    vec4 position = object.renderFromLocal * vec4(vertex.position.xyz, 1.0);
    fromEye = position.xyz - view.cameraPosition.xyz;
    normalRender = (object.flags & kObjectHasNormals) != 0u ? renderNormal(object, vertex.normal.xyz) : vec3(0.0);
    tangentRender = (object.flags & kObjectHasTangents) != 0u ? renderTangent(object, vertex.tangent) : vec4(0.0);
    uvSets01 = vertex.uvSets01;
    uvSets23 = vertex.uvSets23;
    color = vertex.color;
    gl_Position = view.clipFromRender * position;
    gl_PointSize = 1.0;
}
