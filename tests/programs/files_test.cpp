// Files and options as people meet them: grids to choose from, very long names, sizes without room, light that is no number.

#include <algorithm>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/image.h"
#include "media_volume_files.h"
#include "programs/process.h"
#include "programs/scenes.h"
#include "support/content.h"

namespace tyndall::test {
namespace {
namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

VolumeSpec cube(const std::string& name, int edge, double value) {
    VolumeSpec spec;
    spec.name = name;
    for (int z = 0; z < edge; ++z)
        for (int y = 0; y < edge; ++y)
            for (int x = 0; x < edge; ++x) spec.voxels.emplace_back(ivec3(x, y, z), value);
    return spec;
}

struct FilesTest : ::testing::Test {
    ProcessOptions options;
    void SetUp() override { options.folder = scratchDir("files"); }

    [[nodiscard]] ProcessResult capture(std::vector<std::string> arguments) const {
        const std::vector<std::string> all = {"--size", "8x8", "--gi", "none"};
        arguments.insert(arguments.begin(), "capture");
        arguments.insert(arguments.end(), all.begin(), all.end());
        return tyndall(arguments, options);
    }
    void expectOneSentence(const ProcessResult& result, int status, const std::string& part) const {
        EXPECT_EQ(result.status, status) << result.err;
        EXPECT_THAT(result.err, AllOf(HasSubstr(part), Not(HasSubstr("this is a bug"))));
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    }
};

TEST_F(FilesTest, TwoGridsThatCouldBeDensityAreToBeChosenFrom) {
    writeOpenVdb(options.folder / "two.vdb", {cube("a", 4, 1), cube("b", 12, 1)});
    expectOneSentence(capture({"two.vdb", "-o", "o.exr", "--quiet"}), 2,
                      "several grids that could be density, 'a' or 'b'; choose with --grid NAME");
    expectOneSentence(capture({"two.vdb", "-o", "o.exr", "--quiet", "--grid", "c"}), 2,
                      "has no grid 'c'; it has 'a'");
    // Both ways that the sentence names.
    std::ofstream(options.folder / "two.scene.json") << R"({"tyndall": 1, "nodes": [
        {"name": "cloud", "medium": {"type": "grid", "file": "two.vdb", "grid": "b"}}]})";
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"two.vdb", "--grid", "b"}, {"two.scene.json"}}) {
        std::vector<std::string> all = arguments;
        all.insert(all.end(), {"-o", "o.exr"});
        const ProcessResult result = capture(all);
        EXPECT_EQ(result.status, 0) << result.err;
    }
    for (const char* command : {"graph", "reference"}) {
        std::vector<std::string> all = {command, "two.vdb", "--grid", "b", "--size", "4x4"};
        if (command == std::string("reference"))
            all.insert(all.end(), {"-o", "r.exr", "--spp", "1"});
        const ProcessResult result = tyndall(all, options);
        EXPECT_EQ(result.status, 0) << result.err;
    }
}

TEST_F(FilesTest, AGridIsChosenInBareVolumesAlone) {
    const std::string scene = writeClearScene(options.folder).filename().string();
    expectOneSentence(capture({scene, "-o", "o.exr", "--quiet", "--grid", "density"}), 2,
                      "--grid density: it chooses a grid of a bare .vdb or .nvdb");
}

TEST_F(FilesTest, NamesOf255BytesAreWritten) {
    const std::string scene = writeClearScene(options.folder).filename().string();
    for (const size_t bytes : {249, 255})
        for (const char* ending : {".exr", ".png"}) {
            const std::string name = std::string(bytes - 4, 'x') + ending;
            const ProcessResult result = capture({scene, "-o", name});
            EXPECT_EQ(result.status, 0) << result.err;
            EXPECT_TRUE(fs::exists(options.folder / name)) << bytes << ending;
        }
    const std::string name = std::string(251, 'r') + ".exr";
    const ProcessResult reference =
        tyndall({"reference", scene, "-o", name, "--size", "4x4", "--spp", "2"}, options);
    EXPECT_EQ(reference.status, 0) << reference.err;
    EXPECT_TRUE(fs::exists(options.folder / name));
    expectOneSentence(capture({scene, "-o", std::string(252, 'x') + ".exr", "--quiet"}), 2,
                      "the file's name has 256 bytes; it can have 255");
}

