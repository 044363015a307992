#include "core/image_metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/math.h"

namespace tyndall {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

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

/// An error over what it is relative to, where 0/0 is no error.
double relative(double error, double scale) { return error == 0 ? 0.0 : error / scale; }

/// `what` tells the second image's part in the sentence.
Result<void> checkShapes(const Image& image, const Image& other, const char* what) {
    if (image.width != other.width || image.height != other.height ||
        image.channels != other.channels)
        return Error{fmt::format("{}: {}x{} with {} channels against {}x{} with {}", what,
                                 image.width, image.height, image.channels, other.width,
                                 other.height, other.channels)};
    CHECK(!image.pixels.empty() && image.channels >= 1 && image.channels <= 4,
          fmt::format("{} channels", image.channels));
    return {};
}

void setAll(ImageMetrics& metrics, double value) {
    metrics.rmse = metrics.relmse = metrics.relmseTrimmed = metrics.mrse = metrics.smape =
        metrics.p999 = metrics.energy = metrics.largestDifference = value;
    metrics.energyPerChannel.fill(value);
}

/// Squared relative errors: their mean, and the mean without the worst pixels.
void addRelmse(ImageMetrics& metrics, const Image& image, const Image& reference, double mean) {
    const size_t channels = size_t(image.channels), count = image.pixels.size() / channels;
    const double floor = 0.01 * mean * mean;
    std::vector<double> errors(count, 0.0);
    double sum = 0;
    for (size_t i = 0; i < image.pixels.size(); ++i) {
        const double r = double(reference.pixels[i]), difference = double(image.pixels[i]) - r;
        const double error = relative(difference * difference, r * r + floor);
        errors[i / channels] += error;
        sum += error;
    }
    metrics.relmse = sum / double(image.pixels.size());
    const size_t kept = count - count / 1000;
    if (kept < count)
        std::nth_element(errors.begin(), errors.begin() + std::ptrdiff_t(kept), errors.end());
    double keptSum = 0;
    for (size_t i = 0; i < kept; ++i) keptSum += errors[i];
    metrics.relmseTrimmed = keptSum / double(kept * channels);
}

double meanLuminance(const std::array<double, 4>& means, int channels) {
    if (channels < 3) return meanOf(means, channels);
    return 0.2126 * means[0] + 0.7152 * means[1] + 0.0722 * means[2];
}

double mrse(const Image& image, const Image& reference, double luminance) {
    if (luminance == 0) return image.pixels == reference.pixels ? 0.0 : kInfinity;
    const double scale = 0.5 / luminance;
    double sum = 0;
    for (size_t i = 0; i < image.pixels.size(); ++i) {
        const double r = scale * double(reference.pixels[i]);
        const double error = (scale * double(image.pixels[i]) - r) / (r + 0.01);
        sum += error * error;
    }
    return sum / double(image.pixels.size());
}

/// Absolute errors: rmse, the largest, smape and the percentile.
void addDifferences(ImageMetrics& metrics, const Image& image, const Image& reference,
                    double mean) {
    const size_t count = image.pixels.size();
    std::vector<double> errors(count);
    double squares = 0, symmetric = 0;
    for (size_t i = 0; i < count; ++i) {
        const double v = double(image.pixels[i]), r = double(reference.pixels[i]);
        const double difference = std::abs(v - r);
        squares += difference * difference;
        symmetric += relative(2 * difference, std::abs(v) + std::abs(r) + 0.01 * mean);
        errors[i] = relative(difference, std::abs(r) + 0.1 * mean);
        metrics.largestDifference = std::max(metrics.largestDifference, difference);
    }
    metrics.rmse = std::sqrt(squares / double(count));
    metrics.smape = symmetric / double(count);
    const size_t rank = count - count / 1000; // ceil(0.999·count)
    const auto at = errors.begin() + std::ptrdiff_t(rank - 1);
    std::nth_element(errors.begin(), at, errors.end());
    metrics.p999 = *at;
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
    if (Result<void> same = checkShapes(image, reference, "the images differ in shape"); !same.ok())
        return same.error();
    ImageMetrics metrics;
    metrics.image = countValues(image);
    metrics.reference = countValues(reference);
    if (metrics.image.nonFinite + metrics.reference.nonFinite > 0) {
        setAll(metrics, kNaN);
        return metrics;
    }
    const std::array<double, 4> ofImage = channelMeans(image),
                                ofReference = channelMeans(reference);
    const double mean = meanOf(ofReference, reference.channels);
    addRelmse(metrics, image, reference, mean);
    addDifferences(metrics, image, reference, std::abs(mean));
    metrics.mrse = mrse(image, reference, meanLuminance(ofReference, reference.channels));
    metrics.energy = ratio(meanOf(ofImage, image.channels), mean);
    for (size_t c = 0; c < size_t(image.channels); ++c)
        metrics.energyPerChannel[c] = ratio(ofImage[c], ofReference[c]);
    return metrics;
}

Result<double> referenceFloor(const Image& reference, const Image& variance) {
    if (Result<void> same = checkShapes(variance, reference,
                                        "the variance differs in shape from what it belongs to");
        !same.ok())
        return same.error();
    if (countValues(reference).nonFinite > 0) return kNaN;
    const ValueCounts wrong = countValues(variance);
    if (wrong.nonFinite + wrong.negative > 0)
        return Error{fmt::format(
            "{} variances are not finite and {} negative: a variance is finite and at least 0",
            wrong.nonFinite, wrong.negative)};
    const double mean = meanOf(channelMeans(reference), reference.channels);
    double sum = 0;
    for (size_t i = 0; i < reference.pixels.size(); ++i) {
        const double r = double(reference.pixels[i]);
        sum += relative(double(variance.pixels[i]), r * r + 0.01 * mean * mean);
    }
    return sum / double(reference.pixels.size());
}

} // namespace tyndall
