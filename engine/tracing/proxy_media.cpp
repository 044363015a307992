#include "tracing/proxy_media.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "tracing/sampler.h"

namespace tyndall::tracing {
namespace {

constexpr double kOctave = 8; // steps of coefficients
constexpr double kLarger =
    1.125; // boxes and balls: rounding moves a place by less than half of √3 times its step
constexpr double kPlaceSteps = 8;      // of half the smallest extent
constexpr int kCells = 8;              // of a grid, along its longest edge
constexpr int kLooks = 4;              // samples of a grid, along each axis of a cell's surroundings
constexpr double kThinnest = 1.0 / 32; // of the densest cell: nothing is empty

double rounded(double value, double steps) {
    return value > 0 ? std::exp2(std::round(std::log2(value) * steps) / steps) : 0;
}

vec3 rounded(const vec3& value) {
    vec3 result;
    for (int c = 0; c < 3; ++c) result[c] = float(rounded(double(value[c]), kOctave));
    return result;
}

void roundPlace(dmat4& place, double step) {
    if (step > 0 && std::isfinite(step))
        place[3] = dvec4(step * glm::round(dvec3(place[3]) / step), 1);
}

double shortestColumn(const dmat4& m) {
    return std::min({glm::length(dvec3(m[0])), glm::length(dvec3(m[1])), glm::length(dvec3(m[2]))});
}

/// The mean of a grid's density over a cube of index space, roughly: from kLooks³ points.
double meanAround(const BrickGrid& grid, const dvec3& middle, double half) {
    double sum = 0;
    for (int z = 0; z < kLooks; ++z)
        for (int y = 0; y < kLooks; ++y)
            for (int x = 0; x < kLooks; ++x)
                sum += grid.sample(middle + half * ((dvec3(x, y, z) + 0.5) * (2.0 / kLooks) - 1.0));
    return sum / (kLooks * kLooks * kLooks);
}

std::shared_ptr<const BrickGrid> coarse(const BrickGrid& grid, double cell) {
    // One voxel more on each side: the field falls to nothing beyond them, and places are off by half a cell.
    const Bounds bounds = grid.indexBounds();
    const ivec3 size = ivec3(glm::ceil(bounds.extent() / cell)) + 3;
    std::vector<float> voxels;
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x)
                voxels.push_back(float(rounded(
                    meanAround(grid, bounds.minimum + cell * (dvec3(x, y, z) - 1.0), cell), 2)));
    const float least = float(kThinnest) * *std::max_element(voxels.begin(), voxels.end());
    for (float& voxel : voxels) voxel = std::max(voxel, least);
    dmat4 indexFromCell(cell);
    indexFromCell[3] = dvec4(bounds.minimum - cell, 1);
    return std::make_shared<BrickGrid>(
        makeBrickGrid(voxels, ivec3(0), size, grid.worldFromIndex * indexFromCell));
}

bool glows(const Medium& medium) {
    return medium.emission != vec3(0) || medium.temperatureScale > 0;
}

void makeProxy(Medium& medium, dmat4& rayFromNode) {
    if (glows(medium)) return;
    medium.scattering = rounded(medium.scattering);
    medium.absorption = rounded(medium.absorption);
    if (medium.kind == MediumKind::Box || medium.kind == MediumKind::Sphere) {
        dmat4 scaled = rayFromNode;
        for (int axis = 0; axis < 3; ++axis) scaled[axis] *= medium.size[axis];
        medium.size *= kLarger;
        roundPlace(rayFromNode, 0.5 * shortestColumn(scaled) / kPlaceSteps);
    } else if (medium.kind == MediumKind::Grid && medium.density->maximum > 0) {
        const dvec3 extent = medium.density->indexBounds().extent();
        const double cell = std::max({extent.x, extent.y, extent.z}) / kCells;
        medium.density = coarse(*medium.density, cell);
        roundPlace(rayFromNode, shortestColumn(rayFromNode * medium.density->worldFromIndex) / 2);
    }
}

uint64_t mix(uint64_t hash, uint64_t value) { return mixBits(hash ^ value) + 1; }

uint64_t hashOf(const Medium& medium, const dmat4& rayFromNode, uint64_t hash) {
    for (int i = 0; i < 16; ++i)
        hash = mix(hash, std::bit_cast<uint64_t>(rayFromNode[i / 4][i % 4]));
    for (int c = 0; c < 3; ++c) {
        hash = mix(hash, std::bit_cast<uint64_t>(medium.size[c]));
        for (const vec3& coefficients : {medium.scattering, medium.absorption, medium.emission})
            hash = mix(hash, std::bit_cast<uint32_t>(coefficients[c]));
    }
    hash = mix(hash, std::bit_cast<uint64_t>(medium.scaleHeight));
    hash = mix(hash, std::bit_cast<uint32_t>(medium.anisotropy));
    hash = mix(hash, uint64_t(medium.kind) * 16 + uint64_t(medium.phase));
    if (glows(medium)) {
        // The medium itself, which may be large.
        hash = mix(hash, medium.version);
        return mix(hash, std::bit_cast<uintptr_t>(medium.density.get()));
    }
    if (medium.kind == MediumKind::Grid)
        for (const float sample : medium.density->samples)
            hash = mix(hash, std::bit_cast<uint32_t>(sample));
    return hash;
}

} // namespace

ProxyMedia makeProxyMedia(const Scene& scene, const dvec3& origin) {
    uint64_t hash = 0;
    MediaField field(scene, origin, [&](Medium& medium, dmat4& rayFromNode) {
        makeProxy(medium, rayFromNode);
        hash = hashOf(medium, rayFromNode, hash);
    });
    return {std::move(field), hash};
}

void reweigh(const EmittedRay& start, std::vector<WalkVertex>& walk, const MediaField& from,
             const MediaField& to) {
    Sampler unused(0, 0, 0);
    const auto through = [&](const MediaField& field, const Ray& ray, double length) {
        return transmittance(field, ray, length, TransmittanceMode::Exact, unused);
    };
    const auto ratio = [&](const Ray& ray, double length) {
        const dvec3 now = through(to, ray, length), proxy = through(from, ray, length);
        dvec3 result;
        // The proxy's transmittance is so low that no walk passed it.
        for (int c = 0; c < 3; ++c) result[c] = proxy[c] > 0 ? now[c] / proxy[c] : 0;
        return result;
    };
    dvec3 carried(1);
    if (start.distant && !walk.empty())
        carried = ratio({start.ray.origin, -start.ray.direction}, kInfinity);
    dvec3 before = start.ray.origin;
    for (WalkVertex& vertex : walk) {
        carried *= ratio({before, vertex.travel}, glm::length(vertex.position - before));
        if (vertex.medium) {
            const MediumSource& proxy = *vertex.medium;
            const MediumSource& now = to.media()[size_t(&proxy - from.media().data())];
            const dvec3 was = proxy.density(vertex.position) * proxy.scattering,
                        is = now.density(vertex.position) * now.scattering;
            for (int c = 0; c < 3; ++c) carried[c] *= was[c] > 0 ? is[c] / was[c] : 0;
            vertex.medium = &now;
        }
        vertex.power *= carried;
        before = vertex.position;
    }
}

} // namespace tyndall::tracing
