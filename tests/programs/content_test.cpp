// Every file of the shared content through the program: rendered, or refused with one sentence and status 2; never a crash,
// a hang or a sanitizer's report.

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <fstream>
#include <mutex>
#include <random>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/image.h"
#include "programs/process.h"
#include "programs/scenes.h"
#include "scene/scene_file.h"
#include "support/content.h"
#include "support/render.h"

namespace tyndall::test {
namespace {
namespace fs = std::filesystem;

bool longRun() { return std::getenv("TYNDALL_LONG_TESTS") != nullptr; }

std::vector<fs::path> filesUnder(const fs::path& folder,
                                 const std::vector<std::string>& extensions) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file() && std::find(extensions.begin(), extensions.end(),
                                                 entry.path().extension()) != extensions.end())
            files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

void keepEvery(std::vector<fs::path>& files, size_t step) {
    std::vector<fs::path> kept;
    for (size_t i = 0; i < files.size(); i += step) kept.push_back(files[i]);
    files = std::move(kept);
}

/// Empty when the program did what it should with this file; the complaint otherwise.
std::string complaint(const std::string& file, const ProcessResult& result) {
    std::string why;
    if (!endedByItself(result, why)) return file + ": " + why;
    if (result.status == 0) return {};
    if (result.status != 2)
        return file + ": exit status " + std::to_string(result.status) + ": " + result.err;
    if (!result.err.starts_with("tyndall: ") ||
        std::count(result.err.begin(), result.err.end(), '\n') != 1)
        return file + ": not one sentence: " + result.err;
    return {};
}

/// Runs `action` for every file on two threads and collects the complaints.
template <typename Action>
std::vector<std::string> forEach(const std::vector<fs::path>& files, Action action) {
    std::vector<std::string> complaints;
    std::mutex mutex;
    std::atomic<size_t> next{0};
    const auto work = [&](int worker) {
        for (size_t i = next++; i < files.size(); i = next++) {
            const std::string wrong = action(files[i], worker);
            if (wrong.empty()) continue;
            const std::lock_guard lock(mutex);
            complaints.push_back(wrong);
        }
    };
    std::thread other(work, 1);
    work(0);
    other.join();
    return complaints;
}

/// Loads and renders each file by what `tyndall capture` is made of, in this process and with one renderer: starting one takes
/// a while. A crash ends the test; the file that caused it is the last one named in TYNDALL_SWEEP_LOG, if that is set.
std::vector<std::string> renderAll(const std::vector<fs::path>& files) {
    std::vector<std::string> complaints;
    const char* log = std::getenv("TYNDALL_SWEEP_LOG");
    RenderOptions options;
    options.width = options.height = 16;
    options.separateTerms = false;
    for (const fs::path& file : files) {
        if (log) std::ofstream(log, std::ios::app) << file.string() << std::endl;
        const Result<LoadedScene> loaded = loadScene(file);
        if (!loaded.ok()) {
            if (loaded.message().find(file.filename().string()) == std::string::npos)
                complaints.push_back(file.string() + ": not named in: " + loaded.message());
            if (loaded.message().find('\n') != std::string::npos)
                complaints.push_back(file.string() + ": not one sentence: " + loaded.message());
            continue;
        }
        try {
            const ::testing::ScopedTrace trace(__FILE__, __LINE__,
                                               file.string()); // non-finite pixels fail in there
            (void)sharedRenderer().render(loaded->scene, options);
        } catch (const std::exception& failure) {
            complaints.push_back(file.string() + ": " + failure.what());
        }
    }
    return complaints;
}

std::vector<std::string> describeAll(const std::vector<fs::path>& files) {
    return forEach(files, [](const fs::path& file, int) {
        return complaint(file.string(), tyndall({"info", file.string()}));
    });
}

TEST(Content, InvalidGltfFilesAreUnderstoodOrRefused) {
    const auto root = REQUIRE_CONTENT("invalid-gltf");
    const std::vector<fs::path> files = filesUnder(root, {".gltf", ".glb"});
    EXPECT_GE(files.size(), 372u);
    EXPECT_THAT(describeAll(files), ::testing::IsEmpty());
}

TEST(Content, InvalidGltfFilesAreRenderedOrRefused) {
    const auto root = REQUIRE_CONTENT("invalid-gltf");
    std::vector<fs::path> files = filesUnder(root, {".gltf", ".glb"});
    if (!longRun()) keepEvery(files, 10);
    EXPECT_THAT(renderAll(files), ::testing::IsEmpty());
}

TEST(Content, ModelsAndVolumesAreRenderedOrRefused) {
    std::vector<fs::path> files;
    for (const char* folder : {"gltf", "vdb", "nvdb"}) {
        const auto root = REQUIRE_CONTENT(folder);
        const std::vector<fs::path> found = filesUnder(root, {".gltf", ".glb", ".vdb", ".nvdb"});
        EXPECT_FALSE(found.empty()) << folder;
        files.insert(files.end(), found.begin(), found.end());
    }
    if (!longRun()) keepEvery(files, 4);
    EXPECT_THAT(renderAll(files), ::testing::IsEmpty());
}

TEST(Content, ScenesOfOurOwnRender) {
    const std::vector<fs::path> files = filesUnder(sourceDir() / "content", {".json"});
    ASSERT_FALSE(files.empty());
    for (const fs::path& file : files) {
        const Result<LoadedScene> loaded = loadScene(file);
        EXPECT_TRUE(loaded.ok()) << loaded.message();
    }
    EXPECT_THAT(renderAll(files), ::testing::IsEmpty());
}

/// Truncated and bit-flipped copies of one file through `tyndall info`.
void damage(const fs::path& original, const std::string& name) {
    const std::string good = readFile(original).value();
    const fs::path folder = scratchDir("damage-" + name);
    const int copies = 24; // tests/stress has the thousands
    std::vector<fs::path> cases(size_t(copies), original);
    std::atomic<int> number{0};
    const auto complaints = forEach(cases, [&](const fs::path&, int) {
        const int index = number++;
        std::mt19937_64 random(seed() * 1000003 + uint64_t(index));
        std::string bad = good;
        if (index % 2)
            bad.resize(random() % good.size());
        else
            for (uint64_t flips = 1 + random() % 8; flips > 0; --flips)
                bad[random() % bad.size()] ^= char(1 << (random() % 8));
        const fs::path file = folder / (std::to_string(index) + original.extension().string());
        if (!writeFileAtomically(file, bad).ok())
            return std::string("cannot write ") + file.string();
        const std::string wrong =
            complaint(original.filename().string() + " case " + std::to_string(index) + " seed " +
                          std::to_string(seed()),
                      tyndall({"info", file.string()}));
        fs::remove(file);
        return wrong;
    });
    EXPECT_THAT(complaints, ::testing::IsEmpty());
}

TEST(Damage, SceneFile) { damage(writeFoggyScene(scratchDir("damage-original")), "scene"); }
TEST(Damage, Glb) { damage(REQUIRE_CONTENT("gltf/compressed/BoxTextured-quantized.glb"), "glb"); }
TEST(Damage, Gltf) {
    damage(REQUIRE_CONTENT("gltf/khronos/BoxVertexColors/BoxVertexColors.gltf"), "gltf");
}
TEST(Damage, DracoGlb) {
    damage(REQUIRE_CONTENT("gltf/compressed/BoxTextured-draco.glb"), "draco");
}
TEST(Damage, OpenVdb) { damage(REQUIRE_CONTENT("vdb/sphere_fog_tiny.vdb"), "vdb"); }
TEST(Damage, NanoVdb) { damage(REQUIRE_CONTENT("nvdb/wdas_cloud_sixteenth_fpN_zip.nvdb"), "nvdb"); }

} // namespace
} // namespace tyndall::test
