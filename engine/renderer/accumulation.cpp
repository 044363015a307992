#include "renderer/accumulation.h"

#include <limits>

#include "core/check.h"

namespace tyndall {

uint32_t Accumulation::next(const std::string& key, bool restart) {
    if (restart || key != key_ || frames_ == 0) {
        key_ = key;
        frames_ = 0;
        error_ = std::numeric_limits<double>::infinity();
    }
    return ++frames_;
}

bool Accumulation::shouldMeasure(const ConvergeSettings& settings) const {
    return frames_ >= 2 && (frames_ % uint32_t(settings.checkEvery) == 0 ||
                            frames_ == uint32_t(settings.maximumFrames));
}

void Accumulation::measure(const Image& mean) {
    CHECK(mean.channels == 4 && frames_ >= 2);
    const size_t count = mean.pixels.size() / 4;
    const auto luminance = [&](size_t i) {
        const float* p = &mean.pixels[i * 4];
        return 0.2126 * double(p[0]) + 0.7152 * double(p[1]) + 0.0722 * double(p[2]);
    };
    double average = 0;
    for (size_t i = 0; i < count; ++i) average += luminance(i) / double(count);
    if (!(average > 0)) {
        error_ = 0; // A black picture does not vary.
        return;
    }
    const double n = frames_;
    double sum = 0;
    for (size_t i = 0; i < count; ++i) {
        const double l = luminance(i), variance = double(mean.pixels[i * 4 + 3]) / (n * (n - 1));
        sum += variance / (l * l + 0.01 * average * average);
    }
    error_ = sum / double(count);
}

} // namespace tyndall
