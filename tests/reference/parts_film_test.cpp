// The reference's film, checkpoints, path terms and random numbers.

#include <cmath>
#include <fstream>
#include <gtest/gtest.h>

#include "core/image.h"
#include "reference/checkpoint.h"
#include "tracing/sampler.h"
#include "support/content.h"

namespace tyndall::validation {
namespace {

using reference::Film;
using tracing::PathHistory;
using tracing::Sampler;
using tracing::Scattering;
using tracing::TermLight;

/// Pixels of independent samples of variance 1/12 · scale².
Film noisyFilm(uint32_t samples, double scale) {
    Film film(24, 16, kAllTerms);
    for (int y = 0; y < film.height(); ++y)
        for (int x = 0; x < film.width(); ++x)
            for (uint32_t i = 0; i < samples; ++i) {
                Sampler sampler(9, uint64_t(y * 24 + x), i);
                TermLight light;
                light.add(Term::LE, dvec3(1, 2, 3));
                light.add(Term::LVE,
                          scale * dvec3(sampler.random(), sampler.random(), sampler.random()));
                film.add(x, y, i, light);
            }
    film.setSamples(samples);
    return film;
}

TEST(ReferenceFilm, TheVarianceIsTheSamplesVarianceOverTheirNumber) {
    for (const uint32_t samples : {8u, 13u, 64u}) { // also where streams have unequal numbers
        const Image variance = noisyFilm(samples, 2).variance();
        double mean = 0;
        for (const float v : variance.pixels) mean += double(v) / double(variance.pixels.size());
        const double expected = 4.0 / 12 / samples;
        // 1152 estimates with seven degrees of freedom: 1.6 % each way; four times that.
        EXPECT_NEAR(mean / expected, 1, 0.065) << samples;
    }
}

TEST(ReferenceFilm, TermsAddUpAndHalvesAreTheirMeans) {
    const Film film = noisyFilm(16, 1);
    const Image beauty = film.beauty(), le = film.term(Term::LE), lve = film.term(Term::LVE),
                a = film.half(0), b = film.half(1);
    for (size_t i = 0; i < beauty.pixels.size(); ++i) {
        EXPECT_EQ(le.pixels[i], float(1 + i % 3));
        EXPECT_NEAR(beauty.pixels[i], le.pixels[i] + lve.pixels[i], 1e-6);
        EXPECT_NEAR(beauty.pixels[i], 0.5f * (a.pixels[i] + b.pixels[i]), 1e-6);
        EXPECT_NE(a.pixels[i], b.pixels[i]);
    }
    EXPECT_EQ(film.term(Term::LSE).pixels[0], 0);
}

TEST(ReferenceFilm, BytesBringItBackBitForBit) {
    const Film film = noisyFilm(9, 1);
    Film back(24, 16, kAllTerms);
    ASSERT_TRUE(back.deserialise(film.serialise()).ok());
    EXPECT_EQ(back.serialise(), film.serialise());
    EXPECT_EQ(back.samples(), 9u);
    Film other(16, 24, kAllTerms), fewer(24, 16, bit(Term::LE));
    EXPECT_FALSE(other.deserialise(film.serialise()).ok());
    EXPECT_FALSE(fewer.deserialise(film.serialise()).ok());
    EXPECT_FALSE(back.deserialise(film.serialise().substr(1)).ok());
    EXPECT_FALSE(back.deserialise(film.serialise().substr(0, 100)).ok());
}

TEST(ReferenceCheckpoint, OnlyAWholeFileOfTheSamePictureIsTaken) {
    const auto path = test::scratchDir("checkpoint") / "film";
    const Film film = noisyFilm(5, 1);
    ASSERT_TRUE(reference::writeCheckpoint(path, "scene 1", film).ok());
    Film back(24, 16, kAllTerms);
    ASSERT_TRUE(reference::readCheckpoint(path, "scene 1", back).ok());
    EXPECT_EQ(back.serialise(), film.serialise());
    EXPECT_FALSE(reference::readCheckpoint(path, "scene 2", back).ok());
    EXPECT_FALSE(reference::readCheckpoint(path.string() + "x", "scene 1", back).ok());
    std::string bytes = *readFile(path);
    for (const size_t at : {size_t(0), bytes.size() / 2, bytes.size() - 1}) {
        std::string damaged = bytes;
        damaged[at] = char(damaged[at] ^ 4);
        ASSERT_TRUE(writeFileAtomically(path, damaged).ok());
        EXPECT_FALSE(reference::readCheckpoint(path, "scene 1", back).ok()) << "byte " << at;
    }
    ASSERT_TRUE(writeFileAtomically(path, bytes.substr(0, bytes.size() - 9)).ok());
    EXPECT_FALSE(reference::readCheckpoint(path, "scene 1", back).ok());
}

TEST(ReferencePathTerms, EveryHistoryHasTheTermOfItsLastTwoScatterings) {
    const auto termOf = [](const std::string& fromEye) {
        PathHistory history;
        for (const char c : fromEye)
            history.add(c == 'V' ? Scattering::Medium : Scattering::Surface);
        return history.term();
    };
    const std::pair<const char*, Term> table[] = {
        {"", Term::LE},         {"S", Term::LSE},     {"V", Term::LVE},       {"SS", Term::LSSE},
        {"SV", Term::LVSE},     {"VS", Term::LSVE},   {"VV", Term::LVVE},     {"SSS", Term::LXSSE},
        {"SSV", Term::LXSSE},   {"SVS", Term::LXVSE}, {"SVVVV", Term::LXVSE}, {"VSV", Term::LXSVE},
        {"VSSSS", Term::LXSVE}, {"VVS", Term::LXVVE}, {"VVVVVV", Term::LXVVE}};
    for (const auto& [history, term] : table) EXPECT_EQ(termOf(history), term) << history;
    PathHistory history;
    history.add(Scattering::Surface);
    EXPECT_EQ(history.termAfter(Scattering::Medium), Term::LVSE);
    EXPECT_EQ(history.count(), 1);
    EXPECT_EQ(tracing::longestPath(bit(Term::LE)), 0);
    EXPECT_EQ(tracing::longestPath(bit(Term::LE) | bit(Term::LVE)), 1);
    EXPECT_EQ(tracing::longestPath(bit(Term::LSVE)), 2);
    EXPECT_EQ(tracing::longestPath(bit(Term::LXVSE)), -1);
}

TEST(ReferenceSampler, NumbersDependOnSeedPixelAndSampleAlone) {
    const auto numbers = [](uint64_t seed, uint64_t pixel, uint32_t sample) {
        Sampler sampler(seed, pixel, sample);
        std::vector<double> drawn;
        for (int i = 0; i < 60; ++i) {
            const dvec2 pair = sampler.next2();
            drawn.insert(drawn.end(), {pair.x, pair.y, sampler.next1(), sampler.random()});
        }
        return drawn;
    };
    EXPECT_EQ(numbers(1, 2, 3), numbers(1, 2, 3));
    EXPECT_NE(numbers(1, 2, 3), numbers(2, 2, 3));
    EXPECT_NE(numbers(1, 2, 3), numbers(1, 3, 3));
    EXPECT_NE(numbers(1, 2, 3), numbers(1, 2, 4));
    for (const double v : numbers(7, 8, 9)) {
        EXPECT_GE(v, 0);
        EXPECT_LT(v, 1);
    }
}

TEST(ReferenceSampler, EveryDimensionIsUniform) {
    constexpr uint32_t kSamples = 4096;
    std::vector<double> mean(80), square(80);
    for (uint32_t i = 0; i < kSamples; ++i) {
        Sampler sampler(11, 5, i);
        for (size_t d = 0; d < mean.size(); ++d) {
            const double v = sampler.next1();
            mean[d] += v / kSamples;
            square[d] += v * v / kSamples;
        }
    }
    for (size_t d = 0; d < mean.size(); ++d) { // 4.5 standard errors of independent numbers
        EXPECT_NEAR(mean[d], 0.5, 4.5 * std::sqrt(1.0 / 12 / kSamples)) << d;
        EXPECT_NEAR(square[d], 1.0 / 3, 4.5 * std::sqrt(4.0 / 45 / kSamples)) << d;
    }
}

} // namespace
} // namespace tyndall::validation
