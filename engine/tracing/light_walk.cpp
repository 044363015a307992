#include "tracing/light_walk.h"

#include <algorithm>
#include <cmath>

namespace tyndall::tracing {
namespace {

/// Without a limit, light that grazes a facet under a tilted shading normal would have an unbounded weight.
constexpr double kLeastCosine = 1e-3;
/// Part of the light scattered outside of the ball around the content that is sampled towards it.
constexpr double kOnToContent = 0.5;

/// Correction of light arriving along `travel` for shading normals: its cosine over that of the facet (Veach 1997, 5.3).
double tilt(const Surface& surface, const dvec3& direction) {
    const double facet = std::abs(glm::dot(surface.geometricNormal, direction)),
                 shading = std::abs(glm::dot(surface.normal, direction));
    return shading / std::max(facet, kLeastCosine);
}

} // namespace

dvec3 WalkVertex::intensity(const dvec3& direction) const {
    if (medium) {
        const dvec3 apart = direction - travel;
        return power * medium->phaseValue(0.5 * glm::dot(apart, apart));
    }
    const double facet = glm::dot(point.surface.geometricNormal, direction);
    if (!(facet > 0)) return dvec3(0);
    const dvec3 reflected = Bsdf(point.surface, -travel).evaluate(direction);
    const double shading = std::abs(glm::dot(point.surface.normal, direction));
    return power * reflected * (facet / std::max(shading, kLeastCosine));
}

LightWalker::ContentCone LightWalker::contentConeFrom(const dvec3& position) const {
    const dvec3 way = centre_ - position;
    const double distance = glm::length(way);
    if (!(radius_ > 0) || !(distance > radius_) || !std::isfinite(distance)) return {};
    const double sine = radius_ / distance;
    return {way / distance, sine * sine / (1 + std::sqrt(1 - sine * sine))};
}

dvec3 LightWalker::ContentCone::sample(const dvec2& u) const {
    const double v = u.x * versine, sine = std::sqrt(v * (2 - v)), azimuth = 2 * kPi * u.y;
    return glm::normalize(
        Frame(axis).toWorld({sine * std::cos(azimuth), sine * std::sin(azimuth), 1 - v}));
}

double LightWalker::ContentCone::density(const dvec3& direction, double own) const {
    const dvec3 apart = direction - axis;
    const bool within = 0.5 * glm::dot(apart, apart) <= versine;
    return (1 - kOnToContent) * own + (within ? kOnToContent / (2 * kPi * versine) : 0.0);
}

bool LightWalker::survives(size_t vertices, Sampler& sampler, Progress& progress) const {
    const double carried = maximumOf(progress.weights.carried());
    if (!(carried > 0)) return false;
    if (vertices < 2) return true;
    const double chance =
        std::clamp(carried / progress.started, settings_.leastSurvival, settings_.mostSurvival);
    if (!(sampler.random() < chance)) return false;
    progress.weights.throughput /= chance;
    return true;
}

bool LightWalker::begin(Sampler& sampler, Progress& progress) {
    start_ = emission_.sample(sampler);
    progress.started = maximumOf(start_.power);
    if (!(progress.started > 0) || !std::isfinite(progress.started)) return false;
    progress.weights.throughput = start_.power;
    if (!scene_.media->grey()) progress.weights.hero = std::min(2, int(3 * sampler.next1()));
    progress.ray = start_.ray;
    return true;
}

bool LightWalker::addVertex(Sampler& sampler, Progress& progress, std::vector<WalkVertex>& walk) {
    ++rays_;
    PathWeights& weights = progress.weights;
    const RayHit hit =
        scene_.surfaces->intersect(progress.ray, 0, kInfinity, RayKind::Path, sampler.bits());
    MediaSegment::Flight segment{false, hit.distance};
    if (!scene_.media->empty()) {
        segment_.start(progress.ray, hit.distance);
        segment = segment_.fly(sampler, weights, mediumPoint_, emitted_);
    }
    if (!segment.collided && !hit.found()) return false;
    if (walk.empty()) weights.throughput *= rangeWindow(start_.range, segment.distance);
    if (weights.throughput == dvec3(0)) return false;
    const double choice = sampler.next1();
    const dvec2 u = sampler.next2();
    WalkVertex vertex;
    vertex.travel = progress.ray.direction;
    vertex.scatterings = int(walk.size()) + 1;
    if (segment.collided) {
        enterMedium(segment.distance, choice, progress, vertex);
        walk.push_back(vertex);
        scatterInMedium(vertex, u, sampler, progress);
        return true;
    }
    vertex.point = scene_.surfaces->pointAt(progress.ray, hit);
    if (vertex.point.unlit) return false;
    vertex.position = vertex.point.position;
    weights.throughput *= tilt(vertex.point.surface, vertex.travel);
    vertex.power = weights.carried();
    walk.push_back(vertex);
    return scatterOnSurface(vertex, choice, u, sampler, progress);
}

void LightWalker::enterMedium(double distance, double choice, Progress& progress,
                              WalkVertex& vertex) const {
    PathWeights& weights = progress.weights;
    dvec3 share;
    vertex.medium = &mediumPoint_.pick(weights.hero, choice, share);
    vertex.position = progress.ray.at(distance);
    weights.throughput *= share;
    weights.ratio *= share; // every hero would have drawn it by its own scattering
    vertex.power = weights.carried();
}

void LightWalker::scatterInMedium(const WalkVertex& vertex, const dvec2& u, Sampler& sampler,
                                  Progress& progress) const {
    const ContentCone cone = contentConeFrom(vertex.position);
    dvec3 direction;
    if (cone.versine > 0 && sampler.random() < kOnToContent) {
        direction = cone.sample(u);
    } else {
        const double cosine = std::clamp(vertex.medium->samplePhase(u.x), -1.0, 1.0);
        direction = glm::normalize(Frame(vertex.travel).toWorld(directionAround(cosine, u.y)));
    }
    if (cone.versine > 0) {
        const dvec3 apart = direction - vertex.travel;
        const double phase = vertex.medium->phaseValue(0.5 * glm::dot(apart, apart)),
                     weight = phase / cone.density(direction, phase);
        progress.weights.throughput *= weight;
        progress.started *= weight;
    }
    progress.ray = {vertex.position, direction};
}

bool LightWalker::scatterOnSurface(const WalkVertex& vertex, double choice, const dvec2& u,
                                   Sampler& sampler, Progress& progress) const {
    const Bsdf bsdf(vertex.point.surface, -vertex.travel);
    const ContentCone cone = contentConeFrom(vertex.position);
    BsdfSample sample;
    if (cone.versine > 0 && sampler.random() < kOnToContent) {
        sample.direction = cone.sample(u);
        sample.weight = bsdf.evaluate(sample.direction);
        sample.density = bsdf.density(sample.direction);
        sample.weight /= sample.density > 0 ? sample.density : 1.0;
    } else {
        sample = bsdf.sample(choice, u);
    }
    if (sample.weight == dvec3(0)) return false;
    if (cone.versine > 0) {
        const double weight = sample.density / cone.density(sample.direction, sample.density);
        sample.weight *= weight;
        progress.started *= weight;
    }
    progress.weights.throughput *=
        sample.weight / std::max(tilt(vertex.point.surface, sample.direction), kLeastCosine);
    progress.ray = rayFrom(vertex.point, sample.direction);
    return true;
}

void LightWalker::trace(Sampler& sampler, std::vector<WalkVertex>& walk) {
    walk.clear();
    Progress progress;
    if (!begin(sampler, progress)) return;
    while (addVertex(sampler, progress, walk)) {
        if (!survives(walk.size(), sampler, progress)) return;
        if (int(walk.size()) >= settings_.longest) {
            ++cutOff_;
            return;
        }
    }
}

} // namespace tyndall::tracing
