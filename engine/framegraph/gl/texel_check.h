#pragma once
// Counts texels that are not finite or negative in what passes wrote (shaders/common/count_invalid.comp).

#include <cstdint>
#include <vector>

#include "core/result.h"
#include "framegraph/gl/program_cache.h"
#include "framegraph/gl/storage.h"
#include "gl/buffer.h"

namespace tyndall::fg {

class TexelCheck {
public:
    struct Counts {
        uint32_t nonFinite = 0, negative = 0;
    };

    /// Makes room for counts of so many passes and sets them to 0.
    void begin(size_t passCount);
    /// Adds the texels of all levels of a float texture to the counts of `pass`. Changes program and bindings.
    Result<void> add(ProgramCache& programs, const gl::Texture& texture, bool countNegative,
                     size_t pass);
    /// Waits for the GPU.
    const std::vector<Counts>& read();

private:
    gl::Buffer counts_;
    std::vector<Counts> values_;
    size_t passCount_ = 0;
};

} // namespace tyndall::fg
