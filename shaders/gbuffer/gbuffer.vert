// Surfaces for the G-buffer: vertices in render space.
#include "common/view.glsl"
#include "gbuffer/mesh_vertex.glsl"
#include "gbuffer/vertex_frame.glsl"

out vec3 fromEye;      // render space, from the camera's position: small numbers near the camera, so that derivatives are good
out vec3 normalRender;
out vec4 tangentRender;
out vec4 uvSets01;
out vec4 uvSets23;
out vec4 color;
flat out uint objectIndex;

void main() {
    objectIndex = drawnObject();
    ObjectData object = objects[objectIndex];
    vec4 position = object.renderFromLocal * vec4(positionLocal, 1.0);
    fromEye = position.xyz - view.cameraPosition.xyz;
    normalRender = (object.flags & kObjectHasNormals) != 0u ? renderNormal(object, normalLocal) : vec3(0.0);
    tangentRender = (object.flags & kObjectHasTangents) != 0u ? renderTangent(object, tangentLocal) : vec4(0.0);
    uvSets01 = vec4(uvSet0, uvSet1);
    uvSets23 = vec4(uvSet2, uvSet3);
    color = (object.flags & kObjectHasColors) != 0u ? vertexColor : vec4(1.0);
    gl_Position = view.clipFromRender * position;
    gl_PointSize = 1.0;
}
