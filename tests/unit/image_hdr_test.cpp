#include "core/image.h"

#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/content.h"

namespace tyndall {
namespace {
namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string header(int width, int height, const std::string& extra = "") {
    return "#?RADIANCE\n# a comment\nFORMAT=32-bit_rle_rgbe\n" + extra + "\n-Y " +
           std::to_string(height) + " +X " + std::to_string(width) + "\n";
}

struct HdrTest : ::testing::Test {
    fs::path folder = test::scratchDir("hdr");
    Result<Image> read(const std::string& content, const std::string& name = "a.hdr") {
        EXPECT_TRUE(writeFileAtomically(folder / name, content).ok());
        return readHdr(folder / name);
    }
};

TEST_F(HdrTest, PlainPixelsAreMantissaTimesTwoToTheExponentMinus136) {
    // Radiance manual: component = mantissa/256 · 2^(exponent-128); exponent 0 is black.
    const Result<Image> image = read(header(2, 2) + std::string("\x80\x40\x20\x81"
                                                                "\xff\x01\x02\x80"
                                                                "\x10\x20\x30\x00"
                                                                "\x01\x00\x00\x90",
                                                                16));
    ASSERT_TRUE(image.ok()) << image.message();
    EXPECT_THAT(image->pixels, ElementsAre(1.0f, 0.5f, 0.25f, 255 / 256.0f, 1 / 256.0f, 2 / 256.0f,
                                           0, 0, 0, 256.0f, 0, 0));
}

TEST_F(HdrTest, OldRepeatsAndNewRunsUnfold) {
    const Result<Image> old = read(header(5, 1) + std::string("\x80\x80\x80\x81"
                                                              "\x01\x01\x01\x04",
                                                              8));
    ASSERT_TRUE(old.ok()) << old.message();
    EXPECT_THAT(old->pixels, ::testing::Each(1.0f));

    std::string line = std::string("\x02\x02\x00\x08", 4);
    line += std::string("\x88\x80", 2);                             // red: a run of eight
    line += std::string("\x08\x00\x10\x20\x30\x40\x50\x60\x70", 9); // green: eight literals
    line += std::string("\x84\x00\x84\x80", 4);                     // blue: two runs
    line += std::string("\x88\x81", 2);                             // exponent
    const Result<Image> runs = read(header(8, 1) + line);
    ASSERT_TRUE(runs.ok()) << runs.message();
    for (int x = 0; x < 8; ++x)
        EXPECT_THAT(std::vector<float>(runs->at(x, 0), runs->at(x, 0) + 3),
                    ElementsAre(1.0f, float(x) / 8.0f, x < 4 ? 0.0f : 1.0f));
}

TEST_F(HdrTest, ExposureIsDividedOut) {
    const Result<Image> image =
        read(header(1, 1, "EXPOSURE=2\nEXPOSURE= 4.0\n") + std::string("\x80\x40\x20\x81", 4));
    ASSERT_TRUE(image.ok()) << image.message();
    EXPECT_THAT(image->pixels, ElementsAre(0.125f, 0.0625f, 0.03125f));
}

TEST_F(HdrTest, DamageIsRefusedWithASentenceThatNamesTheFile) {
    const std::string pixel("\x80\x40\x20\x81", 4);
    for (const std::string& bad :
         {std::string(), std::string("hello"), std::string("#?RADIANCE\n"), header(2, 1) + pixel,
          header(0, 1), header(-4, 1), header(70000, 70000) + pixel, header(60000, 60000) + pixel,
          header(2, 1) + std::string("\x01\x01\x01\x02", 4) + pixel,
          header(8, 1) + std::string("\x02\x02\x00\x08\x89\x80", 6),
          header(8, 1) + std::string("\x02\x02\x00\x08\x80\x80", 6),
          std::string("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n") + pixel}) {
        const Result<Image> image = read(bad);
        ASSERT_FALSE(image.ok()) << bad;
        EXPECT_THAT(image.message(), HasSubstr("a.hdr"));
    }
    EXPECT_FALSE(readHdr(folder / "missing.hdr").ok());
    EXPECT_THAT(readHdr(folder / "a.png").message(), HasSubstr(".hdr or .exr"));
}

TEST_F(HdrTest, FlippedBitsNeverCrashAndNeverYieldNonFiniteLight) {
    std::string good = header(64, 8);
    std::mt19937_64 random(test::seed());
    for (int i = 0; i < 64 * 8 * 4; ++i) good += char(random());
    for (int i = 0; i < 500; ++i) {
        std::string bad = good;
        bad[random() % (i % 2 ? 80 : bad.size())] ^= char(1 << (random() % 8));
        const Result<Image> image = read(bad);
        if (!image.ok()) continue;
        for (float value : image->pixels)
            ASSERT_TRUE(std::isfinite(value) && value >= 0)
                << "seed " << test::seed() << " case " << i;
    }
}

TEST_F(HdrTest, ExrMapsLoseNothingButWhatIsNoLight) {
    Image map(2, 1, 3);
    map.pixels = {1, 2, INFINITY, -3, NAN, 0.5f};
    ASSERT_TRUE(
        writeExr(folder / "map.exr", std::vector<ImageLayer>{{"other", Image(2, 1, 3)}, {"", map}})
            .ok());
    const Result<Image> image = readHdr(folder / "map.exr");
    ASSERT_TRUE(image.ok()) << image.message();
    EXPECT_THAT(image->pixels, ElementsAre(1, 2, 65504, 0, 0, 0.5f));
}

TEST_F(HdrTest, TheSharedEnvironmentMapReads) {
    const auto hdr = REQUIRE_CONTENT("hdr");
    int maps = 0;
    for (const auto& entry : fs::directory_iterator(hdr)) {
        if (entry.path().extension() != ".hdr" && entry.path().extension() != ".exr") continue;
        const Result<Image> image = readHdr(entry.path());
        ASSERT_TRUE(image.ok()) << image.message();
        EXPECT_EQ(image->width, 2 * image->height)
            << "latitude-longitude maps are twice as wide as high";
        ++maps;
    }
    EXPECT_GT(maps, 0);
}

} // namespace
} // namespace tyndall
