#pragma once
// Where samples become a picture: sums for every pixel, term and stream, from which the mean and its error follow.

#include <string>
#include <vector>

#include "core/image.h"
#include "reference/path_settings.h"

namespace tyndall::reference {

class Film {
public:
    Film() = default;
    Film(int width, int height, TermSet terms);

    /// What one of this size takes.
    [[nodiscard]] static uint64_t bytes(int width, int height, TermSet terms);

    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }
    [[nodiscard]] TermSet terms() const { return terms_; }
    /// Samples that every pixel has.
    [[nodiscard]] uint32_t samples() const { return samples_; }
    void setSamples(uint32_t samples) { samples_ = samples; }

    /// Sample number `sample` of a pixel; samples of one pixel must come in order, from one thread at a time.
    void add(int x, int y, uint32_t sample, const TermLight& light);

    /// The mean of one term, nits.
    [[nodiscard]] Image term(Term term) const;
    /// The sum of all terms' images: equal to it but for one rounding.
    [[nodiscard]] Image beauty() const;
    /// Of the mean, per pixel and channel, nits²: from the spread of the streams' means. 0 with fewer than two samples.
    [[nodiscard]] Image variance() const;
    /// The mean of a part of the streams: two halves that share no sample. CHECKs that half is 0 or 1.
    [[nodiscard]] Image half(int half) const;
    /// `relmse` that the picture is expected to have against the truth: mean(variance / (r² + 0.01·m²)).
    [[nodiscard]] double estimatedRelmse() const;

    /// All that it holds, and back. Errors: it is not of this size and these terms.
    [[nodiscard]] std::string serialise() const;
    Result<void> deserialise(std::string_view bytes);

private:
    [[nodiscard]] size_t pixel(int x, int y) const {
        return size_t(y) * size_t(width_) + size_t(x);
    }
    [[nodiscard]] uint32_t samplesOfStream(int stream) const {
        return samples_ / kStreams + (uint32_t(stream) < samples_ % kStreams ? 1 : 0);
    }
    int width_ = 0, height_ = 0;
    TermSet terms_ = 0;
    std::vector<Term> order_; // of the terms in terms_
    uint32_t samples_ = 0;
    std::vector<double> sums_;       // pixels × terms × 3
    std::vector<double> streamSums_; // pixels × kStreams × 3, all terms together
};

} // namespace tyndall::reference
