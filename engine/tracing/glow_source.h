#pragma once
// Emission of media as a light to sample: points in the volume, drawn in proportion to the emission of the cells around them. Rays that
// pass collect the same emission along their length; MIS combines both point by point (Simon, Hanika,
// Zirr and Dachsbacher 2017, "Line Integration for Rendering Heterogeneous Emissive Volumes"), which removes the inverse square.

#include <vector>

#include "tracing/media_field.h"

namespace tyndall::tracing {

/// A point that glows.
struct GlowSample {
    dvec3 position{0};
    dvec3 emission{0};  // of all media there, nits per metre
    double density = 0; // per m³; 0: nothing glows
};

class GlowSource {
public:
    /// Media that have no end are not sampled. `media` must outlive it.
    explicit GlowSource(const std::vector<MediumSource>& media);

    [[nodiscard]] bool black() const { return !(power_ > 0); }
    [[nodiscard]] GlowSample sample(double u0, const dvec2& u) const;
    /// Density with which sample() draws a point, per m³.
    [[nodiscard]] double density(const dvec3& position) const;
    /// Candela, the mean of the channels, before extinction.
    [[nodiscard]] double intensity() const { return power_; }
    [[nodiscard]] const Bounds& bounds() const { return bounds_; }
    /// Roughly the points per metre at which a ray through a glowing medium collects emission: its density for MIS.
    [[nodiscard]] double pointsPerMetre() const { return pointsPerMetre_; }

private:
    /// One medium's cells: of a grid its voxels, of a homogeneous shape one around it.
    struct Part {
        const MediumSource* medium = nullptr;
        dmat4 rayFromLocal{1};
        double cellVolume = 0;        // m³
        std::vector<ivec3> bricks;    // those that glow
        std::vector<int32_t> placeOf; // of every brick in `bricks`, -1: dark
        std::vector<float> powers;    // 512 for each of `bricks`
        double power = 0;
    };
    void addGrid(Part& part);
    [[nodiscard]] dvec3 emission(const dvec3& position) const;

    const std::vector<MediumSource>& media_;
    std::vector<Part> parts_;
    /// Cumulative powers of all bricks (and homogeneous shapes) in order, from 0.
    std::vector<double> sums_{0};
    std::vector<std::pair<uint32_t, uint32_t>> brickOf_; // part and place, of each of sums_
    double power_ = 0, pointsPerMetre_ = 1;
    Bounds bounds_;
};

} // namespace tyndall::tracing
