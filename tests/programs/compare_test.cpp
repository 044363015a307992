// `tyndall compare` as scripts rely on it: metrics, limits, JSON, heat maps, refusals.

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/image.h"
#include "core/tone_curve.h"
#include "programs/process.h"
#include "programs/scenes.h"
#include "support/content.h"
#include "support/images.h"

namespace tyndall::test {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

Image plain(float r, float g, float b) { return test::uniformImage(16, 12, r, g, b); }

struct CompareTest : ::testing::Test {
    ProcessOptions options;
    void SetUp() override {
        options.folder = scratchDir("compare");
        // The values worked out by hand in tests/unit/image_metrics_test.cpp: r = (1,2,3), m = 2.
        write("a.exr", {{"", plain(2, 2, 1)}, {"LE", plain(1, 1, 0)}, {"LSE", plain(1, 0, 0.5f)}});
        write("b.exr", {{"", plain(1, 2, 3)}, {"LE", plain(1, 1, 1)}, {"LSE", plain(0, 1, 1)}});
    }
    void write(const std::string& name, const std::vector<ImageLayer>& layers,
               const ImageMetadata& metadata = {}) const {
        ASSERT_TRUE(writeExr(options.folder / name, layers, metadata).ok());
    }
    ProcessResult compare(std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), "compare");
        return tyndall(arguments, options);
    }
    /// The JSON of a comparison that succeeds.
    json report(std::vector<std::string> arguments) {
        for (const char* more : {"--json", "r.json", "--quiet"}) arguments.emplace_back(more);
        const ProcessResult result = compare(arguments);
        EXPECT_EQ(result.status, 0) << result.err;
        EXPECT_EQ(result.out + result.err, "") << "quiet is quiet";
        return json::parse(readFile(options.folder / "r.json").value());
    }
    /// 32x24 pixels whose averages of 2x2 are those of a.exr.
    void writeTwiceAsLarge(const std::string& name) const {
        Image large(32, 24, 3);
        for (int y = 0; y < 24; ++y)
            for (int x = 0; x < 32; ++x)
                for (int c = 0; c < 3; ++c)
                    large.at(x, y)[c] = float((c == 2 ? 1 : 2) * (x % 2 + 2 * (y % 2)) / 1.5);
        write(name, {{"", large}});
    }
    void expectRefused(const std::vector<std::string>& arguments, const std::string& sentence) {
        const ProcessResult result = compare(arguments);
        EXPECT_EQ(result.status, 2) << sentence << ": " << result.err;
        EXPECT_THAT(result.err, AllOf(StartsWith("tyndall: "), HasSubstr(sentence)));
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
        EXPECT_EQ(result.out, "");
    }
};

TEST_F(CompareTest, MetricsHaveTheValuesWorkedOutByHand) {
    const json m = report({"a.exr", "b.exr"}).at("metrics");
    const double s = 0.5 / 1.8596; // mean luminance of the reference
    const std::map<std::string, double> expected = {
        {"rmse", std::sqrt(5.0 / 3)},
        {"relmse", (1 / 1.04 + 4 / 9.04) / 3},
        {"relmse_trimmed", (1 / 1.04 + 4 / 9.04) / 3},
        {"mrse", (std::pow(s / (s + 0.01), 2) + std::pow(2 * s / (3 * s + 0.01), 2)) / 3},
        {"smape", (2 / 3.02 + 4 / 4.02) / 3},
        {"p999", 1 / 1.2},
        {"energy", 5.0 / 6},
        {"energy_r", 2},
        {"energy_g", 1},
        {"energy_b", 1.0 / 3}};
    for (const auto& [name, value] : expected)
        EXPECT_NEAR(m.at(name).get<double>(), value, 1e-9) << name;
    for (const char* name : {"psnr", "ssim", "flip"}) EXPECT_TRUE(m.at(name).is_number()) << name;
    EXPECT_TRUE(m.at("reference_floor").is_null());
}

