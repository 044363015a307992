#pragma once
// From a camera in the scene to the view of one frame.

#include <array>

#include "core/result.h"
#include "plugin/frame_resources.h"
#include "scene/scene.h"

namespace tyndall {

/// Whole metres near the camera, moved only when the camera is farther away than a few sizes of what is around it, and than single
/// precision has millimetres for, so that what was cached in render space stays valid while the camera flies about.
dvec3 chooseRenderOrigin(const dvec3& cameraPosition, const Bounds& surroundings,
                         const dvec3& previousOrigin);

struct ViewRequest {
    const Camera* camera = nullptr;
    dmat4 worldFromCamera{1.0};
    dvec3 renderOrigin{0};
    double sceneRadius = 1; // metres around the camera that hold everything of interest
    int width = 0, height = 0;
    uint32_t frameIndex = 0, seed = 0;
    bool converge = false;
};

/// Matrices and per-frame numbers. In converge mode every frame has its own sub-pixel offset, box-distributed over the pixel
/// (frame 0 included: the average of the pixel, not its centre, is what a path tracer with a box filter computes).
/// The node's scale is taken out: a camera sees metres.
ViewResources makeView(const ViewRequest& request);

/// Planes of the view's frustum in render space, pointing inwards: dot(plane.xyz, p) + plane.w ≥ 0 inside. Left, right,
/// bottom, top, near; there is no far plane.
std::array<vec4, 5> frustumPlanes(const gpu::ViewData& view);

} // namespace tyndall
