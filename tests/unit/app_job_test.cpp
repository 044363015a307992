// Jobs: progress and cancelling, from any thread.

#include "app/job.h"

#include <fstream>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "app/load_scene.h"
#include "support/content.h"

namespace tyndall::test {
namespace {

TEST(JobControl, TheListenerHearsPhasesAndEachStepOfThemInOrder) {
    std::vector<JobProgress> heard;
    JobControl control([&](const JobProgress& progress) { heard.push_back(progress); });
    {
        JobPhase phase(control, "loading");
        phase.update(0.5, "loading: half of it");
        phase.update(7); // clamped
    }
    { JobPhase phase(control, "rendering"); }
    ASSERT_EQ(heard.size(), 6u);
    const std::vector<std::string> labels{"loading", "loading", "loading", "", "rendering", ""};
    for (size_t i = 0; i < heard.size(); ++i) EXPECT_EQ(heard[i].label, labels[i]) << i;
    EXPECT_EQ(heard[1].fraction, 0.5);
    EXPECT_EQ(heard[1].sentence, "loading: half of it");
    EXPECT_EQ(heard[2].fraction, 1);
    EXPECT_EQ(heard[0].phase, heard[2].phase);
    EXPECT_NE(heard[0].phase, heard[4].phase);
}

TEST(JobControl, AListenerMayLookAtTheProgressAndCancel) {
    JobControl* self = nullptr;
    JobControl control([&](const JobProgress& progress) {
        EXPECT_EQ(self->progress().fraction, progress.fraction);
        self->cancel();
    });
    self = &control;
    EXPECT_FALSE(control.cancelled());
    JobPhase phase(control, "loading");
    EXPECT_TRUE(control.cancelled());
}

TEST(JobControl, AStopRequestOfTheProgramCounts) {
    bool stop = false;
    const JobControl control({}, [&] { return stop; });
    EXPECT_FALSE(control.cancelled());
    stop = true;
    EXPECT_TRUE(control.cancelled());
}

/// Works until it is cancelled.
int workUntilCancelled(JobControl& control) {
    JobPhase phase(control, "working");
    int rounds = 0;
    for (; !control.cancelled(); ++rounds) phase.update(0.001 * (rounds % 1000), "round");
    return rounds;
}

TEST(Job, ItsProgressIsSeenAndItIsCancelledFromAnotherThread) {
    Job<int> job(workUntilCancelled);
    while (job.control().progress().sentence.empty()) std::this_thread::yield();
    const JobProgress progress = job.control().progress();
    EXPECT_EQ(progress.label, "working");
    EXPECT_GE(progress.fraction, 0);
    EXPECT_LT(progress.fraction, 1);
    EXPECT_FALSE(job.finished());
    job.control().cancel();
    EXPECT_GT(job.take(), 0);
}

TEST(Job, DestructionCancelsItAndWaits) {
    bool ended = false;
    {
        const Job<int> job([&](JobControl& control) {
            const int rounds = workUntilCancelled(control);
            ended = true;
            return rounds;
        });
    }
    EXPECT_TRUE(ended);
}

TEST(Job, WhatTheWorkThrowsComesOutOfTake) {
    Job<int> job([](JobControl&) -> int { throw std::runtime_error("no"); });
    EXPECT_THROW((void)job.take(), std::runtime_error);
}

/// Three nodes with a file each, which the reader names before it reads it.
std::string writeScene() {
    const std::filesystem::path folder = scratchDir("app-load");
    std::ofstream(folder / "empty.gltf")
        << R"({"asset": {"version": "2.0"}, "nodes": [{"name": "a"}]})";
    std::ofstream(folder / "a.scene.json") << R"({"tyndall": 1, "nodes": [
        {"name": "a", "gltf": "empty.gltf"}, {"name": "b", "gltf": "empty.gltf"}, {"name": "c", "gltf": "empty.gltf"}]})";
    return (folder / "a.scene.json").string();
}

TEST(SceneLoad, ACancelledOneStopsAtOnceAndLeavesTheSceneAsItWas) {
    const std::string path = writeScene();
    int steps = 0, stepsUntilTheEnd = 0;
    Scene scene;
    JobControl whole(
        [&](const JobProgress& progress) { stepsUntilTheEnd += !progress.sentence.empty(); });
    ViewOptions options;
    options.scene = path;
    ASSERT_TRUE(loadScene(options, whole, scene).ok());
    ASSERT_GT(stepsUntilTheEnd, 1);

    JobControl* self = nullptr;
    JobControl cancelled([&](const JobProgress& progress) {
        steps += !progress.sentence.empty();
        if (steps == 1) self->cancel();
    });
    self = &cancelled;
    Scene kept;
    kept.name = "as it was";
    const Outcome outcome = loadScene(options, cancelled, kept);
    EXPECT_EQ(outcome.status, ExitStatus::Failed);
    EXPECT_NE(outcome.message.find("interrupted"), std::string::npos) << outcome.message;
    EXPECT_EQ(kept.name, "as it was");
    EXPECT_EQ(steps, 1) << "nothing was read after it was cancelled";
    EXPECT_EQ(cancelled.progress().label, "") << "no phase goes on";
}

} // namespace
} // namespace tyndall::test
