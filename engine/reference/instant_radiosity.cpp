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
/// Also between surfaces that absorb nothing, with a bound so wide that it takes away all.
constexpr double kMostSurvival = 0.95;
/// Of the distance to a surface that an eye ray passes: on from behind it.
constexpr double kPassed = 1e-6;

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

double InstantRadiosity::scaleAt(const dvec3& position) const {
    return std::max(1.0, glm::length(position - settings_.middle) / settings_.radius);
}

InstantRadiosity::Reach InstantRadiosity::reachAt(const dvec3& position) const {
    const double reach = settings_.clampDistance * scaleAt(position);
    return {reach, reach};
}

/// For light that a path's first vertex receives.
InstantRadiosity::Reach InstantRadiosity::reachElsewhere(const Vertex& vertex) const {
    const double scale = scaleAt(vertex.position);
    const HeldElsewhere& held = settings_.elsewhere;
    if (vertex.onSurface()) return {scale * held.betweenSurfaces, scale * held.ofMedia};
    const double reach = std::min(scale * held.ofMedia, 1 / maximumOf(mediumPoint_.extinction));
    return {std::min(scale * held.fromSurfacesToMedia, reach), reach};
}

/// A path's first random numbers: which channel it follows.
void InstantRadiosity::begin(Sampler& sampler, TermLight& light) {
    ++counts_.paths;
    sampler_ = &sampler;
    light_ = &light;
    history_ = {};
    weights_ = {};
}

void InstantRadiosity::traceWalk() {
    walker_.trace(*sampler_, walk_);
    for (WalkVertex& vertex : walk_)
        vertex.point.surface.roughness =
            std::max(vertex.point.surface.roughness, settings_.leastRoughness);
}

/// The vertex where a ray meets a surface.
void InstantRadiosity::enter(const Ray& ray, const RayHit& hit, Vertex& vertex) const {
    vertex.before = ray.direction;
    vertex.point = scene_.surfaces->pointAt(ray, hit);
    Surface& surface = vertex.point.surface;
    surface.roughness = std::max(surface.roughness, settings_.leastRoughness);
    vertex.position = vertex.point.position;
    vertex.bsdf.emplace(surface, -ray.direction);
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
    if (flight.collided) {
        vertex.before = ray.direction;
        vertex.bsdf.reset();
        vertex.position = ray.at(flight.distance);
        history_.add(Scattering::Medium);
        return true;
    }
    enter(ray, hit, vertex);
    if (vertex.point.unlit) return false;
    history_.add(Scattering::Surface);
    return true;
}

/// On to where light comes from that is too near to be left to virtual lights, with the part of it that the bound takes away. False where there is none.
bool InstantRadiosity::nearVertex(Vertex& vertex, const Reach& reach) {
    const double u = sampler_->next1();
    dvec3 direction;
    if (vertex.onSurface()) {
        const BsdfSample sample = vertex.bsdf->sample(u, sampler_->next2());
        weights_.throughput *= sample.weight;
        direction = sample.direction;
    } else {
        direction = mediumPoint_.samplePhase(weights_.hero, vertex.before, u, sampler_->next2());
        const dvec3 density = mediumPoint_.phase(vertex.before, direction);
        weights_.scale(density, density);
    }
    if (weights_.throughput == dvec3(0)) return false;
    const Vertex from = vertex;
    Ray ray = from.rayTowards(direction);
    if (!nextVertex(ray, 0, RayKind::Path, vertex)) return false;
    const dvec3 way = vertex.position - from.position;
    const double held = vertex.onSurface() ? reach.ofSurfaces : reach.ofMedia;
    const double cosines = from.cosine(direction) * vertex.cosine(-direction);
    const double missing =
        cosines > 0 ? std::max(0.0, 1 - glm::dot(way, way) / (held * held * cosines)) : 0;
    weights_.throughput *= missing;
    return weights_.throughput != dvec3(0);
}

