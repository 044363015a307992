#pragma once
// Rays through the pixels of a picture: a pinhole or parallel rays, pixels as boxes.

#include "tracing/ray.h"
#include "scene/scene.h"

namespace tyndall::tracing {

class CameraRays {
public:
    /// Through the scene's camera at `node`; the world's point `origin()` becomes the origin of ray space.
    CameraRays(const Scene& scene, int node, int width, int height);

    [[nodiscard]] const dvec3& origin() const { return origin_; }
    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }

    struct CameraRay {
        Ray ray;
        double nearest = 0; // nearer surfaces are invisible
    };
    /// `u`: where in the pixel, [0,1)²; rows count from the top.
    [[nodiscard]] CameraRay through(int x, int y, const dvec2& u) const;

private:
    int width_, height_;
    dvec3 origin_{0};
    dvec3 right_{1, 0, 0}, up_{0, 1, 0}, back_{0, 0, 1}; // unit
    bool parallel_ = false;
    double halfHeight_ = 1; // metres, or at distance 1
    double nearest_ = 0;
};

} // namespace tyndall::tracing
