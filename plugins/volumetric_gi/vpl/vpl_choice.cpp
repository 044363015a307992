#include "volumetric_gi/vpl/vpl_choice.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <tbb/parallel_for.h>

#include "volumetric_gi/vpl/compensation_light.h"

namespace tyndall::volumetric_gi {
namespace {

/// Least importance of a light over the mean: points are few, and may not receive a light that matters elsewhere. A kept light carries at most three
/// times its own power.
constexpr double kLeastWorth = 0.5;
/// Points that a light is tested against, with one ray each.
constexpr size_t kPointsOfLight = 32;
/// Halvings that find the scale of probabilities.
constexpr int kHalvings = 60;

/// Contribution of a light to a point, in any unit: only ratios count.
double givenTo(const SeenPoint& point, const tracing::WalkVertex& light,
               const tracing::SurfaceScene& surfaces, const tracing::MediaField& media,
               double least, tracing::Sampler& sampler) {
    const dvec3 way = light.position - point.position;
    const double distance = glm::length(way);
    if (!(distance > 0)) return 0;
    const dvec3 towards = way / distance;
    double cosine = 1;
    if (point.normal != dvec3(0)) cosine = glm::dot(point.normal, towards);
    if (!(cosine > 0)) return 0;
    const double intensity = tracing::meanOf(light.intensity(-towards));
    if (!(intensity > 0)) return 0;
    const tracing::Ray shadow{point.position + point.margin * point.normal, towards};
    const double room = distance - std::min(2 * light.point.margin, 0.5 * distance);
    if (surfaces.occluded(shadow, room, sampler.bits())) return 0;
    const double through = tracing::meanOf(tracing::transmittance(
        media, shadow, distance, tracing::TransmittanceMode::Ratio, sampler));
    return intensity * cosine * through / std::max(distance * distance, least * least);
}

/// Along Morton's curve; `place`: in the unit cube.
uint32_t mortonCode(const dvec3& place) {
    constexpr int kBits = 10;
    uint32_t code = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const auto along = uint32_t(std::clamp(place[axis], 0.0, 1.0) * ((1 << kBits) - 1));
        for (int bit = 0; bit < kBits; ++bit) code |= ((along >> bit) & 1u) << (3 * bit + axis);
    }
    return code;
}

/// Which lights to keep, each with the probability min(1, scale · importance): a light is kept where the sum of probabilities, along a space-filling curve, reaches a
/// whole number, so that each region keeps its expected number to within one.
std::vector<bool> inTurn(const std::vector<const tracing::WalkVertex*>& lights,
                         const std::vector<double>& worth, double scale, uint64_t seed) {
    Bounds around;
    for (const auto* light : lights) around.include(light->position);
    const dvec3 inverse = 1.0 / glm::max(around.extent(), dvec3(1e-30));
    std::vector<std::pair<uint32_t, size_t>> order(lights.size());
    for (size_t i = 0; i < lights.size(); ++i)
        order[i] = {mortonCode((lights[i]->position - around.minimum) * inverse), i};
    std::sort(order.begin(), order.end());
    std::vector<bool> keeps(lights.size());
    double sum = double(tracing::mixBits(seed * 0x9e3779b97f4a7c15ull) >> 11) * 0x1p-53;
    for (const auto& [code, i] : order) {
        const double before = std::floor(sum);
        sum += std::min(1.0, scale * worth[i]);
        keeps[i] = std::floor(sum) > before;
    }
    return keeps;
}

} // namespace

std::vector<SeenPoint> seenPoints(const gpu::ViewData& view,
                                  const tracing::SurfaceScene& surfaces,
                                  const tracing::MediaField& media, uint32_t count,
                                  uint64_t seed) {
    std::vector<SeenPoint> seen;
    tracing::MediaSegment segment(media);
    tracing::MediumPoint there;
    std::vector<tracing::EmittedLight> emitted;
    for (uint32_t i = 0; i < count; ++i) {
        tracing::Sampler sampler(seed, 1, i);
        const auto [ray, nearest] = eyeRay(view, 2.0 * sampler.next2() - 1.0);
        const tracing::RayHit hit = surfaces.intersect(
            ray, nearest, kInfinity, tracing::RayKind::Camera, sampler.bits());
        segment.start(ray, hit.distance);
        tracing::PathWeights weights;
        const auto flight = segment.fly(sampler, weights, there, emitted);
        if (flight.collided) {
            if (there.scattering != dvec3(0)) seen.push_back({ray.at(flight.distance)});
        } else if (hit.found()) {
            const tracing::SurfacePoint point = surfaces.pointAt(ray, hit);
            if (!point.unlit)
                seen.push_back({point.position, point.surface.geometricNormal, point.margin});
        }
    }
    return seen;
}

void chooseLights(Walks& walks, const std::vector<SeenPoint>& seen,
                  const tracing::SurfaceScene& surfaces, const tracing::MediaField& media,
                  double wanted, double least, uint64_t seed) {
    std::vector<const tracing::WalkVertex*> lights;
    for (const auto& walk : walks.vertices)
        for (const tracing::WalkVertex& light : walk) lights.push_back(&light);
    if (lights.empty() || double(lights.size()) <= wanted) return;
    // A light's part of the light of each point: dark places matter as much as bright ones. A light is tested against a subset of the points.
    const size_t stride = std::max<size_t>(seen.size() / kPointsOfLight, 1);
    // Its importance is the root of the sum of their squares: probabilities in proportion to it minimise the sum of the variances of all points.
    std::vector<std::vector<double>> parts(seen.size());
    tbb::parallel_for(size_t(0), seen.size(), [&](size_t p) {
        double sum = 0;
        tracing::Sampler sampler(seed, 2, uint32_t(p));
        for (size_t i = p % stride; i < lights.size(); i += stride)
            sum += parts[p].emplace_back(
                givenTo(seen[p], *lights[i], surfaces, media, least, sampler));
        for (double& part : parts[p]) part = sum > 0 ? part / sum : 0;
    });
    std::vector<double> worth(lights.size(), 0);
    for (size_t p = 0; p < seen.size(); ++p)
        for (size_t k = 0; k < parts[p].size(); ++k)
            worth[p % stride + k * stride] += parts[p][k] * parts[p][k];
    for (double& w : worth) w = std::sqrt(w);
    const double mean = std::accumulate(worth.begin(), worth.end(), 0.0) / double(lights.size());
    for (double& w : worth) w += mean > 0 ? kLeastWorth * mean : 1;
    // The probability is min(1, scale · importance), with the scale that keeps the wanted number.
    const auto kept = [&](double scale) {
        double sum = 0;
        for (const double w : worth) sum += std::min(1.0, scale * w);
        return sum;
    };
    double low = 0, high = 1 / *std::min_element(worth.begin(), worth.end());
    for (int i = 0; i < kHalvings; ++i) {
        const double middle = 0.5 * (low + high);
        (kept(middle) < wanted ? low : high) = middle;
    }
    const std::vector<bool> keeps = inTurn(lights, worth, high, seed);
    size_t number = 0;
    for (auto& walk : walks.vertices) {
        auto out = walk.begin();
        for (tracing::WalkVertex& light : walk) {
            const double chance = std::min(1.0, high * worth[number]);
            if (!keeps[number++]) continue;
            light.power /= chance;
            *out++ = light;
        }
        walk.erase(out, walk.end());
    }
}

} // namespace tyndall::volumetric_gi