TEST_F(CompareTest, AveragesOfALargerImageAreCompared) {
    writeTwiceAsLarge("large.exr");
    const json m = report({"large.exr", "b.exr", "--reduce"}).at("metrics");
    EXPECT_NEAR(m.at("relmse").get<double>(), (1 / 1.04 + 4 / 9.04) / 3, 1e-6);
    EXPECT_NEAR(m.at("energy").get<double>(), 5.0 / 6, 1e-6);
    EXPECT_EQ(report({"a.exr", "b.exr", "--reduce"}).at("metrics").at("rmse"),
              report({"a.exr", "b.exr"}).at("metrics").at("rmse"));
    expectRefused({"large.exr", "b.exr"}, "they must be of one size");
    expectRefused({"b.exr", "large.exr", "--reduce"}, "no multiple of the 32x24");
    write("odd.exr", {{"", Image(32, 12, 3)}});
    expectRefused({"odd.exr", "b.exr", "--reduce"}, "no multiple of the 16x12");
}

TEST_F(CompareTest, ItPrintsEveryMetricOfTheInterfaceInATable) {
    const ProcessResult result = compare({"a.exr", "b.exr"});
    ASSERT_EQ(result.status, 0) << result.err;
    for (const char* name : {"nonfinite", "negative", "rmse", "relmse", "relmse_trimmed", "mrse",
                             "smape", "p999", "energy", "psnr", "ssim", "flip", "reference_floor"})
        EXPECT_THAT(result.out,
                    HasSubstr(std::string("\n  ") +
                              (std::string_view(name) == "reference_floor" ? "no " : "") + name));
    EXPECT_THAT(result.out, AllOf(StartsWith("a.exr against b.exr: the picture in 16x12 pixels"),
                                  HasSubstr("relmse           0.468005"),
                                  HasSubstr("'b.exr' has no layer 'variance'")));
}

TEST_F(CompareTest, AnImageEqualsItself) {
    const json r = report({"a.exr", "a.exr", "--max-relmse", "0", "--min-psnr", "200",
                           "--max-energy-error", "0", "--max-flip", "0", "--min-ssim", "1"});
    EXPECT_EQ(r.at("metrics").at("relmse"), 0.0);
    EXPECT_EQ(r.at("metrics").at("flip"), 0.0);
    EXPECT_TRUE(r.at("metrics").at("psnr").is_null());
    EXPECT_EQ(r.at("without_value").at("psnr"), "infinite");
    EXPECT_EQ(r.at("passed"), true);
}

TEST_F(CompareTest, EachLimitThatIsNotKeptIsNamedWithItsValueAndFailsWithStatusOne) {
    const struct {
        const char* option;
        const char* tight;
        const char* loose;
        const char* value; // as the sentence tells it
    } cases[] = {
        {"--max-rmse", "1.29", "1.2910", "rmse of 'a.exr' against 'b.exr' is 1.29099"},
        {"--max-relmse", "0.468", "0.469", "is 0.468005"},
        {"--max-relmse-trimmed", "0.468", "0.469", "relmse_trimmed"},
        {"--max-mrse", "0.4", "0.5", "mrse"},
        {"--max-smape", "0.5", "0.6", "smape"},
        {"--max-p999", "0.83", "0.84", "p999 of 'a.exr' against 'b.exr' is 0.833333"},
        {"--max-energy-error", "0.16", "0.17", "is 0.833333 and should be 1 to within 0.16"},
        {"--min-psnr", "90", "1", "psnr"},
        {"--min-ssim", "0.999999", "0", "ssim"},
        {"--max-flip", "0.001", "1", "flip"}};
    for (const auto& c : cases) {
        const ProcessResult tight = compare({"a.exr", "b.exr", "--quiet", c.option, c.tight});
        EXPECT_EQ(tight.status, 1) << c.option;
        EXPECT_THAT(tight.err,
                    AllOf(HasSubstr(std::string(c.option) + " " + c.tight), HasSubstr(c.value)));
        EXPECT_EQ(compare({"a.exr", "b.exr", "--quiet", c.option, c.loose}).status, 0) << c.option;
    }
    const ProcessResult both =
        compare({"a.exr", "b.exr", "--max-rmse", "0", "--max-relmse", "0", "--json", "r.json"});
    EXPECT_EQ(both.status, 1);
    EXPECT_THAT(both.err, AllOf(HasSubstr("--max-rmse 0"), HasSubstr("--max-relmse 0")));
    const json r = json::parse(readFile(options.folder / "r.json").value());
    EXPECT_EQ(r.at("passed"), false);
    EXPECT_EQ(r.at("thresholds").size(), 2u);
    EXPECT_EQ(r.at("thresholds").at(0).at("met"), false);
}

