#pragma once
// From shader files to what the driver compiles: version line, defines, #include with #line; and from the driver's
// messages back to files and lines. Needs no GL.

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

namespace tyndall::gl {

/// `#define NAME VALUE` before the first line of a shader.
struct ShaderDefine {
    std::string name;
    int32_t value = 0;
    bool operator==(const ShaderDefine&) const = default;
};

/// The text of the file with this path relative to shaders/, or nothing where there is none.
using ReadShader = std::function<std::optional<std::string>(const std::string& path)>;

/// In what the driver sees, line n of file f is line f·kLinesPerFile + n. The source number that #line may give would
/// be the usual way, but Mesa forgets it for some expressions (GLSL parser of 22.3: messages about undeclared variables
/// say source 0).
inline constexpr int kLinesPerFile = 100000;

/// One shader, ready for the driver.
struct ExpandedShader {
    std::string text;
    std::vector<std::string>
        files; // 0: the shader itself, then its includes in the order in which they were met
};

/// Puts `#version 450 core` and the defines before the shader `path` and its includes in their places. An included file
/// is taken once, as if it had a guard. What stands between `#ifdef __cplusplus` and its #else or #endif is left out.
/// Errors: a missing file, an include cycle, an #include that cannot be read; with file and line.
Result<ExpandedShader> expandShader(const std::string& path, std::span<const ShaderDefine> defines,
                                    const ReadShader& read);

/// The driver's messages with `file:line:` (and column where known) instead of its numbers; blank lines are dropped.
std::string mapShaderMessages(std::string_view driverLog, const ExpandedShader& shader);

} // namespace tyndall::gl
