#include "volumetric_gi/vpl/vpl_choice.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include <tbb/parallel_for.h>

#include "framegraph/hash.h"

namespace tyndall::volumetric_gi {
namespace {

/// Of a mean light's worth, so much has each at least: points are few, and may miss what a light gives.
constexpr double kLeastWorth = 0.1;
/// Points that a light is asked about: a ray each.
constexpr size_t kPointsOfLight = 16;
/// Chances are met to within this by so many halvings.
constexpr int kHalvings = 60;

/// As cameraRay() in shaders/common/view.glsl; `ndc`: -1 to 1.
reference::Ray eyeRay(const gpu::ViewData& view, const dvec2& ndc) {
    const dmat4 renderFromClip(view.renderFromClip);
    const dvec3 eye(view.cameraPosition), forward(view.cameraForward);
    if (view.flags & gpu::kViewOrthographic) {
        const dvec4 point = renderFromClip * dvec4(ndc, 1, 1);
        const dvec3 fromEye = dvec3(point) / point.w - eye;
        return {eye + fromEye - forward * glm::dot(fromEye, forward), forward};
    }
    return {eye, glm::normalize(dvec3(renderFromClip * dvec4(ndc, 0, 1)))};
}

/// What a light gives to a point, watts per square metre and the like: only ratios count.
double givenTo(const SeenPoint& point, const reference::WalkVertex& light,
               const reference::SurfaceScene& surfaces, const reference::MediaField& media,
               double least, reference::Sampler& sampler) {
    const dvec3 way = light.position - point.position;
    const double distance = glm::length(way);
    if (!(distance > 0)) return 0;
    const dvec3 towards = way / distance;
    double cosine = 1;
    if (point.normal != dvec3(0)) cosine = glm::dot(point.normal, towards);
    if (!(cosine > 0)) return 0;
    const double intensity = reference::meanOf(light.intensity(-towards));
    if (!(intensity > 0)) return 0;
    const reference::Ray shadow{point.position + point.margin * point.normal, towards};
    const double room = distance - std::min(2 * light.point.margin, 0.5 * distance);
    if (surfaces.occluded(shadow, room, sampler.bits())) return 0;
    const double through = reference::meanOf(reference::transmittance(
        media, shadow, distance, reference::TransmittanceMode::Ratio, sampler));
    return intensity * cosine * through / std::max(distance * distance, least * least);
}

} // namespace

std::vector<SeenPoint> seenPoints(const gpu::ViewData& view,
                                  const reference::SurfaceScene& surfaces,
                                  const reference::MediaField& media, uint32_t count,
                                  uint64_t seed) {
    std::vector<SeenPoint> seen;
    reference::MediaSegment segment(media);
    reference::MediumPoint there;
    std::vector<reference::EmittedLight> emitted;
    for (uint32_t i = 0; i < count; ++i) {
        reference::Sampler sampler(seed, 1, i);
        const reference::Ray ray = eyeRay(view, 2.0 * sampler.next2() - 1.0);
        const reference::RayHit hit =
            surfaces.intersect(ray, double(view.cameraPosition.w), reference::kInfinity,
                               reference::RayKind::Camera, sampler.bits());
        segment.start(ray, hit.distance);
        reference::PathWeights weights;
        const auto flight = segment.fly(sampler, weights, there, emitted);
        if (flight.collided) {
            if (there.scattering != dvec3(0)) seen.push_back({ray.at(flight.distance)});
        } else if (hit.found()) {
            const reference::SurfacePoint point = surfaces.pointAt(ray, hit);
            if (!point.unlit)
                seen.push_back({point.position, point.surface.geometricNormal, point.margin});
        }
    }
    return seen;
}

void chooseLights(Walks& walks, const std::vector<SeenPoint>& seen,
                  const reference::SurfaceScene& surfaces, const reference::MediaField& media,
                  double wanted, double least, uint64_t seed) {
    std::vector<const reference::WalkVertex*> lights;
    for (const auto& walk : walks.vertices)
        for (const reference::WalkVertex& light : walk) lights.push_back(&light);
    if (lights.empty() || double(lights.size()) <= wanted) return;
    // Of what a point gets each light has a part: dark places matter as much as bright ones. A light is asked about every so many points alone.
    const size_t stride = std::max<size_t>(seen.size() / kPointsOfLight, 1);
    std::vector<double> given(seen.size() * lights.size());
    tbb::parallel_for(size_t(0), seen.size(), [&](size_t p) {
        double* of = &given[p * lights.size()];
        double sum = 0;
        reference::Sampler sampler(seed, 2, uint32_t(p));
        for (size_t i = p % stride; i < lights.size(); i += stride)
            sum += of[i] = givenTo(seen[p], *lights[i], surfaces, media, least, sampler);
        for (size_t i = p % stride; i < lights.size() && sum > 0; i += stride) of[i] /= sum;
    });
    std::vector<double> worth(lights.size(), 0);
    for (size_t p = 0; p < seen.size(); ++p)
        for (size_t i = 0; i < lights.size(); ++i) worth[i] += given[p * lights.size() + i];
    const double mean = std::accumulate(worth.begin(), worth.end(), 0.0) / double(lights.size());
    for (double& w : worth) w += mean > 0 ? kLeastWorth * mean : 1;
    // The chance is min(1, scale · worth): the scale with which as many are kept as are wanted.
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
    size_t number = 0;
    for (auto& walk : walks.vertices) {
        auto out = walk.begin();
        for (reference::WalkVertex& light : walk) {
            const double chance = std::min(1.0, high * worth[number]);
            const double u =
                double(reference::mixBits(seed * 0x9e3779b97f4a7c15ull + number++) >> 11) * 0x1p-53;
            if (!(u < chance)) continue;
            light.power /= chance;
            *out++ = light;
        }
        walk.erase(out, walk.end());
    }
}

uint64_t viewKey(const gpu::ViewData& view) {
    uint64_t key = fg::kHashStart;
    const auto mix = [&](float value) { key = fg::mixHash(key, std::bit_cast<uint32_t>(value)); };
    for (int i = 0; i < 16; ++i) mix(view.viewFromRender[i / 4][i % 4]);
    for (int i = 0; i < 2; ++i) mix(view.clipFromRender[i][i]);
    for (int i = 0; i < 2; ++i) mix(view.size[i]);
    return fg::mixHash(key, view.flags);
}

} // namespace tyndall::volumetric_gi
