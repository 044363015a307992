#pragma once
// The environment as directional lights: regions of about equal importance, one light a region. GL-free and in double.

#include <cstdint>
#include <string>
#include <vector>

#include "core/math.h"
#include "scene/scene.h"

namespace tyndall {

/// A piece of the sky as a directional light.
struct EnvironmentLight {
    dvec3 toLight{0};     // unit, world
    dvec3 illuminance{0}; // lux on a facing surface
};

/// Direction in the world of the point (u, v) of a latitude-longitude image, v = 0 at the top row's upper edge:
/// -Z at the centre, +X at u = 0.75, +Y at the top, then turned by `rotation` radians, right-handed about +Y.
dvec3 environmentDirection(double u, double v, double rotation);

/// Distribution of an environment's light over directions, made once for each version of the environment. The image counts
/// as constant within its pixels; one wider than 2048 pixels is averaged over pixels first (by solid angle).
class EnvironmentSampler {
public:
    EnvironmentSampler() = default;
    explicit EnvironmentSampler(const Environment& environment);

    /// No light at all: there is nothing to sample.
    [[nodiscard]] bool black() const { return !(total_ > 0); }
    /// ∫ L dω over the sphere, per channel: what the illuminances of lights() sum to.
    [[nodiscard]] const dvec3& fluence() const { return fluence_; }
    /// Pixels that were not finite or negative, and count as black.
    [[nodiscard]] uint64_t brokenPixels() const { return brokenPixels_; }

    /// At most `count` lights (fewer where the image has fewer lit pixels): each region's light from its mean direction.
    /// The illuminances sum to fluence() in every channel.
    [[nodiscard]] std::vector<EnvironmentLight> lights(int count) const;
    /// As many lights for frame `frame` of a sequence: each region's light from one direction in it, drawn in proportion to
    /// importance and weighted by 1/probability. The mean over frames of any sum over the lights tends to the integral over
    /// the environment (frames step through a low-discrepancy sequence; `seed` shifts it).
    [[nodiscard]] std::vector<EnvironmentLight> sample(int count, uint32_t frame,
                                                       uint32_t seed) const;

private:
    struct Region {
        int x0 = 0, y0 = 0, x1 = 0, y1 = 0; // pixels, half open
        double weight = 0;                  // importance inside
    };
    [[nodiscard]] double sum(int x0, int y0, int x1, int y1) const;
    [[nodiscard]] double extent(const Region& region) const;
    [[nodiscard]] bool split(const Region& region, Region& low, Region& high) const;
    [[nodiscard]] const std::vector<Region>& regions(int count) const;
    [[nodiscard]] EnvironmentLight meanLight(const Region& region) const;
    [[nodiscard]] EnvironmentLight sampleLight(const Region& region, double u, double v) const;
    [[nodiscard]] double rowSolidAngle(int y) const;
    void buildFromImage(const Image& image, double intensity);
    void buildTable();

    int width_ = 0, height_ = 0;
    double rotation_ = 0;
    std::vector<vec3> radiance_; // nits, top row first
    std::vector<double>
        table_; // sums of importance over [0,x)×[0,y); importance = mean of the channels × solid angle
    double total_ = 0;
    dvec3 fluence_{0};
    uint64_t brokenPixels_ = 0;
    mutable int regionCount_ = -1; // that regions_ was made for
    mutable std::vector<Region> regions_;
};

} // namespace tyndall
