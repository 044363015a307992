#include "volumetric_gi/surfels/surfel_patches.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "framegraph/hash.h"

namespace tyndall::volumetric_gi {
namespace {

constexpr uint32_t kMostLevel = gpu::kSurfelMostLevel;
constexpr double kFewest = 3; // points that a patch has at least
constexpr uint32_t kMostSurfelsOfSet = 65535; // Mesa's software drivers count a draw's points with 16 bits
constexpr uint32_t kMostPlanned = 8; // times as many surfels as there may be, before sizes grow
constexpr int kMostCuts = 40; // of one triangle after another; 2^-40 of its area is nothing

/// A patch while it is cut.
struct Piece {
    std::array<dvec3, 3> corners;
    std::array<dvec2, 3> places; // barycentric coordinates in the triangle, of its second and third corner
    double area = 0;
    uint64_t key = 0;
    int cuts = 0;
};

double areaOf(const std::array<dvec3, 3>& corners) {
    return 0.5 * glm::length(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
}

class Planner {
public:
    Planner(const SurfelSize& size, uint64_t most, SurfelPlan& plan)
        : size_(size), most_(most), plan_(plan) {}

    /// False where there are too many surfels.
    bool add(Piece piece, uint32_t triangle) {
        pieces_.assign(1, piece);
        while (!pieces_.empty()) {
            piece = pieces_.back();
            pieces_.pop_back();
            const dvec3 middle = (piece.corners[0] + piece.corners[1] + piece.corners[2]) / 3.0;
            const double size = size_.at(middle), wanted = piece.area / (size * size);
            if (piece.cuts < kMostCuts && mustCut(piece, middle, size, wanted)) {
                cut(piece);
                continue;
            }
            if (!put(piece, triangle, wanted)) return false;
        }
        return true;
    }

private:
    [[nodiscard]] bool mustCut(const Piece& piece, const dvec3& middle, double size,
                               double wanted) const {
        if (wanted <= kFewest) return false;
        if (levelFor(wanted) > kMostLevel) return true;
        double radius = 0, longest = 0;
        for (int i = 0; i < 3; ++i) {
            radius = std::max(radius, glm::distance(piece.corners[size_t(i)], middle));
            longest = std::max(longest, glm::distance(piece.corners[size_t(i)],
                                                      piece.corners[size_t(i + 1) % 3]));
        }
        // Points of a thin patch are far apart along it and crowded across.
        if (longest > 3 * size * double(levelFor(wanted) + 1)) return true;
        // Sizes differ by a factor of more than two where the piece is large beside its distance.
        for (const dvec3& corner : piece.corners)
            if (size > 2 * size_.at(corner) || size_.at(corner) > 2 * size) return true;
        return false;
    }

    /// The level whose number of points, about 3/4 (n + 1)², is nearest.
    static uint32_t levelFor(double wanted) {
        return uint32_t(std::clamp(std::round(std::sqrt(wanted * 4 / 3)) - 1, 1.0, 1e6));
    }

    void cut(const Piece& piece) {
        int from = 0;
        double longest = -1;
        for (int i = 0; i < 3; ++i) {
            const double length =
                glm::distance(piece.corners[size_t(i)], piece.corners[size_t(i + 1) % 3]);
            if (length > longest) {
                longest = length;
                from = i;
            }
        }
        const auto a = size_t(from), b = size_t(from + 1) % 3;
        for (const size_t replaced : {b, a}) {
            Piece half = piece;
            half.corners[replaced] = 0.5 * (piece.corners[a] + piece.corners[b]);
            half.places[replaced] = 0.5 * (piece.places[a] + piece.places[b]);
            half.area = 0.5 * piece.area;
            half.key = fg::mixHash(piece.key, replaced == b ? 0 : 1);
            ++half.cuts;
            pieces_.push_back(half);
        }
    }

    bool put(const Piece& piece, uint32_t triangle, double wanted) {
        const double chance = std::min(wanted / kFewest, 1.0);
        if (double(piece.key >> 11) * 0x1p-53 >= chance) return true;
        gpu::SurfelPatch patch{};
        patch.corners = vec4(vec2(piece.places[0]), vec2(piece.places[1]));
        patch.lastCorner = vec2(piece.places[2]);
        patch.triangle = triangle;
        patch.level = std::min(levelFor(wanted), kMostLevel);
        patch.area = float(piece.area / chance);
        patch.firstSurfel = plan_.surfels;
        plan_.surfels += surfelsOfLevel(patch.level);
        plan_.patches.push_back(patch);
        return plan_.surfels <= most_;
    }

    const SurfelSize& size_;
    uint64_t most_;
    SurfelPlan& plan_;
    std::vector<Piece> pieces_;
};

/// False where there are too many surfels.
bool tryPlan(std::span<const SurfelTriangles> objects, const SurfelSize& size, uint64_t most,
             uint64_t seed, SurfelPlan& plan) {
    Planner planner(size, most, plan);
    for (const SurfelTriangles& object : objects) {
        const uint64_t key = fg::mixHash(fg::mixHash(fg::kHashStart, seed), object.set);
        const auto first = uint32_t(plan.patches.size());
        for (uint32_t triangle = 0; triangle < object.corners.size() / 3; ++triangle) {
            Piece piece;
            for (size_t i = 0; i < 3; ++i) piece.corners[i] = object.corners[3 * triangle + i];
            piece.places = {dvec2(0, 0), dvec2(1, 0), dvec2(0, 1)};
            piece.area = areaOf(piece.corners);
            if (!(piece.area > 0) || !std::isfinite(piece.area)) {
                ++plan.degenerate;
                continue;
            }
            piece.key = fg::mixHash(key, triangle);
            if (!planner.add(piece, triangle)) return false;
        }
        addSets(plan, object.set, first);
    }
    return true;
}

} // namespace

double SurfelSize::at(const dvec3& position) const {
    double size = std::max(perDistance * glm::distance(position, eye), least);
    if (!media.empty()) {
        const dvec3 off = glm::max(glm::max(media.minimum - position, position - media.maximum), 0.0);
        size = std::max(size, perMediumDistance * glm::length(off));
    }
    return scale * size;
}

uint32_t surfelsOfLevel(uint32_t level) {
    return level % 2 == 1 ? 3 * ((level + 1) / 2) * ((level + 1) / 2)
                          : 3 * (level / 2) * (level / 2 + 1) + 1;
}

void addSets(SurfelPlan& plan, uint32_t set, uint32_t first) {
    SurfelPlan::Set part{set, first, 0, 0, 0};
    for (uint32_t i = first; i < plan.patches.size(); ++i) {
        const gpu::SurfelPatch& patch = plan.patches[i];
        const uint32_t surfels = surfelsOfLevel(patch.level);
        if (part.surfels + surfels > kMostSurfelsOfSet) {
            plan.sets.push_back(part);
            part = {set, i, 0, 0, 0};
        }
        if (part.patches == 0) part.firstSurfel = patch.firstSurfel;
        ++part.patches;
        part.surfels += surfels;
    }
    if (part.patches > 0) plan.sets.push_back(part);
}

SurfelPlan planSurfels(std::span<const SurfelTriangles> objects, SurfelSize size, uint32_t most,
                       uint64_t seed) {
    const double first = size.scale;
    for (;;) {
        SurfelPlan plan;
        plan.scale = size.scale / first;
        const bool whole = tryPlan(objects, size, uint64_t(kMostPlanned) * most, seed, plan);
        if (whole && plan.surfels <= most) return plan;
        if (!std::isfinite(size.scale)) return {}; // sizes are 0 everywhere
        // Numbers go with the inverse square of sizes: as far as that says, but not farther.
        const double growth = std::sqrt(double(plan.surfels) / most);
        size.scale *= std::pow(2, 0.25 * std::max(std::floor(4 * std::log2(growth)), 1.0));
    }
}

} // namespace tyndall::volumetric_gi
