#pragma once
// Programs by shader files and defines, found again without making strings.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>

#include "core/result.h"
#include "framegraph/frame_graph.h"
#include "gl/shader_library.h"

namespace tyndall::fg {

class ProgramCache {
public:
    explicit ProgramCache(gl::ShaderLibrary& library) : library_(library) {}

    /// `files` are the stages in order. CHECKs that shaders/variants.txt lists the program; `pass` is named
    /// where it does not. Errors: it does not compile and has no last good version.
    Result<const gl::Program*> find(std::string_view pass, std::span<const char* const> files,
                                    std::span<const Define> defines);

private:
    gl::ShaderLibrary& library_;
    std::unordered_map<uint64_t, const gl::Program*> programs_;
};

} // namespace tyndall::fg
