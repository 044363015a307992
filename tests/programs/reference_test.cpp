// `tyndall reference` as its user relies on it: layers, goals, the same bits from any number of threads and after being killed, and
// what becomes of a file when the disk is full.

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/image.h"
#include "programs/process.h"
#include "programs/scenes.h"
#include "support/content.h"
#include "transport/terms.h"

namespace tyndall::test {
namespace {
namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

struct ReferenceTest : ::testing::Test {
    ProcessOptions options;
    fs::path scene;
    void SetUp() override {
        options.folder = scratchDir("reference");
        scene = writeFoggyScene(options.folder);
    }
    ProcessResult reference(std::vector<std::string> more) {
        std::vector<std::string> arguments{"reference", scene.string(), "--size", "32x18"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return tyndall(arguments, options);
    }
    std::string bytes(const std::string& name) const {
        Result<std::string> content = readFile(options.folder / name);
        EXPECT_TRUE(content.ok()) << name;
        return content.ok() ? *content : std::string();
    }
    ExrFile exr(const std::string& name) const {
        Result<ExrFile> file = readExr(options.folder / name);
        EXPECT_TRUE(file.ok()) << name;
        return file.ok() ? std::move(*file) : ExrFile{};
    }
};

const ImageLayer* layer(const ExrFile& file, const std::string& name) {
    for (const ImageLayer& candidate : file.layers)
        if (candidate.name == name) return &candidate;
    return nullptr;
}

TEST_F(ReferenceTest, WritesEveryTermAndTheirSumIsThePicture) {
    const ProcessResult result =
        reference({"-o", "a.exr", "--spp", "24", "--report", "a.json", "--seed", "5"});
    ASSERT_EQ(result.status, 0) << result.err;
    ExrFile file = exr("a.exr");
    const ImageLayer* picture = layer(file, "");
    ASSERT_NE(picture, nullptr);
    std::vector<double> sum(picture->image.pixels.size());
    for (uint32_t i = 0; i < kTermCount; ++i) {
        const ImageLayer* term = layer(file, std::string(termName(Term(i))));
        ASSERT_NE(term, nullptr) << termName(Term(i));
        for (size_t p = 0; p < sum.size(); ++p) sum[p] += double(term->image.pixels[p]);
    }
    double light = 0;
    for (size_t p = 0; p < sum.size(); ++p) {
        EXPECT_FLOAT_EQ(picture->image.pixels[p], float(sum[p])) << p;
        light += sum[p];
    }
    EXPECT_GT(light, 0);
    ASSERT_NE(layer(file, "variance"), nullptr);
    EXPECT_EQ(file.metadata["tyndall.samples"], "24");
    EXPECT_EQ(file.metadata["tyndall.seed"], "5");
    EXPECT_EQ(file.metadata.count("tyndall.version"), 1u);
    EXPECT_GT(std::stod(file.metadata["tyndall.estimatedRelmse"]), 0);
    const auto report = nlohmann::json::parse(bytes("a.json"));
    EXPECT_EQ(report["samples_per_pixel"], 24);
    EXPECT_EQ(report["counters"]["paths"], 24 * 32 * 18);
    EXPECT_EQ(report["counters"]["nonfinite"], 0);
    EXPECT_EQ(report["counters"]["negative"], 0);
    EXPECT_FALSE(fs::exists(options.folder / "a.exr.resume")) << "nothing to go on from when done";
}

TEST_F(ReferenceTest, TheVarianceLayerIsTheErrorOfTheMean) {
    // Two pictures of different seeds differ by the sum of both variances: over many pixels the ratio is 1.
    for (const char* seed : {"1", "2"})
        ASSERT_EQ(
            reference({"-o", std::string(seed) + ".exr", "--spp", "64", "--seed", seed}).status, 0);
    const ExrFile a = exr("1.exr"), b = exr("2.exr");
    double differences = 0, expected = 0;
    const size_t count = layer(a, "")->image.pixels.size();
    for (size_t p = 0; p < count; ++p) {
        // Weighed by the variance itself, so that no bright pixel decides alone.
        const double variance = double(layer(a, "variance")->image.pixels[p]) +
                                double(layer(b, "variance")->image.pixels[p]);
        const double d =
            double(layer(a, "")->image.pixels[p]) - double(layer(b, "")->image.pixels[p]);
        if (!(variance > 0)) continue;
        differences += std::min(d * d / variance, 25.0);
        expected += 1;
    }
    // d²/v of two estimates with 7 degrees of freedom each, v itself uncertain: its mean is about 14/12. A spread of 10 % over
    // 1728 values would be 6 standard errors.
    EXPECT_NEAR(differences / expected, 14.0 / 12.0, 0.15);
}

TEST_F(ReferenceTest, TheThreadsDoNotShowInThePicture) {
    ASSERT_EQ(reference({"-o", "one.exr", "--spp", "40", "--threads", "1"}).status, 0);
    ASSERT_EQ(reference({"-o", "four.exr", "--spp", "40", "--threads", "4"}).status, 0);
    EXPECT_EQ(bytes("one.exr"), bytes("four.exr"));
}

TEST_F(ReferenceTest, KilledAndResumedItIsTheSamePicture) {
    ASSERT_EQ(reference({"-o", "whole.exr", "--spp", "1200"}).status, 0);
    const std::vector<std::string> arguments{"-o",   "parts.exr",    "--spp",
                                             "1200", "--checkpoint", "0"};
    bool killed = false;
    for (double patience = 0.3; !killed && patience < 30; patience *= 2) {
        options.timeoutSeconds = patience; // SIGKILL
        const ProcessResult result = reference(arguments);
        if (!result.timedOut) break; // too fast for this patience: it has finished
        killed = fs::exists(options.folder / "parts.exr.resume");
    }
    ASSERT_TRUE(killed) << "it was never caught between its first checkpoint and its end";
    const ExrFile part = exr("parts.exr"); // the last good picture is whole
    EXPECT_LT(std::stoi(part.metadata.at("tyndall.samples")), 1200);
    options.timeoutSeconds = 120;
    std::vector<std::string> resumed = arguments;
    resumed.emplace_back("--resume");
    const ProcessResult result = reference(resumed);
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_THAT(result.err, HasSubstr("going on after"));
    EXPECT_EQ(bytes("whole.exr"), bytes("parts.exr"));
}

TEST_F(ReferenceTest, MoreSamplesLaterAreTheSameAsMoreAtOnce) {
    ASSERT_EQ(reference({"-o", "once.exr", "--spp", "48"}).status, 0);
    ASSERT_EQ(reference({"-o", "twice.exr", "--spp", "19", "--keep-checkpoint"}).status, 0);
    ASSERT_EQ(reference({"-o", "twice.exr", "--spp", "48", "--resume"}).status, 0);
    EXPECT_EQ(bytes("once.exr"), bytes("twice.exr"));
}

TEST_F(ReferenceTest, ResumesOnlyWhatIsItsOwn) {
    ASSERT_EQ(reference({"-o", "a.exr", "--spp", "8", "--keep-checkpoint"}).status, 0);
    ProcessResult other = reference({"-o", "a.exr", "--spp", "16", "--resume", "--seed", "9"});
    EXPECT_EQ(other.status, 2);
    EXPECT_THAT(other.err,
                AllOf(HasSubstr("a.exr.resume"), HasSubstr("seed 0"), HasSubstr("seed 9")));
    std::string damaged = bytes("a.exr.resume");
    damaged[damaged.size() / 2] = char(damaged[damaged.size() / 2] ^ 0x10);
    ASSERT_TRUE(writeFileAtomically(options.folder / "a.exr.resume", damaged).ok());
    other = reference({"-o", "a.exr", "--spp", "16", "--resume"});
    EXPECT_EQ(other.status, 2);
    EXPECT_THAT(other.err, HasSubstr("damaged"));
    for (const size_t kept : {size_t(0), size_t(20), size_t(200), damaged.size() - 1}) {
        ASSERT_TRUE(
            writeFileAtomically(options.folder / "a.exr.resume", damaged.substr(0, kept)).ok());
        EXPECT_EQ(reference({"-o", "a.exr", "--spp", "16", "--resume"}).status, 2) << kept;
    }
}

TEST_F(ReferenceTest, AnInterruptLeavesTheLastGoodPicture) {
    ASSERT_EQ(reference({"-o", "a.exr", "--spp", "4"}).status, 0);
    const std::string before = bytes("a.exr");
    options.interruptAfterSeconds = 0.7;
    const ProcessResult result = reference({"-o", "a.exr", "--spp", "1000000"});
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.err, HasSubstr("interrupted"));
    EXPECT_EQ(bytes("a.exr"), before);
}

TEST_F(ReferenceTest, AFullDiskIsASentenceAndTheLastGoodPictureStays) {
    const fs::path disk = options.folder / "disk";
    fs::create_directories(disk);
    const fs::path program = binDir() / "tyndall";
    // A file system of 64 KiB, seen by this shell alone.
    const std::string script =
        "mount -t tmpfs -o size=64k none '" + disk.string() + "' || exit 77\n" + "'" +
        program.string() + "' reference '" + scene.string() + "' -q -o '" + disk.string() +
        "/a.exr' --size 8x4 --spp 2 || exit 78\n" + "cp '" + disk.string() + "/a.exr' '" +
        options.folder.string() + "/before.exr'\n" + "'" + program.string() + "' reference '" +
        scene.string() + "' -q -o '" + disk.string() + "/a.exr' --size 96x54 --spp 2\n" +
        "status=$?\ncp '" + disk.string() + "/a.exr' '" + options.folder.string() +
        "/after.exr'\nls '" + disk.string() + "' >&2\nexit $status\n";
    const ProcessResult result = run({"unshare", "-m", "bash", "-c", script}, options);
    if (result.status == 77 || result.err.find("Operation not permitted") != std::string::npos ||
        result.status == 127)
        GTEST_SKIP() << "no small disk to fill here: " << result.err;
    EXPECT_EQ(result.status, 1) << result.err;
    EXPECT_THAT(result.err, HasSubstr("a.exr"));
    EXPECT_THAT(result.err, ::testing::Not(HasSubstr("bug")));
    EXPECT_EQ(bytes("before.exr"), bytes("after.exr"));
}

TEST_F(ReferenceTest, AnUnwritablePlaceIsRefusedBeforeTheWork) {
    const ProcessResult result = reference({"-o", "/proc/a.exr", "--spp", "100000000"});
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.err, HasSubstr("/proc/a.exr"));
    EXPECT_LT(result.seconds, 20);
}

TEST_F(ReferenceTest, StopsAtWhicheverGoalComesFirst) {
    ASSERT_EQ(reference({"-o", "e.exr", "--target-error", "0.05", "--spp", "100000"}).status, 0);
    const ExrFile good = exr("e.exr");
    EXPECT_LE(std::stod(good.metadata.at("tyndall.estimatedRelmse")), 0.05);
    EXPECT_LT(std::stoi(good.metadata.at("tyndall.samples")), 100000);
    const ProcessResult timed = reference({"-o", "t.exr", "--seconds", "1", "--spp", "100000000"});
    ASSERT_EQ(timed.status, 0) << timed.err;
    EXPECT_LT(timed.seconds, 30);
    // The scene's clock is no goal.
    ASSERT_EQ(reference({"-o", "c.exr", "--time", "0.5", "--spp", "3"}).status, 0);
    EXPECT_EQ(exr("c.exr").metadata.at("tyndall.samples"), "3");
    EXPECT_EQ(exr("c.exr").metadata.at("tyndall.time"), "0.5");
}

TEST_F(ReferenceTest, TermsAndDepthLeaveOutTheRest) {
    ASSERT_EQ(reference({"-o", "all.exr", "--spp", "16"}).status, 0);
    ASSERT_EQ(reference({"-o", "few.exr", "--spp", "16", "--terms", "LSE,LVE"}).status, 0);
    ASSERT_EQ(reference({"-o", "one.exr", "--spp", "16", "--max-depth", "1"}).status, 0);
    const ExrFile all = exr("all.exr"), few = exr("few.exr"), one = exr("one.exr");
    EXPECT_EQ(layer(few, "LE"), nullptr);
    EXPECT_EQ(layer(few, "LSSE"), nullptr);
    // The same paths, cut short: the terms of one scattering are the same to the last bit.
    for (const char* name : {"LSE", "LVE"}) {
        EXPECT_EQ(layer(all, name)->image.pixels, layer(few, name)->image.pixels) << name;
        EXPECT_EQ(layer(all, name)->image.pixels, layer(one, name)->image.pixels) << name;
    }
    for (const float value : layer(one, "LSSE")->image.pixels) EXPECT_EQ(value, 0.0f);
}

} // namespace
} // namespace tyndall::test
