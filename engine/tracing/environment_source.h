#pragma once
// Light from infinity: the environment's radiance, and directions drawn in proportion to it.

#include <vector>

#include "tracing/ray.h"
#include "scene/scene.h"

namespace tyndall::tracing {

struct DirectionSample {
    dvec3 direction{0};
    dvec3 radiance{0};  // nits
    double density = 0; // per steradian; 0: none
};

class EnvironmentSource {
public:
    explicit EnvironmentSource(const Environment& environment);

    [[nodiscard]] bool black() const { return black_; }
    /// The same radiance from all directions: then sampling surfaces and phase functions is best.
    [[nodiscard]] bool constant() const { return columns_ == 0; }
    /// Of light that travels against `direction`, bilinear between the image's pixels. Pixels that are not finite or
    /// negative count as 0.
    [[nodiscard]] dvec3 radiance(const dvec3& direction) const;
    /// Uniform over the sphere for a constant environment.
    [[nodiscard]] DirectionSample sample(const dvec2& u) const;
    [[nodiscard]] double density(const dvec3& direction) const;
    /// Mean luminance over all directions.
    [[nodiscard]] double meanLuminance() const { return meanLuminance_; }

private:
    [[nodiscard]] dvec3 texel(int column, int row) const;
    [[nodiscard]] dvec2 uvOf(const dvec3& direction) const;
    void makeTables();

    dvec3 constant_{0};
    bool black_ = true;
    double meanLuminance_ = 0;
    int columns_ = 0, rows_ = 0;
    std::vector<vec3> texels_;
    double cosine_ = 1, sine_ = 0;   // of the rotation
    std::vector<double> rowSums_;    // cumulative, rows_ + 1
    std::vector<double> columnSums_; // cumulative in each row, rows_ × (columns_ + 1)
};

} // namespace tyndall::tracing