bool InstantRadiosity::survives() {
    if (history_.count() < 3) return true;
    const double chance = std::clamp(maximumOf(weights_.carried()), kLeastSurvival, kMostSurvival);
    if (!(sampler_->random() < chance)) return false;
    weights_.throughput /= chance;
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
    begin(sampler, light);
    traceWalk();
    if (!scene_.media->grey()) weights_.hero = std::min(2, int(3 * sampler.next1()));
    Ray ray = start.ray;
    Vertex vertex;
    if (!nextVertex(ray, start.nearest, RayKind::Camera, vertex)) return;
    gatherWalk(vertex);
    if (!settings_.compensate || !(settings_.clampDistance > 0)) return;
    while (nearVertex(vertex, reachAt(vertex.position))) {
        gatherLights(vertex);
        if (!survives()) return;
        gatherWalk(vertex);
    }
}

/// Of the surface where an eye ray ends.
RayHit InstantRadiosity::opaqueHit(const CameraRays::CameraRay& start) {
    RayHit hit;
    double nearest = start.nearest;
    do {
        hit = scene_.surfaces->intersect(start.ray, nearest, kInfinity, RayKind::Camera,
                                         sampler_->bits());
        nearest = hit.distance * (1 + kPassed);
    } while (hit.found() &&
             scene_.surfaces->instances()[hit.instance].material->alphaMode == AlphaMode::Blend);
    return hit;
}

/// On from a path's first vertex, to where nobody else has gathered.
void InstantRadiosity::followMissed(Vertex& vertex) {
    const Reach reach = reachElsewhere(vertex);
    if (!nearVertex(vertex, reach)) return;
    if (!vertex.onSurface()) {
        // What is scattered there once, and what virtual lights bring within the relaxed bound, is gathered elsewhere.
        const HeldElsewhere& held = settings_.elsewhere;
        const double relaxed = reach.ofMedia / held.relaxed;
        const double ofSurfaces = scaleAt(vertex.position) * held.fromSurfacesToMedia;
        if (!nearVertex(vertex, {std::min(ofSurfaces, relaxed), relaxed}) || !survives()) return;
    }
    traceWalk();
    do {
        gatherLights(vertex);
        if (!survives()) return;
        gatherWalk(vertex);
    } while (nearVertex(vertex, reachAt(vertex.position)));
}

const Surface* InstantRadiosity::traceMissedOnSurface(const CameraRays::CameraRay& start,
                                                      Sampler& sampler, TermLight& light) {
    begin(sampler, light);
    if (!scene_.media->grey()) weights_.hero = std::min(2, int(3 * sampler.next1()));
    const RayHit hit = opaqueHit(start);
    if (!hit.found()) return nullptr;
    Vertex vertex;
    enter(start.ray, hit, vertex);
    if (vertex.point.unlit) return nullptr;
    seen_ = vertex.point.surface;
    history_.add(Scattering::Surface);
    followMissed(vertex);
    return &seen_;
}

void InstantRadiosity::traceMissedInMedia(const CameraRays::CameraRay& start, Sampler& sampler,
                                          TermLight& light) {
    begin(sampler, light);
    if (!scene_.media->grey()) weights_.hero = std::min(2, int(3 * sampler.next1()));
    segment_.start(start.ray, opaqueHit(start).distance);
    const auto flight = segment_.fly(sampler, weights_, mediumPoint_, emitted_);
    if (!flight.collided || weights_.throughput == dvec3(0)) return;
    Vertex vertex;
    vertex.before = start.ray.direction;
    vertex.position = start.ray.at(flight.distance);
    history_.add(Scattering::Medium);
    followMissed(vertex);
}

/// Light of all vertices of the walk, with the geometry term held at the bound.
void InstantRadiosity::gatherWalk(const Vertex& vertex) {
    const double distanceHeld = settings_.clampDistance * scaleAt(vertex.position),
                 least = distanceHeld * distanceHeld;
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
