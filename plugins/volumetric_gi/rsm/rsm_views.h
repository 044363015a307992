#pragma once
// Views of reflective shadow maps: those of the strongest lights.

#include <cstdint>
#include <span>
#include <vector>

#include "plugin/plugin_api.h"

namespace tyndall::volumetric_gi {

/// One map: a square picture from a point of a light.
struct RsmView {
    plugin::SurfaceView view{};
    uint32_t light = 0;
    float share = 1;     // part of the light's power that this point represents
    float texelArea = 0; // m², parallel views
    int box = -1;        // the box that it lights; -1: all
};

struct RsmPlan {
    std::vector<RsmView> views;
    std::vector<dvec3> power; // by box, watts: power that leaves all lights through their views
    uint32_t lightsLeftOut = 0;
};

/// The views of the `mostLights` lights of the largest power. A light without directions gets six, a narrow spot and light from infinity one;
/// a rect from `rectPoints` points of it. Light from infinity gets a view for each of `boxes`, parts of `bounds` that are to be lit (render
/// space). `side`: texels.
[[nodiscard]] RsmPlan planRsm(std::span<const gpu::LightData> lights, const Bounds& bounds,
                              std::span<const Bounds> boxes, int side, int mostLights,
                              int rectPoints);

} // namespace tyndall::volumetric_gi
