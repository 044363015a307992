#include "renderer/view.h"

#include <cmath>

#include "core/low_discrepancy.h"
#include "framegraph/hash.h"

namespace tyndall {
namespace {

/// Reversed depth, far plane at infinity: depth = near / distance along the axis.
dmat4 perspective(const Camera& camera, double aspect) {
    const double f = 1.0 / std::tan(0.5 * camera.yfov);
    dmat4 m(0.0);
    m[0][0] = f / aspect;
    m[1][1] = f;
    m[3][2] = camera.znear;
    m[2][3] = -1.0;
    return m;
}

/// Reversed depth from 1 at the camera's plane to 0 at `farDistance`.
dmat4 orthographic(const Camera& camera, double aspect, double farDistance) {
    dmat4 m(1.0);
    m[0][0] = 1.0 / (camera.ymag * aspect);
    m[1][1] = 1.0 / camera.ymag;
    m[2][2] = 1.0 / farDistance;
    m[3][2] = 1.0;
    return m;
}

dmat4 withoutScale(const dmat4& worldFromCamera) {
    dmat4 m = worldFromCamera;
    // Gram-Schmidt from the viewing axis: shear and mirror go as well, as a lens has neither.
    const dvec3 z = glm::normalize(dvec3(m[2]));
    dvec3 x = dvec3(m[0]) - z * glm::dot(dvec3(m[0]), z);
    if (!(glm::dot(x, x) > 0))
        x = std::abs(z.y) < 0.9 ? glm::cross(dvec3(0, 1, 0), z) : glm::cross(dvec3(1, 0, 0), z);
    x = glm::normalize(x);
    m[0] = dvec4(x, 0);
    m[1] = dvec4(glm::cross(z, x), 0);
    m[2] = dvec4(z, 0);
    return m;
}

} // namespace

dvec3 chooseRenderOrigin(const dvec3& cameraPosition, const Bounds& surroundings,
                         const dvec3& previousOrigin) {
    constexpr double kFarthest = 8192; // metres: steps of single precision there are half a millimetre
    const double radius =
        surroundings.empty() ? 1.0 : std::max(1e-3, 0.5 * glm::length(surroundings.extent()));
    const double farthest = std::min(8.0 * radius, kFarthest);
    if (glm::length(cameraPosition - previousOrigin) < farthest) return previousOrigin;
    // Close enough to the world's origin that single precision loses nothing: the common case, and the simplest numbers.
    if (glm::length(cameraPosition) < farthest) return dvec3(0);
    return glm::round(cameraPosition);
}

ViewResources makeView(const ViewRequest& request) {
    CHECK(request.camera && request.width > 0 && request.height > 0);
    const Camera& camera = *request.camera;
    const double aspect = double(request.width) / double(request.height);
    dmat4 renderFromCamera = withoutScale(request.worldFromCamera);
    renderFromCamera[3] -= dvec4(request.renderOrigin, 0);

    const dvec2 point = lowDiscrepancyPoint(request.frameIndex, fg::mixHash(request.seed, 1));
    const dvec2 jitter = request.converge ? point - 0.5 : dvec2(0);
    dmat4 jitterClip(1.0);
    jitterClip[3] = dvec4(2.0 * jitter.x / request.width, 2.0 * jitter.y / request.height, 0, 1);

    const bool parallel = camera.type == CameraType::Orthographic;
    const double farDistance = 4.0 * request.sceneRadius;
    const dmat4 clipFromView = jitterClip * (parallel ? orthographic(camera, aspect, farDistance)
                                                      : perspective(camera, aspect));
    const dmat4 viewFromRender = glm::inverse(renderFromCamera);

    ViewResources view;
    view.width = request.width;
    view.height = request.height;
    gpu::ViewData& data = view.data;
    data.clipFromRender = mat4(clipFromView * viewFromRender);
    data.renderFromClip = mat4(renderFromCamera * glm::inverse(clipFromView));
    data.viewFromRender = mat4(viewFromRender);
    data.cameraPosition = vec4(vec3(renderFromCamera[3]), parallel ? 0.0f : float(camera.znear));
    data.cameraForward = vec4(-vec3(renderFromCamera[2]), float(request.sceneRadius));
    data.size = vec4(float(request.width), float(request.height), 1.0f / float(request.width),
                     1.0f / float(request.height));
    const dvec2 frame = lowDiscrepancyPoint(request.frameIndex, fg::mixHash(request.seed, 2));
    data.jitter = vec4(vec2(jitter), vec2(frame));
    data.frameIndex = request.frameIndex;
    data.seed = request.seed;
    data.flags =
        (parallel ? gpu::kViewOrthographic : 0u) | (request.converge ? gpu::kViewConverge : 0u);
    data.padding0 = 0;
    return view;
}

std::array<vec4, 5> frustumPlanes(const gpu::ViewData& view) {
    const mat4 rows = glm::transpose(view.clipFromRender);
    std::array<vec4, 5> planes = {rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1],
                                  rows[3] - rows[1], rows[3] - rows[2]};
    for (vec4& plane : planes) plane /= std::max(glm::length(vec3(plane)), 1e-30f);
    return planes;
}

} // namespace tyndall
