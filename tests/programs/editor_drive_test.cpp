// The editor driven by mouse and keys under a virtual display. Places are those of a window of 1280x800.

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
using ::testing::Not;

/// Starts the editor with the arguments after the first and waits for its first picture. The functions are for the script that follows.
constexpr const char* kPrelude = R"sh(
program=$1; shift
"$program" "$@" --window 1280x800 --gi none 2> err.txt &
pid=$!
said() { for i in $(seq 400); do [ "$(grep -c "$1" err.txt)" -ge "$2" ] && return; sleep 0.1; done; echo "never said: $1"; }
keys() { xdotool key "$@"; }
click() { xdotool mousemove $1 $2 click 1; }
ticks() { awk '{print $14 + $15}' /proc/$pid/stat; } # hundredths of a second of processor time
state() { import -window root -crop 240x22+735+27 rgba:- | md5sum; } # of the picture, as the toolbar says it
quit() { kill $pid; wait $pid 2> /dev/null; true; }
said 'direct terms only' 1
window=$(xdotool search --onlyvisible --name Tyndall | tail -1)
xdotool windowfocus $window
sleep 1
)sh";

struct EditorDriven : ::testing::Test {
    ProcessOptions options;
    std::string foggy;
    void SetUp() override {
        for (const char* tool : {"/usr/bin/xvfb-run", "/usr/bin/xdotool", "/usr/bin/import"})
            if (!fs::exists(tool)) GTEST_SKIP() << tool << " is not here";
        options.folder = scratchDir("editor_driven");
        foggy = writeFoggyScene(options.folder).filename().string();
        fs::create_directories(options.folder / "home");
        options.environment = std::vector<std::string>{
            "PATH=/usr/bin:/bin", "HOME=" + (options.folder / "home").string(),
            "LIBGL_ALWAYS_SOFTWARE=1"};
    }
    /// What the script printed.
    std::string drive(const std::vector<std::string>& arguments, const std::string& script) {
        std::vector<std::string> all{"/usr/bin/xvfb-run",
                                     "-a",
                                     "-s",
                                     "-noreset -screen 0 1280x800x24",
                                     "/bin/bash",
                                     "-c",
                                     kPrelude + script + "\nquit\n",
                                     "drive",
                                     (binDir() / "tyndall-editor").string()};
        all.insert(all.end(), arguments.begin(), arguments.end());
        const ProcessResult result = run(all, options);
        EXPECT_EQ(result.status, 0) << result.err;
        EXPECT_THAT(result.out, Not(HasSubstr("never said"))) << file("err.txt");
        return result.out;
    }
    [[nodiscard]] std::string file(const std::string& name) const {
        const Result<std::string> bytes = readFile(options.folder / name);
        return bytes.ok() ? *bytes : "";
    }
};

TEST_F(EditorDriven, KeysShorterThanAFrameAreAllHeard) {
    // Averaging never rests, and a frame of this size takes llvmpipe longer than a key is held.
    const std::string out = drive({foggy, "--size", "480x270", "--converge"}, R"sh(
        keys --delay 5 $(for i in $(seq 12); do echo ctrl+l; done)
        said copied: 12; sleep 1; grep -c copied: err.txt)sh");
    EXPECT_EQ(out, "12\n");
}

TEST_F(EditorDriven, ATextCursorLeavesTheProcessorAlone) {
    const std::string out = drive({foggy, "--size", "64x48"}, R"sh(
        click 120 62; sleep 2
        before=$(ticks); sleep 4; echo $(($(ticks) - before))
        keys ctrl+l; sleep 1; grep -c copied: err.txt)sh");
    const size_t line = out.find('\n');
    EXPECT_LT(std::stoi(out), 20) << "5 % of 4 s, in hundredths of a second";
    EXPECT_EQ(out.substr(line + 1), "0\n") << "the cursor was in the field, which takes the keys";
}

TEST_F(EditorDriven, APresetIsCopiedByItsName) {
    drive({foggy, "--size", "64x48"},
          "click 1057 428; sleep 1; xdotool mousemove 640 10; keys ctrl+l; said copied: 1");
    EXPECT_THAT(file("err.txt"), AllOf(HasSubstr(" --quality low "), Not(HasSubstr("--set"))));
}

TEST_F(EditorDriven, AFileIsNotReplacedUnaskedAndACopyDoesNotRenameTheScene) {
    const std::string name = fs::path(foggy).stem().stem().string() + "-edited.scene.json";
    drive({foggy, "--size", "64x48"}, "copy=" + name + R"sh(
        echo precious > $copy
        for key in ctrl+s Return Escape Escape; do keys $key; sleep 0.5; done
        keys ctrl+l; said copied: 1; cat $copy > kept.txt; rm $copy
        keys ctrl+s; sleep 0.5; keys Return; said wrote 1
        xdotool getwindowname $window > title.txt)sh");
    EXPECT_EQ(file("kept.txt"), "precious\n");
    EXPECT_THAT(file(name), HasSubstr("\"tyndall\""));
    EXPECT_THAT(file("title.txt"), HasSubstr(foggy));
}

TEST_F(EditorDriven, TheToolbarSaysRenderingWhileAFrameIsMade) {
    const std::string out = drive({foggy, "--size", "320x180"}, R"sh(
        sleep 2; rest=$(state); other=no
        keys f # moves the camera, for a frame of about a second
        for i in $(seq 10); do [ "$(state)" != "$rest" ] && other=yes && break; done
        for i in $(seq 100); do [ "$(state)" = "$rest" ] && break; sleep 0.2; done
        echo $other; [ "$(state)" = "$rest" ] && echo rests)sh");
    EXPECT_EQ(out, "yes\nrests\n");
}

} // namespace
} // namespace tyndall::test
