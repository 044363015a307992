#pragma once
// Runs a few lines of GLSL over a table, so that functions of the engine's shaders can be compared with numbers from elsewhere.

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/math.h"
#include "gl/shader_library.h"

namespace tyndall::test {

/// A std140 block for the shader, by name.
struct BlockBytes {
    std::string name;
    std::span<const std::byte> bytes;
};

/// Runs `body` once for each of `count` invocations. It sees `uint id`, `vec4 inputs[]` and `vec4 outputs[]`, and what `includes`
/// (paths below shaders/) define. Returns the outputs. Throws with the driver's message where it does not compile.
std::vector<vec4> runOnGpu(const std::vector<std::string>& includes, std::string_view body,
                           std::span<const vec4> inputs, size_t outputs, uint32_t count,
                           const std::vector<BlockBytes>& blocks = {});

} // namespace tyndall::test
