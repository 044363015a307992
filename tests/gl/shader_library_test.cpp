#include "gl/shader_library.h"

#include <gmock/gmock.h>

#include <cstdlib>
#include <fstream>

#include "core/log.h"
#include "gl/buffer.h"
#include "gl/gl_fixture.h"
#include "support/content.h"

namespace tyndall::gl {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr const char* kShader =
    "#include \"lib/value.glsl\"\nlayout(local_size_x = 1) in;\nlayout(std430) buffer Out { float result; };\n"
    "void main() { result = value(); }\n";

/// A folder of shaders that a library watches, and a way to run what is in it.
class ShaderLibraryTest : public test::GlTest {
protected:
    void SetUp() override {
        GlTest::SetUp();
        sink_ = log::setSink([this](log::Level level, std::string_view line) {
            if (level >= log::Level::Warning) warnings.emplace_back(line);
        });
    }
    void TearDown() override {
        log::setSink(sink_);
        GlTest::TearDown();
    }

    /// Writes a file with a time that differs from the one before, as an edit does.
    void write(const std::string& path, const std::string& text) {
        fs::create_directories((folder / path).parent_path());
        std::ofstream(folder / path, std::ios::binary) << text;
        fs::last_write_time(folder / path,
                            fs::file_time_type::clock::now() + std::chrono::seconds(++edits_));
    }
    [[nodiscard]] ShaderLibrary library() const {
        ShaderLibraryOptions options;
        options.folder = folder;
        options.pollInterval = std::chrono::milliseconds(0);
        return ShaderLibrary(options);
    }
    static float run(const Program& program) {
        const Buffer out("out", 4);
        glUseProgram(program.id());
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, GLuint(program.find("Out")->binding), out.id());
        glDispatchCompute(1, 1, 1);
        glUseProgram(0);
        return out.readAll<float>()[0];
    }
    /// Warnings that mention `text`.
    [[nodiscard]] size_t warningsWith(std::string_view text) const {
        return size_t(std::ranges::count_if(
            warnings, [&](const std::string& w) { return w.find(text) != std::string::npos; }));
    }

    fs::path folder = test::scratchDir("shaders");
    std::vector<std::string> warnings;

private:
    int edits_ = 0;
    log::Sink sink_;
};
TYNDALL_GL_TESTS(ShaderLibraryTest);

TEST_P(ShaderLibraryTest, AProgramIsMadeOnceAndStaysInItsPlace) {
    write("a.comp", kShader);
    write("lib/value.glsl", "float value() { return float(LEVEL); }\n");
    ShaderLibrary lib = library();
    const Program* one = lib.compute("a.comp", {{"LEVEL", 1}}).value();
    const Program* two = lib.compute("a.comp", {{"LEVEL", 2}}).value();
    EXPECT_NE(one, two);
    EXPECT_EQ(lib.compute("a.comp", {{"LEVEL", 1}}).value(), one);
    EXPECT_EQ(lib.programCount(), 2u);
    EXPECT_EQ(run(*one), 1.0f);
    EXPECT_EQ(run(*two), 2.0f);
    ShaderLibrary moved = std::move(lib);
    EXPECT_EQ(moved.compute("a.comp", {{"LEVEL", 2}}).value(), two);
}

TEST_P(ShaderLibraryTest, AChangedIncludeMakesTheProgramsThatUseItAnew) {
    write("a.comp", kShader);
    write(
        "b.comp",
        "layout(local_size_x = 1) in;\nlayout(std430) buffer Out { float result; };\nvoid main() { result = 5.0; }\n");
    write("lib/value.glsl", "float value() { return 1.0; }\n");
    ShaderLibrary lib = library();
    const Program* a = lib.compute("a.comp").value();
    const Program* b = lib.compute("b.comp").value();
    const GLuint nameOfB = b->id();
    EXPECT_EQ(lib.pollChanges(), 0);
    write("lib/value.glsl", "float value() { return 2.0; }\n");
    EXPECT_EQ(lib.pollChanges(), 1);
    EXPECT_EQ(lib.generation(), 1u);
    EXPECT_EQ(lib.pollChanges(), 0);
    EXPECT_EQ(lib.compute("a.comp").value(), a) << "the address stays";
    EXPECT_EQ(run(*a), 2.0f);
    EXPECT_EQ(b->id(), nameOfB);
}

TEST_P(ShaderLibraryTest, ABrokenEditKeepsTheLastGoodProgramAndIsReportedOnce) {
    write("a.comp", kShader);
    write("lib/value.glsl", "float value() { return 1.0; }\n");
    ShaderLibrary lib = library();
    const Program* program = lib.compute("a.comp").value();
    write("lib/value.glsl", "float value() { return oops; }\n");
    EXPECT_EQ(lib.pollChanges(), 0);
    for (int frame = 0; frame < 5; ++frame) {
        EXPECT_EQ(lib.pollChanges(), 0);
        EXPECT_EQ(lib.compute("a.comp").value(), program);
    }
    EXPECT_EQ(run(*program), 1.0f);
    EXPECT_EQ(warningsWith("the last good program stays"), 1u);
    EXPECT_EQ(warningsWith("lib/value.glsl:1"), 1u);
    ASSERT_EQ(lib.failures().size(), 1u);

    write(
        "lib/value.glsl",
        "#include \"lib/more.glsl\"\nfloat value() { return more(); }\n"); // broken in another way
    EXPECT_EQ(lib.pollChanges(), 0);
    EXPECT_EQ(warningsWith("lib/more.glsl"), 1u);
    write("lib/more.glsl",
          "float more() { return 3.0; }\n"); // mended by a file that was not there before
    EXPECT_EQ(lib.pollChanges(), 1);
    EXPECT_EQ(run(*program), 3.0f);
    EXPECT_TRUE(lib.failures().empty());
}

