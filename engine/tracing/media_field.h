#pragma once
// The media of a scene for rays: where they are, how dense, and bounds of their density for free flight.
//
// A medium's density is dimensionless; its coefficients are per metre at density 1. Media overlap freely: coefficients add.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tracing/ray.h"
#include "scene/scene.h"

namespace tyndall::tracing {

/// An interval of a ray; empty where end ≤ begin.
struct Interval {
    double begin = 0, end = 0;
    [[nodiscard]] bool empty() const { return !(end > begin); }
};

/// Above this many scale heights no fog is left, e⁻⁶⁰, so that free flight ends.
inline constexpr double kHighestFog = 60;

/// A grid's bricks with their bounds.
struct BrickBounds {
    float minimum = 0, maximum = 0, mean = 0;
};

class MediumSource {
public:
    /// `rayFromNode` maps the medium's node to ray space.
    MediumSource(const Medium& medium, const dmat4& rayFromNode);

    dvec3 scattering{0}, extinction{0}; // per metre at density 1
    dvec3 emission{0};                  // nits per metre at density 1
    double anisotropy = 0;
    PhaseFunction phase = PhaseFunction::HenyeyGreenstein;

    [[nodiscard]] bool emits() const { return emission != dvec3(0) || temperature_ != nullptr; }
    /// Where along [0,length] the density may be more than 0.
    [[nodiscard]] Interval clip(const Ray& ray, double length) const;
    [[nodiscard]] double density(const dvec3& position) const;
    /// Nits per metre that the medium emits at a point of this density.
    [[nodiscard]] dvec3 emitted(const dvec3& position, double density) const;
    /// ∫ density dt over the interval of the ray, metres; in closed form, for grids exact cell by cell.
    [[nodiscard]] double densityIntegral(const Ray& ray, Interval interval) const;
    /// Additional majorant where the medium emits, so that thin fire has enough tentative collisions: per metre.
    [[nodiscard]] double emissionMajorant() const { return emissionMajorant_; }
    [[nodiscard]] double phaseValue(double oneMinusCosine) const;
    /// Cosine between the directions of travel before and after.
    [[nodiscard]] double samplePhase(double u) const;
    /// The density is nowhere more.
    [[nodiscard]] double densestBound() const { return grid_ ? double(grid_->maximum) : 1; }
    /// Unbounded above and to the sides, with density 1 at most: Height.
    [[nodiscard]] bool isHeight() const { return kind_ == MediumKind::Height; }
    /// It has no end in any direction.
    [[nodiscard]] bool endless() const {
        return kind_ == MediumKind::Everywhere || kind_ == MediumKind::Height;
    }
    [[nodiscard]] bool isGrid() const { return kind_ == MediumKind::Grid; }
    /// In ray space; empty for media without an end.
    [[nodiscard]] Bounds bounds() const;

private:
    friend class MediumWalk;
    friend class GlowSource;
    void makeBrickBounds();
    [[nodiscard]] double gridIntegral(const dvec3& origin, const dvec3& direction,
                                      Interval interval) const;
    [[nodiscard]] double heightIntegral(const Ray& ray, Interval interval) const;
    [[nodiscard]] dvec3 localPoint(const dvec3& p) const {
        return dmat3(localFromRay_) * p + dvec3(localFromRay_[3]);
    }
    [[nodiscard]] double gridDensity(const dvec3& index) const;
    [[nodiscard]] double cellDensity(const ivec3& cell, const dvec3& index) const;

    MediumKind kind_;
    dmat4 localFromRay_{1}; // Box: the unit cube about 0; Sphere: the unit ball; Grid: index space
    dvec3 up_{0, 1, 0};
    double ground_ = 0,
           scaleHeight_ = 1; // Height: the density falls above up_·p = ground_
    std::shared_ptr<const BrickGrid> grid_, temperature_;
    dmat4 temperatureFromRay_{1};
    double temperatureScale_ = 0;
    std::vector<BrickBounds> bricks_;
    double emissionMajorant_ = 0;
};

/// One medium along a ray, piece by piece; in each the density lies between `minimum` and `maximum`.
class MediumWalk {
public:
    /// Starts with the first piece. `interval` as from clip().
    MediumWalk(const MediumSource& medium, const Ray& ray, Interval interval);

    [[nodiscard]] bool done() const { return done_; }
    [[nodiscard]] double begin() const { return begin_; }
    [[nodiscard]] double end() const { return end_; }
    [[nodiscard]] double minimum() const { return minimum_; }
    [[nodiscard]] double maximum() const { return maximum_; }
    /// An estimate of the mean density, the same for every ray through the piece.
    [[nodiscard]] double mean() const { return mean_; }
    void next();
    /// The density at a point of the present piece.
    [[nodiscard]] double density(double t) const;
    [[nodiscard]] const MediumSource& medium() const { return *medium_; }

private:
    void startGrid();
    void enterBrick();
    void enterHeight();

    const MediumSource* medium_;
    dvec3 origin_, direction_, perUnit_; // local, and 1/direction; t keeps its meaning
    double begin_, end_, stop_;
    double minimum_ = 1, maximum_ = 1, mean_ = 1;
    bool done_ = false;
    ivec3 brick_{0};
    dvec3 crossing_{0};             // of the brick's far planes
    double height_ = 0, slope_ = 0; // Height: above the ground at t = 0, and per metre
};

class MediaField {
public:
    using Change = std::function<void(Medium&, dmat4& rayFromNode)>;
    /// No media.
    MediaField() = default;
    /// `origin`: the world's point that becomes the origin of ray space. `change`: is applied to each medium first.
    MediaField(const Scene& scene, const dvec3& origin, const Change& change = {});

    [[nodiscard]] bool empty() const { return media_.empty(); }
    [[nodiscard]] const std::vector<MediumSource>& media() const { return media_; }
    /// Extinction is the same in all channels of each medium: free flight need not distinguish channels.
    [[nodiscard]] bool grey() const { return grey_; }
    [[nodiscard]] bool scatters() const { return scatters_; }
    [[nodiscard]] bool emits() const { return emits_; }

private:
    std::vector<MediumSource> media_;
    bool grey_ = true, scatters_ = false, emits_ = false;
};

} // namespace tyndall::tracing
