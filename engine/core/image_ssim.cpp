// Peak signal-to-noise ratio and structural similarity.

#include "core/display_metrics.h"

#include <cmath>
#include <limits>

#include "core/separable_filter.h"

namespace tyndall {
namespace {

constexpr double kDeviation = 1.5; // pixels
constexpr double kK1 = 0.01, kK2 = 0.03;

Plane lumaOf(const Image& display) {
    Plane luma(display.width, display.height);
    for (size_t i = 0; i < luma.values.size(); ++i) {
        const float* rgb = display.pixels.data() + i * 3;
        luma.values[i] =
            0.2126 * double(rgb[0]) + 0.7152 * double(rgb[1]) + 0.0722 * double(rgb[2]);
    }
    return luma;
}

Plane product(const Plane& a, const Plane& b) {
    Plane out(a.width, a.height);
    for (size_t i = 0; i < out.values.size(); ++i) out.values[i] = a.values[i] * b.values[i];
    return out;
}

Plane windowMean(const Plane& plane, const Kernel& kernel) {
    return filterDown(filterAcross(plane, kernel), kernel);
}

} // namespace

double psnr(const Image& display, const Image& reference) {
    CHECK(display.pixels.size() == reference.pixels.size() && !display.pixels.empty(),
          "pictures of one size");
    double squares = 0;
    for (size_t i = 0; i < display.pixels.size(); ++i) {
        const double difference = double(display.pixels[i]) - double(reference.pixels[i]);
        squares += difference * difference;
    }
    if (squares == 0) return std::numeric_limits<double>::infinity();
    return -10 * std::log10(squares / double(display.pixels.size()));
}

double ssim(const Image& display, const Image& reference) {
    CHECK(display.width == reference.width && display.height == reference.height &&
              display.channels == 3 && reference.channels == 3,
          "RGB pictures of one size");
    CHECK(display.width >= kSsimWindow && display.height >= kSsimWindow, "a window fits in");
    constexpr int kRadius = kSsimWindow / 2;
    const Kernel bell = gaussianKernel(kDeviation, kRadius);
    const Kernel kernel = scaled(bell, 1 / sumOf(bell));
    const Plane v = lumaOf(display), r = lumaOf(reference);
    const Plane meanV = windowMean(v, kernel), meanR = windowMean(r, kernel);
    const Plane meanVV = windowMean(product(v, v), kernel),
                meanRR = windowMean(product(r, r), kernel),
                meanVR = windowMean(product(v, r), kernel);
    constexpr double kC1 = kK1 * kK1, kC2 = kK2 * kK2;
    double sum = 0;
    for (int y = kRadius; y < display.height - kRadius; ++y)
        for (int x = kRadius; x < display.width - kRadius; ++x) {
            const double a = meanV.row(y)[x], b = meanR.row(y)[x];
            const double varianceV = meanVV.row(y)[x] - a * a, varianceR = meanRR.row(y)[x] - b * b;
            const double covariance = meanVR.row(y)[x] - a * b;
            sum += (2 * a * b + kC1) * (2 * covariance + kC2) /
                   ((a * a + b * b + kC1) * (varianceV + varianceR + kC2));
        }
    return sum / (double(display.width - 2 * kRadius) * double(display.height - 2 * kRadius));
}

} // namespace tyndall
