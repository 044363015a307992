#include "reference/instant_radiosity.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tyndall::reference {
namespace {

PathSettings directOnly(TermSet terms) {
    PathSettings settings;
    settings.terms = terms & kDirectTerms;
    return settings;
}

/// Compensation far from its beginning carries little: from the third vertex on it ends by chance.
constexpr double kLeastSurvival = 0.1;

} // namespace

/// A vertex of the path from the eye, or of one that compensates.
struct InstantRadiosity::Vertex {
    dvec3 position{0};
    dvec3 before{0};          // direction in which the path came
    std::optional<Bsdf> bsdf; // of a surface
    SurfacePoint point;
    [[nodiscard]] bool onSurface() const { return bsdf.has_value(); }
    /// D of the geometry term.
    [[nodiscard]] double cosine(const dvec3& direction) const {
        return onSurface() ? std::max(0.0, glm::dot(point.surface.geometricNormal, direction)) : 1;
    }
    [[nodiscard]] Ray rayTowards(const dvec3& direction) const {
        return onSurface() ? rayFrom(point, direction) : Ray{position, direction};
    }
};

InstantRadiosity::InstantRadiosity(const TracerScene& scene, const LightEmission& emission,
                                   const InstantRadiositySettings& settings)
    : scene_(scene), settings_(settings), direct_(scene, directOnly(settings.terms)),
      walker_(scene, emission, {}), segment_(*scene.media) {}

PathCounts InstantRadiosity::counts() const {
    PathCounts sum = counts_;
    sum.add(direct_.counts());
    sum.segments += walker_.rays();
    sum.cutOff += walker_.cutOff();
    return sum;
}

void InstantRadiosity::see(PathHistory history, const dvec3& light) {
    const Term term = history.term();
    if (!(settings_.terms & bit(term))) return;
    for (int c = 0; c < 3; ++c) {
        if (!std::isfinite(light[c])) {
            ++counts_.nonFinite;
            return;
        }
        counts_.negative += light[c] < 0;
    }
    light_->add(term, light);
}

/// Follows the ray to where it is scattered. False where it leaves the scene.
bool InstantRadiosity::nextVertex(Ray& ray, double nearest, RayKind kind, Vertex& vertex) {
    ++counts_.segments;
    const RayHit hit = scene_.surfaces->intersect(ray, nearest, kInfinity, kind, sampler_->bits());
    MediaSegment::Flight flight{false, hit.distance};
    if (!scene_.media->empty()) {
        segment_.start(ray, hit.distance);
        flight = segment_.fly(*sampler_, weights_, mediumPoint_, emitted_);
    }
    if ((!flight.collided && !hit.found()) || weights_.throughput == dvec3(0)) return false;
    vertex.before = ray.direction;
    vertex.bsdf.reset();
    if (flight.collided) {
        vertex.position = ray.at(flight.distance);
        history_.add(Scattering::Medium);
        return true;
    }
    vertex.point = scene_.surfaces->pointAt(ray, hit);
    if (vertex.point.unlit) return false;
    vertex.position = vertex.point.position;
    vertex.bsdf.emplace(vertex.point.surface, -ray.direction);
    history_.add(Scattering::Surface);
    return true;
}

