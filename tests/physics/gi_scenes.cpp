#include "gi_scenes.h"

#include <cmath>

#include <fmt/format.h>

#include "support/render.h"

namespace tyndall::test {

double indirectMean(const std::string& gi, const Scene& scene, std::vector<std::string> settings) {
    RenderOptions options;
    options.width = 48;
    options.height = 27;
    options.gi = gi;
    options.terms = kIndirect;
    options.settings = std::move(settings);
    double sum = 0;
    for (const auto& [name, picture] : sharedRenderer().render(scene, options).terms)
        sum += meanOf(picture);
    return sum;
}

std::string sealedRoom(double thickness, double angle, bool fromInside) {
    const double e = thickness;
    std::string walls;
    for (int axis = 0; axis < 3; ++axis)
        for (int side = -1; side <= 1; side += 2) {
            dvec3 size(4 + 2 * e, 3 + 2 * e, 5 + 2 * e), place(0);
            place[axis] = side * 0.5 * (size[axis] - e);
            size[axis] = e;
            walls += fmt::format(
                R"({{"name": "wall {}{}", "parent": "room", "primitive": {{"shape": "box", "size": [{}, {}, {}]}},
                "material": {{"baseColor": [0.7, 0.7, 0.7], "specular": 0}}, "translation": [{}, {}, {}]}},)",
                axis, side, size.x, size.y, size.z, place.x, place.y, place.z);
        }
    return fmt::format(
        R"({{"tyndall": 1, "nodes": [
        {{"name": "room", "translation": [0.13, 0.07, -0.11], "rotation": [0, {}, 0, {}]}}, {}
        {{"name": "ground", "primitive": {{"shape": "plane", "size": [14, 14]}}, "translation": [0, -4, 0]}},
        {{"name": "fog", "medium": {{"type": "homogeneous", "shape": "box", "size": [12, 9, 12],
            "scattering": [0.2, 0.2, 0.2], "absorption": [0.01, 0.01, 0.01]}}}},
        {{"name": "sun", "light": {{"type": "directional", "intensity": 100}}, "rotation": [-0.479, 0, 0, 0.878]}},
        {{"name": "lamp", "light": {{"type": "point", "intensity": 200}}, "translation": [4, 2, 3]}},
        {{"name": "eye", "camera": {{"type": "perspective", "yfov": 1.2, "znear": 0.02}}, "translation": {}}}],
        "camera": "eye"}})",
        std::sin(angle / 2), std::cos(angle / 2), walls,
        fromInside ? "[0.13, 0.07, 2]" : "[0, 1, 9]");
}

std::string corner(double light, const std::string& medium) {
    return fmt::format(
        R"({{"tyndall": 1, "nodes": [
        {{"name": "floor", "primitive": {{"shape": "plane", "size": [4, 4]}}, "material": {{"baseColor": [0.8, 0.6, 0.4], "specular": 0}}}},
        {{"name": "wall", "primitive": {{"shape": "box", "size": [4, 3, 0.1]}}, "material": {{"baseColor": [0.3, 0.5, 0.8], "specular": 0}},
            "translation": [0, 1.5, -2]}}, {}
        {{"name": "lamp", "light": {{"type": "point", "intensity": {}, "radius": 0.05}}, "translation": [0.5, 2, 0.3]}},
        {{"name": "eye", "camera": {{"type": "perspective", "yfov": 0.8}}, "translation": [0, 1.5, 6]}}],
        "camera": "eye"}})",
        medium, light);
}

} // namespace tyndall::test
