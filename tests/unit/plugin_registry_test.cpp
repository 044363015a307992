#include "plugin/registry.h"

#include <algorithm>
#include <gtest/gtest.h>

#include "plugin/builtin_plugins.h"
#include "support/content.h"

namespace tyndall::plugin {
namespace {

struct SilentHost final : Host {
    std::vector<std::string> shaders;
    void addShader(const char* path, const char*) override { shaders.emplace_back(path); }
    void log(const char*) override {}
};

std::string refusal(const std::string& file) {
    PluginRegistry registry;
    const Result<void> loaded = registry.load(file);
    EXPECT_FALSE(loaded.ok());
    EXPECT_EQ(registry.count(), 0u) << "a refused plugin leaves nothing behind";
    return loaded.ok() ? "" : loaded.message();
}

TEST(PluginRegistry, AnotherAbiVersionIsRefusedWithBothNumbers) {
    const std::string message = refusal(FAULTY_PLUGINS "/faulty_plugin_abi.so");
    EXPECT_NE(message.find("ABI " + std::to_string(kAbiVersion + 1)), std::string::npos) << message;
    EXPECT_NE(message.find("has ABI " + std::to_string(kAbiVersion)), std::string::npos) << message;
}

TEST(PluginRegistry, EveryOtherFaultHasItsSentence) {
    EXPECT_NE(refusal(FAULTY_PLUGINS "/faulty_plugin_size.so").find("bytes"), std::string::npos);
    for (const char* fault : {"headers", "layout"})
        EXPECT_NE(refusal(std::string(FAULTY_PLUGINS "/faulty_plugin_") + fault + ".so")
                      .find("other headers"),
                  std::string::npos);
    EXPECT_NE(refusal(FAULTY_PLUGINS "/faulty_plugin_incomplete.so").find("incomplete"),
              std::string::npos);
    EXPECT_NE(
        refusal(FAULTY_PLUGINS "/faulty_plugin_nothing.so").find("no symbol 'tyndall_plugin'"),
        std::string::npos);
    EXPECT_NE(refusal(FAULTY_PLUGINS "/missing.so").find("does not exist"), std::string::npos);
    EXPECT_NE(refusal((test::sourceDir() / "CMakeLists.txt").string()).find("cannot be loaded"),
              std::string::npos);
}

TEST(PluginRegistry, ASharedLibraryReplacesTheBuiltInPluginOfItsName) {
    PluginRegistry registry;
    registry.addBuiltins(builtinPlugins());
    const size_t count = registry.count();
    ASSERT_TRUE(registry.load(PLUGINS "/example_tint.so").ok());
    ASSERT_EQ(registry.count(), count);
    size_t shared = 0;
    for (size_t i = 0; i < count; ++i) shared += registry.origin(i) != "built in";
    EXPECT_EQ(shared, 1u);
}

TEST(PluginRegistry, SettingsAndShadersArriveAtTheHost) {
    PluginRegistry registry;
    registry.addBuiltins(builtinPlugins());
    SilentHost host;
    SettingsRegistry settings;
    EXPECT_TRUE(registry.setup(host, settings).empty());
    EXPECT_TRUE(settings.set("tint.red", "0.5").ok());
    EXPECT_NE(std::find(host.shaders.begin(), host.shaders.end(), "example_tint/tint.comp"),
              host.shaders.end());
}

} // namespace
} // namespace tyndall::plugin
