// Commands and the camera of the editor, without a window.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "camera_controller.h"
#include "command.h"

namespace tyndall::editor {
namespace {

// --- commands ---

struct Values {
    float strength;
    int32_t steps;
};
constexpr SettingDesc kFields[] = {
    TYNDALL_FLOAT(Values, strength, "test.strength", "Strength", "", 0, 10, 1, "A number."),
    TYNDALL_INT(Values, steps, "test.steps", "Steps", "", 1, 100, 8, "A count."),
};

bool same(const dmat4& a, const dmat4& b) {
    for (int c = 0; c < 4; ++c)
        if (a[c] != b[c]) return false;
    return true;
}

/// Everything that the editor's commands change.
void expectSame(const Scene& a, const Scene& b) {
    ASSERT_EQ(a.nodes.size(), b.nodes.size());
    for (size_t i = 0; i < a.nodes.size(); ++i) {
        EXPECT_EQ(a.nodes[i].visible, b.nodes[i].visible) << i;
        EXPECT_EQ(a.nodes[i].translation, b.nodes[i].translation) << i;
        EXPECT_EQ(a.nodes[i].rotation, b.nodes[i].rotation) << i;
        EXPECT_EQ(a.nodes[i].scale, b.nodes[i].scale) << i;
        ASSERT_EQ(a.nodes[i].matrix.has_value(), b.nodes[i].matrix.has_value()) << i;
        if (a.nodes[i].matrix) {
            EXPECT_TRUE(same(*a.nodes[i].matrix, *b.nodes[i].matrix)) << i;
        }
    }
    for (size_t i = 0; i < a.lights.size(); ++i) {
        EXPECT_EQ(a.lights[i].intensity, b.lights[i].intensity);
        EXPECT_EQ(a.lights[i].color, b.lights[i].color);
        EXPECT_EQ(a.lights[i].castsShadows, b.lights[i].castsShadows);
    }
    for (size_t i = 0; i < a.media.size(); ++i)
        EXPECT_EQ(a.media[i].scattering, b.media[i].scattering);
    EXPECT_EQ(a.ev100, b.ev100);
}

struct CommandTest : ::testing::Test {
    Scene scene;
    Values values{};
    SettingsRegistry settings;
    History history{EditTarget{scene, settings}};

