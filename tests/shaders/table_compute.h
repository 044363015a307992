#pragma once
// Runs a few lines of GLSL over a table, so that functions of the engine's shaders can be compared with numbers from elsewhere.

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/math.h"
#include "gl/buffer.h"
#include "gl/shader_library.h"

namespace tyndall::test {

/// Runs `body` once for each of `count` invocations. It sees `uint id`, `vec4 inputs[]` and `vec4 outputs[]`, and what `includes`
/// (paths below shaders/) define. `bind` binds what else the program wants. Returns the outputs. Throws with the driver's message
/// where it does not compile.
std::vector<vec4> runTable(gl::ShaderLibrary& library, const std::vector<std::string>& includes,
                           std::string_view body, std::span<const vec4> inputs, size_t outputs,
                           uint32_t count, const std::function<void(const gl::Program&)>& bind);

/// Binds a storage block by its name, where the program has one.
void bindStorage(const gl::Program& program, const char* name, const gl::Buffer& buffer);

/// A std140 block for the shader, by name.
struct BlockBytes {
    std::string name;
    std::span<const std::byte> bytes;
};

/// The same with nothing but uniform blocks, and a library of its own.
std::vector<vec4> runOnGpu(const std::vector<std::string>& includes, std::string_view body,
                           std::span<const vec4> inputs, size_t outputs, uint32_t count,
                           const std::vector<BlockBytes>& blocks = {});

} // namespace tyndall::test
