// Casters of shadows. MASK: carries what the alpha test needs. BALL: and where the caster is.
#include "gbuffer/mesh_vertex.glsl"
#include "shared/shadow.h"

layout(std140) uniform Params { ShadowDrawParams params; };

#if MASK
out vec4 uvSets01;
out vec4 uvSets23;
out vec4 color;
flat out uint objectIndex;
#endif

#if BALL
out vec3 positionRender;
#endif

void main() {
    uint drawn = drawnObject();
#if MASK
    objectIndex = drawn;
    uvSets01 = vec4(uvSet0, uvSet1);
    uvSets23 = vec4(uvSet2, uvSet3);
    color = (objects[drawn].flags & kObjectHasColors) != 0u ? vertexColor : vec4(1.0);
#endif
    vec4 position = objects[drawn].renderFromLocal * vec4(positionLocal, 1.0);
#if BALL
    positionRender = position.xyz;
#endif
    gl_Position = params.clipFromRender * position;
}
