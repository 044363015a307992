// `tyndall capture` as scripts rely on it: pictures, layers, sequences, reports, thresholds, interruption.

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iomanip>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/image.h"
#include "core/image_metrics.h"
#include "media/particles.h"
#include "programs/process.h"
#include "programs/scenes.h"
#include "support/content.h"

namespace tyndall::test {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;

struct CaptureTest : ::testing::Test {
    ProcessOptions options;
    std::string foggy, clear;
    void SetUp() override {
        options.folder = scratchDir("capture");
        foggy = writeFoggyScene(options.folder).filename().string();
        clear = writeClearScene(options.folder).filename().string();
    }
    ProcessResult capture(std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), "capture");
        return tyndall(arguments, options);
    }
    [[nodiscard]] std::string content(const std::string& name) const {
        return readFile(options.folder / name).value();
    }
    [[nodiscard]] ExrFile exr(const std::string& name) const {
        return readExr(options.folder / name).value();
    }
    [[nodiscard]] size_t fileCount() const {
        return size_t(
            std::distance(fs::directory_iterator(options.folder), fs::directory_iterator()));
    }
};

TEST_F(CaptureTest, TheReportHasEveryFieldOfTheInterface) {
    const ProcessResult result = capture({foggy, "-o", "a.exr", "--size", "64x48", "--frames", "4",
                                          "--report", "r.json", "--seed", "3"});
    ASSERT_EQ(result.status, 0) << result.err;
    const json report = json::parse(content("r.json"));
    EXPECT_EQ(report.at("scene"), foggy);
    EXPECT_EQ(report.at("size"), json::array({64, 48}));
    EXPECT_EQ(report.at("frames"), 4);
    EXPECT_THAT((std::vector<std::string>{"egl-device", "egl-surfaceless", "osmesa"}),
                ::testing::Contains(report.at("backend").get<std::string>()));
    for (const char* key : {"vendor", "renderer", "version"})
        EXPECT_NE(report.at("gl").at(key).get<std::string>(), "");
    EXPECT_TRUE(report.at("technique").is_string());
    EXPECT_NE(report.at("why").get<std::string>(), "");
    EXPECT_THAT(report.at("claims").get<std::vector<std::string>>(),
                ::testing::IsSupersetOf({"LE", "LSE", "LVE"}));
    EXPECT_TRUE(report.at("missing").is_array());
    EXPECT_GT(report.at("frame_ms").at("median").get<double>(), 0);
    EXPECT_GE(report.at("frame_ms").at("p95").get<double>(),
              report.at("frame_ms").at("median").get<double>());
    EXPECT_GT(report.at("startup_ms").get<double>(), 0);
    EXPECT_GT(report.at("gpu_bytes").get<uint64_t>(), 64u * 48 * 16);
    EXPECT_GT(report.at("peak_rss_bytes").get<uint64_t>(), 1u << 20);
    for (const char* key : {"nonfinite", "negative", "gl_errors", "gl_objects_leaked"})
        EXPECT_EQ(report.at("counters").at(key), 0) << key;
    EXPECT_TRUE(report.at("iterations").is_object());
    EXPECT_TRUE(report.at("residual").is_object());
}

TEST_F(CaptureTest, EveryPassOfTheReportRanWithATimeOrSaysWhyNot) {
    ASSERT_EQ(
        capture({clear, "-o", "a.exr", "--size", "64x48", "--frames", "6", "--report", "r.json"})
            .status,
        0);
    const json report = json::parse(content("r.json"));
    int ran = 0, skippedMedia = 0;
    for (const json& pass : report.at("passes")) {
        const auto name = pass.at("name").get<std::string>(),
                   status = pass.at("status").get<std::string>();
        if (status == "ran") {
            ++ran;
            EXPECT_GE(pass.at("cpu_ms").get<double>(), 0) << name;
            EXPECT_TRUE(pass.at("gpu_ms").is_number())
                << name << ": after six frames there is a measurement";
        } else {
            EXPECT_THAT((std::vector<std::string>{"skipped", "cached", "culled"}),
                        ::testing::Contains(status))
                << name;
            EXPECT_NE(pass.at("reason").get<std::string>(), "") << name;
            EXPECT_TRUE(pass.contains("saved_ms")) << name;
            skippedMedia += status == "skipped" && name.starts_with("media.");
        }
        EXPECT_FALSE(name.starts_with("media.") && status == "ran")
            << name << " in a scene without media";
    }
    EXPECT_GT(ran, 0);
    EXPECT_GT(skippedMedia, 0) << report.at("passes");
}

