#pragma once
// What `tyndall info FILE` says about a file: what is in it, what is understood, what is ignored.

#include <filesystem>
#include <string>

#include "core/result.h"

namespace tyndall {

/// Lines for a person. Understands scene files, .gltf, .glb, .vdb, .nvdb, .exr and .hdr.
/// Errors: missing, damaged, or of a kind that is not understood.
Result<std::string> describeFile(const std::filesystem::path& path);

} // namespace tyndall