TEST_F(CompareTest, TermsAreSummedOnBothSides) {
    // A: LE + LSE = (2, 1, 0.5), B: (1, 2, 2).
    const json r = report({"a.exr", "b.exr", "--terms", "LSE,LE"});
    EXPECT_EQ(r.at("compared"), "LE + LSE");
    EXPECT_NEAR(r.at("metrics").at("energy_r").get<double>(), 2, 1e-9);
    EXPECT_NEAR(r.at("metrics").at("energy").get<double>(), 3.5 / 5, 1e-9);
    EXPECT_NEAR(report({"a.exr", "b.exr", "--terms", "LE"}).at("metrics").at("rmse").get<double>(),
                std::sqrt(1.0 / 3), 1e-9);
}

TEST_F(CompareTest, TermsThatLieInOneLayerAreComparedTogether) {
    write("both.exr",
          {{"", plain(1, 1, 1)}, {"LVE", plain(1, 1, 1)}, {"LVVE+LXVVE", plain(2, 2, 2)}});
    write("apart.exr", {{"beauty", plain(1, 1, 1)},
                        {"LVE", plain(1, 1, 1)},
                        {"LVVE", plain(1, 1, 1)},
                        {"LXVVE", plain(1, 1, 1)}});
    const json r = report({"both.exr", "apart.exr", "--terms", "LVE,LVVE,LXVVE"});
    EXPECT_EQ(r.at("metrics").at("rmse"), 0.0);
    EXPECT_EQ(report({"both.exr", "apart.exr"}).at("metrics").at("rmse"), 0.0)
        << "a layer 'beauty' is the picture too";
    expectRefused({"both.exr", "apart.exr", "--terms", "LVVE"}, "compare LVVE,LXVVE together");
}

TEST_F(CompareTest, WhatIsNotInAFileIsNamedTogetherWithWhatIs) {
    write("bare.exr", {{"", plain(1, 1, 1)}});
    expectRefused({"a.exr", "b.exr", "--terms", "LE,LVE"},
                  "'a.exr' has no layer 'LVE': there are the picture, LE, LSE");
    expectRefused({"a.exr", "b.exr", "--terms", "LE,LVE,LVVE"},
                  "has no layer 'LVE', 'LVVE': there");
    expectRefused({"a.exr", "bare.exr", "--terms", "LE"}, "'bare.exr' has no layer 'LE'");
    expectRefused({"a.exr", "b.exr", "--layer", "depth"}, "'a.exr' has no layer 'depth'");
    write("nothing.exr", {{"LE", plain(1, 1, 1)}});
    expectRefused({"a.exr", "nothing.exr"}, "'nothing.exr' has no picture");
}

TEST_F(CompareTest, ALayerOfItsOwnIsComparedAndWhatIsNoLightHasNoLook) {
    Image depth(16, 12, 1), other(16, 12, 1);
    std::fill(depth.pixels.begin(), depth.pixels.end(), 2.0f);
    std::fill(other.pixels.begin(), other.pixels.end(), 1.0f);
    write("c.exr", {{"", plain(1, 1, 1)}, {"depth", depth}, {"normal", plain(0, -1, 0)}});
    write("d.exr", {{"", plain(1, 1, 1)}, {"depth", other}, {"normal", plain(0, -1, 0)}});
    const json r = report({"c.exr", "d.exr", "--layer", "depth"});
    EXPECT_NEAR(r.at("metrics").at("rmse").get<double>(), 1, 1e-9);
    EXPECT_TRUE(r.at("metrics").at("flip").is_null());
    EXPECT_THAT(r.at("without_value").at("flip").get<std::string>(), HasSubstr("is not light"));
    EXPECT_EQ(report({"c.exr", "d.exr", "--layer", "normal"}).at("metrics").at("rmse"), 0.0)
        << "a normal may be negative";
    expectRefused({"c.exr", "d.exr", "--layer", "depth", "--max-flip", "1"}, "--max-flip");
    expectRefused(
        {"c.exr", "d.exr", "--layer", "depth", "--heatmap", "h.png", "--heatmap-metric", "flip"},
        "is not light");
}