TEST_F(CaptureTest, TheTraceIsALoadableListOfEvents) {
    ASSERT_EQ(
        capture({foggy, "-o", "a.png", "--size", "32x32", "--frames", "3", "--trace", "t.json"})
            .status,
        0);
    const json trace = json::parse(content("t.json"));
    std::vector<std::string> names;
    for (const json& event : trace.at("traceEvents")) {
        names.push_back(event.at("name"));
        if (event.at("ph") != "X") continue;
        EXPECT_GE(event.at("ts").get<double>(), 0);
        EXPECT_GE(event.at("dur").get<double>(), 0);
    }
    EXPECT_THAT(names, ::testing::IsSupersetOf({"scene.load", "context.create", "renderer.create",
                                                "frame 0", "frame 2"}));
}

TEST_F(CaptureTest, LayersCarryTermsThatAddUpToTheBeauty) {
    ASSERT_EQ(capture({foggy, "-o", "a.exr", "--size", "48x40", "--gi", "none", "--aov",
                       "terms,depth,normal,albedo,transmittance", "--seed", "9"})
                  .status,
              0);
    const ExrFile file = exr("a.exr");
    std::map<std::string, Image> layers;
    for (const ImageLayer& layer : file.layers) layers[layer.name] = layer.image;
    for (const char* name : {"", "LE", "LSE", "LVE", "depth", "normal", "albedo", "transmittance"})
        ASSERT_TRUE(layers.contains(name)) << name;
    EXPECT_EQ(layers["depth"].channels, 1);
    EXPECT_EQ(layers["transmittance"].channels, 3);
    const Image& beauty = layers[""];
    EXPECT_EQ(beauty.width, 48);
    EXPECT_EQ(beauty.height, 40);
    double lit = 0;
    for (size_t i = 0; i < beauty.pixels.size(); ++i) {
        const float sum =
            layers["LE"].pixels[i] + layers["LSE"].pixels[i] + layers["LVE"].pixels[i];
        ASSERT_NEAR(beauty.pixels[i], sum, 1e-5f * std::abs(sum) + 1e-7f) << "pixel value " << i;
        lit += double(layers["LVE"].pixels[i]);
    }
    EXPECT_GT(lit, 0) << "the fog scatters light";
    for (float t : layers["transmittance"].pixels) ASSERT_TRUE(t >= 0 && t <= 1) << t;
    EXPECT_EQ(file.metadata.at("tyndall.scene"), foggy);
    EXPECT_EQ(file.metadata.at("tyndall.size"), "48x40");
    EXPECT_EQ(file.metadata.at("tyndall.seed"), "9");
    EXPECT_TRUE(file.metadata.contains("tyndall.version") &&
                file.metadata.contains("tyndall.settings"));
}

TEST_F(CaptureTest, RowsRunFromTheTop) {
    ASSERT_EQ(capture({clear, "-o", "a.exr", "--size", "32x32", "--aov", "depth,albedo"}).status,
              0);
    // The floor lies below the eye: it covers the lower rows alone.
    for (const ImageLayer& layer : exr("a.exr").layers)
        if (layer.name == "albedo") {
            EXPECT_EQ(*layer.image.at(16, 1), 0.0f);
            EXPECT_GT(*layer.image.at(16, 24), 0.0f);
        }
}

TEST_F(CaptureTest, TermsThatAreNotAskedForAreNotRendered) {
    ASSERT_EQ(capture({foggy, "-o", "a.exr", "--size", "32x32", "--terms", "LSE", "--aov", "terms",
                       "--report", "r.json"})
                  .status,
              0);
    EXPECT_EQ(json::parse(content("r.json")).at("claims"), json::array({"LSE"}));
    for (const ImageLayer& layer : exr("a.exr").layers)
        EXPECT_TRUE(layer.name.empty() || layer.name == "LSE") << layer.name;
}

// Emission alone: no light is gathered, and the shaders must do without the lights' buffers; no shadow falls on anything.
TEST_F(CaptureTest, AFlameIsSeenWithoutAnyOtherTerm) {
    const ProcessResult result =
        capture({(sourceDir() / "content/campfire.scene.json").string(), "-o", "a.exr", "--size",
                 "64x36", "--terms", "LE", "--aov", "terms", "--report", "r.json"});
    ASSERT_EQ(result.status, 0) << result.err;
    float brightest = 0;
    const ExrFile picture = exr("a.exr");
    for (const float value : picture.layers[0].image.pixels) brightest = std::max(brightest, value);
    EXPECT_GT(brightest, 1.0f) << "nits: the flame is not there";
    const json report = json::parse(content("r.json"));
    for (const json& pass : report.at("passes"))
        if (pass.at("name") == "shadow.maps") {
            EXPECT_EQ(pass.at("status"), "skipped") << pass;
        }
}

