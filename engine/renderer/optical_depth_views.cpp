#include "renderer/optical_depth_views.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/check.h"

namespace tyndall {
namespace {

constexpr int kLargest3D = 2048; // what GL 4.5 grants
constexpr double kWidestTangent =
    2; // beyond, the corners of a square cone get too many texels: octahedral then
constexpr double kMargin =
    1.0 + 1e-5; // single precision must not push the grids' corners out of the volume

std::array<dvec3, 8> corners(const Bounds& box) {
    std::array<dvec3, 8> points;
    for (size_t i = 0; i < 8; ++i)
        points[i] = {(i & 1) ? box.maximum.x : box.minimum.x,
                     (i & 2) ? box.maximum.y : box.minimum.y,
                     (i & 4) ? box.maximum.z : box.minimum.z};
    return points;
}

/// Columns x, y, z of a right-handed frame that looks along z.
dmat3 frameAlong(const dvec3& z) {
    const dvec3 x = glm::normalize(std::abs(z.y) < 0.9 ? glm::cross(dvec3(0, 1, 0), z)
                                                       : glm::cross(dvec3(1, 0, 0), z));
    return {x, glm::cross(z, x), z};
}

/// From [0,1]³ over the grids' extent in a frame along the light.
gpu::OpticalDepthView parallelView(const dvec3& travel, const Bounds& grids) {
    const dmat3 frame = frameAlong(travel);
    Bounds local;
    for (const dvec3& corner : corners(grids)) local.include(glm::transpose(frame) * corner);
    // A margin around, and an extent where the grids are flat.
    const dvec3 size =
        glm::max(local.extent() * kMargin, dvec3(1e-6 * glm::length(local.extent()) + 1e-30));
    const dvec3 lowest = local.centre() - 0.5 * size;
    dmat4 renderFromVolume(1.0);
    for (int i = 0; i < 3; ++i) renderFromVolume[i] = dvec4(frame[i] * size[i], 0);
    renderFromVolume[3] = dvec4(frame * lowest, 1);
    gpu::OpticalDepthView view{};
    view.kind = gpu::kDepthViewParallel;
    view.renderFromVolume = mat4(renderFromVolume);
    view.volumeFromRender = mat4(glm::inverse(renderFromVolume));
    view.radial = vec4(0, float(size.z), 0, 0);
    view.origin = vec4(0, 0, 0, float(1.0 / size.z));
    return view;
}

/// Sets a cone along `axis` whose square opening reaches `tangent` to each side.
void setCone(gpu::OpticalDepthView& view, const dvec3& axis, const dvec2& tangent) {
    const dmat3 frame = frameAlong(axis);
    dmat4 renderFromVolume(1.0);
    renderFromVolume[0] = dvec4(frame[0] * tangent.x, 0);
    renderFromVolume[1] = dvec4(frame[1] * tangent.y, 0);
    renderFromVolume[2] = dvec4(frame[2], 0);
    view.kind = gpu::kDepthViewCone;
    view.renderFromVolume = mat4(renderFromVolume);
    view.volumeFromRender = mat4(glm::inverse(renderFromVolume));
}

/// The cone from `origin` that just holds the grids; false where there is none that is narrow enough.
bool coneAround(const dvec3& origin, const Bounds& grids, dvec3& axis, dvec2& tangent) {
    const dvec3 toCentre = grids.centre() - origin;
    if (!(glm::length(toCentre) > 0)) return false;
    axis = glm::normalize(toCentre);
    const dmat3 frame = frameAlong(axis);
    tangent = dvec2(1e-6);
    for (const dvec3& corner : corners(grids)) {
        const dvec3 d = glm::transpose(frame) * (corner - origin);
        if (!(d.z > 0)) return false;
        tangent = glm::max(tangent, glm::abs(dvec2(d)) / d.z);
    }
    tangent *= kMargin;
    return std::max(tangent.x, tangent.y) <= kWidestTangent;
}

gpu::OpticalDepthView localView(const gpu::LightData& light, const Bounds& grids, double nearest) {
    const dvec3 origin(light.position);
    double farthest = 0;
    for (const dvec3& corner : corners(grids))
        farthest = std::max(farthest, glm::length(corner - origin));
    if (light.position.w > 0) farthest = std::min(farthest, double(light.position.w));
    gpu::OpticalDepthView view{};
    view.kind = gpu::kDepthViewOctahedral;
    view.radial = vec4(float(nearest), float(farthest), 0, 0);
    view.origin = vec4(vec3(origin), float(1.0 / std::max(farthest - nearest, 1e-30)));
    view.renderFromVolume = view.volumeFromRender = mat4(1.0f);
    dvec3 axis;
    dvec2 tangent;
    if (coneAround(origin, grids, axis, tangent)) setCone(view, axis, tangent);
    // A spot's own cone may be the narrower one; outside of it nothing is lit.
    if (light.type == gpu::kLightSpot && light.axisY.w > 0.2f) {
        const double cosine = double(light.axisY.w);
        const double spot = std::sqrt(std::max(1 - cosine * cosine, 1e-12)) / cosine * kMargin;
        if (view.kind == gpu::kDepthViewOctahedral || spot * spot < tangent.x * tangent.y)
            setCone(view, glm::normalize(dvec3(light.direction)), dvec2(spot));
    }
    return view;
}

} // namespace

OpticalDepthLayout layOutOpticalDepth(std::span<const gpu::LightData> lights, const Bounds& grids,
                                      int resolution, int mostVolumes) {
    CHECK(resolution >= 2 && resolution <= kLargest3D,
          "a light's volume has 2 to 2048 texels a side");
    OpticalDepthLayout layout;
    const int perAxis = kLargest3D / resolution;
    const int most = int(std::min<int64_t>(mostVolumes, int64_t(perAxis) * perAxis * perAxis));
    for (const gpu::LightData& light : lights) {
        gpu::OpticalDepthView view{};
        const bool parallel = light.type == gpu::kLightDirectional;
        const dvec3 origin(light.position);
        const double nearest =
            parallel ? 0
                     : glm::length(glm::max(
                           glm::max(grids.minimum - origin, origin - grids.maximum), dvec3(0)));
        const bool reaches =
            parallel || !(light.position.w > 0) || nearest < double(light.position.w);
        if (grids.empty() || !reaches) {
            view.kind = gpu::kDepthViewNone;
        } else if (int(layout.volumeCount) >= most) {
            view.kind = gpu::kDepthViewMarch;
        } else {
            view = parallel ? parallelView(glm::normalize(dvec3(light.direction)), grids)
                            : localView(light, grids, nearest);
            const int n = int(layout.volumeCount++);
            view.block = ivec4(
                resolution * ivec3(n % perAxis, n / perAxis % perAxis, n / (perAxis * perAxis)),
                resolution);
        }
        layout.views.push_back(view);
    }
    const int n = std::max(int(layout.volumeCount), 1);
    layout.volume = fg::texture3D(fg::Format::RGBA16F, resolution * std::min(n, perAxis),
                                  resolution * std::min((n + perAxis - 1) / perAxis, perAxis),
                                  resolution * ((n + perAxis * perAxis - 1) / (perAxis * perAxis)));
    return layout;
}

} // namespace tyndall
