#pragma once
// What there is to say about a file: what is in it, what is understood, what is ignored.

#include <filesystem>
#include <string>

#include "app/job.h"
#include "core/result.h"

namespace tyndall {

/// Lines for a person. Understands scene files, .gltf, .glb, .vdb, .nvdb, .exr and .hdr.
/// Errors: missing, damaged, of a kind that is not understood, or cancelled.
Result<std::string> describeFile(const std::filesystem::path& path, const JobControl& job);

} // namespace tyndall