TEST_F(CaptureTest, FramesAreNumberedAndTheSameSeedGivesTheSameBits) {
    ASSERT_EQ(capture({foggy, "-o", "f-%04d.exr", "--size", "24x24", "--frames", "3", "--time-step",
                       "0.5", "--quiet"})
                  .status,
              0);
    for (const char* name : {"f-0000.exr", "f-0001.exr", "f-0002.exr"})
        EXPECT_TRUE(fs::exists(options.folder / name)) << name;
    EXPECT_FALSE(fs::exists(options.folder / "f-0003.exr"));
    ASSERT_EQ(capture({foggy, "-o", "g-%04d.exr", "--size", "24x24", "--frames", "3", "--time-step",
                       "0.5", "--quiet"})
                  .status,
              0);
    EXPECT_EQ(exr("f-0002.exr").layers[0].image.pixels, exr("g-0002.exr").layers[0].image.pixels);
}

TEST_F(CaptureTest, ConvergingLowersTheErrorAndIsReported) {
    ASSERT_EQ(
        capture({foggy, "-o", "r.exr", "--size", "32x24", "--converge", "--frames", "48"}).status,
        0);
    ASSERT_EQ(capture({foggy, "-o", "a.exr", "--size", "32x24", "--converge", "--frames", "2",
                       "--seed", "1"})
                  .status,
              0);
    ASSERT_EQ(capture({foggy, "-o", "b.exr", "--size", "32x24", "--converge", "--frames", "16",
                       "--seed", "1", "--report", "r.json"})
                  .status,
              0);
    const Image reference = exr("r.exr").layers[0].image;
    const double few = compareImages(exr("a.exr").layers[0].image, reference)->relmse;
    const double many = compareImages(exr("b.exr").layers[0].image, reference)->relmse;
    // Errors of independent frames fall with their number: 8 times as many leave an eighth; a quarter is asked for.
    EXPECT_LT(many, few / 4) << few << " with 2 frames, " << many << " with 16";
    EXPECT_LE(json::parse(content("r.json")).at("iterations").at("converge").get<int>(), 16);
}

TEST_F(CaptureTest, ThresholdsFailWithStatusOneButThePictureIsThere) {
    const ProcessResult result =
        capture({clear, "-o", "a.png", "--size", "32x32", "--max-ms", "0.000001", "--quiet"});
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.err, HasSubstr("--max-ms"));
    EXPECT_TRUE(fs::exists(options.folder / "a.png"));
    EXPECT_EQ(capture({clear, "-o", "a.png", "--size", "32x32", "--max-ms", "600000",
                       "--fail-on-nonfinite", "--quiet"})
                  .status,
              0);
}

TEST_F(CaptureTest, QuietIsQuietAndOtherwiseItSaysWhichBackEndItGot) {
    const ProcessResult quiet = capture({clear, "-o", "a.png", "--size", "16x16", "--quiet"});
    EXPECT_EQ(quiet.status, 0);
    EXPECT_EQ(quiet.err, "");
    EXPECT_EQ(quiet.out, "");
    const ProcessResult loud =
        capture({clear, "-o", "a.png", "--size", "16x16", "--backend", "osmesa"});
    EXPECT_EQ(loud.status, 0) << loud.err;
    EXPECT_THAT(loud.err, HasSubstr("osmesa"));
    EXPECT_THAT(loud.err, HasSubstr("wrote a.png"));
}

TEST_F(CaptureTest, CtrlCLeavesTheLastGoodPictureAndNothingHalfWritten) {
    ASSERT_TRUE(writeFileAtomically(options.folder / "a.exr", "the last good picture").ok());
    const size_t before = fileCount();
    options.interruptAfterSeconds = 2;
    const ProcessResult result = capture({foggy, "-o", "a.exr", "--size", "256x256", "--frames",
                                          "100000", "--report", "r.json", "--quiet"});
    EXPECT_EQ(result.status, 1) << "signal " << result.signal;
    EXPECT_THAT(result.err, HasSubstr("interrupted"));
    EXPECT_EQ(content("a.exr"), "the last good picture");
    EXPECT_EQ(fileCount(), before);
}