    CommandTest() {
        settings.add({kFields, &values});
        scene.nodes.resize(3);
        scene.nodes[0].translation = {0.1, 0.2, 0.3};
        scene.nodes[1].matrix = dmat4(2.0);
        scene.nodes[1].parent = 0;
        scene.nodes[2].light = 0;
        scene.lights.resize(1);
        scene.media.resize(1);
    }
    CommandPtr brighten(float intensity) {
        Light light = scene.lights[0];
        light.intensity = intensity;
        return changeLight(scene, 0, light);
    }
};

TEST_F(CommandTest, UndoingAndRedoingEveryKindRestoresTheSceneExactly) {
    std::vector<Scene> states{scene};
    const auto perform = [&](CommandPtr command) {
        history.seal();
        history.perform(std::move(command));
        states.push_back(scene);
    };
    perform(changeVisibility(scene, 1, false));
    perform(changeTransform(scene, 0, {1.0 / 3, -7, 1e9}, glm::angleAxis(0.7, dvec3(0, 1, 0)),
                            {1, 2, -3}));
    perform(changeTransform(scene, 1, {4, 5, 6}, {1, 0, 0, 0}, {1, 1, 1})); // it had a matrix
    perform(brighten(0.1f));
    Medium medium = scene.media[0];
    medium.scattering = {0.1f, 0.2f, 0.3f};
    perform(changeMedium(scene, 0, medium));
    perform(changeExposure(scene, 3.7f));

    EXPECT_FALSE(scene.nodes[1].visible);
    EXPECT_FALSE(scene.nodes[1].matrix.has_value());
    EXPECT_EQ(scene.lights[0].intensity, 0.1f);
    EXPECT_EQ(scene.ev100, 3.7f);
    for (size_t i = states.size() - 1; i-- > 0;) {
        history.undo();
        expectSame(scene, states[i]);
    }
    EXPECT_EQ(history.undoName(), "");
    for (size_t i = 1; i < states.size(); ++i) {
        history.redo();
        expectSame(scene, states[i]);
    }
    EXPECT_EQ(history.redoName(), "");
}

TEST_F(CommandTest, WhatAnEditChangesGetsANewVersionAlsoWhenItIsUndone) {
    const SceneVersions before = scene.versions;
    history.perform(brighten(2));
    const SceneVersions after = scene.versions;
    EXPECT_GT(after.lights, before.lights);
    EXPECT_EQ(after.transforms, before.transforms);
    history.undo();
    EXPECT_GT(scene.versions.lights, after.lights)
        << "a cache that saw the edit must see that it went";
}

TEST_F(CommandTest, OneDragIsOneStep) {
    for (const float intensity : {2.0f, 3.0f, 4.0f}) history.perform(brighten(intensity));
    history.seal();
    history.perform(brighten(5));
    history.undo();
    EXPECT_EQ(scene.lights[0].intensity, 4);
    history.undo();
    EXPECT_EQ(scene.lights[0].intensity, 1);
    EXPECT_EQ(history.undoName(), "");
}

TEST_F(CommandTest, EditsOfDifferentThingsAreDifferentStepsEvenWithoutAPause) {
    history.perform(brighten(2));
    history.perform(changeVisibility(scene, 2, false));
    history.perform(changeVisibility(scene, 1, false));
    history.undo();
    EXPECT_TRUE(scene.nodes[1].visible);
    EXPECT_FALSE(scene.nodes[2].visible);
}

TEST_F(CommandTest, SettingsComeBackToo) {
    history.perform(
        changeSettings(settings, "a preset",
                       {{"test.strength", "2.5"}, {"test.steps", "16"}, {"test.strength", "3.5"}}));
    EXPECT_EQ(values.strength, 3.5f);
    EXPECT_EQ(values.steps, 16);
    history.undo();
    EXPECT_EQ(values.strength, 1);
    EXPECT_EQ(values.steps, 8);
    history.redo();
    EXPECT_EQ(values.strength, 3.5f);
    EXPECT_FALSE(history.hasUnsavedEdits()) << "settings of the session are not in the scene";
}

TEST_F(CommandTest, ANewEditForgetsWhatWasUndone) {
    history.perform(brighten(2));
    history.undo();
    history.perform(changeVisibility(scene, 0, false));
    EXPECT_EQ(history.redoName(), "");
    history.redo();
    EXPECT_EQ(scene.lights[0].intensity, 1);
}

TEST_F(CommandTest, TheSceneIsUnsavedExactlyWhileItDiffersFromItsFile) {
    EXPECT_FALSE(history.hasUnsavedEdits());
    history.perform(brighten(2));
    EXPECT_TRUE(history.hasUnsavedEdits());
    history.markSaved();
    EXPECT_FALSE(history.hasUnsavedEdits());
    history.perform(brighten(3)); // not merged into the saved step
    EXPECT_TRUE(history.hasUnsavedEdits());
    history.undo();
    EXPECT_EQ(scene.lights[0].intensity, 2);
    EXPECT_FALSE(history.hasUnsavedEdits());
    history.undo();
    EXPECT_TRUE(history.hasUnsavedEdits());
    history.perform(brighten(9)); // the saved state cannot come back
    EXPECT_TRUE(history.hasUnsavedEdits());
    history.undo();
    EXPECT_TRUE(history.hasUnsavedEdits());
}

// --- the camera ---

dmat4 lookingFrom(const dvec3& position, const dquat& rotation = {1, 0, 0, 0}) {
    dmat4 result = glm::mat4_cast(rotation);
    result[3] = dvec4(position, 1);
    return result;
}

constexpr double kTiny = 1e-9; // relative to lengths of about one: some hundred roundings

void expectNear(const dvec3& a, const dvec3& b, double tolerance = kTiny) {
    EXPECT_LT(glm::length(a - b), tolerance)
        << a.x << " " << a.y << " " << a.z << " is not " << b.x << " " << b.y << " " << b.z;
}

TEST(Camera, StartsWhereTheScenesCameraIsWithoutItsScale) {
    const dquat rotation = glm::normalize(dquat(0.9, 0.1, -0.3, 0.05));
    CameraController camera;
    camera.reset(lookingFrom({1, 2, 3}, rotation) * dmat4(dvec4(2, 0, 0, 0), dvec4(0, 3, 0, 0),
                                                          dvec4(0, 0, 4, 0), dvec4(0, 0, 0, 1)),
                 10);
    const dmat4 pose = camera.worldFromCamera(), expected = lookingFrom({1, 2, 3}, rotation);
    for (int c = 0; c < 4; ++c) expectNear(dvec3(pose[c]), dvec3(expected[c]));
}

TEST(Camera, LookingTurnsInPlaceAndKeepsTheHorizonLevel) {
    CameraController camera;
    camera.reset(lookingFrom({1, 2, 3}), 10);
    camera.look({200, 0});
    EXPECT_GT(camera.forward().x, 0) << "the mouse went right";
    camera.look({-350, -120});
    EXPECT_GT(camera.forward().y, 0) << "the mouse went up";
    expectNear(camera.position(), {1, 2, 3});
    EXPECT_NEAR((camera.rotation() * dvec3(1, 0, 0)).y, 0, kTiny);
}

TEST(Camera, DoesNotTurnOverTheZenith) {
    CameraController camera;
    camera.reset(lookingFrom({0, 0, 0}), 10);
    camera.look({0, -1e5});
    EXPECT_GT(camera.forward().y, 0.999);
    EXPECT_GT((camera.rotation() * dvec3(0, 1, 0)).y, 0) << "it stands upright";
    camera.look({0, 2e5});
    EXPECT_LT(camera.forward().y, -0.999);
    EXPECT_GT((camera.rotation() * dvec3(0, 1, 0)).y, 0);
}

TEST(Camera, FliesAlongItsAxesAtItsSpeed) {
    CameraController camera;
    camera.reset(lookingFrom({0, 0, 0}, glm::angleAxis(kPi / 2, dvec3(0, 1, 0))),
                 10); // looks along -X
    const double speed = camera.speed();
    camera.fly({0, 0, 1}, 2);
    expectNear(camera.position(), {-2 * speed, 0, 0});
    camera.fly({1, 0, 0}, 1); // its right is -Z
    expectNear(camera.position(), {-2 * speed, 0, -speed});
    camera.changeSpeed(3);
    camera.changeSpeed(-3);
    EXPECT_NEAR(camera.speed(), speed, kTiny);
}

TEST(Camera, OrbitingKeepsThePivotInTheMiddleAndItsDistance) {
    CameraController camera;
    camera.reset(lookingFrom({0, 1, 5}), 10);
    const dvec3 pivot = camera.pivot();
    const double distance = glm::length(camera.position() - pivot);
    for (int i = 0; i < 50; ++i) camera.orbit({17, i % 2 ? 9.0 : -11.0});
    expectNear(camera.pivot(), pivot, 50 * kTiny);
    EXPECT_NEAR(glm::length(camera.position() - pivot), distance, 50 * kTiny);
    EXPECT_GT(glm::length(camera.position() - dvec3(0, 1, 5)), 0.1);
}

TEST(Camera, PanningMovesWhatIsAtThePivotWithTheCursor) {
    CameraController camera;
    camera.reset(lookingFrom({0, 0, 5}), 10);
    const dvec3 pivot = camera.pivot();
    const double height = 400, yfov = 0.8,
                 metresPerPixel = 2 * camera.pivotDistance() * std::tan(yfov / 2) / height;
    camera.pan({30, 12}, metresPerPixel);
    const dvec3 seen = glm::inverse(camera.worldFromCamera()) * dvec4(pivot, 1);
    const double pixelsPerTangent = height / 2 / std::tan(yfov / 2);
    EXPECT_NEAR(seen.x / -seen.z * pixelsPerTangent, 30, 1e-6);
    EXPECT_NEAR(-seen.y / -seen.z * pixelsPerTangent, 12, 1e-6);
}

TEST(Camera, DollyingApproachesThePivotAndNeverPassesIt) {
    CameraController camera;
    camera.reset(lookingFrom({0, 0, 5}), 10);
    const dvec3 pivot = camera.pivot();
    const double distance = camera.pivotDistance();
    camera.dolly(1);
    EXPECT_NEAR(glm::length(camera.position() - pivot), 0.9 * distance, kTiny);
    camera.dolly(10000);
    EXPECT_GT(camera.pivotDistance(), 0);
    expectNear(camera.pivot(), pivot);
}

TEST(Camera, FramingBringsAllCornersIntoThePicture) {
    const Bounds bounds{{-3, 100, 7}, {5, 101, 20}};
    for (const double aspect : {0.3, 1.0, 3.0}) {
        const double yfov = 0.6;
        CameraController camera;
        camera.reset(lookingFrom({0, 0, 0}, glm::normalize(dquat(0.8, 0.2, 0.5, 0))), 10);
        camera.frame(bounds, yfov, aspect);
        const dmat4 cameraFromWorld = glm::inverse(camera.worldFromCamera());
        double most = 0;
        for (int i = 0; i < 8; ++i) {
            const dvec3 corner((i & 1) ? 5 : -3, (i & 2) ? 101 : 100, (i & 4) ? 20 : 7);
            const dvec3 p = cameraFromWorld * dvec4(corner, 1);
            ASSERT_LT(p.z, 0) << "in front of the camera";
            const double vertical = std::abs(p.y / p.z) / std::tan(yfov / 2),
                         horizontal = std::abs(p.x / p.z) / (aspect * std::tan(yfov / 2));
            EXPECT_LE(vertical, 1);
            EXPECT_LE(horizontal, 1);
            most = std::max({most, vertical, horizontal});
        }
        EXPECT_GT(most, 0.3) << "and not far away";
        expectNear(camera.pivot(), bounds.centre(), 1e-6);
    }
}

TEST(Camera, FramingNothingChangesNothing) {
    CameraController camera;
    camera.reset(lookingFrom({1, 2, 3}), 10);
    camera.frame(Bounds{}, 0.8, 1);
    expectNear(camera.position(), {1, 2, 3});
}

} // namespace
} // namespace tyndall::editor
