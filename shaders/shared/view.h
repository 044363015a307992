// The view of one frame, as the uniform block `View` (std140).
//
// "Render space" is world space moved by a whole number of metres, so that the camera is near the origin and single
// precision suffices far from the world's origin. All positions on the GPU are in render space.
#ifndef TYNDALL_SHARED_VIEW_H
#define TYNDALL_SHARED_VIEW_H
#include "shared/types.h"
TYNDALL_SHARED_BEGIN

TYNDALL_CONST uint kViewOrthographic = 1u; // rays are parallel: origin differs per pixel
TYNDALL_CONST uint kViewConverge = 2u;     // this frame is one of many that are averaged: sample, do not filter

struct ViewData {
    mat4 clipFromRender;  // with this frame's sub-pixel jitter; reversed z: 1 at the near plane, 0 at infinity
    mat4 renderFromClip;
    mat4 viewFromRender;
    vec4 cameraPosition;  // render space; w: near plane distance, metres
    vec4 cameraForward;   // unit; w: metres of scene around the camera that matter (for far = infinity)
    vec4 size;            // width, height, 1/width, 1/height in pixels
    vec4 jitter;          // sub-pixel offset x, y in pixels (-0.5..0.5); z, w: a 2D low-discrepancy point of this frame, 0..1
    uint frameIndex;      // counts frames of this view; 0 for the first
    uint seed;
    uint flags;
    uint padding0;
};

TYNDALL_SHARED_END
#endif
