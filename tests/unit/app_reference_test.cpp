// Reference runs as jobs: cancelled from another thread, with whole files or none.

#include <chrono>
#include <fstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/reference_run.h"
#include "core/image.h"
#include "support/content.h"

namespace tyndall::test {
namespace {
namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

constexpr const char* kScene = R"({
  "tyndall": 1,
  "nodes": [
    {"name": "floor", "primitive": {"shape": "box", "size": [4, 0.1, 4]}},
    {"name": "lamp", "light": {"type": "point", "intensity": 50}, "translation": [0, 2, 0]},
    {"name": "haze", "medium": {"type": "homogeneous", "shape": "height", "scaleHeight": 2, "scattering": [0.1, 0.1, 0.1], "absorption": [0.05, 0.05, 0.05]}},
    {"name": "eye", "camera": {"type": "perspective", "yfov": 0.8, "znear": 0.05}, "translation": [0, 1, 5]}
  ],
  "camera": "eye"
})";

struct ReferenceJob : ::testing::Test {
    fs::path folder = scratchDir("app-reference");
    ReferenceOptions options;
    void SetUp() override {
        std::ofstream(folder / "a.scene.json") << kScene;
        options.scene = (folder / "a.scene.json").string();
        options.output = (folder / "a.exr").string();
        options.size = "64x36";
        options.goals.spp = int64_t(1) << 30; // hours
    }
    [[nodiscard]] std::vector<std::string> files() const {
        std::vector<std::string> names;
        for (const auto& entry : fs::directory_iterator(folder))
            names.push_back(entry.path().filename().string());
        return names;
    }
    static Job<Outcome> start(ReferenceRun& run) {
        return Job<Outcome>([&run](JobControl& control) { return run.run(control); });
    }
};

/// Cancels the job and returns how long it then went on, seconds.
double secondsToEnd(Job<Outcome>& job, Outcome& outcome) {
    const auto begun = std::chrono::steady_clock::now();
    job.control().cancel();
    outcome = job.take();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
}

// A pass takes about two seconds; a tile of this picture less than a hundredth of one. Half of the former tells the two apart on a
// machine that is busy with other tests.
constexpr double kMuchLessThanAPass = 1;

TEST_F(ReferenceJob, CancelledFromAnotherThreadItStopsAndLeavesNoFile) {
    ReferenceRun run(options);
    Job<Outcome> job = start(run);
    // Passes grow; from the third second on they are as long as they get.
    std::this_thread::sleep_for(std::chrono::seconds(3));
    EXPECT_EQ(job.control().progress().label, "rendering");
    Outcome outcome;
    EXPECT_LT(secondsToEnd(job, outcome), kMuchLessThanAPass);
    EXPECT_EQ(outcome.status, ExitStatus::Failed);
    EXPECT_THAT(outcome.message, HasSubstr("interrupted; nothing was written"));
    EXPECT_THAT(files(), UnorderedElementsAre("a.scene.json"));
}

TEST_F(ReferenceJob, CancelledAfterACheckpointItLeavesThatWhole) {
    options.checkpointSeconds = 0; // after every pass
    ReferenceRun run(options);
    Job<Outcome> job = start(run);
    while (!fs::exists(folder / "a.exr") && !job.finished()) std::this_thread::yield();
    Outcome outcome;
    (void)secondsToEnd(job, outcome);
    EXPECT_THAT(outcome.message, HasSubstr("'--resume' goes on from"));
    EXPECT_THAT(files(), UnorderedElementsAre("a.scene.json", "a.exr", "a.exr.resume"));
    const Result<ExrFile> picture = readExr(folder / "a.exr");
    ASSERT_TRUE(picture.ok()) << picture.message();
    const int samples = std::stoi(picture->metadata.at("tyndall.samples"));
    EXPECT_GT(samples, 0);

    // What is left is good enough to go on from.
    options.resume = true;
    options.goals.spp = samples + 1;
    JobControl control;
    ReferenceRun resumed(options);
    const Outcome done = resumed.run(control);
    EXPECT_TRUE(done.ok()) << done.message;
    EXPECT_GE(resumed.report().samples, uint32_t(samples + 1));
    EXPECT_THAT(files(), UnorderedElementsAre("a.scene.json", "a.exr"));
}

TEST_F(ReferenceJob, ItsReportIsThereWithoutAFile) {
    options.goals.spp = 8;
    ReferenceRun run(options);
    JobControl control;
    ASSERT_TRUE(run.run(control).ok());
    EXPECT_EQ(run.pictureFile(), options.output);
    EXPECT_EQ(run.report().samples, 8u);
    EXPECT_EQ(run.report().counts.paths, 8u * 64 * 36);
    EXPECT_EQ(run.report().triangles, 12u) << "a box";
    EXPECT_GT(run.report().estimatedRelmse, 0);
}

} // namespace
} // namespace tyndall::test
