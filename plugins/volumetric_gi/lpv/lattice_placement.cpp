#include "volumetric_gi/lpv/lattice_placement.h"

#include <algorithm>
#include <cmath>

#include "plugin/cache_key.h"
#include "volumetric_gi/lpv/lattice_params.h"

namespace tyndall::volumetric_gi {
namespace {

constexpr int kMostRatio = 4;
constexpr double kAhead = 0.3; // distance of a lattice's centre before the eye, over its side
/// In cells: a cell begins where the scene begins, so that walls there lie between cells; but for a thousandth, so that surfaces a whole number
/// of cells away do not lie on centres and edges of cells.
const dvec3 kMargin(1.001, 1.0013, 1.0017);

double longest(const Bounds& b) {
    const dvec3 extent = b.extent();
    return std::max({extent.x, extent.y, extent.z});
}

struct Span {
    double lowest = 0; // metres
    int cells = 0;
    bool whole = false; // all of the scene
};

Span placeAlong(const PlacementRequest& request, int axis, double cell,
                const LatticeLevel* coarser) {
    const double least = request.bounds.minimum[axis], length = request.bounds.extent()[axis];
    const int inner = request.resolution - 2;
    if (length <= cell * inner * 1.001)
        return {least - cell * kMargin[axis], int(std::ceil(length / cell - 0.01)) + 2, true};
    const double side = cell * inner, half = 0.5 * side;
    const double first = request.content.minimum[axis], last = request.content.maximum[axis];
    double centre = 0.5 * (first + last);
    if (last - first > side)
        centre = std::clamp(request.eye[axis] + kAhead * side * request.forward[axis], first + half,
                            last - half);
    centre = std::clamp(centre, least + half, least + length - half);
    // In whole cells of the coarser lattice, which itself is fixed or moves in whole cells.
    const double step = coarser ? double(coarser->params.grid.lowest.w) : cell;
    const double origin =
        coarser ? double(coarser->params.grid.lowest[axis]) : least - cell * kMargin[axis];
    const int steps = int(std::ceil((side + 2 * cell) / step - 0.01));
    double index = std::round((centre - origin) / step - 0.5 * steps);
    if (coarser)
        index =
            std::clamp(index, 0.0, double(std::max(coarser->params.grid.size[axis] - steps, 0)));
    return {origin + index * step, int(std::lround(steps * step / cell)), false};
}

LatticeLevel placeLevel(const PlacementRequest& request, double cell, const LatticeLevel* coarser) {
    dvec3 lowest(0);
    ivec3 size(0);
    int goesOn = 0, whole = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const Span span = placeAlong(request, axis, cell, coarser);
        lowest[axis] = span.lowest;
        size[axis] = span.cells;
        (span.whole ? whole : goesOn) |= 1 << axis;
    }
    LatticeLevel level;
    level.params = latticeParams(size, 0, vec3(lowest), float(cell));
    level.params.grid.place.z = goesOn;
    level.cells = uint64_t(size.x) * uint64_t(size.y) * uint64_t(size.z);
    level.key = cacheKey(level.params.grid.lowest, level.params.grid.size);
    return level;
}

} // namespace

Bounds LatticeLevel::box() const {
    const gpu::LpvGrid& grid = params.grid;
    Bounds b;
    b.include(dvec3(vec3(grid.lowest)));
    b.include(dvec3(vec3(grid.lowest)) + double(grid.lowest.w) * dvec3(ivec3(grid.size)));
    return b;
}

std::vector<LatticeLevel> placeLattices(const PlacementRequest& request) {
    const double all = std::max(longest(request.bounds), 1e-6);
    const double wanted = request.extent > 0 ? request.extent : longest(request.content);
    const double finest = std::clamp(wanted, 1e-6 * all, all);
    int ratio = 2;
    while (ratio < kMostRatio && finest * std::pow(ratio, request.most - 1) < 0.999 * all) ++ratio;
    int count = 1;
    while (count < request.most && finest * std::pow(ratio, count - 1) < 0.999 * all) ++count;
    std::vector<LatticeLevel> levels;
    for (int i = count - 1; i >= 0; --i) {
        const double cell = finest * std::pow(ratio, i) / (request.resolution - 2);
        LatticeLevel next = placeLevel(request, cell, levels.empty() ? nullptr : &levels.back());
        if (!levels.empty()) levels.back().covered = next.params.grid.place.z == 0;
        levels.push_back(next);
    }
    return levels;
}

SharedPlaces sharePlaces(std::vector<LatticeLevel>& levels) {
    SharedPlaces shared;
    for (size_t i = levels.size(); i-- > 0;) {
        LatticeLevel& level = levels[i];
        if (level.covered) continue;
        gpu::LpvGrid& grid = level.params.grid;
        grid.place.x = shared.layers;
        grid.place.y = int(shared.links);
        shared.layers += grid.size.z;
        shared.links += level.cells * gpu::kLpvLookupPlanes;
        shared.across = glm::max(shared.across, ivec2(grid.size));
        shared.levels.grids[shared.levels.count.x++] = grid;
    }
    return shared;
}

} // namespace tyndall::volumetric_gi
