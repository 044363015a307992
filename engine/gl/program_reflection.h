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
/// Bytes that a vertex leaves in transform feedback's buffer 0; 0 where the shader captures nothing. Errors: it captures into another.
Result<int> captureStride(std::string_view name, GLuint program);
/// GL_POINTS, GL_LINES or GL_TRIANGLES, of a linked program with a tessellation evaluation shader.
GLenum tessellatedPrimitive(GLuint program);

} // namespace tyndall::gl
