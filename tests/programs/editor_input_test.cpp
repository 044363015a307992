// The editor's input, angles and command line, without a window.

#include <gtest/gtest.h>

#include "input_queue.h"
#include "rotation_angles.h"
#include "setting_options.h"

namespace tyndall::editor {
namespace {

using Kind = InputKind;

InputEvent cursor(double x, double y) { return {.kind = Kind::Cursor, .at = {x, y}}; }
InputEvent button(bool down) { return {.kind = Kind::Button, .code = 0, .down = down}; }
InputEvent key(int code, bool down) { return {.kind = Kind::Key, .code = code, .down = down}; }
InputEvent character(int code) { return {.kind = Kind::Text, .code = code}; }

/// How many events each frame takes.
std::vector<size_t> framesOf(const std::vector<InputEvent>& events) {
    InputQueue queue;
    for (const InputEvent& event : events) queue.push(event);
    std::vector<size_t> sizes;
    while (!queue.empty()) sizes.push_back(queue.takeFrame().size());
    return sizes;
}

TEST(InputQueue, AClickIsSeenAtItsPlaceHoweverMuchFollowed) {
    InputQueue queue;
    for (const InputEvent& event :
         {cursor(1, 1), cursor(10, 20), button(true), button(false), cursor(90, 90)})
        queue.push(event);
    EXPECT_EQ(queue.takeFrame().back().at, dvec2(10, 20)) << "there first";
    for (const bool down : {true, false}) {
        const std::vector<InputEvent> change = queue.takeFrame();
        ASSERT_EQ(change.size(), 1u) << "before the cursor went on";
        EXPECT_EQ(change[0].down, down);
    }
    EXPECT_EQ(queue.takeFrame().at(0).at, dvec2(90, 90));
    EXPECT_TRUE(queue.empty());
}

TEST(InputQueue, EveryChangeOfAKeyHasItsFrameAndTextGoesWithItsKey) {
    EXPECT_EQ(framesOf({key(65, true), character('a'), key(65, false), key(66, true),
                        character('b'), key(66, false)}),
              (std::vector<size_t>{2, 1, 2, 1}));
}

TEST(InputQueue, MovementsAndNotchesAddUp) {
    const InputEvent notch{.kind = Kind::Wheel, .at = {0, 1}};
    EXPECT_EQ(framesOf({cursor(1, 1), cursor(2, 2), notch, notch, cursor(3, 3)}),
              (std::vector<size_t>{2, 2, 1}));
    EXPECT_TRUE(InputQueue().takeFrame().empty());
}

// --- angles ---

constexpr double kDegree = kPi / 180;

void expectSameRotation(const dquat& a, const dquat& b) {
    EXPECT_NEAR(std::abs(glm::dot(a, b)), 1, 1e-12) << "a few roundings";
}
void expectAngles(const dvec3& a, const dvec3& b) {
    // The inverse sine of a rounded number near 1 is off by the square root of a rounding.
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(a[axis], b[axis], 2e-6) << axis;
}
dquat about(const dvec3& axis, double degrees) { return glm::angleAxis(degrees * kDegree, axis); }

TEST(RotationAngles, WhatWasTypedStays) {
    RotationAngles angles;
    for (const dvec3& typed : {dvec3(0, 120, 0), dvec3(200, -135, 33), dvec3(0, 90, 0),
                               dvec3(-720, 45, 180), dvec3(90, 90, 90)}) {
        const dquat rotation = angles.set(3, typed);
        EXPECT_EQ(angles.of(3, rotation), typed);
        EXPECT_EQ(angles.of(3, -rotation), typed) << "the same rotation";
    }
    expectSameRotation(angles.set(3, {0, 120, 0}), about({0, 1, 0}, 120));
}

TEST(RotationAngles, DraggingGoesPastNinetyDegreesAndOn) {
    RotationAngles angles;
    dquat rotation(1, 0, 0, 0);
    for (int step = 1; step <= 800; ++step) {
        dvec3 shown = angles.of(0, rotation);
        shown.y += 0.5;
        rotation = angles.set(0, shown);
        ASSERT_EQ(angles.of(0, rotation), dvec3(0, 0.5 * step, 0));
        expectSameRotation(rotation, about({0, 1, 0}, 0.5 * step));
    }
}

TEST(RotationAngles, AChangeFromOutsideIsFoundAnew) {
    RotationAngles angles;
    (void)angles.set(0, {10, 120, 0});
    expectAngles(angles.of(0, about({1, 0, 0}, 30)), {30, 0, 0}); // undone
    (void)angles.set(0, {0, 500, 0});
    expectAngles(angles.of(1, about({0, 1, 0}, 140)), {0, 140, 0}); // another node, turned alike
}

TEST(RotationAngles, AnglesThatAreFoundGiveTheRotationAndTurnLittle) {
    RotationAngles angles, again;
    for (const double y : {-170.0, -91.0, -90.0, -45.0, 0.0, 60.0, 90.0, 120.0, 179.0})
        for (const double x : {-80.0, 0.0, 75.0}) {
            const dvec3 set(x, y, 20);
            const dquat rotation = again.set(0, set);
            const dvec3 found = angles.of(0, rotation);
            // Next to ±90° an angle may be off by 1e-7 of a radian, and the cosine by the square of that.
            EXPECT_NEAR(std::abs(glm::dot(again.set(0, found), rotation)), 1, 1e-12)
                << x << " " << y;
            (void)angles.set(1, {0, 0, 0});
        }
    expectAngles(angles.of(2, about({0, 1, 0}, 120)), {0, 120, 0});
}

// --- settings as a command line ---

struct Values {
    float a;
    int32_t b;
    bool c;
    SettingText technique;
    float shown;
};
constexpr SettingDesc kFields[] = {
    TYNDALL_FLOAT(Values, a, "x.a", "A", "", 0, 10, 1, "A number."),
    TYNDALL_INT(Values, b, "x.b", "B", "", 1, 100, 8, "A count."),
    TYNDALL_BOOL(Values, c, "x.c", "C", true, "A switch."),
    TYNDALL_TEXT(Values, technique, "gi.technique", "Technique", "auto", "A name."),
    TYNDALL_FLOAT(Values, shown, "inspect.level", "Level", "", 0, 10, 1, "Of no picture."),
};
constexpr PresetEntry kPresets[] = {
    {Quality::Low, "x.a", "0.50"}, {Quality::Low, "x.b", "2"},   {Quality::Low, "x.c", "off"},
    {Quality::High, "x.a", "4"},   {Quality::High, "x.b", "50"},
};

struct SettingOptions : ::testing::Test {
    Values values{};
    SettingsRegistry settings;
    std::map<std::string, std::string> ofScene;
    SettingOptions() {
        settings.add({kFields, &values});
        settings.addPreset(kPresets);
        set("x.b", "9"); // by the scene file
        for (const SettingDesc& field : kFields)
            ofScene[field.key] = settings.get(field.key).value();
    }
    void set(const char* name, const char* text) {
        const Result<void> done = settings.set(name, text);
        ASSERT_TRUE(done.ok()) << done.message();
    }
    std::vector<std::string> options() { return settingOptions(settings, ofScene, "gi.technique"); }
    using Words = std::vector<std::string>;
};

TEST_F(SettingOptions, WhatIsAsInTheSceneFileIsNotSaid) {
    EXPECT_EQ(options(), Words{});
    set("inspect.level", "3");
    EXPECT_EQ(options(), Words{}) << "it changes no picture";
}

TEST_F(SettingOptions, AFewSettingsAreSaidOneByOne) {
    set("x.a", "0.5");
    set("gi.technique", "LVVE=lpv, LSSE=vpl");
    EXPECT_EQ(options(), (Words{"--set x.a=0.5", "--gi 'LVVE=lpv, LSSE=vpl'"}));
}

TEST_F(SettingOptions, APresetIsSaidByItsNameAndOnlyWhatDiffersFromIt) {
    settings.applyPreset(Quality::Low);
    EXPECT_EQ(options(), Words{"--quality low"});
    set("x.b", "3");
    set("gi.technique", "lpv");
    EXPECT_EQ(options(), (Words{"--quality low", "--set x.b=3", "--gi lpv"}));
    settings.applyPreset(Quality::High);
    EXPECT_EQ(options(), (Words{"--quality high", "--set x.c=false", "--gi lpv"}))
        << "high does not set what low did";
}

} // namespace
} // namespace tyndall::editor
