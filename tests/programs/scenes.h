#pragma once
// A small scene for tests of the programs.

#include <filesystem>

namespace tyndall::test {

/// Writes a scene file with a floor, a lamp, height fog and a camera called "eye" into `folder` and returns its path.
std::filesystem::path writeFoggyScene(const std::filesystem::path& folder);
/// The same without the fog.
std::filesystem::path writeClearScene(const std::filesystem::path& folder);

} // namespace tyndall::test
