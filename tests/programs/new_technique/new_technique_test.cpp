// What cmake/new-technique.sh makes: it builds, renders, is listed and obeys the laws of techniques. Broken copies of it obey them
// not: the laws can fail.

#include <cstdlib>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/image.h"
#include "programs/process.h"
#include "support/content.h"

namespace tyndall::test {
namespace {
namespace fs = std::filesystem;
using ::testing::HasSubstr;

std::string textOf(const fs::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

/// A copy of what the script reads and changes.
fs::path copyOfTheSource(const char* name) {
    const fs::path copy = scratchDir(name);
    for (const char* folder : {"cmake", "plugins/volumetric_gi", "shaders", "docs/techniques"}) {
        fs::create_directories(copy / folder);
        fs::copy(sourceDir() / folder, copy / folder, fs::copy_options::recursive);
    }
    return copy;
}

ProcessResult newTechnique(const fs::path& folder, const std::string& name) {
    return run({"/bin/bash", (folder / "cmake/new-technique.sh").string(), name});
}

TEST(NewTechnique, AddsFilesAndTwoEntriesAndTouchesNothingElse) {
    const fs::path copy = copyOfTheSource("new_technique");
    ASSERT_EQ(newTechnique(copy, "two_fold").status, 0);
    std::set<std::string> added, changed;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(copy)) {
        if (!entry.is_regular_file()) continue;
        const fs::path name = fs::relative(entry.path(), copy);
        if (!fs::exists(sourceDir() / name))
            added.insert(name.string());
        else if (textOf(entry.path()) != textOf(sourceDir() / name))
            changed.insert(name.string());
    }
    EXPECT_THAT(added, ::testing::ElementsAre(
                           "docs/techniques/two_fold.md",
                           "plugins/volumetric_gi/two_fold/two_fold_technique.cpp",
                           "plugins/volumetric_gi/two_fold/two_fold_technique.h",
                           "shaders/gi/two_fold/march.comp", "shaders/shared/two_fold.h"));
    EXPECT_THAT(changed,
                ::testing::ElementsAre("plugins/volumetric_gi/plugin.cpp", "shaders/variants.txt"));
    EXPECT_THAT(textOf(copy / "plugins/volumetric_gi/plugin.cpp"), HasSubstr("    X(TwoFold)\n"));
    for (const std::string& file : added)
        EXPECT_EQ(textOf(copy / file).find('@'), std::string::npos) << "left open in " << file;
}

TEST(NewTechnique, RefusesNamesThatCannotBe) {
    const fs::path copy = copyOfTheSource("new_technique_refused");
    for (const char* name : {"", "Two", "2fold", "two-fold", "two__fold", "../two", "octaves",
                             "shared", "traced", "none"})
        EXPECT_EQ(newTechnique(copy, name).status, 2) << name;
    EXPECT_EQ(textOf(copy / "shaders/variants.txt"), textOf(sourceDir() / "shaders/variants.txt"));
    EXPECT_THAT(newTechnique(copy, "octaves").err, HasSubstr("exists already"));
}

/// Shaders of what was made are read from its folder, not built into the programs.
class MadeTechnique : public ::testing::Test {
protected:
    void SetUp() override {
        setenv("TYNDALL_SHADER_DIR", MADE_TREE "/shaders", 1);
        setenv("TYNDALL_TEST_PLUGIN", MADE_PLUGIN, 1);
    }
    void TearDown() override {
        unsetenv("TYNDALL_SHADER_DIR");
        unsetenv("TYNDALL_TEST_PLUGIN");
    }
    static ProcessResult capture(const std::string& technique, const fs::path& picture) {
        return tyndall({"capture", (sourceDir() / "content/cornell_fog.scene.json").string(), "-o",
                        picture.string(), "--size", "96x54", "--aov", "terms", "--plugin",
                        MADE_PLUGIN, "--gi", technique});
    }
};

TEST_F(MadeTechnique, RendersAndIsListed) {
    const fs::path folder = scratchDir("made_technique"), picture = folder / "picture.exr";
    const ProcessResult captured = capture("two_fold", picture);
    ASSERT_EQ(captured.status, 0) << captured.err;
    const Result<ExrFile> file = readExr(picture);
    ASSERT_TRUE(file.ok()) << file.message();
    float brightest = 0;
    for (const ImageLayer& layer : file->layers)
        if (layer.name == "LVVE")
            for (const float value : layer.image.pixels) brightest = std::max(brightest, value);
    EXPECT_GT(brightest, 0);
    const ProcessResult unknown = capture("no_such", folder / "none.exr");
    EXPECT_NE(unknown.status, 0);
    EXPECT_THAT(unknown.err, HasSubstr("octaves, lpv, vpl, surfels, two_fold"));
}

/// The laws that each technique breaks.
std::map<std::string, std::set<std::string>> judge(const std::string& filter) {
    const fs::path report = scratchDir("laws") / "report.json";
    ProcessOptions options;
    options.timeoutSeconds = 600; // a busy machine, and shaders that no test has compiled yet
    const ProcessResult judged =
        run({TECHNIQUE_LAWS, "--gtest_filter=" + filter, "--gtest_output=json:" + report.string()},
            options);
    std::map<std::string, std::set<std::string>> broken;
    std::string why;
    EXPECT_TRUE(endedByItself(judged, why)) << why;
    const nlohmann::json results = nlohmann::json::parse(textOf(report));
    for (const nlohmann::json& suite : results.at("testsuites"))
        for (const nlohmann::json& test : suite.at("testsuite")) {
            const std::string name = test.at("name"); // Law/technique
            const size_t slash = name.find('/');
            std::set<std::string>& laws = broken[name.substr(slash + 1)];
            if (test.contains("failures")) laws.insert(name.substr(0, slash));
        }
    for (const auto& [technique, laws] : broken) {
        printf("%s:", technique.c_str());
        for (const std::string& law : laws) printf(" %s", law.c_str());
        printf("\n");
    }
    return broken;
}

TEST_F(MadeTechnique, ObeysTheLawsThatItsBrokenCopiesBreak) {
    const auto broken = judge("*/two_fold:*/black:*/doubled:*/leaking:*/noisy:*/late:*/misplaced");
    ASSERT_EQ(broken.size(), 7u);
    EXPECT_TRUE(broken.at("two_fold").empty());
    // Each breaks the law that was made for it, and may break others.
    const std::pair<const char*, const char*> expected[] = {
        {"black", "TwiceTheLightIsTwiceThePicture"},
        {"doubled", "EachClaimIsNearTheReference"},
        {"leaking", "AClosedRoomStaysDark"},
        {"noisy", "EachClaimIsNearTheReference"},
        {"late", "ALightThatGoesOutLeavesNothing"},
        {"misplaced", "APictureIsTheSumOfTermsThatWereAskedFor"}};
    for (const auto& [technique, law] : expected)
        EXPECT_TRUE(broken.at(technique).count(law)) << technique << " obeys " << law;
}

} // namespace
} // namespace tyndall::test
