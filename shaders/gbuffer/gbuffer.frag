// Surfaces for the G-buffer. MASK: alpha-tested materials.
#include "common/octahedral.glsl"
#include "common/view.glsl"
#include "gbuffer/surface.glsl"
#include "shared/gbuffer.h"

in vec3 fromEye;
in vec3 normalRender;
in vec4 tangentRender;
in vec4 uvSets01;
in vec4 uvSets23;
in vec4 color;
flat in uint objectIndex;

layout(std430) readonly buffer Objects {
    ObjectData objects[];
};
uniform int isTriangle;

layout(location = 0) out vec4 normalTarget;
layout(location = 1) out vec4 baseTarget;
layout(location = 2) out vec4 materialTarget;
layout(location = 3) out vec4 emissiveTarget;

void main() {
    MaterialData material = materials[objects[objectIndex].material];
    SurfacePoint point = SurfacePoint(fromEye, normalRender, tangentRender, uvSets01, uvSets23, color, gl_FrontFacing, isTriangle != 0);
    Surface surface = evaluateSurface(material, point);
#if MASK
    if (surface.alpha < surfaceAlphaCutoff(material, point)) discard;
#endif
    uint flags = surface.unlit ? kGBufferUnlit : 0u;
    normalTarget = vec4(octahedralEncodeUnorm(surface.normal), octahedralEncodeUnorm(surface.geometricNormal));
    // An unlit surface reflects nothing and shows its colour as it is.
    baseTarget = surface.unlit ? vec4(0.0) : vec4(surface.baseColor, surface.metallic);
    materialTarget = vec4(surface.roughness, surface.unlit ? 0.0 : surface.specular, surface.occlusion, float(flags) / 65535.0);
    emissiveTarget = vec4(max(surface.unlit ? surface.baseColor : surface.emissive, vec3(0.0)), 1.0);
}
