#include "tracing/environment_source.h"

#include <algorithm>
#include <cmath>

namespace tyndall::tracing {
namespace {

/// Index i with sums[i] ≤ u·total < sums[i+1], and how far u lies between the two.
std::pair<size_t, double> invert(const double* sums, size_t count, double u) {
    const double target = u * sums[count];
    size_t i = size_t(std::upper_bound(sums, sums + count + 1, target) - sums);
    i = std::clamp<size_t>(i, 1, count) - 1;
    while (i + 1 < count && !(sums[i + 1] > sums[i])) ++i; // never an entry without weight
    const double width = sums[i + 1] - sums[i];
    return {i, width > 0 ? std::clamp((target - sums[i]) / width, 0.0, 1.0) : 0.5};
}

} // namespace

EnvironmentSource::EnvironmentSource(const Environment& environment)
    : cosine_(std::cos(double(environment.rotation))),
      sine_(std::sin(double(environment.rotation))) {
    const auto valid = [](double v) { return std::isfinite(v) && v > 0 ? v : 0.0; };
    if (!environment.image) {
        for (int c = 0; c < 3; ++c) constant_[c] = valid(double(environment.radiance[c]));
        meanLuminance_ = luminanceOf(constant_);
        black_ = !(maximumOf(constant_) > 0);
        return;
    }
    const Image& image = *environment.image;
    columns_ = image.width;
    rows_ = image.height;
    texels_.reserve(size_t(columns_) * size_t(rows_));
    for (int y = 0; y < rows_; ++y)
        for (int x = 0; x < columns_; ++x) {
            vec3 value(0);
            for (int c = 0; c < 3; ++c)
                value[c] = float(valid(double(image.at(x, y)[std::min(c, image.channels - 1)]) *
                                       double(environment.intensity)));
            texels_.push_back(value);
            black_ = black_ && value == vec3(0);
        }
    makeTables();
}

dvec3 EnvironmentSource::texel(int column, int row) const {
    column = ((column % columns_) + columns_) % columns_;
    row = std::clamp(row, 0, rows_ - 1);
    return dvec3(texels_[size_t(row) * size_t(columns_) + size_t(column)]);
}

void EnvironmentSource::makeTables() {
    rowSums_.assign(1, 0);
    double luminance = 0, solidAngle = 0;
    for (int y = 0; y < rows_; ++y) {
        const double top = kPi * y / rows_, bottom = kPi * (y + 1) / rows_;
        const double band = std::cos(top) - std::cos(bottom);
        double sum = 0;
        columnSums_.push_back(0);
        for (int x = 0; x < columns_; ++x) {
            // Interpolation spreads light by half a texel: a dark texel beside a bright one must be sampled, too.
            double weight = 0;
            for (int j = -1; j <= 1; ++j)
                for (int i = -1; i <= 1; ++i) {
                    const double part = (i == 0 ? 0.5 : 0.25) * (j == 0 ? 0.5 : 0.25);
                    weight += part * luminanceOf(texel(x + i, y + j));
                }
            luminance += luminanceOf(texel(x, y)) * band;
            solidAngle += band;
            columnSums_.push_back(sum += weight * band);
        }
        rowSums_.push_back(rowSums_.back() + sum);
    }
    meanLuminance_ = luminance / solidAngle;
}

dvec2 EnvironmentSource::uvOf(const dvec3& direction) const {
    const dvec3 d(cosine_ * direction.x - sine_ * direction.z, direction.y,
                  sine_ * direction.x + cosine_ * direction.z);
    const double u = d.x == 0 && d.z == 0 ? 0.5 : 0.5 + std::atan2(d.x, -d.z) / (2 * kPi);
    return {u, std::acos(std::clamp(d.y, -1.0, 1.0)) / kPi};
}

dvec3 EnvironmentSource::radiance(const dvec3& direction) const {
    if (columns_ == 0 || black_) return constant_;
    const dvec2 uv = uvOf(direction);
    const double x = uv.x * columns_ - 0.5, y = uv.y * rows_ - 0.5;
    const double x0 = std::floor(x), y0 = std::floor(y), fx = x - x0, fy = y - y0;
    const int i = int(x0), j = int(y0);
    return (1 - fy) * ((1 - fx) * texel(i, j) + fx * texel(i + 1, j)) +
           fy * ((1 - fx) * texel(i, j + 1) + fx * texel(i + 1, j + 1));
}

DirectionSample EnvironmentSource::sample(const dvec2& u) const {
    DirectionSample result;
    if (black_) return result;
    if (constant()) {
        result.direction = directionAround(1 - 2 * u.x, u.y);
        result.density = 1 / (4 * kPi);
    } else {
        const auto [row, partOfRow] = invert(rowSums_.data(), size_t(rows_), u.y);
        const double* columns = &columnSums_[row * size_t(columns_ + 1)];
        const auto [column, partOfColumn] = invert(columns, size_t(columns_), u.x);
        // Uniform in solid angle within the texel.
        const double top = std::cos(kPi * double(row) / rows_),
                     bottom = std::cos(kPi * double(row + 1) / rows_);
        const double y = top + (bottom - top) * partOfRow, s = std::sqrt(std::max(0.0, 1 - y * y)),
                     azimuth = 2 * kPi * ((double(column) + partOfColumn) / columns_ - 0.5);
        const dvec3 d(s * std::sin(azimuth), y, -s * std::cos(azimuth));
        result.direction = {cosine_ * d.x + sine_ * d.z, d.y, -sine_ * d.x + cosine_ * d.z};
        result.density = density(result.direction);
    }
    result.radiance = radiance(result.direction);
    return result;
}

double EnvironmentSource::density(const dvec3& direction) const {
    if (black_) return 0;
    if (constant()) return 1 / (4 * kPi);
    const dvec2 uv = uvOf(direction);
    const size_t column = size_t(std::clamp(int(uv.x * columns_), 0, columns_ - 1)),
                 row = size_t(std::clamp(int(uv.y * rows_), 0, rows_ - 1));
    const double* columns = &columnSums_[row * size_t(columns_ + 1)];
    const double chance = (columns[column + 1] - columns[column]) / rowSums_.back();
    const double band =
        std::cos(kPi * double(row) / rows_) - std::cos(kPi * double(row + 1) / rows_);
    return chance / (band * 2 * kPi / columns_);
}

} // namespace tyndall::tracing
