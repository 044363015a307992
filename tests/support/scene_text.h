#pragma once

#include <string>

#include "core/check.h"
#include "core/image.h"
#include "scene/scene_file.h"
#include "support/content.h"

namespace tyndall::test {

/// Loads a scene file with this text; it is written to a folder of the tests first.
inline Result<LoadedScene> loadSceneText(const std::string& text) {
    static const std::filesystem::path folder = scratchDir("scene-text");
    const std::filesystem::path path = folder / "test.scene.json";
    CHECK(writeFileAtomically(path, text).ok());
    return loadScene(path);
}

}  // namespace tyndall::test
