#include "scene/json_schema.h"

#include <gtest/gtest.h>

#include <set>

#include <nlohmann/json.hpp>

#include "core/image.h"
#include "scene/scene_file.h"
#include "support/content.h"

namespace tyndall {
namespace {

/// Calls `visit(keyword, value)` for every keyword of every schema in `schema`.
template <typename F> void forEachKeyword(const Json& schema, F&& visit) {
    if (!schema.is_object()) return;
    for (const auto& [keyword, value] : schema.items()) {
        visit(keyword, value);
        if (keyword == "properties" || keyword == "$defs") {
            for (const auto& [name, inner] : value.items()) forEachKeyword(inner, visit);
        } else if (keyword == "anyOf") {
            for (const Json& inner : value) forEachKeyword(inner, visit);
        } else if (keyword == "items" || keyword == "additionalProperties") {
            forEachKeyword(value, visit);
        }
    }
}

TEST(SceneSchema, UsesOnlyWhatTheValidatorKnows) {
    const std::set<std::string> known = {"$schema",
                                         "$defs",
                                         "$ref",
                                         "title",
                                         "description",
                                         "type",
                                         "const",
                                         "enum",
                                         "anyOf",
                                         "properties",
                                         "required",
                                         "additionalProperties",
                                         "items",
                                         "minItems",
                                         "maxItems",
                                         "minLength",
                                         "minimum",
                                         "maximum",
                                         "exclusiveMinimum",
                                         "exclusiveMaximum"};
    forEachKeyword(sceneFileSchema(), [&](const std::string& keyword, const Json&) {
        EXPECT_TRUE(known.contains(keyword)) << keyword;
    });
}

TEST(SceneSchema, EveryObjectRefusesUnknownKeys) {
    size_t objects = 0;
    const auto judge = [&](const Json& schema) {
        if (!schema.is_object() || !schema.contains("properties")) return;
        ++objects;
        EXPECT_TRUE(schema.contains("additionalProperties") &&
                    schema.at("additionalProperties") == false)
            << schema.dump().substr(0, 200);
    };
    judge(sceneFileSchema());
    for (const auto& [name, inner] : sceneFileSchema().at("$defs").items()) judge(inner);
    EXPECT_GE(objects, 9u);
}

TEST(SceneSchema, DocumentationHasEveryKeyAndEveryName) {
    const std::string text = readFile(test::sourceDir() / "docs/scene-format.md").value();
    forEachKeyword(sceneFileSchema(), [&](const std::string& keyword, const Json& value) {
        if (keyword == "properties") {
            for (const auto& [key, unused] : value.items())
                EXPECT_NE(text.find("`" + key + "`"), std::string::npos) << "key " << key;
        }
        if (keyword == "enum") {
            for (const Json& name : value)
                EXPECT_NE(text.find("`" + name.get<std::string>() + "`"), std::string::npos)
                    << "name " << name;
        }
    });
}

TEST(SceneSchema, DocumentedExampleLoads) {
    const std::string text = readFile(test::sourceDir() / "docs/scene-format.md").value();
    const size_t begin = text.find("```json\n") + 8, end = text.find("```", begin);
    const std::filesystem::path path = test::scratchDir("scene-doc") / "example.scene.json";
    ASSERT_TRUE(writeFileAtomically(path, text.substr(begin, end - begin)).ok());
    const auto loaded = loadScene(path);
    ASSERT_TRUE(loaded.ok()) << loaded.message();
    EXPECT_TRUE(loaded->notes.empty());
    EXPECT_TRUE(loaded->supplied.empty());
}

TEST(JsonSchema, FirstBranchThatFitsTheTypeSpeaks) {
    const Json schema = Json::parse(
        R"({"anyOf": [{"type": "array", "maxItems": 1}, {"type": "object", "required": ["a"]}]})");
    EXPECT_TRUE(validateJson(Json::parse("[1]"), schema).ok());
    EXPECT_EQ(validateJson(Json::parse("[1, 2]"), schema).message(),
              "the file has 2 elements but must have 0 to 1");
    EXPECT_EQ(validateJson(Json::parse("{}"), schema).message(),
              "the file lacks the key 'a', which is required");
    EXPECT_EQ(validateJson(Json::parse("3"), schema).message(),
              "the file is 3 but must be of type array or object");
}

} // namespace
} // namespace tyndall