TEST_F(CompareTest, InvalidValuesFailWithTheirPlaceAndTheRestIsStillWritten) {
    Image image = plain(1, 1, 1);
    image.at(3, 5)[1] = NAN;
    image.at(4, 5)[0] = INFINITY;
    image.at(9, 9)[2] = -1;
    write("c.exr", {{"", image}});
    const ProcessResult result =
        compare({"c.exr", "b.exr", "--json", "r.json", "--heatmap", "h.png", "--max-relmse", "9"});
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.err, AllOf(HasSubstr("'c.exr': 2 values are not finite and 1 are negative"),
                                  HasSubstr("nan at pixel (3, 5), channel G")));
    const json r = json::parse(readFile(options.folder / "r.json").value());
    EXPECT_EQ(r.at("counts").at("image").at("nonfinite"), 2);
    EXPECT_EQ(r.at("counts").at("image").at("negative"), 1);
    EXPECT_EQ(r.at("counts").at("reference").at("nonfinite"), 0);
    EXPECT_TRUE(r.at("metrics").at("relmse").is_null());
    EXPECT_EQ(r.at("passed"), false);
    const Image map = readPng(options.folder / "h.png").value();
    EXPECT_EQ((std::vector<float>(map.at(3, 5), map.at(3, 5) + 3)), (std::vector<float>{0, 1, 0}));
    EXPECT_NE(*map.at(0, 0), 0.0f);
}

TEST_F(CompareTest, NegativeLightFailsButIsMeasured) {
    Image image = plain(1, 2, 3);
    image.at(0, 0)[0] = -0.5f;
    write("c.exr", {{"", image}});
    const ProcessResult result = compare({"b.exr", "c.exr", "--json", "r.json", "--quiet"});
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(
        result.err,
        HasSubstr(
            "'c.exr': 0 values are not finite and 1 are negative, the first is -0.5 at pixel (0, 0), channel R"));
    EXPECT_TRUE(json::parse(readFile(options.folder / "r.json").value())
                    .at("metrics")
                    .at("relmse")
                    .is_number());
}

TEST_F(CompareTest, TheFloorIsThatOfTheReferencesVariance) {
    write("c.exr", {{"", plain(1, 2, 3)}, {"variance", plain(0.104f, 0, 0.904f)}});
    const json m = report({"a.exr", "c.exr"}).at("metrics");
    EXPECT_NEAR(m.at("reference_floor").get<double>(), (0.1 + 0 + 0.1) / 3, 1e-7)
        << "mean(var / (r² + 0.04)); the layers are floats";
    write("d.exr", {{"", plain(1, 2, 3)}, {"variance", plain(-1, 0, 0)}});
    const json r = report({"a.exr", "d.exr"});
    EXPECT_THAT(r.at("without_value").at("reference_floor").get<std::string>(),
                AllOf(HasSubstr("'d.exr'"), HasSubstr("negative")));
}

TEST_F(CompareTest, TheExposureComesFromTheCommandLineElseFromTheReferenceElseFromTheImage) {
    write("five.exr", {{"", plain(20, 20, 20)}}, {{"tyndall.ev100", "5"}});
    write("three.exr", {{"", plain(30, 30, 30)}}, {{"tyndall.ev100", "3"}});
    write("none.exr", {{"", plain(10, 10, 10)}});
    EXPECT_EQ(report({"five.exr", "three.exr"}).at("ev100"), 3.0);
    EXPECT_EQ(report({"five.exr", "none.exr"}).at("ev100"), 5.0);
    EXPECT_EQ(report({"none.exr", "none.exr"}).at("ev100"), 0.0);
    const json r = report({"five.exr", "three.exr", "--ev100", "6", "--tone-curve", "linear"});
    EXPECT_EQ(r.at("ev100"), 6.0);
    EXPECT_EQ(r.at("tone_curve"), "linear");
    // 20 and 30 of 76.8 nits, sRGB-encoded (IEC 61966-2-1); both grey, so that the peak signal-to-noise ratio follows.
    const auto encoded = [](double v) { return 1.055 * std::pow(v, 1 / 2.4) - 0.055; };
    EXPECT_NEAR(r.at("metrics").at("psnr").get<double>(),
                -20 * std::log10(encoded(30 / 76.8) - encoded(20 / 76.8)), 1e-4);
}

TEST_F(CompareTest, CaptureWritesTheExposureThatItsPngHas) {
    const fs::path scene = writeFoggyScene(options.folder);
    json exposed = json::parse(readFile(scene).value());
    exposed["exposure"]["ev100"] = 4;
    ASSERT_TRUE(writeFileAtomically(scene, exposed.dump()).ok());
    ASSERT_EQ(tyndall({"capture", scene.filename().string(), "-o", "s.exr", "--size", "24x16",
                       "--quiet", "--set", "post.exposureCompensation=1.5"},
                      options)
                  .status,
              0);
    EXPECT_EQ(readExr(options.folder / "s.exr")->metadata.at("tyndall.ev100"), "2.5");
    EXPECT_EQ(report({"s.exr", "s.exr"}).at("ev100"), 2.5);
}

