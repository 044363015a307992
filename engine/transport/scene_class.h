#pragma once
// Kinds of scenes in which techniques fare differently: `auto` chooses by what was measured in scenes of the kind (docs/measured/auto.md).

#include <cstdint>

namespace tyndall {

enum class SceneClass : uint32_t {
    Surfaces = 0,   // no medium scatters
    Thin = 1,       // surfaces in media that most light crosses
    Dense = 2,      // surfaces in media that most light does not cross: mean optical depth above 1
    MediaAlone = 3, // no surface reflects
};
inline constexpr uint32_t kSceneClassCount = 4;
inline constexpr double kDenseFrom = 1; // optical depth

constexpr const char* sceneClassText(SceneClass scene) {
    constexpr const char* kTexts[kSceneClassCount] = {"surfaces without media", "surfaces in thin media",
                                                      "surfaces in dense media", "media without surfaces"};
    return kTexts[uint32_t(scene)];
}

/// How a technique fares in one kind of scene, at medium quality and in a single frame, as measured. Plain data, crosses the plugin boundary.
struct Expectation {
    float cost = 1;            // time of a frame over that of one with direct light alone
    float errorOnSurfaces = 1; // relmse of its terms on surfaces; 1: it has no light for them, or was not measured
    float errorInMedia = 1;    // of those in media
};

} // namespace tyndall
