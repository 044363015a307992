#include "volumetric_gi/vpl/vpl_points.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/low_discrepancy.h"
#include "shared/traced.h"
#include "tracing/sampler.h"

namespace tyndall::volumetric_gi {
namespace {

/// Radius of a point over that of a disc of the area that it represents: discs overlap, so that few gaps remain.
constexpr double kOverlap = 1.75;
/// Pieces of triangles are no wider than this part of their distance from the lights, so that one weight holds for all of a piece.
constexpr double kPiece = 0.5;
/// Halvings of a triangle: a landscape of 1000 km around lights of a metre takes 40.
constexpr int kMostHalvings = 48;

using Corners = std::array<dvec3, 3>;

struct Piece {
    Corners corners;
    uint32_t triangle;
};

/// Where lights are.
struct Around {
    dvec3 middle{0};
    double squared = 0; // m², mean square of their distance from the middle
};

Around aroundLights(std::span<const dvec3> lights, double leastDistance) {
    Around around;
    for (const dvec3& light : lights) around.middle += light / double(lights.size());
    for (const dvec3& light : lights)
        around.squared += glm::dot(light - around.middle, light - around.middle);
    around.squared = std::max(around.squared / std::max(double(lights.size()), 1.0),
                              leastDistance * leastDistance);
    return around;
}

/// m², of which a point's density is the inverse.
double spacing(const Around& around, const dvec3& position) {
    return glm::dot(position - around.middle, position - around.middle) + around.squared;
}

dvec3 middleOf(const Corners& c) { return (c[0] + c[1] + c[2]) / 3.0; }

double weightOf(const Around& around, const Corners& c) {
    return 0.5 * glm::length(glm::cross(c[1] - c[0], c[2] - c[0])) / spacing(around, middleOf(c));
}

void addPieces(std::vector<Piece>& pieces, const Around& around, const Piece& piece, int halvings) {
    const Corners& c = piece.corners;
    int longest = 0;
    double length = 0;
    for (int i = 0; i < 3; ++i)
        if (const double l = glm::distance(c[size_t(i)], c[size_t(i + 1) % 3]); l > length) {
            length = l;
            longest = i;
        }
    if (halvings == 0 || length * length <= kPiece * kPiece * spacing(around, middleOf(c))) {
        pieces.push_back(piece);
        return;
    }
    const dvec3 a = c[size_t(longest)], b = c[size_t(longest + 1) % 3],
                apex = c[size_t(longest + 2) % 3];
    const dvec3 half = 0.5 * (a + b);
    addPieces(pieces, around, {{a, half, apex}, piece.triangle}, halvings - 1);
    addPieces(pieces, around, {{half, b, apex}, piece.triangle}, halvings - 1);
}

/// `chance`, `u`, `v`: in [0,1).
bool covered(const tracing::SurfaceScene& surfaces, uint32_t triangle, const dvec3& at,
             const tracing::SceneTriangle& whole, double chance) {
    if (whole.opaque()) return true;
    const uint32_t instance = surfaces.instanceOf(triangle);
    const dvec3 a = whole.corners[1] - whole.corners[0], b = whole.corners[2] - whole.corners[0];
    const dvec3 normal = glm::cross(a, b), off = at - whole.corners[0];
    const double squared = glm::dot(normal, normal);
    if (!(squared > 0)) return false;
    const double u = glm::dot(glm::cross(off, b), normal) / squared;
    const double v = glm::dot(glm::cross(a, off), normal) / squared;
    return chance < surfaces.coverageAt(
                        instance, triangle - surfaces.instances()[instance].firstTriangle, u, v);
}

} // namespace

SurfacePoints makeSurfacePoints(const tracing::SurfaceScene& surfaces,
                                std::span<const dvec3> lights, uint32_t setSize, uint32_t setCount,
                                uint64_t seed) {
    SurfacePoints made;
    if (lights.empty() || surfaces.triangleCount() == 0) return made;
    const Around around = aroundLights(lights, 1e-3 * glm::length(surfaces.bounds().extent()));
    const std::vector<tracing::SceneTriangle> triangles = surfaces.triangles();
    std::vector<Piece> pieces;
    for (uint32_t i = 0; i < triangles.size(); ++i)
        addPieces(pieces, around, {triangles[i].corners, i}, kMostHalvings);
    std::vector<double> ends(pieces.size()); // of each piece's share of the weight
    double whole = 0;
    for (size_t i = 0; i < pieces.size(); ++i)
        ends[i] = whole += weightOf(around, pieces[i].corners);
    if (!(whole > 0) || !std::isfinite(whole)) return made;
    made.points.reserve(size_t(setSize) * setCount);
    for (uint32_t set = 0; set < setCount; ++set)
        for (uint32_t i = 0; i < setSize; ++i) {
            const uint64_t sequence = tracing::mixBits(seed * setCount + set);
            const dvec2 place = lowDiscrepancyPoint(i, sequence);
            const double share = place.x * whole;
            const auto k =
                std::min(size_t(std::upper_bound(ends.begin(), ends.end(), share) - ends.begin()),
                         pieces.size() - 1);
            const double start = k == 0 ? 0 : ends[k - 1];
            // What is left of the number that chose the piece is a number within it.
            const double u = std::sqrt(std::clamp((share - start) / (ends[k] - start), 0.0, 1.0));
            const Corners& c = pieces[k].corners;
            const dvec3 at = (1 - u) * c[0] + u * ((1 - place.y) * c[1] + place.y * c[2]);
            const uint32_t triangle = pieces[k].triangle;
            const double chance = lowDiscrepancyPoint(i, ~sequence).x;
            // Sets are equally long: a point that covers nothing stands for itself, on no triangle.
            const bool counts = covered(surfaces, triangle, at, triangles[triangle], chance);
            made.points.push_back({vec3(at), counts ? triangle : gpu::kNoTriangle});
        }
    made.params = {vec4(vec3(around.middle), float(around.squared)),
                   float(kOverlap * std::sqrt(whole / (kPi * setSize))), setSize, setCount, 0};
    return made;
}

} // namespace tyndall::volumetric_gi
