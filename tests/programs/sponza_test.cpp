// Real content with fog, smoke and three lights, on both ways to a context: the same picture, nothing invalid, nothing left behind.
// TYNDALL_LONG_TESTS=1: at 1280x720, some three minutes a picture on two cores; TYNDALL_KEEP=FOLDER keeps both as EXR.

#include <cstdlib>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/image.h"
#include "core/image_metrics.h"
#include "programs/process.h"
#include "support/content.h"

namespace tyndall::test {
namespace {
namespace fs = std::filesystem;

fs::path writeScene(const fs::path& folder, const fs::path& content) {
    std::string text = readFile(sourceDir() / "tests/scenes/sponza_fog_smoke.scene.json").value();
    const std::string place = "@CONTENT@";
    for (size_t at = text.find(place); at != std::string::npos; at = text.find(place, at))
        text.replace(at, place.size(), content.string());
    const fs::path path = folder / "sponza.scene.json";
    std::ofstream(path) << text;
    return path;
}

TEST(Sponza, WithFogAndSmokeIsTheSamePictureOnBothBackEnds) {
    const fs::path content =
        fs::absolute(REQUIRE_CONTENT("sponza/Sponza.gltf").parent_path().parent_path());
    REQUIRE_CONTENT("vdb/smoke1.vdb");
    const bool full = std::getenv("TYNDALL_LONG_TESTS") != nullptr;
    const char* keep = std::getenv("TYNDALL_KEEP");
    ProcessOptions options;
    options.folder = keep ? fs::path(keep) : scratchDir("sponza");
    options.timeoutSeconds = full ? 1500 : 300;
    const std::string scene = writeScene(options.folder, content).string();
    std::vector<Image> pictures;
    for (const std::string backend : {"egl", "osmesa"}) {
        const std::string picture = backend + ".exr", report = backend + ".json";
        const ProcessResult result =
            tyndall({"capture", scene, "-o", picture, "--backend", backend, "--gi", "none",
                     "--size", full ? "1280x720" : "96x54", "--report", report},
                    options);
        ASSERT_EQ(result.status, 0) << result.err;
        const auto json = nlohmann::json::parse(readFile(options.folder / report).value());
        for (const char* key : {"nonfinite", "negative", "gl_errors", "gl_objects_leaked"})
            EXPECT_EQ(json.at("counters").at(key), 0) << backend << ", " << key;
        EXPECT_TRUE(json.at("backend").get<std::string>().starts_with(backend))
            << json.at("backend");
        int ran = 0;
        for (const auto& pass : json.at("passes"))
            for (const char* name :
                 {"media.march", "media.opticalDepth", "shadow.maps", "lighting.direct"})
                ran += pass.at("name") == name && pass.at("status") == "ran";
        EXPECT_EQ(ran, 4) << "surfaces, shadows and both media are all in it";
        pictures.push_back(readExr(options.folder / picture).value().layers[0].image);
    }
    const ImageMetrics metrics = compareImages(pictures[1], pictures[0]).value();
    std::printf("relmse %.2e, largest difference %.2e\n", metrics.relmse,
                metrics.largestDifference);
    EXPECT_LE(metrics.relmse, 1e-6);
    EXPECT_EQ(metrics.image.nonFinite + metrics.image.negative + metrics.reference.nonFinite +
                  metrics.reference.negative,
              0u);
    EXPECT_GT(metrics.energy, 0.99);
}

} // namespace
} // namespace tyndall::test
