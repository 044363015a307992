#include "core/heat_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace tyndall {
namespace {

using Rgb = std::array<uint8_t, 3>;

// Every sixteenth colour of "magma" by Stéfan van der Walt and Nathaniel Smith (public domain, CC0), which is even in CAM02-UCS.
// Linear interpolation stays within 2.1 of 255 of the whole map.
constexpr std::array<Rgb, 17> kMagma = {{{0, 0, 4},
                                         {10, 8, 34},
                                         {29, 17, 71},
                                         {54, 16, 107},
                                         {81, 18, 124},
                                         {106, 28, 129},
                                         {131, 38, 129},
                                         {156, 46, 127},
                                         {183, 55, 121},
                                         {207, 64, 112},
                                         {229, 80, 100},
                                         {244, 105, 92},
                                         {251, 135, 97},
                                         {254, 165, 113},
                                         {254, 194, 135},
                                         {253, 224, 161},
                                         {252, 253, 191}}};

// Straight lines in CIELAB from (97,0,0) to (32,25,-62) and to (36,58,42), brought into sRGB.
constexpr std::array<Rgb, 17> kDiverging = {{{0, 68, 175},
                                             {60, 88, 184},
                                             {94, 108, 193},
                                             {122, 129, 203},
                                             {149, 152, 212},
                                             {174, 174, 221},
                                             {198, 198, 229},
                                             {222, 222, 238},
                                             {246, 246, 246},
                                             {243, 220, 215},
                                             {238, 193, 184},
                                             {231, 167, 154},
                                             {222, 141, 126},
                                             {211, 114, 98},
                                             {199, 87, 71},
                                             {186, 57, 45},
                                             {171, 13, 19}}};

constexpr Rgb kInvalid = {0, 255, 0};

Rgb colourAt(std::span<const Rgb> table, double t) {
    const double position = std::clamp(t, 0.0, 1.0) * double(table.size() - 1);
    const size_t below = std::min(size_t(position), table.size() - 2);
    const double share = position - double(below);
    Rgb colour;
    for (size_t c = 0; c < 3; ++c)
        colour[c] = uint8_t(std::lround(double(table[below][c]) * (1 - share) +
                                        double(table[below + 1][c]) * share));
    return colour;
}

double finiteMean(const Image& image) {
    double sum = 0;
    size_t count = 0;
    for (float value : image.pixels)
        if (std::isfinite(value)) {
            sum += double(value);
            ++count;
        }
    return count ? sum / double(count) : 0;
}

template <typename Error> Image errorMap(const Image& image, const Image& reference, Error error) {
    CHECK(image.width == reference.width && image.height == reference.height &&
              image.channels == reference.channels,
          "images of one shape");
    const double mean = std::abs(finiteMean(reference));
    const size_t channels = size_t(image.channels);
    Image map(image.width, image.height, 1);
    for (size_t pixel = 0; pixel < map.pixels.size(); ++pixel) {
        double sum = 0;
        for (size_t c = 0; c < channels; ++c) {
            const float v = image.pixels[pixel * channels + c],
                        r = reference.pixels[pixel * channels + c];
            if (!std::isfinite(v) || !std::isfinite(r))
                sum = std::numeric_limits<double>::quiet_NaN();
            else if (v != r) // 0/0 is no error
                sum += error(double(v) - double(r)) / (std::abs(double(r)) + 0.1 * mean);
        }
        map.pixels[pixel] = float(sum / double(channels));
    }
    return map;
}

} // namespace

Image relativeErrorMap(const Image& image, const Image& reference) {
    return errorMap(image, reference, [](double difference) { return std::abs(difference); });
}

Image signedErrorMap(const Image& image, const Image& reference) {
    return errorMap(image, reference, [](double difference) { return difference; });
}

std::vector<uint8_t> heatMap(const Image& errors, double largest, HeatScale scale) {
    CHECK(errors.channels == 1 && largest > 0, "one channel and a range");
    std::vector<uint8_t> bytes;
    bytes.reserve(errors.pixels.size() * 3);
    for (float error : errors.pixels) {
        const double t = double(error) / largest;
        const Rgb colour = std::isnan(error)            ? kInvalid
                           : scale == HeatScale::Signed ? colourAt(kDiverging, 0.5 + 0.5 * t)
                                                        : colourAt(kMagma, t);
        bytes.insert(bytes.end(), colour.begin(), colour.end());
    }
    return bytes;
}

} // namespace tyndall