TEST_P(ShaderLibraryTest, AProgramThatNeverWorkedIsTriedAgainWhenItsFileChanges) {
    write("a.comp", "layout(local_size_x = 1) in;\nnonsense\n");
    ShaderLibrary lib = library();
    const Result<const Program*> first = lib.compute("a.comp");
    ASSERT_FALSE(first.ok());
    EXPECT_EQ(lib.compute("a.comp").message(), first.message());
    write(
        "a.comp",
        "layout(local_size_x = 1) in;\nlayout(std430) buffer Out { float result; };\nvoid main() { result = 4.0; }\n");
    EXPECT_EQ(lib.pollChanges(), 1);
    EXPECT_EQ(run(*lib.compute("a.comp").value()), 4.0f);
}

TEST_P(ShaderLibraryTest, AFileThatIsGoneForAMomentIsNoChange) {
    write("a.comp", kShader);
    write("lib/value.glsl", "float value() { return 1.0; }\n");
    ShaderLibrary lib = library();
    const Program* program = lib.compute("a.comp").value();
    fs::rename(folder / "lib/value.glsl", folder / "lib/backup");
    EXPECT_EQ(lib.pollChanges(), 0);
    EXPECT_TRUE(warnings.empty());
    write("lib/value.glsl", "float value() { return 6.0; }\n");
    EXPECT_EQ(lib.pollChanges(), 1);
    EXPECT_EQ(run(*program), 6.0f);
}

TEST_P(ShaderLibraryTest, TheFolderComesBeforeAddedSourcesAndTheseBeforeEmbeddedOnes) {
    static constexpr EmbeddedShader kEmbedded[] = {
        {"a.comp", kShader},
        {"lib/value.glsl", "float value() { return 1.0; }\n"},
        {"variants.txt", "a.comp\n"}};
    ShaderLibraryOptions options;
    options.embedded = kEmbedded;
    options.folder = folder;
    options.pollInterval = std::chrono::milliseconds(0);
    ShaderLibrary lib(options);
    const Program* program = lib.compute("a.comp").value();
    EXPECT_EQ(run(*program), 1.0f);
    lib.addSource("lib/value.glsl", "float value() { return 2.0; }\n");
    EXPECT_EQ(lib.pollChanges(), 1);
    EXPECT_EQ(run(*program), 2.0f);
    write("lib/value.glsl", "float value() { return 3.0; }\n");
    EXPECT_EQ(lib.pollChanges(), 1);
    EXPECT_EQ(run(*program), 3.0f);
}

TEST_P(ShaderLibraryTest, AProgramIsListedByVariantsOrByItsPlugin) {
    static constexpr EmbeddedShader kEmbedded[] = {{"variants.txt", "a.comp EXACT=0,1\n"}};
    ShaderLibraryOptions options;
    options.embedded = kEmbedded;
    ShaderLibrary lib(options);
    EXPECT_TRUE(lib.isListed({{"a.comp"}, {{"EXACT", 1}}}));
    EXPECT_FALSE(lib.isListed({{"a.comp"}, {}}));
    EXPECT_FALSE(lib.isListed({{"gi/mine.comp"}, {}}));
    lib.addSource("gi/mine.comp", "layout(local_size_x = 1) in;\nvoid main() {}\n");
    EXPECT_TRUE(lib.isListed({{"gi/mine.comp"}, {}}));
}

TEST_P(ShaderLibraryTest, TheEnvironmentNamesTheFolder) {
    write(
        "env.comp",
        "layout(local_size_x = 1) in;\nlayout(std430) buffer Out { float result; };\nvoid main() { result = 8.0; }\n");
    setenv("TYNDALL_SHADER_DIR", folder.c_str(), 1);
    ShaderLibrary lib;
    unsetenv("TYNDALL_SHADER_DIR");
    const Result<const Program*> program = lib.compute("env.comp");
    ASSERT_TRUE(program.ok()) << program.message();
    EXPECT_EQ(run(**program), 8.0f);
}

TEST_P(ShaderLibraryTest, AFolderThatIsNotThereIsReported) {
    ShaderLibraryOptions options;
    options.folder = folder / ("gone-" + std::to_string(int(GetParam())));
    const ShaderLibrary lib(options);
    EXPECT_EQ(warningsWith(options.folder.string()), 1u);
    EXPECT_FALSE(lib.variants().lines().empty()) << "the built-in ones are used";
}

TEST_P(ShaderLibraryTest, NoPathLeavesTheFolder) {
    std::ofstream(folder.parent_path() / "tyndall-outside.comp") << "void main() {}\n";
    ShaderLibrary lib = library();
    EXPECT_FALSE(lib.compute("../tyndall-outside.comp").ok());
    EXPECT_FALSE(lib.compute((folder.parent_path() / "tyndall-outside.comp").string()).ok());
    fs::remove(folder.parent_path() / "tyndall-outside.comp");
}

/// A shader that no variant names would never be compiled by a test.
TEST(EngineShaders, AreAllInTheListOfVariants) {
    const ShaderLibrary lib;
    for (const EmbeddedShader& shader : engineShaders()) {
        if (!stageOfFile(shader.path)) continue;
        const bool listed =
            std::ranges::any_of(lib.variants().lines(), [&](const VariantLine& line) {
                return std::ranges::find(line.files, shader.path) != line.files.end();
            });
        EXPECT_TRUE(listed) << shader.path << " is not in shaders/variants.txt";
    }
}

} // namespace
} // namespace tyndall::gl
