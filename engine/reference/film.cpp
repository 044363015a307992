#include "reference/film.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include <fmt/format.h>

namespace tyndall::reference {

uint64_t Film::bytes(int width, int height, TermSet terms) {
    const uint64_t images = uint64_t(std::popcount(terms)) + kStreams;
    return uint64_t(width) * uint64_t(height) * images * 3 * sizeof(double);
}

Film::Film(int width, int height, TermSet terms) : width_(width), height_(height), terms_(terms) {
    for (uint32_t i = 0; i < kTermCount; ++i)
        if (terms & bit(Term(i))) order_.push_back(Term(i));
    const size_t pixels = size_t(width) * size_t(height);
    sums_.assign(pixels * order_.size() * 3, 0);
    streamSums_.assign(pixels * kStreams * 3, 0);
}

void Film::add(int x, int y, uint32_t sample, const TermLight& light) {
    double* sums = &sums_[pixel(x, y) * order_.size() * 3];
    double* stream = &streamSums_[(pixel(x, y) * kStreams + sample % kStreams) * 3];
    for (const Term term : order_) {
        const dvec3& value = light.terms[size_t(term)];
        for (int c = 0; c < 3; ++c) {
            *sums++ += value[c];
            stream[c] += value[c];
        }
    }
}

Image Film::term(Term term) const {
    Image image(width_, height_, 3);
    const auto found = std::find(order_.begin(), order_.end(), term);
    if (found == order_.end() || samples_ == 0) return image;
    const size_t index = size_t(found - order_.begin());
    for (size_t p = 0; p < size_t(width_) * size_t(height_); ++p)
        for (size_t c = 0; c < 3; ++c)
            image.pixels[3 * p + c] =
                float(sums_[(p * order_.size() + index) * 3 + c] / double(samples_));
    return image;
}

Image Film::beauty() const {
    Image image(width_, height_, 3);
    if (samples_ == 0) return image;
    for (size_t p = 0; p < size_t(width_) * size_t(height_); ++p)
        for (size_t c = 0; c < 3; ++c) {
            double sum = 0; // of the terms as their images hold them
            for (size_t i = 0; i < order_.size(); ++i)
                sum += double(float(sums_[(p * order_.size() + i) * 3 + c] / double(samples_)));
            image.pixels[3 * p + c] = float(sum);
        }
    return image;
}

Image Film::variance() const {
    Image image(width_, height_, 3);
    const uint32_t streams = std::min<uint32_t>(samples_, kStreams);
    if (streams < 2) return image;
    for (size_t p = 0; p < size_t(width_) * size_t(height_); ++p)
        for (size_t c = 0; c < 3; ++c) {
            double total = 0;
            for (size_t s = 0; s < streams; ++s) total += streamSums_[(p * kStreams + s) * 3 + c];
            const double mean = total / samples_;
            // Streams of n samples have means of variance σ²/n: weighed by n they give σ², and the mean of all has σ²/N.
            double spread = 0;
            for (size_t s = 0; s < streams; ++s) {
                const double n = samplesOfStream(int(s)),
                             d = streamSums_[(p * kStreams + s) * 3 + c] / n - mean;
                spread += n * d * d;
            }
            image.pixels[3 * p + c] = float(spread / (streams - 1) / samples_);
        }
    return image;
}

Image Film::half(int half) const {
    CHECK(half == 0 || half == 1);
    Image image(width_, height_, 3);
    double samples = 0;
    for (int s = half; s < kStreams; s += 2) samples += samplesOfStream(s);
    if (samples == 0) return image;
    for (size_t p = 0; p < size_t(width_) * size_t(height_); ++p)
        for (size_t c = 0; c < 3; ++c) {
            double sum = 0;
            for (size_t s = size_t(half); s < kStreams; s += 2)
                sum += streamSums_[(p * kStreams + s) * 3 + c];
            image.pixels[3 * p + c] = float(sum / samples);
        }
    return image;
}

double Film::estimatedRelmse() const {
    const Image mean = beauty(), error = variance();
    double total = 0;
    for (const float value : mean.pixels) total += double(value);
    const double m = total / double(std::max<size_t>(1, mean.pixels.size()));
    double sum = 0;
    for (size_t i = 0; i < mean.pixels.size(); ++i) {
        const double r = double(mean.pixels[i]), denominator = r * r + 0.01 * m * m;
        if (error.pixels[i] > 0) sum += double(error.pixels[i]) / denominator;
    }
    return sum / double(std::max<size_t>(1, mean.pixels.size()));
}

std::string Film::serialise() const {
    const uint32_t header[4] = {uint32_t(width_), uint32_t(height_), terms_, samples_};
    std::string bytes(sizeof header + 8 * (sums_.size() + streamSums_.size()), '\0');
    char* out = bytes.data();
    std::memcpy(out, header, sizeof header);
    std::memcpy(out + sizeof header, sums_.data(), 8 * sums_.size());
    std::memcpy(out + sizeof header + 8 * sums_.size(), streamSums_.data(), 8 * streamSums_.size());
    return bytes;
}

Result<void> Film::deserialise(std::string_view bytes) {
    uint32_t header[4] = {};
    if (bytes.size() >= sizeof header) std::memcpy(header, bytes.data(), sizeof header);
    if (header[0] != uint32_t(width_) || header[1] != uint32_t(height_) || header[2] != terms_)
        return Error{fmt::format("it is of {}x{} pixels and terms '{}', not of {}x{} and '{}'",
                                 header[0], header[1], termNames(header[2] & kAllTerms), width_,
                                 height_, termNames(terms_))};
    const size_t wanted = sizeof header + 8 * (sums_.size() + streamSums_.size());
    if (bytes.size() != wanted)
        return Error{fmt::format("it has {} bytes where {} belong", bytes.size(), wanted)};
    samples_ = header[3];
    std::memcpy(sums_.data(), bytes.data() + sizeof header, 8 * sums_.size());
    std::memcpy(streamSums_.data(), bytes.data() + sizeof header + 8 * sums_.size(),
                8 * streamSums_.size());
    return {};
}

} // namespace tyndall::reference
