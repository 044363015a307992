#include "volumetric_gi/rsm/rsm_views.h"

#include <algorithm>
#include <cmath>

#include "scene/light_flux.h"

namespace tyndall::volumetric_gi {
namespace {

constexpr double kWidestSpot = 1.2; // radians from its axis; a wider one gets all six views

dvec3 rgb(const vec4& v) { return dvec3(v.x, v.y, v.z); }

/// Watts that leave the light through its views of `box`.
dvec3 powerOf(const gpu::LightData& light, const Bounds& box) {
    const dvec3 intensity = rgb(light.intensity);
    switch (light.type) {
    case gpu::kLightDirectional: {
        // Its view is a square around the box's ball, whatever the direction.
        const double side = glm::length(box.extent());
        return parallelFlux(intensity, side * side);
    }
    case gpu::kLightSpot: return spotFlux(intensity, double(light.axisX.w), double(light.axisY.w));
    case gpu::kLightRect: return lambertFlux(intensity, double(light.intensity.w));
    default: return pointFlux(intensity);
    }
}

/// Looks along `forward`.
dmat4 lookingAlong(const dvec3& position, const dvec3& forward) {
    const dvec3 z = -glm::normalize(forward);
    const dvec3 pole = std::abs(z.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0);
    const dvec3 x = glm::normalize(glm::cross(pole, z));
    return dmat4(dvec4(x, 0), dvec4(glm::cross(z, x), 0), dvec4(z, 0), dvec4(position, 1));
}

class Planner {
public:
    Planner(const Bounds& bounds, std::span<const Bounds> boxes, int side, RsmPlan& plan)
        : bounds_(bounds), boxes_(boxes), radius_(0.5 * glm::length(bounds.extent())), side_(side),
          plan_(plan) {}

    void addParallel(uint32_t light, const dvec3& travel) {
        for (size_t i = 0; i < boxes_.size(); ++i) {
            const dvec3 centre = boxes_[i].centre();
            const double radius = 0.5 * glm::length(boxes_[i].extent());
            // From outside the scene: surfaces in between cast their shadows into the box.
            const double before = 0.5 * glm::dot(bounds_.extent(), glm::abs(travel)) +
                                  std::abs(glm::dot(bounds_.centre() - centre, travel)) + radius;
            RsmView v = make(light, lookingAlong(centre - before * travel, travel));
            v.view.halfHeight = float(radius);
            v.view.depthRange = float(before + 2 * radius);
            v.texelArea = float(std::pow(2 * radius / side_, 2));
            v.box = int(i);
            plan_.views.push_back(v);
        }
    }
    void addPerspective(uint32_t light, const dvec3& from, const dvec3& forward, double yfov,
                        double ball, double share) {
        RsmView v = make(light, lookingAlong(from, forward));
        v.view.yfov = float(yfov);
        // Surfaces inside a lamp's ball do not block it; else as near as single precision of depth allows.
        v.view.nearest = float(std::max(ball, 1e-4 * radius_));
        v.share = float(share);
        plan_.views.push_back(v);
    }
    /// The views of a cube around `from`, but not those that look away from `towards` (zero: all).
    void addCube(uint32_t light, const dvec3& from, const dvec3& towards, double ball,
                 double share) {
        for (int axis = 0; axis < 3; ++axis)
            for (int sign = -1; sign <= 1; sign += 2) {
                dvec3 forward(0);
                forward[axis] = sign;
                // All of a face's directions are within 55° of its middle.
                if (glm::dot(forward, towards) < -std::cos(kPi / 2 - 0.9554)) continue;
                addPerspective(light, from, forward, kPi / 2, ball, share);
            }
    }

private:
    RsmView make(uint32_t light, const dmat4& renderFromView) const {
        RsmView v;
        v.view.renderFromView = mat4(renderFromView);
        v.view.side = side_;
        v.light = light;
        return v;
    }
    Bounds bounds_;
    std::span<const Bounds> boxes_;
    double radius_;
    int side_;
    RsmPlan& plan_;
};

void addLight(Planner& planner, uint32_t index, const gpu::LightData& light, int rectPoints) {
    const dvec3 position = rgb(light.position), direction = rgb(light.direction);
    if (light.type == gpu::kLightDirectional) return planner.addParallel(index, direction);
    if (light.type == gpu::kLightRect) {
        // Centres of equal rows, and of equal parts of each: the points' mean is the rect's centre.
        const int rows = std::max(int(std::lround(std::sqrt(rectPoints))), 1);
        for (int row = 0; row < rows; ++row) {
            const int columns = rectPoints * (row + 1) / rows - rectPoints * row / rows;
            for (int column = 0; column < columns; ++column) {
                const dvec2 u((column + 0.5) / columns, (row + 0.5) / rows);
                planner.addCube(index,
                                position + (2 * u.x - 1) * rgb(light.axisX) +
                                    (2 * u.y - 1) * rgb(light.axisY),
                                direction, 0, 1.0 / (rows * columns));
            }
        }
        return;
    }
    const double ball = double(light.direction.w);
    const double outer = std::acos(std::clamp(double(light.axisY.w), -1.0, 1.0));
    if (light.type == gpu::kLightSpot && outer < kWidestSpot)
        return planner.addPerspective(index, position, direction, 2 * outer, ball, 1);
    planner.addCube(index, position, light.type == gpu::kLightSpot ? direction : dvec3(0), ball, 1);
}

} // namespace

RsmPlan planRsm(std::span<const gpu::LightData> lights, const Bounds& bounds,
                std::span<const Bounds> boxes, int side, int mostLights, int rectPoints) {
    RsmPlan plan;
    plan.power.resize(boxes.size(), dvec3(0));
    if (bounds.empty()) return plan;
    std::vector<uint32_t> order;
    const auto strength = [&](uint32_t i) {
        const dvec3 power = powerOf(lights[i], bounds);
        return std::max({power.x, power.y, power.z});
    };
    for (uint32_t i = 0; i < lights.size(); ++i)
        if (strength(i) > 0) order.push_back(i);
    // Lights of the environment last: much of their power falls on roofs, and they are many and similar.
    const auto ofScene = [&](uint32_t i) {
        return (lights[i].flags & gpu::kLightFromEnvironment) == 0;
    };
    std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
        if (ofScene(a) != ofScene(b)) return ofScene(a);
        return strength(a) > strength(b);
    });
    if (order.size() > size_t(mostLights)) {
        plan.lightsLeftOut = uint32_t(order.size()) - uint32_t(mostLights);
        order.resize(size_t(mostLights));
    }
    Planner planner(bounds, boxes, side, plan);
    for (const uint32_t i : order) {
        for (size_t b = 0; b < boxes.size(); ++b) plan.power[b] += powerOf(lights[i], boxes[b]);
        addLight(planner, i, lights[i], rectPoints);
    }
    return plan;
}

} // namespace tyndall::volumetric_gi