TEST_F(FilesTest, ASizeWithoutRoomIsOneSentenceAndStatusOne) {
    const std::string scene = writeClearScene(options.folder).filename().string();
    const ProcessResult picture = tyndall(
        {"capture", scene, "-o", "o.exr", "--size", "16384x16384", "--gi", "none", "--quiet"},
        options);
    // A GPU with that much memory may well do it.
    if (picture.status != 0) expectOneSentence(picture, 1, "a smaller --size");
    // 268 million pixels with 11 terms and 16 streams of three doubles: 160 GiB.
    const ProcessResult reference = tyndall(
        {"reference", scene, "-o", "r.exr", "--size", "16384x16384", "--spp", "1", "--quiet"},
        options);
    expectOneSentence(reference, 1, "a smaller --size needs less");
}

TEST_F(FilesTest, WhatIsNotPlayedYetIsSaid) {
    const std::string scene = writeClearScene(options.folder).filename().string();
    const ProcessResult still = capture({scene, "-o", "o.exr"});
    EXPECT_THAT(still.err, Not(HasSubstr("played")));
    const ProcessResult stepped =
        capture({scene, "-o", "o.exr", "--time-step", "0.5", "--time", "3"});
    EXPECT_EQ(stepped.status, 0) << stepped.err;
    EXPECT_THAT(stepped.err, AllOf(HasSubstr("--time-step 0.5: nothing in a scene is played yet"),
                                   HasSubstr("--time 3: nothing in a scene is played yet")));

    writeOpenVdb(options.folder / "puff_0001.vdb", {cube("density", 4, 1)});
    std::ofstream(options.folder / "moving.scene.json") << R"({"tyndall": 1, "nodes": [
        {"name": "puff", "medium": {"type": "grid", "file": "puff_%04d.vdb", "frames": [1, 9]}},
        {"name": "eye", "camera": {"type": "perspective"}, "translation": [0, 0, 20],
         "animate": {"property": "translation", "times": [0, 1], "values": [[0, 0, 0], [0, 1, 0]]}}]})";
    const ProcessResult moving = capture({"moving.scene.json", "-o", "o.exr"});
    EXPECT_EQ(moving.status, 0) << moving.err;
    EXPECT_THAT(
        moving.err,
        HasSubstr("note: animations are not played yet: 'puff' (frames), 'eye' (animate) stand"));
}

TEST_F(FilesTest, LightThatIsNoNumberIsSaidWithItsTermAndItsOwner) {
    // 1e30 nits a metre over 1e10 m: more than single precision holds.
    std::ofstream(options.folder / "blinding.scene.json") << R"({"tyndall": 1, "nodes": [
        {"name": "glow", "scale": [1e10, 1e10, 1e10],
         "medium": {"type": "homogeneous", "shape": "sphere", "size": [1, 1, 1], "absorption": [0, 0, 0],
                    "scattering": [0, 0, 0], "emission": [1e30, 1e30, 1e30]}},
        {"name": "eye", "translation": [0, 0, 2], "camera": {"type": "perspective"}}]})";
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{}, {"--frames", "3"}, {"--frames", "3", "--converge"}}) {
        std::vector<std::string> all = {"blinding.scene.json", "-o", "o.exr"};
        all.insert(all.end(), arguments.begin(), arguments.end());
        const ProcessResult result = capture(all);
        EXPECT_EQ(result.status, 0) << result.err;
        EXPECT_THAT(result.err,
                    HasSubstr("192 values of the picture are not finite: LE of the direct "
                              "passes from frame 1 on\n"));
    }
    const ProcessResult good =
        capture({writeClearScene(options.folder).filename().string(), "-o", "o.exr"});
    EXPECT_THAT(good.err, Not(HasSubstr("finite")));
}

} // namespace
} // namespace tyndall::test
