#include "core/settings.h"

#include <gtest/gtest.h>

namespace tyndall {
namespace {

enum class Mode : int32_t { Fast = 0, Exact = 1 };
constexpr const char* kModes[] = {"fast", "exact"};

struct Example {
    bool on;
    int32_t steps;
    float scale;
    Mode mode;
    SettingText who;
};

const SettingDesc kExample[] = {
    TYNDALL_BOOL(Example, on, "example.on", "On", true, "Whether it is on."),
    TYNDALL_INT(Example, steps, "example.steps", "Steps", "", 1, 512, 64, "Number of steps."),
    TYNDALL_FLOAT(Example, scale, "example.scale", "Scale", "m", 0.1, 10, 1, "Scale of the thing."),
    TYNDALL_ENUM(Example, mode, "example.mode", "Mode", kModes, Mode::Fast, "How it works."),
    TYNDALL_TEXT(Example, who, "example.who", "Who", "nobody", "Who does it."),
};

struct SettingsTest : ::testing::Test {
    Example values{};
    SettingsRegistry registry;
    void SetUp() override { registry.add({kExample, &values}); }
};

TEST_F(SettingsTest, RegisteringWritesDefaults) {
    EXPECT_TRUE(values.on);
    EXPECT_EQ(values.steps, 64);
    EXPECT_EQ(values.scale, 1.0f);
    EXPECT_EQ(values.mode, Mode::Fast);
    EXPECT_EQ(values.who.view(), "nobody");
    EXPECT_TRUE(registry.differences().empty());
}

TEST_F(SettingsTest, TextRoundTripsForEveryType) {
    for (const char* text : {"example.on=false", "example.steps=7", "example.scale=0.3",
                             "example.mode=exact", "example.who=LVE=a,LSE=b"}) {
        ASSERT_TRUE(registry.assign(text).ok());
        const std::string key = std::string(text).substr(0, std::string(text).find('='));
        EXPECT_EQ(key + "=" + registry.get(key).value(), text);
    }
    EXPECT_EQ(registry.differences().size(), 5u);
    registry.resetAll();
    EXPECT_TRUE(registry.differences().empty());
}

TEST_F(SettingsTest, RefusalsSayWhatWouldBeRight) {
    EXPECT_NE(registry.set("example.step", "3").message().find("did you mean 'example.steps'"),
              std::string::npos);
    EXPECT_NE(registry.set("example.steps", "0").message().find("1 to 512"), std::string::npos);
    EXPECT_NE(registry.set("example.steps", "1.5").message().find("whole number"),
              std::string::npos);
    EXPECT_NE(registry.set("example.scale", "nan").message().find("not a number"),
              std::string::npos);
    EXPECT_NE(registry.set("example.mode", "slow").message().find("fast, exact"),
              std::string::npos);
    EXPECT_NE(registry.set("example.who", std::string(256, 'x')).message().find("255 characters"),
              std::string::npos);
    EXPECT_NE(registry.set("example.on", "maybe").message().find("true or false"),
              std::string::npos);
    EXPECT_NE(registry.assign("example.on").message().find("KEY=VALUE"), std::string::npos);
    EXPECT_EQ(values.steps, 64) << "a refused value changes nothing";
}

TEST_F(SettingsTest, PresetsAreCheckedWhenTheyAreAdded) {
    const PresetEntry good[] = {{Quality::Low, "example.steps", "8"}};
    registry.addPreset(good);
    registry.applyPreset(Quality::Low);
    EXPECT_EQ(values.steps, 8);
    const PresetEntry bad[] = {{Quality::Low, "example.steps", "0"}};
    EXPECT_THROW(registry.addPreset(bad), CheckFailure);
    EXPECT_THROW(registry.add({kExample, &values}), CheckFailure) << "keys are unique";
}

TEST_F(SettingsTest, ATextMayBeEmptyOrOfTheLongestLength) {
    for (const std::string& text : {std::string(), std::string(SettingText::kLongest, 'x')}) {
        ASSERT_TRUE(registry.set("example.who", text).ok());
        EXPECT_EQ(registry.get("example.who").value(), text);
    }
    registry.resetAll();
    EXPECT_EQ(values.who.view(), "nobody");
    for (const SettingDesc& field : kExample)
        EXPECT_EQ(settingDefaultText(field), settingToText(field, &values)) << field.key;
}

} // namespace
} // namespace tyndall
