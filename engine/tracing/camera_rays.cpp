#include "tracing/camera_rays.h"

#include <cmath>

namespace tyndall::tracing {

CameraRays::CameraRays(const Scene& scene, int node, int width, int height)
    : width_(width), height_(height) {
    const Camera& camera = scene.cameras[size_t(scene.nodes[size_t(node)].camera)];
    const dmat4 m = scene.worldTransforms()[size_t(node)];
    origin_ = dvec3(m[3]);
    // A lens has neither scale nor shear nor mirror: axes made orthonormal from the viewing axis on.
    back_ = glm::normalize(dvec3(m[2]));
    dvec3 x = dvec3(m[0]) - back_ * glm::dot(dvec3(m[0]), back_);
    if (!(glm::dot(x, x) > 0))
        x = glm::cross(std::abs(back_.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0), back_);
    right_ = glm::normalize(x);
    up_ = glm::cross(back_, right_);
    parallel_ = camera.type == CameraType::Orthographic;
    halfHeight_ = parallel_ ? camera.ymag : std::tan(0.5 * camera.yfov);
    nearest_ = camera.znear;
}

CameraRays::CameraRay CameraRays::through(int x, int y, const dvec2& u) const {
    const double px = (2 * (x + u.x) - width_) / height_ * halfHeight_,
                 py = (1 - 2 * (y + u.y) / height_) * halfHeight_;
    CameraRay result;
    if (parallel_) {
        // Parallel rays start in the camera's plane.
        result.ray = {px * right_ + py * up_, -back_};
        return result;
    }
    const dvec3 way = px * right_ + py * up_ - back_;
    const double length = glm::length(way);
    result.ray = {dvec3(0), way / length};
    result.nearest = nearest_ * length;
    return result;
}

} // namespace tyndall::tracing