TEST_F(CompareTest, ItsDisplayIsTheOneOfCapture) {
    // The same frame as light and as a picture: brought to a display here, it is the picture but for its 8 bits.
    const std::string scene = writeFoggyScene(options.folder).filename().string();
    for (const char* name : {"s.exr", "s.png"})
        ASSERT_EQ(tyndall({"capture", scene, "-o", name, "--size", "32x24", "--quiet", "--set",
                           "post.dither=false", "--set", "post.exposureCompensation=2"},
                          options)
                      .status,
                  0);
    const ExrFile file = readExr(options.folder / "s.exr").value();
    const Image shown = displayImage(
        file.layers.front().image, std::stod(file.metadata.at("tyndall.ev100")), kDefaultToneCurve);
    const Image png = readPng(options.folder / "s.png").value();
    float brightest = 0;
    for (size_t i = 0; i < png.pixels.size(); ++i) {
        // Half a step of 8 bits, and a tenth of one for the shader's floats.
        ASSERT_NEAR(shown.pixels[i], png.pixels[i], 0.6f / 255) << "value " << i;
        brightest = std::max(brightest, png.pixels[i]);
    }
    EXPECT_GT(brightest, 0.1f) << "something can be seen";
}

TEST_F(CompareTest, FilesThatHaveOtherTermsGetANote) {
    write("c.exr", {{"", plain(1, 1, 1)}}, {{"tyndall.terms", "LE,LSE"}});
    write("d.exr", {{"", plain(1, 1, 1)}}, {{"tyndall.terms", "LE,LSE,LVE"}});
    EXPECT_THAT(compare({"c.exr", "d.exr"}).out,
                HasSubstr("note: 'c.exr' has the terms LE,LSE and"));
    EXPECT_THAT(compare({"c.exr", "c.exr"}).out, Not(HasSubstr("note:")));
}

TEST_F(CompareTest, HeatMapsShowWhereAndInWhichDirection) {
    Image image = plain(1, 1, 1);
    for (int c = 0; c < 3; ++c) {
        image.at(2, 3)[c] = 2;     // brighter
        image.at(10, 8)[c] = 0.1f; // darker
    }
    write("c.exr", {{"", image}});
    write("d.exr", {{"", plain(1, 1, 1)}});
    const auto map = [&](std::vector<std::string> more) {
        more.insert(more.begin(), {"c.exr", "d.exr", "--heatmap", "h.png"});
        const ProcessResult result = compare(more);
        EXPECT_EQ(result.status, 0) << result.err;
        EXPECT_THAT(result.err, HasSubstr("wrote h.png"));
        return readPng(options.folder / "h.png").value();
    };
    const auto sum = [](const float* rgb) { return rgb[0] + rgb[1] + rgb[2]; };
    const Image relative = map({});
    EXPECT_EQ(relative.width, 16);
    EXPECT_EQ(relative.height, 12);
    EXPECT_LT(sum(relative.at(0, 0)), 0.05f);
    EXPECT_GT(sum(relative.at(2, 3)), 1.5f);
    EXPECT_GT(sum(relative.at(2, 3)), sum(relative.at(10, 8)));
    EXPECT_GT(sum(map({"--heatmap-max", "0.1"}).at(10, 8)), sum(relative.at(10, 8)));
    const Image sign = map({"--heatmap-metric", "signed"});
    EXPECT_GT(sign.at(2, 3)[0], sign.at(2, 3)[2] + 0.3f) << "brighter is red";
    EXPECT_GT(sign.at(10, 8)[2], sign.at(10, 8)[0] + 0.3f) << "darker is blue";
    EXPECT_GT(sum(sign.at(0, 0)), 2.8f);
    const Image flip = map({"--heatmap-metric", "flip"});
    EXPECT_GT(sum(flip.at(3, 3)), sum(flip.at(15, 0))) << "the eye blurs: neighbours differ too";
}

