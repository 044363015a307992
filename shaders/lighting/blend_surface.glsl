// What both shaders of blended surfaces need: the surface under the pixel, or nothing.
#ifndef TYNDALL_LIGHTING_BLEND_SURFACE
#define TYNDALL_LIGHTING_BLEND_SURFACE
#include "gbuffer/surface.glsl"
#include "shared/blend.h"

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
layout(std140) uniform Blend {
    BlendParams blend;
};
uniform int isTriangle;

// Discards what the camera does not see: back faces of one-sided surfaces, and what is wholly transparent.
Surface blendedSurface() {
    MaterialData material = materials[objects[objectIndex].material];
    // The raster state knows nothing of mirrored objects, since all kinds are drawn together.
    bool mirrored = (objects[objectIndex].flags & kObjectMirrored) != 0u;
    bool frontFacing = isTriangle == 0 || gl_FrontFacing != mirrored;
    SurfacePoint point = SurfacePoint(fromEye, normalRender, tangentRender, uvSets01, uvSets23, color, frontFacing, isTriangle != 0);
    Surface surface = evaluateSurface(material, point);
    surface.alpha = clamp(surface.alpha, 0.0, 1.0);
    if (surface.alpha == 0.0 || (!frontFacing && (material.flags & kMaterialDoubleSided) == 0u)) discard;
    return surface;
}

#endif
