#include "core/image_metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace tyndall {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::array<double, 4> channelMeans(const Image& image) {
    std::array<double, 4> sums{};
    const size_t channels = size_t(image.channels);
    for (size_t i = 0; i < image.pixels.size(); ++i) sums[i % channels] += double(image.pixels[i]);
    for (double& sum : sums) sum /= double(image.pixels.size() / channels);
    return sums;
}

double meanOf(const std::array<double, 4>& channels, int count) {
    double sum = 0;
    for (int c = 0; c < count; ++c) sum += channels[size_t(c)];
    return sum / count;
}

double ratio(double value, double reference) {
    if (reference == 0) return value == 0 ? 1.0 : kInfinity;
    return value / reference;
}

} // namespace

ValueCounts countValues(const Image& image) {
    ValueCounts counts;
    for (float value : image.pixels) {
        counts.nonFinite += !std::isfinite(value);
        counts.negative += value < 0;
    }
    return counts;
}

Result<ImageMetrics> compareImages(const Image& image, const Image& reference) {
    if (image.width != reference.width || image.height != reference.height ||
        image.channels != reference.channels)
        return Error{fmt::format(
            "the images differ in shape: {}x{} with {} channels against {}x{} with {}", image.width,
            image.height, image.channels, reference.width, reference.height, reference.channels)};
    CHECK(!image.pixels.empty() && image.channels >= 1 && image.channels <= 4,
          fmt::format("{} channels", image.channels));
    ImageMetrics metrics;
    metrics.image = countValues(image);
    metrics.reference = countValues(reference);
    if (metrics.image.nonFinite + metrics.reference.nonFinite > 0) {
        metrics.rmse = metrics.relmse = metrics.energy = metrics.largestDifference =
            std::numeric_limits<double>::quiet_NaN();
        metrics.energyPerChannel.fill(metrics.energy);
        return metrics;
    }
    const std::array<double, 4> ofImage = channelMeans(image),
                                ofReference = channelMeans(reference);
    const double mean = meanOf(ofReference, reference.channels);
    const double floor = 0.01 * mean * mean;
    double squares = 0, relative = 0;
    for (size_t i = 0; i < image.pixels.size(); ++i) {
        const double r = double(reference.pixels[i]), difference = double(image.pixels[i]) - r;
        squares += difference * difference;
        if (difference != 0)
            relative += difference * difference / (r * r + floor); // 0/0 is no error
        metrics.largestDifference = std::max(metrics.largestDifference, std::abs(difference));
    }
    metrics.rmse = std::sqrt(squares / double(image.pixels.size()));
    metrics.relmse = relative / double(image.pixels.size());
    metrics.energy = ratio(meanOf(ofImage, image.channels), mean);
    for (size_t c = 0; c < size_t(image.channels); ++c)
        metrics.energyPerChannel[c] = ratio(ofImage[c], ofReference[c]);
    return metrics;
}

} // namespace tyndall
