#include "tracing/media_field.h"

#include <algorithm>
#include <cmath>

#include "core/phase_function.h"
#include "media/blackbody.h"

namespace tyndall::tracing {
namespace {

/// Tentative collisions of a ray through the middle of a glowing medium, however thin it is.
constexpr double kEmissionCollisions = 8;

dmat4 inverseOf(const dmat4& m) {
    // The affine inverse; a transform that flattens space leaves no medium.
    return glm::determinant(dmat3(m)) != 0 ? glm::inverse(m) : dmat4(0.0);
}

/// Planck's law summed over wavelengths is slow; between entries this close it is straight to 10⁻⁷.
const BlackbodyTable& blackbody() {
    static const BlackbodyTable table = makeBlackbodyTable(16384);
    return table;
}

bool usable(const Medium& medium, const dmat4& rayFromNode) {
    if (medium.extinction() == vec3(0) && medium.emission == vec3(0) &&
        !(medium.temperatureScale > 0))
        return false;
    if (medium.kind == MediumKind::Grid && (!medium.density || medium.density->bricks.empty()))
        return false;
    return medium.kind == MediumKind::Everywhere || glm::determinant(dmat3(rayFromNode)) != 0;
}

} // namespace

MediumSource::MediumSource(const Medium& medium, const dmat4& rayFromNode)
    : scattering(medium.scattering),
      extinction(dvec3(medium.scattering) + dvec3(medium.absorption)), emission(medium.emission),
      anisotropy(double(medium.anisotropy)), phase(medium.phase), kind_(medium.kind),
      scaleHeight_(medium.scaleHeight) {
    double extent = 0; // metres through the middle
    if (kind_ == MediumKind::Box || kind_ == MediumKind::Sphere) {
        dmat4 scaled = rayFromNode;
        for (int axis = 0; axis < 3; ++axis) scaled[axis] *= 0.5 * medium.size[axis];
        localFromRay_ = inverseOf(scaled);
        for (int axis = 0; axis < 3; ++axis)
            extent = std::max(extent, 2 * glm::length(dvec3(scaled[axis])));
    } else if (kind_ == MediumKind::Height) {
        up_ = glm::normalize(dvec3(rayFromNode[1]));
        ground_ = glm::dot(up_, dvec3(rayFromNode[3]));
        extent = scaleHeight_;
    } else if (kind_ == MediumKind::Grid) {
        grid_ = medium.density;
        const dmat4 rayFromIndex = rayFromNode * grid_->worldFromIndex;
        localFromRay_ = inverseOf(rayFromIndex);
        makeBrickBounds();
        const Bounds bounds = grid_->indexBounds();
        for (int axis = 0; axis < 3; ++axis)
            extent =
                std::max(extent, bounds.extent()[axis] * glm::length(dvec3(rayFromIndex[axis])));
        if (medium.temperature && medium.temperatureScale > 0) {
            temperature_ = medium.temperature;
            temperatureScale_ = double(medium.temperatureScale);
            temperatureFromRay_ = inverseOf(rayFromNode * temperature_->worldFromIndex);
        }
    }
    if (emits()) emissionMajorant_ = extent > 0 ? kEmissionCollisions / extent : 1;
}

void MediumSource::makeBrickBounds() {
    bricks_.reserve(grid_->bricks.size());
    for (const Brick& brick : grid_->bricks) {
        BrickBounds bounds{brick.minimum, brick.maximum, brick.minimum};
        if (brick.slot != Brick::kNoSlot) {
            double sum = 0;
            const float* samples = &grid_->samples[size_t(brick.slot) * kBrickSampleCount];
            for (int i = 0; i < kBrickSampleCount; ++i) sum += double(samples[i]);
            bounds.mean = float(sum / kBrickSampleCount);
        }
        bricks_.push_back(bounds);
    }
}

Bounds MediumSource::bounds() const {
    Bounds local;
    if (endless()) return local;
    if (isGrid()) {
        local.minimum = dvec3(grid_->origin);
        local.maximum = local.minimum + double(kBrickCells) * dvec3(grid_->brickCount);
    } else {
        local.include(dvec3(-1));
        local.include(dvec3(1));
    }
    return local.transformed(glm::inverse(localFromRay_));
}

Interval MediumSource::clip(const Ray& ray, double length) const {
    switch (kind_) {
    case MediumKind::Everywhere: return {0, length};
    case MediumKind::Height: {
        const double slope = glm::dot(up_, ray.direction),
                     room = kHighestFog * scaleHeight_ - (glm::dot(up_, ray.origin) - ground_);
        if (slope > 0) return {0, std::min(length, room / slope)};
        if (slope < 0) return {std::max(0.0, room / slope), length};
        return {0, room > 0 ? length : 0};
    }
    default: break;
    }
    const dvec3 o = localPoint(ray.origin), d = dmat3(localFromRay_) * ray.direction;
    if (kind_ == MediumKind::Sphere) {
        const double squared = glm::dot(d, d), nearest = -glm::dot(o, d) / squared;
        const dvec3 closest = o + nearest * d;
        const double within = 1 - glm::dot(closest, closest);
        if (!(within > 0)) return {};
        const double half = std::sqrt(within / squared);
        return {std::max(0.0, nearest - half), std::min(length, nearest + half)};
    }
    dvec3 low(-1), high(1);
    if (kind_ == MediumKind::Grid) {
        low = dvec3(grid_->origin);
        high = low + double(kBrickCells) * dvec3(grid_->brickCount);
    }
    Interval inside{0, length};
    for (int axis = 0; axis < 3; ++axis) {
        if (d[axis] == 0) {
            if (!(o[axis] >= low[axis] && o[axis] <= high[axis])) return {};
            continue;
        }
        const double a = (low[axis] - o[axis]) / d[axis], b = (high[axis] - o[axis]) / d[axis];
        inside.begin = std::max(inside.begin, std::min(a, b));
        inside.end = std::min(inside.end, std::max(a, b));
    }
    return inside;
}

/// Trilinear in the cell whose lowest corner is `cell`, from the grid's origin; the point may lie a rounding outside of it.
double MediumSource::cellDensity(const ivec3& cell, const dvec3& index) const {
    const Brick& brick = grid_->brick(cell / kBrickCells);
    if (brick.slot == Brick::kNoSlot) return double(brick.minimum);
    const ivec3 in = cell % kBrickCells;
    const dvec3 f = glm::clamp(index - dvec3(grid_->origin + cell), 0.0, 1.0);
    constexpr int kRow = kBrickSamples, kSlice = kBrickSamples * kBrickSamples;
    const float* s = &grid_->samples[size_t(brick.slot) * kBrickSampleCount +
                                     size_t(in.z * kSlice + in.y * kRow + in.x)];
    const auto row = [&](const float* r) {
        return double(r[0]) + f.x * (double(r[1]) - double(r[0]));
    };
    const double y0 = row(s), y1 = row(s + kRow), y2 = row(s + kSlice), y3 = row(s + kSlice + kRow);
    const double z0 = y0 + f.y * (y1 - y0), z1 = y2 + f.y * (y3 - y2);
    return z0 + f.z * (z1 - z0);
}

double MediumSource::gridDensity(const dvec3& index) const {
    const dvec3 p = index - dvec3(grid_->origin);
    const ivec3 cells = grid_->brickCount * kBrickCells;
    for (int axis = 0; axis < 3; ++axis)
        if (!(p[axis] >= 0 && p[axis] <= double(cells[axis]))) return 0;
    return cellDensity(glm::min(ivec3(p), cells - 1), index);
}

double MediumSource::density(const dvec3& position) const {
    switch (kind_) {
    case MediumKind::Everywhere: return 1;
    case MediumKind::Box: {
        const dvec3 p = glm::abs(localPoint(position));
        return p.x <= 1 && p.y <= 1 && p.z <= 1 ? 1 : 0;
    }
    case MediumKind::Sphere: {
        const dvec3 p = localPoint(position);
        return glm::dot(p, p) <= 1 ? 1 : 0;
    }
    case MediumKind::Height:
        return std::exp(-std::max(0.0, glm::dot(up_, position) - ground_) / scaleHeight_);
    case MediumKind::Grid: return gridDensity(localPoint(position));
    }
    return 0;
}

dvec3 MediumSource::emitted(const dvec3& position, double density) const {
    dvec3 result = emission * density;
    if (temperature_) {
        const double kelvin = temperature_->sample(dvec3(temperatureFromRay_ * dvec4(position, 1)));
        if (kelvin > BlackbodyTable::kCoolest)
            result += temperatureScale_ * density *
                      blackbody().radiance(std::min(kelvin, BlackbodyTable::kHottest));
    }
    return result;
}

double MediumSource::heightIntegral(const Ray& ray, Interval interval) const {
    const double y = glm::dot(up_, ray.origin) - ground_, slope = glm::dot(up_, ray.direction);
    const double a = y + slope * interval.begin, length = interval.end - interval.begin;
    // ∫₀^L e^(-h(s)/H) ds for heights h ≥ 0 that start at `low` and rise by `rate` a metre.
    const auto above = [this](double low, double rate, double l) {
        if (!(l > 0)) return 0.0;
        const double dense = std::exp(-low / scaleHeight_), k = rate / scaleHeight_;
        if (k * l < 1e-12) return dense * l;
        return dense * -std::expm1(-k * l) / k;
    };
    if (slope == 0) return a <= 0 ? length : std::exp(-a / scaleHeight_) * length;
    // The part at height ≤ 0 has density 1.
    const double reach = std::clamp(-a / slope, 0.0, length); // to the crossing of height 0
    if (slope > 0) return reach + above(std::max(a, 0.0), slope, length - reach);
    const double crossing = a > 0 ? std::min(-a / slope, length) : 0;
    const double lowest = std::max(0.0, a + slope * crossing);
    return above(lowest, -slope, crossing) + (length - crossing);
}

double MediumSource::densityIntegral(const Ray& ray, Interval interval) const {
    if (interval.empty()) return 0;
    switch (kind_) {
    case MediumKind::Everywhere: return interval.end - interval.begin;
    case MediumKind::Height: return heightIntegral(ray, interval);
    default: break;
    }
    const Interval inside = clip(ray, interval.end);
    const Interval part{std::max(inside.begin, interval.begin), inside.end};
    if (part.empty()) return 0;
    if (kind_ != MediumKind::Grid) return part.end - part.begin;
    return gridIntegral(localPoint(ray.origin), dmat3(localFromRay_) * ray.direction, part);
}

/// Within one cell the field along a line is a cubic, for which Simpson's rule is exact; neighbours share a sample.
double MediumSource::gridIntegral(const dvec3& origin, const dvec3& direction,
                                  Interval interval) const {
    double sum = 0;
    ivec3 step;
    dvec3 perCell;
    for (int axis = 0; axis < 3; ++axis) {
        step[axis] = direction[axis] > 0 ? 1 : -1;
        perCell[axis] = direction[axis] != 0 ? 1 / direction[axis] : 0;
    }
    const auto crossing = [&](int axis, double plane) {
        return direction[axis] == 0 ? kInfinity : (plane - origin[axis]) * perCell[axis];
    };
    const ivec3 cells = grid_->brickCount * kBrickCells;
    dvec3 p = origin + interval.begin * direction - dvec3(grid_->origin);
    ivec3 cell = glm::clamp(ivec3(glm::floor(p)), ivec3(0), cells - 1);
    double t = interval.begin, value = -1;
    while (t < interval.end) {
        const ivec3 b = cell / kBrickCells;
        const Brick& brick = grid_->brick(b);
        const bool constant = brick.slot == Brick::kNoSlot;
        // The far planes of this cell, or of the whole brick where it is constant.
        double stop = interval.end;
        int axisOut = -1;
        for (int axis = 0; axis < 3; ++axis) {
            const int low = constant ? b[axis] * kBrickCells : cell[axis];
            const int plane = step[axis] > 0 ? low + (constant ? kBrickCells : 1) : low;
            const double at = crossing(axis, double(plane + grid_->origin[axis]));
            if (at < stop) {
                stop = at;
                axisOut = axis;
            }
        }
        stop = std::max(stop, t);
        if (constant) {
            sum += double(brick.minimum) * (stop - t);
            value = -1;
        } else {
            const auto sampleIn = [&](double at) {
                return cellDensity(cell, origin + at * direction);
            };
            const double first = value >= 0 ? value : sampleIn(t), last = sampleIn(stop);
            sum += (stop - t) / 6 * (first + 4 * sampleIn(0.5 * (t + stop)) + last);
            value = last;
        }
        t = stop;
        if (axisOut < 0) break;
        if (constant) { // to the cell behind the brick, wherever the ray leaves it
            p = origin + t * direction - dvec3(grid_->origin);
            ivec3 at = glm::clamp(ivec3(glm::floor(p)), b * kBrickCells,
                                  b * kBrickCells + kBrickCells - 1);
            at[axisOut] =
                step[axisOut] > 0 ? (b[axisOut] + 1) * kBrickCells : b[axisOut] * kBrickCells - 1;
            cell = at;
        } else {
            cell[axisOut] += step[axisOut];
        }
        if (cell[axisOut] < 0 || cell[axisOut] >= cells[axisOut]) break;
    }
    return sum;
}

double MediumSource::phaseValue(double oneMinusCosine) const {
    switch (phase) {
    case PhaseFunction::HenyeyGreenstein:
        return anisotropy == 0 ? 1 / (4 * kPi)
                               : henyeyGreensteinFromVersine(oneMinusCosine, anisotropy);
    case PhaseFunction::Rayleigh: return rayleigh(1 - oneMinusCosine);
    case PhaseFunction::CornetteShanks: return cornetteShanks(1 - oneMinusCosine, anisotropy);
    }
    return 0;
}

double MediumSource::samplePhase(double u) const {
    switch (phase) {
    case PhaseFunction::HenyeyGreenstein: return sampleHenyeyGreenstein(u, anisotropy);
    case PhaseFunction::Rayleigh: return sampleRayleigh(u);
    case PhaseFunction::CornetteShanks: return sampleCornetteShanks(u, anisotropy);
    }
    return 1;
}

MediaField::MediaField(const Scene& scene, const dvec3& origin, const Change& change) {
    const std::vector<dmat4> world = scene.worldTransforms();
    const std::vector<bool> visible = scene.worldVisibility();
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        const int index = scene.nodes[i].medium;
        if (!visible[i] || index == kNone) continue;
        const Medium& medium = scene.media[size_t(index)];
        dmat4 rayFromNode = world[i];
        rayFromNode[3] -= dvec4(origin, 0);
        if (!usable(medium, rayFromNode)) continue;
        const MediumSource& source = [&]() -> const MediumSource& {
            if (!change) return media_.emplace_back(medium, rayFromNode);
            Medium changed = medium;
            change(changed, rayFromNode);
            return media_.emplace_back(changed, rayFromNode);
        }();
        grey_ = grey_ && source.extinction.x == source.extinction.y &&
                source.extinction.y == source.extinction.z;
        scatters_ = scatters_ || source.scattering != dvec3(0);
        emits_ = emits_ || source.emits();
    }
}

} // namespace tyndall::tracing
