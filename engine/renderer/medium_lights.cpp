#include "renderer/medium_lights.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/check.h"
#include "core/low_discrepancy.h"
#include "framegraph/hash.h"

namespace tyndall {
namespace {

constexpr double kNearPart =
    0.3; // of a part's radius: wide enough against fireflies, near enough that little stands in between
constexpr double kLeastEighth =
    0.02; // chance of an eighth of a cell that hardly glows, over that of the cell
constexpr int kShapeBricks = 2; // a side of the box around a homogeneous shape: 16³ cells

bool glows(const Medium& medium) {
    return medium.emission != vec3(0) || (medium.temperature && medium.temperatureScale > 0);
}

double meanOf(const dvec3& v) { return (v.x + v.y + v.z) / 3; }

constexpr int kCells = kBrickCells * kBrickCells * kBrickCells;

/// Cell `i` of a brick, along Morton's curve: every third bit of `i` is one of a coordinate's.
ivec3 cellOf(const ivec3& brick, int i) {
    ivec3 cell(0);
    for (int bit = 0; bit < 3; ++bit)
        for (int axis = 0; axis < 3; ++axis) cell[axis] |= ((i >> (3 * bit + axis)) & 1) << bit;
    return kBrickCells * brick + cell;
}

/// Points 1/4 and 3/4 along each edge: a trilinear field that is not 0 in the cell is not 0 at one of them.
dvec3 innerPoint(int i) { return dvec3(i & 1, (i >> 1) & 1, i >> 2) * 0.5 + 0.25; }

/// Maps `u` in the unit cube to a point of it: half by half along each axis, so that eighth e (innerPoint's order) is met with the
/// probability `chance`, in proportion to `weights[e]` but for a least part; evenly within it.
dvec3 chooseEighth(const double (&weights)[8], dvec3 u, double& chance) {
    double sum = 0, left[8];
    for (const double weight : weights) sum += weight;
    for (int e = 0; e < 8; ++e) left[e] = sum > 0 ? weights[e] + kLeastEighth * sum : 1;
    chance = 1;
    for (int axis = 0; axis < 3; ++axis) {
        double halves[2] = {};
        for (int e = 0; e < 8; ++e) halves[(e >> axis) & 1] += left[e];
        const double lower = halves[0] / (halves[0] + halves[1]);
        const int upper = u[axis] < lower ? 0 : 1;
        chance *= upper ? 1 - lower : lower;
        u[axis] = 0.5 * upper + 0.5 * (upper ? (u[axis] - lower) / (1 - lower) : u[axis] / lower);
        for (int e = 0; e < 8; ++e)
            if (((e >> axis) & 1) != upper) left[e] = 0;
    }
    return u;
}

} // namespace

MediumEmitter::MediumEmitter(const Medium& medium, const dmat4& worldFromNode, int parts)
    : medium_(medium) {
    ivec3 count(kShapeBricks);
    if (medium.kind == MediumKind::Grid) {
        const BrickGrid& grid = *medium.density;
        count = grid.brickCount;
        densityFromCell_ = glm::translate(dmat4(1.0), dvec3(grid.origin));
        worldFromCell_ = worldFromNode * grid.worldFromIndex * densityFromCell_;
        if (medium.temperature && medium.temperatureScale > 0) {
            blackbody_ = makeBlackbodyTable();
            temperatureFromCell_ = glm::inverse(medium.temperature->worldFromIndex) *
                                   grid.worldFromIndex * densityFromCell_;
        }
    } else {
        worldFromCell_ =
            glm::scale(worldFromNode, medium.size / double(kShapeBricks * kBrickCells));
        worldFromCell_ = glm::translate(worldFromCell_, dvec3(-0.5 * kShapeBricks * kBrickCells));
    }
    edges_ = {distance({1, 0, 0}), distance({0, 1, 0}), distance({0, 0, 1})};
    cellVolume_ = std::abs(glm::determinant(dmat3(worldFromCell_)));
    if (!(cellVolume_ > 0) || !std::isfinite(cellVolume_)) return;
    for (ivec3 b(0); b.z < count.z; ++b.z)
        for (b.y = 0; b.y < count.y; ++b.y)
            for (b.x = 0; b.x < count.x; ++b.x) {
                if (medium.kind == MediumKind::Grid && !(medium.density->brick(b).maximum > 0))
                    continue;
                const Brick brick = measure(b);
                if (brick.power > 0 && std::isfinite(brick.power)) bricks_.push_back(brick);
            }
    splitInto(parts);
}

dvec3 MediumEmitter::emission(const dvec3& cell) const {
    if (medium_.kind == MediumKind::Box) return medium_.emission;
    if (medium_.kind == MediumKind::Sphere) {
        const dvec3 p = cell / (0.5 * kShapeBricks * kBrickCells) - 1.0;
        return glm::dot(p, p) < 1 ? dvec3(medium_.emission) : dvec3(0);
    }
    const double density = medium_.density->sample(dvec3(densityFromCell_ * dvec4(cell, 1)));
    if (!(density > 0)) return dvec3(0);
    dvec3 sum(medium_.emission);
    if (!blackbody_.entries.empty()) {
        const double kelvin =
            medium_.temperature->sample(dvec3(temperatureFromCell_ * dvec4(cell, 1)));
        if (kelvin >= BlackbodyTable::kCoolest)
            sum += double(medium_.temperatureScale) * blackbody_.radiance(kelvin);
    }
    return density * sum;
}

/// Mean over the cell. In a grid by Simpson's rule along each axis: where the temperature falls to nothing within a cell, as at a
/// flame's foot, all of its light comes from one face, of which inner points know nothing.
dvec3 MediumEmitter::cellEmission(const ivec3& cell) const {
    dvec3 sum(0);
    if (medium_.kind != MediumKind::Grid) {
        for (int i = 0; i < 8; ++i) sum += emission(dvec3(cell) + innerPoint(i));
        return sum / 8.0;
    }
    constexpr double kSimpson[3] = {1.0 / 6, 4.0 / 6, 1.0 / 6};
    for (int z = 0; z < 3; ++z)
        for (int y = 0; y < 3; ++y)
            for (int x = 0; x < 3; ++x)
                sum += kSimpson[x] * kSimpson[y] * kSimpson[z] *
                       emission(dvec3(cell) + 0.5 * dvec3(x, y, z));
    return sum;
}

double MediumEmitter::distance(const dvec3& cells) const {
    return glm::length(dmat3(worldFromCell_) * cells);
}

MediumEmitter::Brick MediumEmitter::measure(const ivec3& index) {
    Brick brick;
    brick.index = index;
    float powers[kCells];
    for (int i = 0; i < kCells; ++i) {
        const ivec3 cell = cellOf(index, i);
        const dvec3 light = cellEmission(cell) * cellVolume_;
        powers[i] = float(meanOf(light));
        brick.intensity += light;
        brick.power += double(powers[i]);
        brick.middle += double(powers[i]) * (dvec3(cell) + 0.5);
    }
    if (!(brick.power > 0) || !std::isfinite(brick.power)) return brick;
    brick.middle /= brick.power;
    brick.spread = glm::dot(edges_, edges_) / 12; // within a cell
    for (int i = 0; i < kCells; ++i) {
        if (!(powers[i] > 0)) continue;
        const double d = distance(dvec3(cellOf(index, i)) + 0.5 - brick.middle);
        brick.spread += double(powers[i]) / brick.power * d * d;
    }
    brick.cells = powers_.size();
    powers_.insert(powers_.end(), std::begin(powers), std::end(powers));
    return brick;
}

/// Sorts bricks [first, last) along the longest side of their glow; returns where the second half of their power begins.
size_t MediumEmitter::halve(size_t first, size_t last) {
    Bounds extent;
    double power = 0;
    for (size_t i = first; i < last; ++i) {
        extent.include(bricks_[i].middle);
        power += bricks_[i].power;
    }
    const dvec3 sides = extent.extent() * edges_;
    const int axis = sides.x >= sides.y && sides.x >= sides.z ? 0 : (sides.y >= sides.z ? 1 : 2);
    std::stable_sort(
        bricks_.begin() + ptrdiff_t(first), bricks_.begin() + ptrdiff_t(last),
        [&](const Brick& a, const Brick& b) { return a.middle[axis] < b.middle[axis]; });
    double below = bricks_[first].power;
    size_t middle = first + 1;
    while (middle + 1 < last && below + bricks_[middle].power <= 0.5 * power)
        below += bricks_[middle++].power;
    return middle;
}

/// Neighbours in space become neighbours in order, so that evenly spread numbers become evenly spread points.
void MediumEmitter::orderBricks(size_t first, size_t last) {
    if (last - first < 2) return;
    const size_t middle = halve(first, last);
    orderBricks(first, middle);
    orderBricks(middle, last);
}

/// Halves the strongest part until there are enough. Bricks are not divided.
void MediumEmitter::splitInto(int parts) {
    if (bricks_.empty() || parts < 1) return;
    const auto partOf = [&](size_t first, size_t last) {
        Part part{first, last, 0};
        for (size_t i = first; i < last; ++i) part.power += bricks_[i].power;
        return part;
    };
    const auto divisible = [](const Part& part) {
        return part.last - part.first > 1 ? part.power : 0;
    };
    parts_ = {partOf(0, bricks_.size())};
    while (int(parts_.size()) < parts) {
        const auto strongest =
            std::max_element(parts_.begin(), parts_.end(), [&](const Part& a, const Part& b) {
                return divisible(a) < divisible(b);
            });
        const Part whole = *strongest;
        if (whole.last - whole.first < 2) break;
        const size_t middle = halve(whole.first, whole.last);
        *strongest = partOf(whole.first, middle);
        parts_.push_back(partOf(middle, whole.last));
    }
    for (const Part& part : parts_) orderBricks(part.first, part.last);
}

dvec3 MediumEmitter::intensity() const {
    dvec3 sum(0);
    for (const Brick& brick : bricks_) sum += brick.intensity;
    return sum;
}

std::vector<MediumLight> MediumEmitter::lights() const {
    std::vector<MediumLight> result;
    for (const Part& part : parts_) {
        MediumLight light;
        dvec3 middle(0);
        double spread = 0;
        for (size_t i = part.first; i < part.last; ++i) {
            light.intensity += bricks_[i].intensity;
            middle += bricks_[i].power / part.power * bricks_[i].middle;
        }
        for (size_t i = part.first; i < part.last; ++i) {
            const double d = distance(bricks_[i].middle - middle);
            spread += bricks_[i].power / part.power * (d * d + bricks_[i].spread);
        }
        light.position = dvec3(worldFromCell_ * dvec4(middle, 1));
        // The ball whose even glow is spread as far: a ball's mean square distance from its centre is 3/5 R².
        light.radius = std::sqrt(spread * 5.0 / 3.0);
        result.push_back(light);
    }
    return result;
}

/// Candela that a point of the part stands for. `u` chooses brick and cell, both in proportion to their power; `inCell` the point.
dvec3 MediumEmitter::emittedFrom(const Part& part, double u, const dvec3& inCell,
                                 dvec3& cell) const {
    double left = u * part.power;
    size_t i = part.first;
    while (i + 1 < part.last && left >= bricks_[i].power) left -= bricks_[i++].power;
    const Brick& brick = bricks_[i];
    const float* powers = &powers_[brick.cells];
    int chosen = -1;
    for (int c = 0; c < kCells; ++c) {
        if (!(powers[c] > 0)) continue;
        chosen = c; // the last that glows, should rounding leave some
        if (left < double(powers[c])) break;
        left -= double(powers[c]);
    }
    if (chosen < 0) return dvec3(0);
    const dvec3 corner(cellOf(brick.index, chosen));
    // A flame grows tenfold within a cell: its eighths are drawn by what their middles emit, and never without a chance.
    // Shapes end abruptly, and one point of an eighth says nothing of the rest: all alike.
    double chances[8];
    for (int e = 0; e < 8; ++e)
        chances[e] =
            medium_.kind == MediumKind::Grid ? meanOf(emission(corner + innerPoint(e))) : 1;
    double chance = 0;
    cell = corner + chooseEighth(chances, inCell, chance);
    return emission(cell) * (cellVolume_ / 8 * part.power / (double(powers[chosen]) * chance));
}

std::vector<MediumLight> MediumEmitter::sample(uint32_t frame, uint64_t key) const {
    std::vector<MediumLight> result;
    for (size_t i = 0; i < parts_.size(); ++i) {
        const dvec2 a = lowDiscrepancyPoint(frame, fg::mixHash(key, 2 * i));
        const dvec2 b = lowDiscrepancyPoint(frame, fg::mixHash(key, 2 * i + 1));
        MediumLight light;
        dvec3 cell(0);
        light.intensity = emittedFrom(parts_[i], a.x, dvec3(a.y, b), cell);
        light.position = dvec3(worldFromCell_ * dvec4(cell, 1));
        result.push_back(light);
    }
    return result;
}

double MediumEmitter::nearDistance() const {
    double sum = 0;
    for (const MediumLight& light : lights()) sum += light.radius;
    return parts_.empty() ? 0 : kNearPart * sum / double(parts_.size());
}

MediumEmitters findMediumEmitters(const Scene& scene, const std::vector<dmat4>& world,
                                  const std::vector<bool>& visible, int parts) {
    MediumEmitters result;
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        const Node& node = scene.nodes[i];
        if (node.medium == kNone || !visible[i]) continue;
        const Medium& medium = scene.media[size_t(node.medium)];
        if (!glows(medium)) continue;
        const bool endless =
            medium.kind == MediumKind::Everywhere || medium.kind == MediumKind::Height;
        if (endless)
            result.notes.push_back(fmt::format(
                "medium '{}' glows and has no end: it is seen, but lights nothing", node.name));
        if (endless) continue;
        if (medium.kind == MediumKind::Grid && !medium.density) continue;
        result.emitters.emplace_back(medium, world[i], parts);
        result.nodes.push_back(int(i));
        if (const double near = result.emitters.back().nearDistance(); near > 0)
            result.nearDistance = std::min(result.nearDistance, near);
    }
    return result;
}

} // namespace tyndall
