#include "core/image.h"

#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/content.h"

namespace tyndall {
namespace {
namespace fs = std::filesystem;

/// Values that a linear picture holds: tiny, huge, zero, negative (a difference picture).
Image picture(int width, int height, int channels, float scale = 1) {
    Image image(width, height, channels);
    std::mt19937 random(7);
    std::uniform_real_distribution<float> exponent(-20, 15);
    for (float& value : image.pixels)
        value = scale * std::exp2(exponent(random)) * (random() % 8 ? 1.0f : -1.0f);
    return image;
}

const ImageLayer* find(const ExrFile& file, const std::string& name) {
    for (const ImageLayer& layer : file.layers)
        if (layer.name == name) return &layer;
    return nullptr;
}

TEST(Exr, FloatRoundTripIsExactForEveryLayerAndKeepsOrientation) {
    const fs::path path = test::scratchDir("exr") / "a.exr";
    const std::vector<ImageLayer> layers = {{"LSE", picture(37, 21, 3, 2)},
                                            {"", picture(37, 21, 3)},
                                            {"depth", picture(37, 21, 1)},
                                            {"rgba", picture(37, 21, 4)}};
    ASSERT_TRUE(writeExr(path, layers, {{"scene", "a \"quoted\" scene"}, {"settings", ""}}).ok());
    const Result<ExrFile> file = readExr(path);
    ASSERT_TRUE(file.ok()) << file.message();
    EXPECT_EQ(file->layers.front().name, "") << "the main layer leads";
    ASSERT_EQ(file->layers.size(), layers.size());
    for (const ImageLayer& layer : layers) {
        const ImageLayer* read = find(*file, layer.name);
        ASSERT_NE(read, nullptr) << layer.name;
        EXPECT_EQ(read->image.channels, layer.image.channels) << layer.name;
        EXPECT_EQ(read->image.pixels, layer.image.pixels) << layer.name;
    }
    EXPECT_EQ(file->metadata.at("scene"), "a \"quoted\" scene");
    EXPECT_EQ(file->metadata.at("settings"), "");
}

TEST(Exr, HalfKeepsElevenBits) {
    const fs::path path = test::scratchDir("exr-half") / "a.exr";
    Image image(64, 3, 3);
    for (size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = 0.001f + float(i) * 0.37f;
    ASSERT_TRUE(writeExr(path, std::vector<ImageLayer>{{"", image}}, {}, ExrDepth::Half).ok());
    const Result<ExrFile> file = readExr(path);
    ASSERT_TRUE(file.ok()) << file.message();
    for (size_t i = 0; i < image.pixels.size();
         ++i) // 11 significant bits, rounded: half a unit in the last place
        EXPECT_NEAR(file->layers[0].image.pixels[i], image.pixels[i],
                    std::ldexp(image.pixels[i], -11));
}

TEST(Exr, ALayerMayKeep32BitsInAFileOf16) {
    const fs::path path = test::scratchDir("exr") / "mixed.exr";
    // Below and above what 16 bits hold.
    Image variance(2, 1, 3);
    variance.pixels = {1e-12f, 1e9f, 0.1f, 3e-30f, 7e20f, 1.0f};
    ASSERT_TRUE(
        writeExr(path,
                 std::vector<ImageLayer>{{"", picture(2, 1, 3)}, {"variance", variance, true}}, {},
                 ExrDepth::Half)
            .ok());
    const Result<ExrFile> file = readExr(path);
    ASSERT_TRUE(file.ok()) << file.message();
    ASSERT_NE(find(*file, "variance"), nullptr);
    EXPECT_EQ(find(*file, "variance")->image.pixels, variance.pixels);
}

TEST(Exr, OneFlippedBitOrACutNeverCrashesAndACutIsRefused) {
    const fs::path folder = test::scratchDir("exr-damage");
    ASSERT_TRUE(writeExr(folder / "good.exr", std::vector<ImageLayer>{{"", picture(40, 40, 3)}},
                         {{"scene", "x"}})
                    .ok());
    const std::string good = readFile(folder / "good.exr").value();
    std::mt19937_64 random(test::seed());
    for (int i = 0; i < 300; ++i) {
        std::string bad = good;
        // Half of the flips hit the header, where the lies are.
        const size_t range = i % 2 ? bad.size() : std::min<size_t>(bad.size(), 600);
        bad[random() % range] ^= char(1 << (random() % 8));
        ASSERT_TRUE(writeFileAtomically(folder / "bad.exr", bad).ok());
        const Result<ExrFile> file = readExr(folder / "bad.exr");
        if (file.ok()) continue; // a flipped pixel is still a picture
        EXPECT_THAT(file.message(), ::testing::HasSubstr("bad.exr"))
            << "seed " << test::seed() << " case " << i;
    }
    for (size_t keep :
         {size_t(0), size_t(1), size_t(4), size_t(100), good.size() / 2, good.size() - 40}) {
        ASSERT_TRUE(writeFileAtomically(folder / "cut.exr", good.substr(0, keep)).ok());
        const Result<ExrFile> file = readExr(folder / "cut.exr");
        ASSERT_FALSE(file.ok()) << keep << " bytes of " << good.size();
        EXPECT_THAT(file.message(), ::testing::HasSubstr("cut.exr"));
        EXPECT_THAT(file.message(), ::testing::Not(::testing::HasSubstr("\n"))) << "one sentence";
    }
}

TEST(Exr, AHeaderThatPromisesTooMuchIsRefusedBeforeItsMemoryIsTaken) {
    const fs::path folder = test::scratchDir("exr-bomb");
    ASSERT_TRUE(
        writeExr(folder / "good.exr", std::vector<ImageLayer>{{"", Image(16, 16, 3)}}).ok());
    std::string bomb = readFile(folder / "good.exr").value();
    // An attribute is its name, its type, a 4-byte size and its value: the box (0,0)-(15,15) becomes (0,0)-(16383,16383).
    for (const char* window : {"dataWindow", "displayWindow"}) {
        const size_t value = bomb.find(std::string(window) + '\0' + "box2i") +
                             std::string(window).size() + 1 + 6 + 4;
        for (size_t corner : {value + 8, value + 12}) {
            bomb[corner] = char(0xff);
            bomb[corner + 1] = char(0x3f);
        }
    }
    bomb.append(16384, 0); // room for the table of line offsets that the header announces
    ASSERT_TRUE(writeFileAtomically(folder / "bomb.exr", bomb).ok());
    const Result<ExrFile> file = readExr(folder / "bomb.exr");
    ASSERT_FALSE(file.ok());
    EXPECT_THAT(file.message(), ::testing::HasSubstr("16384x16384"));
}

TEST(Exr, LayersOfDifferentSizesAreAProgrammersError) {
    const fs::path path = test::scratchDir("exr-check") / "a.exr";
    EXPECT_THROW(
        (void)writeExr(path, std::vector<ImageLayer>{{"", Image(2, 2, 3)}, {"LE", Image(2, 3, 3)}}),
        CheckFailure);
    EXPECT_THROW((void)writeExr(path, {}), CheckFailure);
    EXPECT_FALSE(fs::exists(path));
}

} // namespace
} // namespace tyndall
