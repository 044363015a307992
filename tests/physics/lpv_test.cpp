// Light propagation volumes in pictures: laws that need no reference.

#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/render.h"

namespace tyndall::test {
namespace {

constexpr TermSet kIndirect = kIndirectOnSurfaces | kIndirectInMedia;

double meanOf(const Image& image) {
    double sum = 0;
    for (const float v : image.pixels) sum += double(v);
    return sum / double(image.pixels.size());
}

/// Mean indirect light of the picture, on surfaces and in media.
double indirectMean(const Scene& scene, std::vector<std::string> settings) {
    RenderOptions options;
    options.width = 48;
    options.height = 27;
    options.gi = "lpv";
    options.terms = kIndirect;
    options.settings = std::move(settings);
    double sum = 0;
    for (const auto& [name, picture] : sharedRenderer().render(scene, options).terms)
        sum += meanOf(picture);
    return sum;
}

/// A closed room of 4 × 3 × 5 m in fog, with walls of `thickness`, turned by `angle` about the vertical; sun and a lamp are outside.
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

TEST(Lpv, AClosedRoomStaysDark) {
    // Walls far thinner than a cell of the lattice (0.6 m), and as thick as half of one.
    for (const double thickness : {0.02, 0.3})
        for (const double angle : {0.0, 0.3}) {
            const std::vector<std::string> settings = {"gi.lpv.resolution=24", "gi.lpv.rsmSize=64"};
            const double inside =
                indirectMean(sceneFromJson(sealedRoom(thickness, angle, true)), settings);
            const double outside =
                indirectMean(sceneFromJson(sealedRoom(thickness, angle, false)), settings);
            printf("walls of %.2f m, turned by %.1f: inside %.2e of outside\n", thickness, angle,
                   inside / outside);
            EXPECT_GT(outside, 1);
            EXPECT_LT(inside, 1e-3 * outside);
        }
}

std::string corner(double light, const std::string& medium) {
    return fmt::format(
        R"({{"tyndall": 1, "nodes": [
        {{"name": "floor", "primitive": {{"shape": "plane", "size": [4, 4]}}, "material": {{"baseColor": [0.8, 0.6, 0.4], "specular": 0}}}},
        {{"name": "wall", "primitive": {{"shape": "box", "size": [4, 3, 0.1]}}, "material": {{"baseColor": [0.3, 0.5, 0.8], "specular": 0}},
            "translation": [0, 1.5, -2]}}, {}
        {{"name": "lamp", "light": {{"type": "point", "intensity": {}}}, "translation": [0.5, 2, 0.3]}},
        {{"name": "eye", "camera": {{"type": "perspective", "yfov": 0.8}}, "translation": [0, 1.5, 6]}}],
        "camera": "eye"}})",
        medium, light);
}

TEST(Lpv, LightThatDoublesDoublesThePicture) {
    const std::string fog =
        R"({"name": "fog", "medium": {"type": "homogeneous", "shape": "box", "size": [4, 3, 4], "scattering": [0.3, 0.3, 0.3],
        "absorption": [0, 0.1, 0.2], "anisotropy": 0.5}, "translation": [0, 1.5, 0]},)";
    const std::vector<std::string> settings = {"gi.lpv.resolution=12", "gi.lpv.rsmSize=64"};
    // A power of two changes no digit anywhere, not even where light is counted in fixed point.
    const double one = indirectMean(sceneFromJson(corner(50, fog)), settings);
    EXPECT_GT(one, 0);
    EXPECT_EQ(indirectMean(sceneFromJson(corner(100, fog)), settings), 2 * one);
    for (const double light : {1e-15, 1e15})
        EXPECT_NEAR(indirectMean(sceneFromJson(corner(light, fog)), settings) / light * 50 / one, 1,
                    1e-4)
            << light;
}

TEST(Lpv, AMediumThatIsNothingChangesNothing) {
    const std::string nothing =
        R"({"name": "fog", "medium": {"type": "homogeneous", "shape": "box", "size": [4, 3, 4], "scattering": [0, 0, 0],
        "absorption": [0, 0, 0]}, "translation": [0, 1.5, 0]},)";
    RenderOptions options;
    options.gi = "lpv";
    options.terms = kIndirectOnSurfaces;
    options.settings = {"gi.lpv.resolution=12", "gi.lpv.rsmSize=64"};
    const Rendered with = sharedRenderer().render(sceneFromJson(corner(50, nothing)), options),
                   without = sharedRenderer().render(sceneFromJson(corner(50, "")), options);
    EXPECT_GT(meanOf(without.beauty), 0);
    EXPECT_EQ(with.beauty.pixels, without.beauty.pixels);
}

TEST(Lpv, ALightThatGoesOutLeavesNothing) {
    const std::vector<std::string> settings = {"gi.lpv.resolution=12", "gi.lpv.rsmSize=64"};
    EXPECT_GT(indirectMean(sceneFromJson(corner(50, "")), settings), 0);
    EXPECT_EQ(indirectMean(sceneFromJson(corner(0, "")), settings), 0);
}

} // namespace
} // namespace tyndall::test
