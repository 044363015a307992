#pragma once
// Reference pictures kept in a folder, each under a name that says what it is of. A changed scene, size or path tracer changes the
// name, so a stale picture is never taken for a good one.

#include <filesystem>
#include <optional>
#include <string>

#include "core/image.h"
#include "reference/render.h"

namespace tyndall::reference {

/// "cornell-96x54-0123456789abcdef.exr": the scene's name, made fit for a file's, the size, and a number for the scene
/// as seen through that camera, the terms, the depth and kReferenceVersion.
[[nodiscard]] std::string pictureName(const Scene& scene, const std::filesystem::path& scenePath,
                                      int cameraNode, const RenderSettings& settings);

/// What a picture in the folder says of itself.
struct KeptPicture {
    std::filesystem::path path;
    uint64_t samples = 0;
    double estimatedRelmse = 0;
};
/// Empty where there is none of that name, or it cannot be read.
[[nodiscard]] std::optional<KeptPicture> findPicture(const std::filesystem::path& folder,
                                                     const std::string& name);

} // namespace tyndall::reference