TEST_F(CaptureTest, AnOutputThatCannotBeWrittenFailsWithStatusOne) {
    fs::create_directory(options.folder / "a.exr"); // a folder has the name
    const size_t before = fileCount();
    const ProcessResult result = capture({clear, "-o", "a.exr", "--size", "16x16", "--quiet"});
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.err, HasSubstr("a.exr"));
    EXPECT_EQ(fileCount(), before);
    const ProcessResult full =
        capture({clear, "-o", "b.exr", "--size", "16x16", "--quiet", "--report", "/dev/full"});
    EXPECT_EQ(full.status, 1);
    EXPECT_THAT(full.err, HasSubstr("No space left"));
}

TEST_F(CaptureTest, ABareModelGetsACameraAndALightAndSaysSo) {
    const auto box = REQUIRE_CONTENT("gltf/khronos/Box/Box.gltf");
    const ProcessResult result = capture({box.string(), "-o", "a.exr", "--size", "32x32"});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_THAT(result.err, HasSubstr("supplied: "));
    double sum = 0;
    for (float value : exr("a.exr").layers[0].image.pixels) sum += double(value);
    EXPECT_GT(sum, 0) << "something can be seen";
}

TEST_F(CaptureTest, ParticlesOfAFileAreThoseOfTheRuleThatMadeThem) {
    const ParticleSet cloud = generateParticles("cloud", 50, 3, 1).value();
    std::ofstream csv(options.folder / "cloud.csv");
    csv << "x,y,z,radius,density\n" << std::setprecision(9); // digits that give each float back
    for (const Particle& p : cloud.particles)
        csv << p.position.x << ',' << p.position.y << ',' << p.position.z << ',' << p.radius << ','
            << p.density << '\n';
    csv.close();
    const auto picture = [&](const std::string& source) {
        json scene = json::parse(content(clear));
        scene["nodes"].push_back(
            {{"name", "cloud"},
             {"translation", {0, 1, 1}},
             {"medium",
              json::parse(R"({"type": "particles", "scattering": [4, 4, 4], )" + source + "}")}});
        std::ofstream(options.folder / "p.scene.json") << scene.dump();
        const ProcessResult result = capture(
            {"p.scene.json", "-o", "p.exr", "--size", "64x48", "--aov", "terms", "--quiet"});
        EXPECT_EQ(result.status, 0) << result.err;
        EXPECT_EQ(result.err, "");
        return exr("p.exr");
    };
    const ExrFile made = picture(R"("generate": {"kind": "cloud", "count": 50, "seed": 3})"),
                  read = picture(R"("file": "cloud.csv")");
    ASSERT_EQ(made.layers.size(), read.layers.size());
    bool scattered = false;
    for (size_t i = 0; i < made.layers.size(); ++i) {
        EXPECT_EQ(made.layers[i].image.pixels, read.layers[i].image.pixels) << made.layers[i].name;
        for (const float value : made.layers[i].image.pixels)
            scattered = scattered || (made.layers[i].name == "LVE" && value > 0);
    }
    EXPECT_TRUE(scattered);
}

TEST_F(CaptureTest, ASharedEffectGivesTheSamePictureAsTheBuiltInOne) {
    ASSERT_EQ(capture({foggy, "-o", "plain.exr", "--size", "32x32", "--quiet"}).status, 0);
    ASSERT_EQ(capture({foggy, "-o", "a.exr", "--size", "32x32", "--set", "tint.enabled=true",
                       "--set", "tint.red=0.5", "--quiet"})
                  .status,
              0);
    const ProcessResult shared =
        capture({foggy, "-o", "b.exr", "--size", "32x32", "--set", "tint.enabled=true", "--set",
                 "tint.red=0.5", "--plugin", "example_tint", "--quiet"});
    ASSERT_EQ(shared.status, 0) << shared.err;
    EXPECT_EQ(exr("a.exr").layers[0].image.pixels, exr("b.exr").layers[0].image.pixels);
    EXPECT_NE(exr("a.exr").layers[0].image.pixels, exr("plain.exr").layers[0].image.pixels)
        << "the effect has an effect";
}

TEST_F(CaptureTest, ASharedTechniqueGivesTheSamePictureAsTheBuiltInOne) {
    ASSERT_EQ(
        capture({foggy, "-o", "a.exr", "--size", "32x32", "--gi", "octaves", "--quiet"}).status, 0);
    const ProcessResult shared = capture({foggy, "-o", "b.exr", "--size", "32x32", "--gi",
                                          "octaves", "--plugin", "volumetric_gi", "--quiet"});
    ASSERT_EQ(shared.status, 0) << shared.err;
    EXPECT_EQ(exr("a.exr").layers[0].image.pixels, exr("b.exr").layers[0].image.pixels);
}

} // namespace
} // namespace tyndall::test