void InstantRadiosity::trace(const CameraRays::CameraRay& start, Sampler& sampler,
                             TermLight& light) {
    if (settings_.terms & kDirectTerms) {
        // Numbers of its own: the walk and the path below keep theirs.
        Sampler apart(sampler.bits(), 0, 0);
        direct_.trace(start, apart, light);
    }
    if (!(settings_.terms & ~kDirectTerms)) return;
    ++counts_.paths;
    sampler_ = &sampler;
    light_ = &light;
    walker_.trace(sampler, walk_);
    weights_ = {};
    if (!scene_.media->grey()) weights_.hero = std::min(2, int(3 * sampler.next1()));
    history_ = {};
    Ray ray = start.ray;
    Vertex vertex;
    if (!nextVertex(ray, start.nearest, RayKind::Camera, vertex)) return;
    while (true) {
        gatherWalk(vertex);
        if (!settings_.compensate || !(settings_.clampDistance > 0)) return;
        // On to where light comes from that is too near to be left to virtual lights.
        const double u = sampler.next1();
        dvec3 direction;
        if (vertex.onSurface()) {
            const BsdfSample sample = vertex.bsdf->sample(u, sampler.next2());
            weights_.throughput *= sample.weight;
            direction = sample.direction;
        } else {
            direction = mediumPoint_.samplePhase(weights_.hero, vertex.before, u, sampler.next2());
            const dvec3 density = mediumPoint_.phase(vertex.before, direction);
            weights_.scale(density, density);
        }
        if (weights_.throughput == dvec3(0)) return;
        const Vertex from = vertex;
        ray = from.rayTowards(direction);
        if (!nextVertex(ray, 0, RayKind::Path, vertex)) return;
        const dvec3 way = vertex.position - from.position;
        const double bound = 1 / (settings_.clampDistance * settings_.clampDistance);
        const double cosines = from.cosine(direction) * vertex.cosine(-direction);
        const double missing =
            cosines > 0 ? std::max(0.0, 1 - bound * glm::dot(way, way) / cosines) : 0;
        weights_.throughput *= missing;
        if (weights_.throughput == dvec3(0)) return;
        gatherLights(vertex);
        if (history_.count() < 3) continue;
        const double chance = std::clamp(maximumOf(weights_.carried()), kLeastSurvival, 1.0);
        if (!(sampler.random() < chance)) return;
        weights_.throughput /= chance;
    }
}

/// Light of all vertices of the walk, with the geometry term held at the bound.
void InstantRadiosity::gatherWalk(const Vertex& vertex) {
    const double least = settings_.clampDistance * settings_.clampDistance;
    for (const WalkVertex& source : walk_) {
        const dvec3 way = source.position - vertex.position;
        const double squared = glm::dot(way, way);
        if (!(squared > 0)) continue;
        const double distance = std::sqrt(squared);
        const dvec3 direction = way / distance;
        const dvec3 intensity = source.intensity(-direction);
        const dvec3 scattered = vertex.onSurface() ? vertex.bsdf->evaluate(direction)
                                                   : mediumPoint_.phase(vertex.before, direction);
        if (intensity == dvec3(0) || scattered == dvec3(0)) continue;
        const double cosines =
            vertex.cosine(direction) *
            (source.medium ? 1.0 : glm::dot(source.point.surface.geometricNormal, -direction));
        if (!(cosines > 0)) continue;
        const Ray shadow = vertex.rayTowards(direction);
        // Just before the surface that the light lies on.
        double room = distance;
        if (!source.medium)
            room -= std::min(
                2 * source.point.margin /
                    std::max(0.01, glm::dot(source.point.surface.geometricNormal, -direction)),
                0.5 * distance);
        ++counts_.shadowRays;
        if (scene_.surfaces->occluded(shadow, room, sampler_->bits())) continue;
        const dvec3 through = transmittance(*scene_.media, {vertex.position, direction}, distance,
                                            TransmittanceMode::Ratio, *sampler_);
        PathHistory history = history_;
        history.add(source.medium ? Scattering::Medium : Scattering::Surface);
        if (source.scatterings > 1) history.add(Scattering::Surface); // only their number matters
        // min(G, b) / G of 1/d²
        const double perArea = 1 / std::max(squared, cosines * least);
        see(history, weights_.carried() * scattered * intensity * through * perArea);
    }
}

/// Light that comes straight from a light: no vertex of a walk stands for it.
void InstantRadiosity::gatherLights(const Vertex& vertex) {
    scene_.lights->choose(vertex.position, true, choice_);
    if (choice_.empty()) return;
    double u = sampler_->next1();
    const size_t light = Lights::pick(choice_, u);
    const AimedSample aimed = scene_.lights->aim(light, vertex.position, u, sampler_->next2());
    if (!aimed.valid()) return;
    const dvec3 scattered = vertex.onSurface() ? vertex.bsdf->evaluate(aimed.direction)
                                               : mediumPoint_.phase(vertex.before, aimed.direction);
    if (scattered == dvec3(0)) return;
    const Ray shadow = vertex.rayTowards(aimed.direction);
    ++counts_.shadowRays;
    if (aimed.shadowed && scene_.surfaces->occluded(shadow, aimed.distance, sampler_->bits()))
        return;
    const dvec3 through = transmittance(*scene_.media, {vertex.position, aimed.direction},
                                        aimed.distance, TransmittanceMode::Ratio, *sampler_);
    see(history_, weights_.carried() * scattered * aimed.radiance * through /
                      (aimed.density * choice_.chance(light)));
}

} // namespace tyndall::reference
