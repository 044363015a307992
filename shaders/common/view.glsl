// The view of this frame and its rays. `pixel` is gl_FragCoord.xy: the centre of the lower left pixel is (0.5, 0.5); the
// frame's sub-pixel jitter is inside the matrices. Everything is in render space.
#ifndef TYNDALL_COMMON_VIEW
#define TYNDALL_COMMON_VIEW
#include "shared/view.h"

layout(std140) uniform View {
    ViewData view;
};

const float kSkyDistance = 1e30;

struct Ray {
    vec3 origin;
    vec3 direction; // unit
};

bool viewIsOrthographic() {
    return (view.flags & kViewOrthographic) != 0u;
}

bool viewConverges() {
    return (view.flags & kViewConverge) != 0u;
}

// The ray through `pixel`. It starts at the camera's position, in an orthographic view on the plane through it.
Ray cameraRay(vec2 pixel) {
    vec2 ndc = pixel * view.size.zw * 2.0 - 1.0;
    if (viewIsOrthographic()) {
        vec4 point = view.renderFromClip * vec4(ndc, 1.0, 1.0);
        vec3 fromCamera = point.xyz / point.w - view.cameraPosition.xyz;
        vec3 aside = fromCamera - view.cameraForward.xyz * dot(fromCamera, view.cameraForward.xyz);
        return Ray(view.cameraPosition.xyz + aside, view.cameraForward.xyz);
    }
    // Depth 0 lies at infinity, where the camera's position has no part in the result: a point on the near plane minus the
    // position would lose most of its digits in small scenes.
    vec4 atInfinity = view.renderFromClip * vec4(ndc, 0.0, 1.0);
    return Ray(view.cameraPosition.xyz, normalize(atInfinity.xyz));
}

// Metres from cameraRay(pixel).origin to the surface that left `depth`; kSkyDistance where there is none.
float rayDistanceFromDepth(vec2 pixel, float depth) {
    if (!(depth > 0.0)) return kSkyDistance;
    Ray ray = cameraRay(pixel);
    if (viewIsOrthographic()) {
        // Depth falls evenly from 1 at the camera's plane. From its gradient, not from positions: see cameraRay().
        vec3 gradient = vec3(view.clipFromRender[0].z, view.clipFromRender[1].z, view.clipFromRender[2].z);
        return (depth - 1.0) / dot(gradient, ray.direction);
    }
    float alongView = view.cameraPosition.w / depth; // reversed depth with the far plane at infinity
    return alongView / dot(ray.direction, view.cameraForward.xyz);
}

// The surface's position; only for depth > 0.
vec3 renderPosition(vec2 pixel, float depth) {
    Ray ray = cameraRay(pixel);
    return ray.origin + ray.direction * rayDistanceFromDepth(pixel, depth);
}

// Unit vector from `position` to the eye.
vec3 directionToEye(vec3 position) {
    if (viewIsOrthographic()) return -view.cameraForward.xyz;
    return normalize(view.cameraPosition.xyz - position);
}

#endif
