#pragma once
// Files that a command line asks for.

#include <string>

#include "core/result.h"

namespace tyndall {

/// Refuses a file in a folder that is not there, before the work for it is done. No file at all ("") is fine.
Result<void> checkOutputFolder(const char* option, const std::string& file);

} // namespace tyndall
