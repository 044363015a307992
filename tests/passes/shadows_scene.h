#pragma once
// A box over a floor, and which points of the floor it shades.

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "passes/lights_fixture.h"

namespace tyndall::test {

inline constexpr dvec3 kUp{0, 1, 0};

/// True where the segment from `a` to `b` meets the box: the slab test.
inline bool hits(const dvec3& a, const dvec3& b, const dvec3& centre, const dvec3& half) {
    double enter = 0, leave = 1;
    for (int i = 0; i < 3; ++i) {
        const double d = b[i] - a[i];
        double t0 = (centre[i] - half[i] - a[i]) / d, t1 = (centre[i] + half[i] - a[i]) / d;
        if (d == 0) {
            if (std::abs(a[i] - centre[i]) > half[i]) return false;
            continue;
        }
        if (t0 > t1) std::swap(t0, t1);
        enter = std::max(enter, t0);
        leave = std::min(leave, t1);
    }
    return enter <= leave;
}

/// A box of 2 × 1 × 2 m hovering over a floor of 16 × 16 m, and a grid of probes on the floor, all times `scale`.
struct BoxOverFloor {
    static constexpr int kGrid = 40;
    SceneMaker maker;
    std::vector<Probe> probes;
    dvec3 centre, half;
    double scale;
    explicit BoxOverFloor(double s = 1)
        : centre(dvec3(0.3, 2, -0.2) * s), half(dvec3(1, 0.5, 1) * s), scale(s) {
        maker.primitive(PrimitiveShape::Plane, dvec3(16, 1, 16) * s, {0, 0, 0});
        maker.primitive(PrimitiveShape::Box, dvec3(2, 1, 2) * s, centre);
        for (int y = 0; y < kGrid; ++y)
            for (int x = 0; x < kGrid; ++x)
                probes.push_back(
                    {dvec3((x + 0.5) / kGrid - 0.5, 0, (y + 0.5) / kGrid - 0.5) * 12.0 * s, kUp});
    }
    [[nodiscard]] ProbeOptions options() const {
        ProbeOptions o;
        o.eye = dvec3(0, 4, 12) * scale;
        o.sceneRadius = 12 * scale;
        return o;
    }
    /// 1 where the way to the light is free by `slack` metres, 0 where it is blocked by that much, -1 between.
    [[nodiscard]] int truth(const dvec3& p, const dvec3& light, double slack) const {
        if (hits(p, light, centre, half - slack)) return 0;
        return hits(p, light, centre, half + slack) ? -1 : 1;
    }
};

} // namespace tyndall::test
