#include "reference/light_walk.h"

#include <algorithm>
#include <cmath>

namespace tyndall::reference {
namespace {

/// Light that grazes a facet under a tilted shading normal would weigh without bound.
constexpr double kLeastCosine = 1e-3;

/// What a shading normal makes of light that falls in along `travel`: its cosine over that of the facet (Veach 1997, 5.3).
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

bool LightWalker::survives(double carried, double started, size_t vertices, Sampler& sampler,
                           PathWeights& weights) const {
    if (!(carried > 0)) return false;
    if (vertices < 2) return true;
    const double chance =
        std::clamp(carried / started, settings_.leastSurvival, settings_.mostSurvival);
    if (!(sampler.random() < chance)) return false;
    weights.throughput /= chance;
    return true;
}

void LightWalker::trace(Sampler& sampler, std::vector<WalkVertex>& walk) {
    walk.clear();
    start_ = emission_.sample(sampler);
    const double started = maximumOf(start_.power);
    if (!(started > 0) || !std::isfinite(started)) return;
    PathWeights weights;
    weights.throughput = start_.power;
    if (!scene_.media->grey()) weights.hero = std::min(2, int(3 * sampler.next1()));
    Ray ray = start_.ray;
    for (;;) {
        ++rays_;
        const RayHit hit =
            scene_.surfaces->intersect(ray, 0, kInfinity, RayKind::Path, sampler.bits());
        MediaSegment::Flight flight{false, hit.distance};
        if (!scene_.media->empty()) {
            segment_.start(ray, hit.distance);
            flight = segment_.fly(sampler, weights, mediumPoint_, emitted_);
        }
        if (!flight.collided && !hit.found()) return;
        WalkVertex vertex;
        vertex.travel = ray.direction;
        vertex.scatterings = int(walk.size()) + 1;
        if (walk.empty()) weights.throughput *= rangeWindow(start_.range, flight.distance);
        if (weights.throughput == dvec3(0)) return;
        const double choice = sampler.next1();
        const dvec2 u = sampler.next2();
        if (flight.collided) {
            dvec3 share;
            vertex.medium = &mediumPoint_.pick(weights.hero, choice, share);
            vertex.position = ray.at(flight.distance);
            weights.throughput *= share;
            weights.ratio *= share; // every hero would have drawn it by its own scattering
            vertex.power = weights.carried();
            walk.push_back(vertex);
            const double cosine = std::clamp(vertex.medium->samplePhase(u.x), -1.0, 1.0);
            ray = {vertex.position,
                   glm::normalize(Frame(ray.direction).toWorld(directionAround(cosine, u.y)))};
        } else {
            vertex.point = scene_.surfaces->pointAt(ray, hit);
            if (vertex.point.unlit) return;
            vertex.position = vertex.point.position;
            weights.throughput *= tilt(vertex.point.surface, ray.direction);
            vertex.power = weights.carried();
            walk.push_back(vertex);
            const BsdfSample sample = Bsdf(vertex.point.surface, -ray.direction).sample(choice, u);
            if (sample.weight == dvec3(0)) return;
            weights.throughput *=
                sample.weight /
                std::max(tilt(vertex.point.surface, sample.direction), kLeastCosine);
            ray = rayFrom(vertex.point, sample.direction);
        }
        if (!survives(maximumOf(weights.carried()), started, walk.size(), sampler, weights)) return;
        if (int(walk.size()) >= settings_.longest) {
            ++cutOff_;
            return;
        }
    }
}

} // namespace tyndall::reference
