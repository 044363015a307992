#pragma once
// Bookkeeping of an average of frames: when it starts anew, how many frames are in it, how good it is.

#include <cstdint>
#include <string>

#include "core/image.h"
#include "renderer/converge_settings.h"

namespace tyndall {

class Accumulation {
public:
    /// Call once a frame. `key` describes everything that the picture depends on (scene versions, camera, settings): when it
    /// changes, or on `restart`, the average starts again. Returns the frame's number in the average, from 1.
    uint32_t next(const std::string& key, bool restart);
    /// True when this frame's average should be measured.
    [[nodiscard]] bool shouldMeasure(const ConvergeSettings& settings) const;
    /// `mean`: RGBA, alpha the sum of squared deviations of luminance over the frames so far. The relative mean square error of
    /// the mean that its own variance accounts for: mean over pixels of var/(n·(r² + 0.01·m²)), frames taken as
    /// independent. They are stratified, so the true error is smaller.
    void measure(const Image& mean);

    [[nodiscard]] uint32_t frames() const { return frames_; }
    [[nodiscard]] double estimatedError() const { return error_; }

private:
    std::string key_;
    uint32_t frames_ = 0;
    double error_ = 0;
};

} // namespace tyndall
