#include "renderer/environment_lights.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/low_discrepancy.h"

namespace tyndall {
namespace {

constexpr int kMostColumns = 2048; // a pixel is then a sixth of a degree, a third of the sun
constexpr int kLeastColumns = 64;  // so that a constant or tiny image can be cut into many regions
constexpr int kLeastRows = 32;

} // namespace

dvec3 environmentDirection(double u, double v, double rotation) {
    // Turning right-handed about +Y takes -Z towards -X: against the way in which u grows.
    const double azimuth = 2.0 * kPi * (u - 0.5) - rotation;
    const double polar = kPi * v;
    return {std::sin(azimuth) * std::sin(polar), std::cos(polar),
            -std::cos(azimuth) * std::sin(polar)};
}

EnvironmentSampler::EnvironmentSampler(const Environment& environment)
    : rotation_(double(environment.rotation)) {
    if (environment.image && environment.image->width > 0 && environment.image->height > 0 &&
        environment.image->channels > 0) {
        buildFromImage(*environment.image, double(environment.intensity));
    } else {
        width_ = kLeastColumns;
        height_ = kLeastRows;
        vec3 value = environment.radiance;
        for (int c = 0; c < 3; ++c)
            if (!std::isfinite(value[c]) || value[c] < 0) {
                value[c] = 0;
                ++brokenPixels_;
            }
        radiance_.assign(size_t(width_) * size_t(height_), value);
    }
    buildTable();
}

double EnvironmentSampler::rowSolidAngle(int y) const {
    return 2.0 * kPi / width_ * (std::cos(kPi * y / height_) - std::cos(kPi * (y + 1) / height_));
}

void EnvironmentSampler::buildFromImage(const Image& image, double intensity) {
    // Whole pixels are averaged or repeated, so that the result is the image as constant within its pixels.
    const int shrink = (image.width + kMostColumns - 1) / kMostColumns;
    const int growX = shrink > 1 ? 1 : (kLeastColumns + image.width - 1) / image.width;
    const int growY = shrink > 1 ? 1 : (kLeastRows + image.height - 1) / image.height;
    width_ = shrink > 1 ? (image.width + shrink - 1) / shrink : image.width * growX;
    height_ = shrink > 1 ? (image.height + shrink - 1) / shrink : image.height * growY;
    radiance_.resize(size_t(width_) * size_t(height_));
    std::vector<dvec3> sums(radiance_.size(), dvec3(0));
    std::vector<double> weights(radiance_.size(), 0.0);
    for (int y = 0; y < image.height; ++y) {
        const double weight =
            std::cos(kPi * y / image.height) - std::cos(kPi * (y + 1) / image.height);
        for (int x = 0; x < image.width; ++x) {
            const float* pixel = image.at(x, y);
            dvec3 value;
            for (int c = 0; c < 3; ++c)
                value[c] = double(pixel[image.channels >= 3 ? c : 0]) * intensity;
            if (!(std::isfinite(value.x) && std::isfinite(value.y) && std::isfinite(value.z)) ||
                std::min({value.x, value.y, value.z}) < 0) {
                ++brokenPixels_;
                value = dvec3(0);
            }
            for (int j = 0; j < growY; ++j)
                for (int i = 0; i < growX; ++i) {
                    const size_t to = size_t((y * growY + j) / shrink) * size_t(width_) +
                                      size_t((x * growX + i) / shrink);
                    sums[to] += weight * value;
                    weights[to] += weight;
                }
        }
    }
    for (size_t i = 0; i < radiance_.size(); ++i)
        radiance_[i] = weights[i] > 0 ? vec3(sums[i] / weights[i]) : vec3(0);
}

void EnvironmentSampler::buildTable() {
    table_.assign(size_t(width_ + 1) * size_t(height_ + 1), 0.0);
    const size_t stride = size_t(width_) + 1;
    for (int y = 0; y < height_; ++y) {
        double row = 0;
        const double solidAngle = rowSolidAngle(y);
        for (int x = 0; x < width_; ++x) {
            const dvec3 value(radiance_[size_t(y) * size_t(width_) + size_t(x)]);
            row += (value.x + value.y + value.z) / 3.0 * solidAngle;
            fluence_ += value * solidAngle;
            table_[size_t(y + 1) * stride + size_t(x) + 1] =
                table_[size_t(y) * stride + size_t(x) + 1] + row;
        }
    }
    total_ = table_.back();
}

double EnvironmentSampler::sum(int x0, int y0, int x1, int y1) const {
    const size_t stride = size_t(width_) + 1;
    const auto at = [&](int x, int y) { return table_[size_t(y) * stride + size_t(x)]; };
    // Cancellation in the table can leave a tiny remainder of either sign.
    return std::max(0.0, (at(x1, y1) - at(x0, y1)) - (at(x1, y0) - at(x0, y0)));
}

double EnvironmentSampler::extent(const Region& region) const {
    const double north = kPi * region.y0 / height_, south = kPi * region.y1 / height_;
    const double widest =
        north <= kPi / 2 && south >= kPi / 2 ? 1.0 : std::max(std::sin(north), std::sin(south));
    return std::max(south - north, 2.0 * kPi * (region.x1 - region.x0) / width_ * widest);
}

bool EnvironmentSampler::split(const Region& region, Region& low, Region& high) const {
    const double north = kPi * region.y0 / height_, south = kPi * region.y1 / height_;
    const double width =
        2.0 * kPi * (region.x1 - region.x0) / width_ * std::sin(0.5 * (north + south));
    const auto cut = [&](bool alongX) {
        const int first = alongX ? region.x0 : region.y0, last = alongX ? region.x1 : region.y1;
        int best = -1;
        double bestDistance = 0;
        for (int at = first + 1; at < last; ++at) {
            const double part = alongX ? sum(region.x0, region.y0, at, region.y1)
                                       : sum(region.x0, region.y0, region.x1, at);
            const double distance = std::abs(part - 0.5 * region.weight);
            const double rest = region.weight - part;
            // Rounding in the table is not light.
            if (part <= 1e-14 * total_ || rest <= 1e-14 * total_) continue;
            if (best < 0 || distance < bestDistance) best = at, bestDistance = distance;
        }
        if (best < 0) return false;
        low = high = region;
        (alongX ? low.x1 : low.y1) = best;
        (alongX ? high.x0 : high.y0) = best;
        low.weight = sum(low.x0, low.y0, low.x1, low.y1);
        high.weight = sum(high.x0, high.y0, high.x1, high.y1);
        return true;
    };
    const bool alongX = width > south - north;
    return cut(alongX) || cut(!alongX);
}

const std::vector<EnvironmentSampler::Region>& EnvironmentSampler::regions(int count) const {
    if (count == regionCount_) return regions_;
    regionCount_ = count;
    regions_.clear();
    if (black() || count <= 0) return regions_;
    regions_.push_back({0, 0, width_, height_, total_});
    std::vector<bool> whole(1, false); // cannot be cut any more
    while (int(regions_.size()) < count) {
        // Light times extent: a sun that is alone in its region stops drawing lights to it.
        int widest = -1;
        double most = 0;
        for (int i = 0; i < int(regions_.size()); ++i) {
            const double importance = regions_[size_t(i)].weight * extent(regions_[size_t(i)]);
            if (!whole[size_t(i)] && importance > most) widest = i, most = importance;
        }
        if (widest < 0) break;
        Region low, high;
        if (!split(regions_[size_t(widest)], low, high)) {
            whole[size_t(widest)] = true;
            continue;
        }
        regions_[size_t(widest)] = low;
        regions_.push_back(high);
        whole.push_back(false);
    }
    return regions_;
}

EnvironmentLight EnvironmentSampler::meanLight(const Region& region) const {
    EnvironmentLight light;
    dvec3 direction(0);
    for (int y = region.y0; y < region.y1; ++y) {
        const double solidAngle = rowSolidAngle(y);
        for (int x = region.x0; x < region.x1; ++x) {
            const dvec3 value =
                dvec3(radiance_[size_t(y) * size_t(width_) + size_t(x)]) * solidAngle;
            light.illuminance += value;
            direction += (value.x + value.y + value.z) *
                         environmentDirection((x + 0.5) / width_, (y + 0.5) / height_, rotation_);
        }
    }
    const double length = glm::length(direction);
    // The whole sphere as one region has no mean direction: the centre of the region then stands for it.
    light.toLight =
        length > 1e-6 * (light.illuminance.x + light.illuminance.y + light.illuminance.z)
            ? direction / length
            : environmentDirection(0.5 * (region.x0 + region.x1) / width_,
                                   0.5 * (region.y0 + region.y1) / height_, rotation_);
    return light;
}

EnvironmentLight EnvironmentSampler::sampleLight(const Region& region, double u, double v) const {
    // First the row, then the pixel in it, by bisection of the sums; what is left of u and v is the place within the pixel.
    const double rowTarget = v * region.weight;
    int y0 = region.y0, y1 = region.y1;
    while (y1 - y0 > 1) {
        const int middle = (y0 + y1) / 2;
        (sum(region.x0, region.y0, region.x1, middle) <= rowTarget ? y0 : y1) = middle;
    }
    const double before = sum(region.x0, region.y0, region.x1, y0),
                 rowWeight = sum(region.x0, y0, region.x1, y0 + 1);
    const double columnTarget = u * rowWeight;
    int x0 = region.x0, x1 = region.x1;
    while (x1 - x0 > 1) {
        const int middle = (x0 + x1) / 2;
        (sum(region.x0, y0, middle, y0 + 1) <= columnTarget ? x0 : x1) = middle;
    }
    const double pixelBefore = sum(region.x0, y0, x0, y0 + 1);
    const dvec3 value(radiance_[size_t(y0) * size_t(width_) + size_t(x0)]);
    const double pixelWeight = (value.x + value.y + value.z) / 3.0 * rowSolidAngle(y0);
    EnvironmentLight light;
    if (!(pixelWeight > 0) || !(rowWeight > 0))
        return light; // only by rounding, at the very edge of a lit region
    const double inRow = std::clamp((rowTarget - before) / rowWeight, 0.0, 1.0);
    const double inPixel = std::clamp((columnTarget - pixelBefore) / pixelWeight, 0.0, 1.0);
    const double cosine =
        std::lerp(std::cos(kPi * y0 / height_), std::cos(kPi * (y0 + 1) / height_), inRow);
    light.toLight = environmentDirection((x0 + inPixel) / width_,
                                         std::acos(std::clamp(cosine, -1.0, 1.0)) / kPi, rotation_);
    // Probability per solid angle is the importance over the region's; radiance over it:
    light.illuminance = value * (3.0 * region.weight / (value.x + value.y + value.z));
    return light;
}

std::vector<EnvironmentLight> EnvironmentSampler::lights(int count) const {
    std::vector<EnvironmentLight> result;
    for (const Region& region : regions(count)) result.push_back(meanLight(region));
    return result;
}

std::vector<EnvironmentLight> EnvironmentSampler::sample(int count, uint32_t frame,
                                                         uint32_t seed) const {
    std::vector<EnvironmentLight> result;
    uint64_t index = (uint64_t(seed) << 20) + (uint64_t(1) << 60);
    for (const Region& region : regions(count)) {
        const dvec2 point =
            lowDiscrepancyPoint(frame, ++index); // every region has its own sequence
        const EnvironmentLight light = sampleLight(region, point.x, point.y);
        if (light.illuminance != dvec3(0)) result.push_back(light);
    }
    return result;
}

} // namespace tyndall
