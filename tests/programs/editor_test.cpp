// `tyndall-editor` under a virtual display: what it shows is what `tyndall capture` renders.

#include <algorithm>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/image.h"
#include "programs/process.h"
#include "programs/scenes.h"
#include "support/content.h"

namespace tyndall::test {
namespace {
namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr const char* kXvfbRun = "/usr/bin/xvfb-run";

struct EditorTest : ::testing::Test {
    ProcessOptions options;
    std::string foggy;
    void SetUp() override {
        options.folder = scratchDir("editor");
        foggy = writeFoggyScene(options.folder).filename().string();
        // What a user's settings are must not matter, nor whether a display is there.
        const fs::path home = options.folder / "home";
        fs::create_directories(home);
        options.environment = std::vector<std::string>{
            "PATH=/usr/bin:/bin", "HOME=" + home.string(), "LIBGL_ALWAYS_SOFTWARE=1"};
    }
    static std::string program() { return (binDir() / "tyndall-editor").string(); }
    ProcessResult bare(std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), program());
        return run(arguments, options);
    }
    ProcessResult editor(std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(),
                         {kXvfbRun, "-a", "-s", "-noreset -screen 0 1280x800x24", program()});
        return run(arguments, options);
    }
    [[nodiscard]] std::string file(const std::string& name) const {
        const Result<std::string> bytes = readFile(options.folder / name);
        return bytes.ok() ? *bytes : "";
    }
    void expectSamePicture(const std::vector<std::string>& both) {
        std::vector<std::string> shown{foggy, "--size",   "160x120",      "--frames",
                                       "3",   "--hidden", "--screenshot", "shown.png"};
        shown.insert(shown.end(), both.begin(), both.end());
        const ProcessResult window = editor(shown);
        ASSERT_EQ(window.status, 0) << window.err;
        std::vector<std::string> captured{"capture", foggy, "--size",
                                          "160x120", "-o",  "captured.png"};
        captured.insert(captured.end(), both.begin(), both.end());
        const ProcessResult headless = tyndall(captured, options);
        ASSERT_EQ(headless.status, 0) << headless.err;
        ASSERT_GT(file("captured.png").size(), 1000u) << "a picture of something";
        // One encoder and the same bytes: the files are equal exactly where the pixels are.
        EXPECT_EQ(file("shown.png"), file("captured.png"));
    }
};

#define REQUIRE_DISPLAY()                                                                          \
    if (!fs::exists(kXvfbRun)) GTEST_SKIP() << "xvfb-run is not here: the editor needs a display"

TEST_F(EditorTest, TheViewportShowsWhatCaptureRenders) {
    REQUIRE_DISPLAY();
    expectSamePicture({});
}

TEST_F(EditorTest, SettingsTechniqueAndPoseMeanTheSameInBoth) {
    REQUIRE_DISPLAY();
    expectSamePicture({"--set", "post.toneCurve=aces", "--gi", "none",
                       "--pose=1,1.5,4,0,0.1,0,0.99498743710662"});
}

TEST_F(EditorTest, ThePoseOfTheSceneCameraMakesTheSceneCamerasPicture) {
    ASSERT_EQ(tyndall({"capture", foggy, "--size", "64x48", "-o", "node.png"}, options).status, 0);
    ASSERT_EQ(tyndall({"capture", foggy, "--size", "64x48", "--pose", "0,1,5,0,0,0,1,0.8", "-o",
                       "pose.png"},
                      options)
                  .status,
              0);
    ASSERT_EQ(
        tyndall({"capture", foggy, "--size", "64x48", "--pose", "1,1,5,0,0,0,1", "-o", "moved.png"},
                options)
            .status,
        0);
    EXPECT_EQ(file("node.png"), file("pose.png"));
    EXPECT_NE(file("node.png"), file("moved.png"));
}

TEST_F(EditorTest, AWrongPoseIsRefusedWithOneSentence) {
    for (const char* pose : {"1,2,3", "1,2,3,0,0,0,0", "1,2,3,0,0,0,x", "1,2,3,0,0,0,1,",
                             "1,2,3,0,0,0,1,4", "nan,2,3,0,0,0,1", "1,2,3,0,0,0,1,1,1"}) {
        const ProcessResult result =
            tyndall({"capture", foggy, "--pose", pose, "-o", "a.png"}, options);
        EXPECT_EQ(result.status, 2) << pose;
        EXPECT_THAT(result.err, StartsWith(std::string("tyndall: --pose ") + pose + ": ")) << pose;
    }
}

TEST_F(EditorTest, AWindowThatIsShownDrawsAllPanesAndLeavesItsLayoutInTheUsersFolder) {
    REQUIRE_DISPLAY();
    const ProcessResult result = editor({foggy, "--frames", "2", "--window", "900x600", "--size",
                                         "64x48", "--screenshot", "pane.png"});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_GT(file("pane.png").size(), 100u);
    EXPECT_THAT(file("home/.config/tyndall/imgui.ini"), HasSubstr("[Tyndall][Panes]"));
    EXPECT_FALSE(fs::exists(options.folder / "imgui.ini"));
}

TEST_F(EditorTest, WithoutADisplayItSaysSoInOneSentence) {
    const ProcessResult result = bare({foggy});
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.err, AllOf(StartsWith("tyndall-editor: no window can be opened"),
                                  HasSubstr("tyndall capture")));
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1);
}

TEST_F(EditorTest, AWrongSceneIsRefusedBeforeAnyWindow) {
    std::ofstream(options.folder / "broken.scene.json") << "{\"tyndall\": 1, \"nodes\": 7}";
    for (const char* scene : {"nothing.gltf", "broken.scene.json"}) {
        const ProcessResult result = bare({scene});
        EXPECT_EQ(result.status, 2) << result.err;
        EXPECT_THAT(result.err, AllOf(StartsWith("tyndall-editor: "), HasSubstr(scene)));
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    }
}

TEST_F(EditorTest, HelpAndVersionNeedNoDisplay) {
    const ProcessResult help = bare({"--help"});
    EXPECT_EQ(help.status, 0) << help.err;
    EXPECT_THAT(help.out,
                AllOf(HasSubstr("Examples:"), HasSubstr("--frames"), HasSubstr("--screenshot"),
                      HasSubstr("--hidden"), HasSubstr("--pose")));
    const ProcessResult version = bare({"--version"});
    EXPECT_EQ(version.status, 0);
    EXPECT_THAT(version.out, StartsWith("tyndall-editor "));
}

TEST_F(EditorTest, CombinationsThatMakeNoSenseAreRefused) {
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{foggy, "--screenshot", "a.png"},
          {foggy, "--hidden"},
          {foggy, "--size", "0x0"},
          {foggy, "--window", "big"},
          {foggy, "--nothing"}}) {
        const ProcessResult result = bare(arguments);
        EXPECT_EQ(result.status, 2) << arguments[1];
        EXPECT_THAT(result.err, HasSubstr(arguments[1])) << result.err;
    }
}

} // namespace
} // namespace tyndall::test
