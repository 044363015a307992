// Expansion of shaders, the list of variants: no GL needed.

#include "gl/shader_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "gl/shader_variants.h"

namespace tyndall::gl {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

struct Folder {
    std::map<std::string, std::string> files;
    [[nodiscard]] ReadShader reader() const {
        return [this](const std::string& path) -> std::optional<std::string> {
            const auto found = files.find(path);
            if (found == files.end()) return std::nullopt;
            return found->second;
        };
    }
    [[nodiscard]] Result<ExpandedShader> expand(const std::string& path,
                                                std::vector<ShaderDefine> defines = {}) const {
        return expandShader(path, defines, reader());
    }
};

size_t occurrences(const std::string& text, std::string_view part) {
    size_t count = 0;
    for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
        ++count;
    return count;
}

TEST(ShaderSource, BeginsWithVersionAndDefines) {
    const Folder folder{{{"a.comp", "void main() {}\n"}}};
    const Result<ExpandedShader> shader = folder.expand("a.comp", {{"EXACT", 1}, {"STEPS", -4}});
    ASSERT_TRUE(shader.ok()) << shader.message();
    EXPECT_EQ(shader->text,
              "#version 450 core\n#define EXACT 1\n#define STEPS -4\n#line 1\nvoid main() {}\n");
    EXPECT_EQ(shader->files, std::vector<std::string>{"a.comp"});
}

TEST(ShaderSource, AnIncludeIsNumberedAndTheLinesAfterItKeepTheirNumbers) {
    const Folder folder{
        {{"a.comp", "one\n#include \"lib/b.glsl\"\nthree\n"}, {"lib/b.glsl", "bee\n"}}};
    const Result<ExpandedShader> shader = folder.expand("a.comp");
    ASSERT_TRUE(shader.ok()) << shader.message();
    EXPECT_THAT(shader->text, HasSubstr("#line 100001\nbee\n"));
    EXPECT_THAT(shader->text, HasSubstr("#line 3\nthree\n"));
    EXPECT_EQ(shader->files, (std::vector<std::string>{"a.comp", "lib/b.glsl"}));
}

TEST(ShaderSource, AnIncludeThatIsNeededTwiceIsThereOnce) {
    const Folder folder{{{"a.comp", "#include \"b.glsl\"\n#include \"c.glsl\"\n"},
                         {"b.glsl", "#include \"c.glsl\"\n"},
                         {"c.glsl", "sea\n"}}};
    const Result<ExpandedShader> shader = folder.expand("a.comp");
    ASSERT_TRUE(shader.ok()) << shader.message();
    EXPECT_EQ(occurrences(shader->text, "sea"), 1u);
}

/// Only the driver knows whether the first copy counts, so both are there, and a guard lets it take one.
TEST(ShaderSource, AnIncludeInsideACaseStaysAvailableOutsideIt) {
    const Folder folder{{{"a.comp", "#if MASK\n#include \"b.glsl\"\n#endif\n#include \"b.glsl\"\n"},
                         {"b.glsl", "bee\n"}}};
    const Result<ExpandedShader> shader = folder.expand("a.comp", {{"MASK", 0}});
    ASSERT_TRUE(shader.ok()) << shader.message();
    EXPECT_EQ(occurrences(shader->text, "bee"), 2u);
    EXPECT_EQ(occurrences(shader->text, "#ifndef TYNDALL_INCLUDED_1\n"), 2u);
}

TEST(ShaderSource, WhatIsForCppIsLeftOut) {
    const Folder folder{
        {{"a.comp",
          "#ifdef __cplusplus\n#include \"core/math.h\"\n#ifdef X\ninner\n#endif\ncpp\n#else\nglsl\n#endif\nboth\n"}}};
    const Result<ExpandedShader> shader = folder.expand("a.comp");
    ASSERT_TRUE(shader.ok()) << shader.message();
    EXPECT_THAT(shader->text, Not(HasSubstr("core/math.h")));
    EXPECT_THAT(shader->text, Not(HasSubstr("inner")));
    EXPECT_THAT(shader->text, Not(HasSubstr("cpp")));
    EXPECT_THAT(shader->text, HasSubstr("glsl\n#endif\nboth\n"));
    EXPECT_EQ(occurrences(shader->text, "\n"), 1u + 1u + 10u)
        << "version and #line, then every line in its place";
}

TEST(ShaderSource, WhatIsCommentedOutIsNotIncluded) {
    const Folder folder{
        {{"a.comp",
          "// #include \"x.glsl\"\n/* begins\n#include \"x.glsl\"\nends */ rest // /*\n  #  "
          "include \"b.glsl\" // here\n"},
         {"b.glsl", "bee"}}};
    const Result<ExpandedShader> shader = folder.expand("a.comp");
    ASSERT_TRUE(shader.ok()) << shader.message();
    EXPECT_THAT(shader->text, HasSubstr("\nbee\n"));
}

TEST(ShaderSource, ACycleIsRefusedWithItsWay) {
    const Folder folder{{{"a.comp", "#include \"b.glsl\"\n"},
                         {"b.glsl", "\n\n#include \"c.glsl\"\n"},
                         {"c.glsl", "#include \"b.glsl\"\n"}}};
    const Result<ExpandedShader> shader = folder.expand("a.comp");
    ASSERT_FALSE(shader.ok());
    EXPECT_THAT(shader.message(), HasSubstr("c.glsl:1"));
    EXPECT_THAT(shader.message(), HasSubstr("b.glsl -> c.glsl -> b.glsl"));
    const Folder self{{{"a.comp", "#include \"a.comp\"\n"}}};
    EXPECT_FALSE(self.expand("a.comp").ok());
}

TEST(ShaderSource, AMissingFileIsNamedWithThePlaceThatWantsIt) {
    const Folder folder{{{"a.comp", "\n#include \"b.glsl\"\n"},
                         {"b.glsl", "\n\n#include \"gone.glsl\"\n"},
                         {"c.comp", "#include <x>\n"}}};
    const Result<ExpandedShader> shader = folder.expand("a.comp");
    ASSERT_FALSE(shader.ok());
    EXPECT_THAT(shader.message(), HasSubstr("b.glsl:3"));
    EXPECT_THAT(shader.message(), HasSubstr("gone.glsl"));
    EXPECT_THAT(folder.expand("none.comp").message(), HasSubstr("none.comp"));
    EXPECT_THAT(folder.expand("c.comp").message(), HasSubstr("c.comp:1"));
}

TEST(ShaderSource, MessagesOfEveryDriverGetFileAndLine) {
    const ExpandedShader shader{"", {"a.comp", "lib/b.glsl"}};
    EXPECT_EQ(mapShaderMessages("0:100012(5): error: `x' undeclared\n\n", shader),
              "lib/b.glsl:12:5: error: `x' undeclared");
    EXPECT_EQ(mapShaderMessages("0(7) : error C1008: undefined variable \"x\"\n", shader),
              "a.comp:7: error C1008: undefined variable \"x\"");
    EXPECT_EQ(mapShaderMessages("ERROR: 0:100003: 'x' : undeclared identifier", shader),
              "lib/b.glsl:3: ERROR: 'x' : undeclared identifier");
    EXPECT_EQ(mapShaderMessages("error: linking failed\n0:1(1): w", shader),
              "error: linking failed\na.comp:1:1: w");
    EXPECT_EQ(mapShaderMessages("0:900001(1): error: e", shader), "line 900001:1: error: e");
}

TEST(Variants, EveryCombinationOfEveryLineIsVisitedOnce) {
    const Result<VariantList> list = VariantList::parse(
        "# all\nmedia/march.comp EXACT=0,1 OCTAVES=0,2,4  # six\n\ng.vert g.frag\ns.vert s.tesc s.tese MASK=0,1\n",
        "variants.txt");
    ASSERT_TRUE(list.ok()) << list.message();
    std::vector<std::string> seen;
    list->forEachVariant(
        [&](const ProgramRequest& request) { seen.push_back(request.describe()); });
    EXPECT_THAT(seen,
                ::testing::UnorderedElementsAre(
                    "media/march.comp EXACT=0 OCTAVES=0", "media/march.comp EXACT=0 OCTAVES=2",
                    "media/march.comp EXACT=0 OCTAVES=4", "media/march.comp EXACT=1 OCTAVES=0",
                    "media/march.comp EXACT=1 OCTAVES=2", "media/march.comp EXACT=1 OCTAVES=4",
                    "g.vert g.frag", "s.vert s.tesc s.tese MASK=0", "s.vert s.tesc s.tese MASK=1"));
}

TEST(Variants, ARequestMustNameEveryDefineOfItsLineWithAListedValue) {
    const Result<VariantList> list =
        VariantList::parse("a.comp EXACT=0,1 OCTAVES=0\na.comp FAST=1\n", "variants.txt");
    ASSERT_TRUE(list.ok()) << list.message();
    EXPECT_TRUE(list->contains({{"a.comp"}, {{"OCTAVES", 0}, {"EXACT", 1}}}));
    EXPECT_TRUE(list->contains({{"a.comp"}, {{"FAST", 1}}}));
    EXPECT_FALSE(list->contains({{"a.comp"}, {}}));
    EXPECT_FALSE(list->contains({{"a.comp"}, {{"EXACT", 1}}}));
    EXPECT_FALSE(list->contains({{"a.comp"}, {{"EXACT", 2}, {"OCTAVES", 0}}}));
    EXPECT_FALSE(list->contains({{"a.comp"}, {{"FAST", 1}, {"EXACT", 1}}}));
    EXPECT_FALSE(list->contains({{"b.comp"}, {}}));
}

TEST(Variants, ABadLineIsRefusedWithItsNumber) {
    const std::pair<const char*, const char*> cases[] = {{"a.comp\nEXACT=0,1\n", "variants.txt:2"},
                                                         {"a.txt\n", "'a.txt'"},
                                                         {"a.comp EXACT=\n", "EXACT="},
                                                         {"a.comp EXACT=yes\n", "'yes'"},
                                                         {"a.comp =1\n", "'=1'"},
                                                         {"a.comp X=1 X=2\n", "'X'"},
                                                         {"a.comp X=1,,2\n", "X=1,,2"},
                                                         {"a.vert X=1 a.frag\n", "'a.frag'"},
                                                         {"a.comp X=99999999999\n", "99999999999"}};
    for (const auto& [text, expected] : cases) {
        const Result<VariantList> list = VariantList::parse(text, "variants.txt");
        ASSERT_FALSE(list.ok()) << text;
        EXPECT_THAT(list.message(), HasSubstr(expected));
        EXPECT_THAT(list.message(), HasSubstr("variants.txt:"));
    }
}

} // namespace
} // namespace tyndall::gl
