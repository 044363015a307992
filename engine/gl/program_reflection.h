#pragma once
// Reads what a linked program uses and gives every resource its binding; for program.cpp.

#include <span>
#include <string_view>
#include <vector>

#include "gl/program.h"

namespace tyndall::gl {

/// All active resources of the linked `program`. Blocks, texture units and image units are numbered from 0 and set in
/// the program.
std::vector<ProgramResource> reflectAndBind(GLuint program);
/// Errors: more bindings of a kind than this GPU has.
Result<void> checkBindingLimits(std::string_view name, std::span<const ProgramResource> resources);

} // namespace tyndall::gl
