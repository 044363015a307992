#include "tracing/glow_source.h"

#include <algorithm>
#include <cmath>

namespace tyndall::tracing {
namespace {

constexpr int kCells = kBrickCells * kBrickCells * kBrickCells;

ivec3 cellInBrick(int i) {
    return {i % kBrickCells, i / kBrickCells % kBrickCells, i / (kBrickCells * kBrickCells)};
}

} // namespace

GlowSource::GlowSource(const std::vector<MediumSource>& media) : media_(media) {
    for (const MediumSource& medium : media) {
        if (!medium.emits() || medium.endless()) continue;
        Part part;
        part.medium = &medium;
        part.rayFromLocal = glm::inverse(medium.localFromRay_);
        part.cellVolume = std::abs(glm::determinant(dmat3(part.rayFromLocal)));
        Bounds local{dvec3(-1), dvec3(1)};
        if (medium.isGrid()) {
            addGrid(part);
            local = medium.grid_->indexBounds();
        } else {
            part.cellVolume *= 8; // the cube from -1 to 1
            part.power = meanOf(medium.emission) * part.cellVolume;
        }
        if (!(part.power > 0) || !std::isfinite(part.power)) continue;
        bounds_.include(local.transformed(part.rayFromLocal));
        pointsPerMetre_ = std::max(parts_.empty() ? 0 : pointsPerMetre_, medium.emissionMajorant());
        parts_.push_back(std::move(part));
    }
    for (uint32_t p = 0; p < parts_.size(); ++p) {
        const Part& part = parts_[p];
        for (uint32_t b = 0; b < std::max<size_t>(part.bricks.size(), 1); ++b) {
            double power = part.bricks.empty() ? part.power : 0;
            if (!part.bricks.empty())
                for (int i = 0; i < kCells; ++i)
                    power += double(part.powers[size_t(b) * kCells + size_t(i)]);
            sums_.push_back(sums_.back() + power);
            brickOf_.emplace_back(p, b);
        }
    }
    power_ = sums_.back();
}

void GlowSource::addGrid(Part& part) {
    const MediumSource& medium = *part.medium;
    const BrickGrid& grid = *medium.grid_;
    const ivec3 count = grid.brickCount;
    part.placeOf.assign(grid.bricks.size(), -1);
    float powers[kCells];
    for (int n = 0; n < int(grid.bricks.size()); ++n) {
        const ivec3 brick(n % count.x, n / count.x % count.y, n / (count.x * count.y));
        if (!(grid.brick(brick).maximum > 0)) continue;
        double sum = 0;
        for (int i = 0; i < kCells; ++i) {
            // Two points along each edge: a field that is not 0 in the cell is not 0 at all eight.
            double mean = 0;
            for (int corner = 0; corner < 8; ++corner) {
                const dvec3 inCell = 0.25 + 0.5 * dvec3(corner & 1, (corner >> 1) & 1, corner >> 2);
                const dvec3 index =
                    dvec3(grid.origin + kBrickCells * brick + cellInBrick(i)) + inCell;
                mean += 0.125 * meanOf(medium.emitted(dvec3(part.rayFromLocal * dvec4(index, 1)),
                                                      medium.gridDensity(index)));
            }
            powers[i] = float(mean * part.cellVolume);
            sum += double(powers[i]);
        }
        if (!(sum > 0) || !std::isfinite(sum)) continue;
        part.placeOf[size_t(n)] = int32_t(part.bricks.size());
        part.bricks.push_back(brick);
        part.powers.insert(part.powers.end(), std::begin(powers), std::end(powers));
        part.power += sum;
    }
}

dvec3 GlowSource::emission(const dvec3& position) const {
    dvec3 sum(0);
    for (const MediumSource& medium : media_) {
        if (!medium.emits()) continue;
        const double density = medium.density(position);
        if (density > 0) sum += medium.emitted(position, density);
    }
    return sum;
}

GlowSample GlowSource::sample(double u0, const dvec2& u) const {
    GlowSample result;
    if (black()) return result;
    double left = u0 * power_;
    const size_t at = size_t(std::upper_bound(sums_.begin(), sums_.end(), left) - sums_.begin());
    const size_t n = std::clamp<size_t>(at, 1, brickOf_.size()) - 1;
    left -= sums_[n];
    const Part& part = parts_[brickOf_[n].first];
    dvec3 local;
    if (part.bricks.empty()) {
        local = 2.0 * dvec3(left / (sums_[n + 1] - sums_[n]), u.x, u.y) - 1.0;
    } else {
        const float* powers = &part.powers[size_t(brickOf_[n].second) * kCells];
        int chosen = 0;
        for (int i = 0; i < kCells; ++i) {
            if (!(powers[i] > 0)) continue;
            chosen = i; // the last that glows, in case of rounding
            if (left < double(powers[i])) break;
            left -= double(powers[i]);
        }
        const double rest = std::clamp(left / double(powers[chosen]), 0.0, 1.0);
        local = dvec3(part.medium->grid_->origin + kBrickCells * part.bricks[brickOf_[n].second] +
                      cellInBrick(chosen)) +
                dvec3(rest, u.x, u.y);
    }
    result.position = dvec3(part.rayFromLocal * dvec4(local, 1));
    result.emission = emission(result.position);
    result.density = density(result.position);
    return result;
}

double GlowSource::density(const dvec3& position) const {
    double sum = 0;
    for (const Part& part : parts_) {
        const dvec3 p = part.medium->localPoint(position);
        if (part.bricks.empty()) {
            if (maximumOf(glm::abs(p)) <= 1) sum += part.power / part.cellVolume;
            continue;
        }
        const BrickGrid& grid = *part.medium->grid_;
        const dvec3 cells = p - dvec3(grid.origin);
        const ivec3 most = grid.brickCount * kBrickCells;
        if (!(cells.x >= 0 && cells.y >= 0 && cells.z >= 0 && cells.x < double(most.x) &&
              cells.y < double(most.y) && cells.z < double(most.z)))
            continue;
        const ivec3 cell(cells), brick = cell / kBrickCells, in = cell % kBrickCells;
        const int32_t place = part.placeOf[size_t(
            (brick.z * grid.brickCount.y + brick.y) * grid.brickCount.x + brick.x)];
        if (place < 0) continue;
        sum += double(part.powers[size_t(place) * kCells +
                                  size_t((in.z * kBrickCells + in.y) * kBrickCells + in.x)]) /
               part.cellVolume;
    }
    return sum / power_;
}

} // namespace tyndall::tracing
