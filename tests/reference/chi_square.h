#pragma once
// Do drawn directions follow a density? Bins over the sphere, even in solid angle.

#include <algorithm>
#include <cmath>
#include <vector>

#include "tracing/ray.h"
#include "tracing/sampler.h"

namespace tyndall::validation {

class ChiSquare {
public:
    ChiSquare(int rows, int columns)
        : rows_(rows), columns_(columns), counts_(size_t(rows) * size_t(columns)) {}

    void count(const dvec3& direction) {
        const double u = std::atan2(direction.y, direction.x) / (2 * kPi) + 0.5;
        const int row = std::clamp(int(0.5 * (1 - direction.z) * rows_), 0, rows_ - 1),
                  column = std::clamp(int(u * columns_), 0, columns_ - 1);
        counts_[size_t(row * columns_ + column)] += 1;
    }
    /// χ² less its expectation, over its standard deviation, among `drawn` directions; bins that expect fewer than ten are pooled.
    template <typename Density> double excess(const Density& density, double drawn) const {
        constexpr int kFine = 24; // midpoints each way in a bin
        double chi = 0, bins = 0, pooled = 0, seen = 0;
        for (int row = 0; row < rows_; ++row)
            for (int column = 0; column < columns_; ++column) {
                double mass = 0;
                for (int i = 0; i < kFine * kFine; ++i) {
                    const double z = 1 - 2 * (row + (i / kFine + 0.5) / kFine) / rows_,
                                 u = (column + (i % kFine + 0.5) / kFine) / columns_ - 0.5;
                    mass += density(tracing::directionAround(z, u));
                }
                const double expected =
                    drawn * mass * 4 * kPi / (rows_ * columns_ * double(kFine * kFine));
                const double found = counts_[size_t(row * columns_ + column)];
                if (expected < 10) {
                    pooled += expected;
                    seen += found;
                    continue;
                }
                chi += (found - expected) * (found - expected) / expected;
                ++bins;
            }
        if (pooled > 10) {
            chi += (seen - pooled) * (seen - pooled) / pooled;
            ++bins;
        }
        return (chi - bins) / std::sqrt(2 * bins);
    }

private:
    int rows_, columns_;
    std::vector<double> counts_;
};

} // namespace tyndall::validation
