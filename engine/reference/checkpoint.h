#pragma once
// A render's sums in a file, from which it goes on as if it had never been stopped.

#include <filesystem>

#include "core/result.h"
#include "reference/film.h"

namespace tyndall::reference {

/// Written atomically: the last good one survives a full disk and a killed program. `identity` names everything that
/// samples depend on: scene, camera, seed, integrator and so on. Errors: the file cannot be written.
Result<void> writeCheckpoint(const std::filesystem::path& path, const std::string& identity,
                             const Film& film);

/// Errors: missing; damaged; of another identity; of another size or other terms.
Result<void> readCheckpoint(const std::filesystem::path& path, const std::string& identity,
                            Film& film);

} // namespace tyndall::reference
