// What gi.vpl.show and gi.vpl.maps make of a picture.

#include <array>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "core/image_metrics.h"
#include "gi_scenes.h"
#include "support/render.h"

namespace tyndall::test {
namespace {

/// Fog whose free path is longer than lights lie apart.
Scene foggyCorner() {
    return sceneFromJson(corner(
        50,
        R"({"name": "fog", "medium": {"type": "homogeneous", "shape": "box", "size": [4, 3, 4],
               "scattering": [0.2, 0.2, 0.2], "absorption": [0, 0, 0]}, "translation": [0, 1.5, 0]},)"));
}

Image pictureWith(const Scene& scene, const std::vector<std::string>& more) {
    RenderOptions options;
    options.width = 96;
    options.height = 54;
    options.gi = "vpl";
    options.terms = kIndirect;
    options.settings = {"gi.vpl.walks=48",   "gi.vpl.samples=8",
                        "gi.vpl.classes=4",  "gi.vpl.surfaces.resolution=full",
                        "gi.vpl.march=full", "gi.vpl.compensation=clamped"};
    options.settings.insert(options.settings.end(), more.begin(), more.end());
    return sharedRenderer().render(scene, options).beauty;
}

using Colour = std::array<float, 3>;

Colour colourAt(const Image& image, int x, int y) {
    Colour colour;
    for (int c = 0; c < 3; ++c)
        colour[size_t(c)] =
            image.pixels[(size_t(y) * size_t(image.width) + size_t(x)) * size_t(image.channels) +
                         size_t(c)];
    return colour;
}

TEST(VplViews, WhatTheBoundTakesAwayIsWhatIsMissing) {
    const Scene scene = foggyCorner();
    const Image held = pictureWith(scene, {}), lost = pictureWith(scene, {"gi.vpl.show=lost"}),
                // A hundredth of the distance: as far as the view counts.
        free = pictureWith(scene, {"gi.vpl.clamp=0.01", "gi.vpl.surfaceClamp=0.005"});
    double difference = 0;
    for (size_t i = 0; i < free.pixels.size(); ++i)
        difference +=
            std::abs(double(held.pixels[i]) + double(lost.pixels[i]) - double(free.pixels[i])) /
            double(free.pixels.size());
    printf("lost: %.3f of the light\n", meanOf(lost) / meanOf(free));
    EXPECT_GT(meanOf(lost), 0.01 * meanOf(free));
    EXPECT_LT(difference, 1e-4 * meanOf(free));
}

TEST(VplViews, LightsAreBallsOfTwoColours) {
    const Scene scene = foggyCorner();
    const Image plain = pictureWith(scene, {}), shown = pictureWith(scene, {"gi.vpl.show=lights"});
    int green = 0, red = 0, other = 0;
    for (int y = 0; y < plain.height; ++y)
        for (int x = 0; x < plain.width; ++x) {
            const Colour now = colourAt(shown, x, y);
            if (now == colourAt(plain, x, y)) continue;
            const bool isGreen = std::abs(now[0] / now[1] - 0.1f) < 1e-3f && now[0] == now[2],
                       isRed = std::abs(now[1] / now[0] - 0.1f) < 1e-3f && now[1] == now[2];
            ++(isGreen ? green : isRed ? red : other);
        }
    EXPECT_GT(green, 10);
    EXPECT_GT(red, 10);
    EXPECT_EQ(other, 0);
}

/// Where a picture is not as another: how many pixels, of how many colours, and whether all lie in the lower left corner's square.
struct Drawn {
    int pixels = 0;
    std::set<Colour> colours;
    bool inSquare = true;
};

Drawn drawnOver(const Image& plain, const Image& shown, int square) {
    Drawn drawn;
    for (int y = 0; y < plain.height; ++y)
        for (int x = 0; x < plain.width; ++x) {
            const Colour now = colourAt(shown, x, y);
            if (now == colourAt(plain, x, y)) continue;
            ++drawn.pixels;
            drawn.colours.insert(now);
            drawn.inSquare = drawn.inSquare && x < square && y >= plain.height - square;
        }
    return drawn;
}

TEST(VplViews, MapsHaveTheColoursOfWallsAndOfNothing) {
    const Scene scene = foggyCorner();
    const Image plain = pictureWith(scene, {});
    // Where nothing is seen maps are black, and so is some of the picture under them.
    const Drawn map = drawnOver(plain, pictureWith(scene, {"gi.vpl.show=map"}), 27);
    EXPECT_GT(map.pixels, 27 * 27 / 3);
    EXPECT_TRUE(map.inSquare);
    const Drawn atlas = drawnOver(plain, pictureWith(scene, {"gi.vpl.show=atlas"}), 27);
    EXPECT_GT(atlas.pixels, 96 * 54 / 2);
    // The floor, sides of the wall, and nothing.
    for (const Drawn& drawn : {map, atlas}) {
        EXPECT_GE(drawn.colours.size(), 2u);
        EXPECT_LE(drawn.colours.size(), 8u);
    }
}

TEST(VplMaps, PointsShowWhatRaysShow) {
    const Scene scene = foggyCorner();
    EXPECT_NE(pictureWith(scene, {"gi.vpl.show=atlas", "gi.vpl.maps=points"}).pixels,
              pictureWith(scene, {"gi.vpl.show=atlas"}).pixels);
    const ImageMetrics found =
        compareImages(pictureWith(scene, {"gi.vpl.maps=points"}), pictureWith(scene, {})).value();
    printf("relmse %.6f, energy %.5f\n", found.relmse, found.energy);
    // Where maps differ the tree decides; what is left are texels whose triangle hides nothing of a neighbour that does: a percent of them (passes_vpl_maps).
    EXPECT_LT(found.relmse, 1e-3);
    EXPECT_NEAR(found.energy, 1, 0.005);
}

} // namespace
} // namespace tyndall::test
