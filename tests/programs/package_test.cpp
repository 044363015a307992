// The package, unpacked into another folder and run with nothing of this machine's environment.

#include <fstream>
#include <regex>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/image.h"
#include "programs/process.h"
#include "programs/scenes.h"
#include "support/content.h"

namespace tyndall::test {
namespace {
namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// Libraries that every Linux with a GL driver has, and the two of which the younger must win.
const std::regex kFromTheSystem(
    "(ld-linux|linux-vdso|lib(c|m|dl|rt|pthread|util|resolv|mvec)\\.so|libstdc\\+\\+|libgcc_s|libGL|libEGL|libOpenGL|libgbm|libdrm|"
    "libX|libxcb|libwayland|libxkbcommon|libbsd|libmd).*"); // the last two come with libX11

class PackageTest : public ::testing::Test {
public:
    static void SetUpTestSuite() {
        folder_ = scratchDir("package");
        ProcessOptions options;
        options.timeoutSeconds = 280;
        made_ = run({(sourceDir() / "cmake/package.sh").string(), binDir().parent_path().string(),
                     (folder_ / "dist").string()},
                    options);
        if (made_.status != 0) return;
        std::istringstream lines(made_.out);
        std::string line, archive;
        while (std::getline(lines, line)) archive = line; // the last line names the file
        fs::create_directories(folder_ / "some where else");
        unpacked_ = run({"/usr/bin/tar", "-xzf", archive, "-C",
                         (folder_ / "some where else").string(), "--strip-components=1"});
        archiveBytes_ = fs::file_size(archive);
    }

protected:
    static inline fs::path folder_;
    static inline ProcessResult made_, unpacked_;
    static inline uintmax_t archiveBytes_ = 0;

    fs::path root = folder_ / "some where else";
    ProcessOptions empty;
    void SetUp() override {
        ASSERT_EQ(made_.status, 0) << made_.out << made_.err;
        ASSERT_EQ(unpacked_.status, 0) << unpacked_.err;
        empty.environment.emplace();
        empty.folder = folder_;
    }
    [[nodiscard]] std::string program(const char* name) const {
        return (root / "bin" / name).string();
    }
};

TEST_F(PackageTest, HoldsProgramsPluginsShadersScenesAndLicences) {
    for (const char* file :
         {"bin/tyndall", "bin/tyndall-grid-reader", "lib/tyndall/plugins/volumetric_gi.so",
          "lib/tyndall/plugins/example_tint.so", "share/tyndall/shaders/variants.txt",
          "share/tyndall/content/demo.scene.json", "share/doc/tyndall/LICENSE"})
        EXPECT_TRUE(fs::exists(root / file)) << file;
    EXPECT_FALSE(fs::is_empty(root / "share/doc/tyndall/licenses"));
    EXPECT_LT(archiveBytes_, 100u << 20) << "a download of reasonable size";
}

TEST_F(PackageTest, FindsEveryLibraryInsideItself) {
    int inside = 0;
    for (const auto& entry : fs::recursive_directory_iterator(root)) {
        const std::string name = entry.path().filename().string();
        const bool isBinary =
            entry.path().parent_path() == root / "bin" || name.find(".so") != std::string::npos;
        if (!entry.is_regular_file() || !isBinary) continue;
        const ProcessResult libraries = run({"/usr/bin/ldd", entry.path().string()}, empty);
        std::istringstream lines(libraries.out);
        std::string line;
        while (std::getline(lines, line)) {
            std::istringstream words(line);
            std::string library, arrow, path;
            words >> library >> arrow;
            if (arrow != "=>") continue;
            std::getline(words >> std::ws, path);
            EXPECT_THAT(path, ::testing::Not(HasSubstr("not found")))
                << entry.path() << " needs " << library;
            if (std::regex_match(library, kFromTheSystem)) continue;
            EXPECT_TRUE(path.starts_with(root.string()))
                << entry.path() << " takes " << library << " from " << path;
            ++inside;
        }
    }
    EXPECT_GT(inside, 0);
}

TEST_F(PackageTest, RunsInAnEmptyEnvironment) {
    const ProcessResult version = run({program("tyndall"), "--version"}, empty);
    EXPECT_EQ(version.status, 0) << version.err;
    EXPECT_THAT(version.out, ::testing::StartsWith("tyndall "));
    const ProcessResult info = run({program("tyndall"), "info"}, empty);
    EXPECT_EQ(info.status, 0) << info.err;
    if (fs::exists(program("tyndall-editor"))) {
        const ProcessResult editor = run({program("tyndall-editor"), "--version"}, empty);
        EXPECT_EQ(editor.status, 0) << editor.err;
    }
}

TEST_F(PackageTest, RendersItsOwnSceneInAnEmptyEnvironment) {
    const fs::path output = folder_ / "demo.exr";
    const ProcessResult result = run(
        {program("tyndall"), "capture", (root / "share/tyndall/content/demo.scene.json").string(),
         "-o", output.string(), "--size", "32x18", "--quiet", "--fail-on-nonfinite"},
        empty);
    ASSERT_EQ(result.status, 0) << result.err;
    double sum = 0;
    for (float value : readExr(output).value().layers[0].image.pixels) sum += double(value);
    EXPECT_GT(sum, 0) << "something can be seen";
}

TEST_F(PackageTest, LoadsItsPluginsByName) {
    const std::string scene = writeFoggyScene(folder_).string();
    const ProcessResult result =
        run({program("tyndall"), "capture", scene, "-o", (folder_ / "p.exr").string(), "--size",
             "16x16", "--gi", "octaves", "--plugin", "volumetric_gi", "--quiet"},
            empty);
    EXPECT_EQ(result.status, 0) << result.err;
}

TEST_F(PackageTest, ReadsVolumesWithItsOwnReader) {
    const auto volume = REQUIRE_CONTENT("vdb/sphere_fog_tiny.vdb");
    const ProcessResult result = run({program("tyndall"), "info", volume.string()}, empty);
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_THAT(result.out, HasSubstr("grid '"));
}

} // namespace
} // namespace tyndall::test
