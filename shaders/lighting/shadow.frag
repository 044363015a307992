// Depth alone. MASK: where alpha is below the cutoff there is a hole; a blended surface is a screen of holes as dense as it is
// transparent, another one in each averaged frame. BALL: the map looks out of the inside of a ball of light, whose surface and contents
// cast no shadow.
#if MASK
#include "common/random.glsl"
#include "gbuffer/surface.glsl"

in vec4 uvSets01;
in vec4 uvSets23;
in vec4 color;
flat in uint objectIndex;

layout(std430) readonly buffer Objects { ObjectData objects[]; };

float holeThreshold() {
    uint hash = hashUint(uint(gl_FragCoord.x) + hashUint(uint(gl_FragCoord.y) + hashUint(objectIndex)));
    return unitFloat(hash + (viewConverges() ? view.frameIndex * 0x9e3779b9u : 0u));
}
#endif

#if BALL
#include "shared/shadow.h"
layout(std140) uniform Params { ShadowDrawParams params; };
in vec3 positionRender;
#endif

void main() {
#if BALL
    if (distance(positionRender, params.ball.xyz) < params.ball.w) discard;
#endif
#if MASK
    MaterialData material = materials[objects[objectIndex].material];
    SurfacePoint point = SurfacePoint(vec3(0.0), vec3(0.0), vec4(0.0), uvSets01, uvSets23, color, true, true);
    float alpha = surfaceBaseColor(material, point).a;
    float cutoff = (material.flags & kMaterialBlend) != 0u ? max(holeThreshold(), 1e-6) : surfaceAlphaCutoff(material, point);
    if (alpha < cutoff) discard;
#endif
}
