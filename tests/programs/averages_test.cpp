// Averages of a cloud whose light hardly ends: albedos up to 1, phase functions from backward to forward, every preset and technique. No pixel may be other than a
// finite number, and none negative. TYNDALL_LONG_TESTS=1: all combinations, hundreds of frames of the quicker presets.
#include <cstdlib>
#include <fstream>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/image.h"
#include "programs/process.h"
#include "support/content.h"

namespace tyndall::test {
namespace {
namespace fs = std::filesystem;

struct Cloud {
    double albedo, anisotropy;
};

fs::path writeCloud(const fs::path& folder, const Cloud& cloud) {
    auto scene = nlohmann::json::parse(readFile(sourceDir() / "content/cloud.scene.json").value());
    for (auto& node : scene["nodes"]) {
        if (node["name"] != "cloud") continue;
        auto& medium = node["medium"];
        const double extinction = medium["scattering"][0];
        medium["file"] = (sourceDir() / "content/cloud.vdb").string();
        medium["scattering"] = std::vector<double>(3, extinction * cloud.albedo);
        medium["absorption"] = std::vector<double>(3, extinction * (1 - cloud.albedo));
        medium["anisotropy"] = cloud.anisotropy;
    }
    const fs::path path = folder / "cloud.scene.json";
    std::ofstream(path) << scene;
    return path;
}

/// Frames of 32x18 pixels; `why` is the command for a message.
void expectSound(const Cloud& cloud, const std::string& technique, const std::string& quality,
                 int frames) {
    ProcessOptions options;
    options.folder = scratchDir("averages");
    options.timeoutSeconds = 1800;
    const std::string scene = writeCloud(options.folder, cloud).string();
    const ProcessResult result =
        tyndall({"capture", scene, "-o", "o.exr", "--size", "32x18", "--gi", technique, "--quality",
                 quality, "--converge", "--frames", std::to_string(frames), "--report", "r.json"},
                options);
    const std::string what = fmt::format("albedo {}, g {}, {}, {}, {} frames", cloud.albedo,
                                         cloud.anisotropy, technique, quality, frames);
    ASSERT_EQ(result.status, 0) << what << ": " << result.err;
    const auto report = nlohmann::json::parse(readFile(options.folder / "r.json").value());
    for (const char* counter : {"nonfinite", "negative", "gl_errors"})
        EXPECT_EQ(report.at("counters").at(counter), 0) << counter << ": " << what;
}

TEST(Averages, OfCloudsThatHardlyAbsorbAreNumbers) {
    if (std::getenv("TYNDALL_LONG_TESTS")) {
        for (const auto& [quality, frames] : {std::pair("low", 300), std::pair("medium", 200),
                                              std::pair("high", 8), std::pair("ultra", 2)})
            for (const char* technique : {"octaves", "lpv", "vpl"})
                for (const double albedo : {0.98, 0.998, 1.0})
                    for (const double g : {-0.9, 0.0, 0.9})
                        expectSound({albedo, g}, technique, quality, frames);
        return;
    }
    for (const char* technique : {"octaves", "lpv", "vpl"})
        expectSound({1, -0.9}, technique, "low", 2);
}

} // namespace
} // namespace tyndall::test
