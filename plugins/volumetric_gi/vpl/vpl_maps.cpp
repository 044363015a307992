#include "volumetric_gi/vpl/vpl_maps.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <tbb/parallel_for.h>

#include "core/low_discrepancy.h"
#include "shared/traced.h"

namespace tyndall::volumetric_gi {
namespace {

/// As in shaders/common/octahedral.glsl.
dvec3 octahedralDecode(const dvec2& square) {
    dvec3 p(square, 1 - std::abs(square.x) - std::abs(square.y));
    if (p.z < 0) {
        const dvec2 folded =
            (1.0 - glm::abs(dvec2(p.y, p.x))) * dvec2(p.x >= 0 ? 1 : -1, p.y >= 0 ? 1 : -1);
        p.x = folded.x;
        p.y = folded.y;
    }
    return glm::normalize(p);
}

/// Directions so far below a light's facet are in no texel that a direction above it falls into.
double lowestCosine(uint32_t side) { return -8.0 / double(side); }

} // namespace

std::vector<uint32_t> makeVisibilityMaps(const tracing::SurfaceScene& surfaces, const VplSet& set,
                                         uint32_t side, uint32_t jitter) {
    const size_t texels = size_t(side) * side;
    const size_t stride = texels + 1;
    std::vector<uint32_t> maps(set.lights.size() * stride, gpu::kNoTriangle);
    std::vector<dvec3> directions(texels);
    for (uint32_t y = 0; y < side; ++y)
        for (uint32_t x = 0; x < side; ++x) {
            const dvec2 place =
                jitter == 0 ? dvec2(0.5) : lowDiscrepancyPoint(jitter, y * side + x);
            directions[size_t(y) * side + x] =
                octahedralDecode((dvec2(x, y) + place) * (2.0 / double(side)) - 1.0);
        }
    const double lowest = lowestCosine(side);
    tbb::parallel_for(tbb::blocked_range<size_t>(0, set.lights.size(), 1), [&](const auto& range) {
        for (size_t i = range.begin(); i < range.end(); ++i) {
            const gpu::VplData& light = set.lights[i];
            const bool onSurface = light.position.w < 0;
            const dvec3 normal(light.normal);
            const dvec3 origin = set.positions[i] + set.margins[i] * normal;
            double nearest = kInfinity;
            for (size_t k = 0; k < texels; ++k) {
                if (onSurface && glm::dot(normal, directions[k]) < lowest) continue;
                const tracing::RayHit hit =
                    surfaces.intersect({origin, directions[k]}, 0, kInfinity,
                                       tracing::RayKind::Path, tracing::mixBits(k));
                if (!hit.found()) continue;
                maps[i * stride + k] =
                    surfaces.instances()[hit.instance].firstTriangle + hit.triangle;
                nearest = std::min(nearest, hit.distance);
            }
            // Between two rays there may be a nearer surface, but not by much.
            maps[i * stride + texels] =
                std::bit_cast<uint32_t>(float(std::min(0.5 * nearest, 1e30)));
        }
    });
    return maps;
}

} // namespace tyndall::volumetric_gi