TEST_F(CompareTest, TwoPngsAreComparedAsTheyAre) {
    std::vector<uint8_t> one(16 * 12 * 3, 128), other(16 * 12 * 3, 138);
    ASSERT_TRUE(writePng(options.folder / "a.png", 16, 12, 3, one).ok());
    ASSERT_TRUE(writePng(options.folder / "b.png", 16, 12, 3, other).ok());
    const json r = report({"a.png", "b.png", "--heatmap", "h.png"});
    EXPECT_NEAR(r.at("metrics").at("psnr").get<double>(), 20 * std::log10(255.0 / 10), 1e-4);
    for (const char* name : {"ssim", "flip"}) EXPECT_TRUE(r.at("metrics").at(name).is_number());
    EXPECT_TRUE(r.at("metrics").at("relmse").is_null());
    EXPECT_THAT(r.at("without_value").at("relmse").get<std::string>(), HasSubstr(".exr"));
    EXPECT_TRUE(fs::exists(options.folder / "h.png"));
    EXPECT_EQ(compare({"a.png", "b.png", "--min-psnr", "40", "--quiet"}).status, 1);
    expectRefused({"a.png", "b.png", "--max-relmse", "1"}, "--max-relmse: relmse cannot be told");
    expectRefused({"a.png", "b.png", "--terms", "LE"}, "'a.png' has no layers");
    expectRefused({"a.png", "b.png", "--heatmap", "h.png", "--heatmap-metric", "relative"},
                  "it takes flip");
    expectRefused({"a.png", "b.exr"}, "'a.png' is a PNG and 'b.exr' is not");
    expectRefused({"b.exr", "a.png"}, "'a.png' is a PNG and 'b.exr' is not");
}

TEST_F(CompareTest, RadiancePicturesAreLinear) {
    // 8×1 pixels of (1, 2, 3): mantissas over 256, exponent 2^2 (byte 130).
    std::string hdr = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n";
    for (int i = 0; i < 2; ++i) hdr += {char(64), char(128), char(192), char(130)};
    ASSERT_TRUE(writeFileAtomically(options.folder / "c.hdr", hdr).ok());
    Image twice(2, 1, 3);
    twice.pixels = {2, 4, 6, 2, 4, 6};
    write("d.exr", {{"", twice}});
    EXPECT_NEAR(report({"d.exr", "c.hdr"}).at("metrics").at("energy").get<double>(), 2, 1e-9);
    expectRefused({"d.exr", "c.hdr", "--min-ssim", "0.5"}, "11x11");
}

TEST_F(CompareTest, WhatCannotBeComparedIsRefusedWithASentence) {
    write("small.exr", {{"", Image(8, 6, 3)}});
    write("grey.exr", {{"", Image(16, 12, 1)}});
    expectRefused({"a.exr", "small.exr"}, "'a.exr' is 16x12 pixels and 'small.exr' 8x6");
    expectRefused({"grey.exr", "a.exr"}, "'grey.exr' has 1 colour channels");
    expectRefused({"a.exr", "none.exr"}, "none.exr");
    expectRefused({"a.exr", "b.jpg"}, "'b.jpg' cannot be compared");
    expectRefused({"a.exr", "b.exr", "--terms", "LSF"}, "LSF");
    expectRefused({"a.exr", "b.exr", "--tone-curve", "filmic"}, "agx");
    expectRefused({"a.exr", "b.exr", "--heatmap", "h.jpg"}, "must end in .png");
    expectRefused({"a.exr", "b.exr", "--heatmap", "h.png", "--heatmap-metric", "ssim"}, "relative");
    expectRefused({"a.exr", "b.exr", "--heatmap-metric", "flip"}, "--heatmap FILE.png");
    expectRefused({"a.exr", "b.exr", "--json", "no/such/r.json"}, "no folder 'no/such'");
    expectRefused({"a.exr", "b.exr", "--max-relmse", "little"}, "--max-relmse");
    ASSERT_TRUE(writeFileAtomically(options.folder / "bad.exr", "not an image").ok());
    expectRefused({"bad.exr", "b.exr"}, "bad.exr");
    ASSERT_TRUE(writeFileAtomically(options.folder / "bad.png", "not an image").ok());
    expectRefused({"bad.png", "bad.png"}, "bad.png");
}

TEST_F(CompareTest, AnOutputThatCannotBeWrittenFailsWithStatusOne) {
    const ProcessResult result = compare({"a.exr", "b.exr", "--json", "/dev/full", "--quiet"});
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.err, HasSubstr("No space left"));
}

} // namespace
} // namespace tyndall::test
