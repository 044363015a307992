#include "tracing/virtual_light_path.h"

#include <algorithm>
#include <cmath>

namespace tyndall::tracing {
namespace {

/// Later vertices of a path add little: Russian roulette from the third on.
constexpr double kLeastSurvival = 0.1;
/// Also between surfaces that absorb nothing, with a clamp distance so large that it removes all light.
constexpr double kMostSurvival = 0.95;

} // namespace

double VirtualLightPath::Vertex::cosine(const dvec3& direction) const {
    return onSurface() ? std::max(0.0, glm::dot(point.surface.geometricNormal, direction)) : 1;
}

Ray VirtualLightPath::Vertex::rayTowards(const dvec3& direction) const {
    return onSurface() ? rayFrom(point, direction) : Ray{position, direction};
}

VirtualLightPath::VirtualLightPath(const TracerScene& scene, const LightEmission& emission,
                                   const VirtualLightPathSettings& settings)
    : scene_(scene), settings_(settings), walker_(scene, emission, {}), segment_(*scene.media) {}

PathCounts VirtualLightPath::counts() const {
    PathCounts sum = counts_;
    sum.segments += walker_.rays();
    sum.cutOff += walker_.cutOff();
    return sum;
}

void VirtualLightPath::see(PathHistory history, const dvec3& light) {
    const Term term = history.term();
    if (!(settings_.terms & bit(term))) return;
    if (counts_.takes(light)) light_->add(term, light);
}

double VirtualLightPath::scaleAt(const dvec3& position) const {
    return std::max(1.0, glm::length(position - settings_.middle) / settings_.radius);
}

VirtualLightPath::ClampDistances VirtualLightPath::clampedAt(const dvec3& position) const {
    const double distance = settings_.clampDistance * scaleAt(position);
    return {distance, distance};
}

void VirtualLightPath::begin(Sampler& sampler, TermLight& light) {
    ++counts_.paths;
    sampler_ = &sampler;
    light_ = &light;
    history_ = {};
    weights_ = {};
}

void VirtualLightPath::chooseHero() {
    if (!scene_.media->grey()) weights_.hero = std::min(2, int(3 * sampler_->next1()));
}

void VirtualLightPath::traceWalk() {
    walker_.trace(*sampler_, walk_);
    for (WalkVertex& vertex : walk_)
        vertex.point.surface.roughness =
            std::max(vertex.point.surface.roughness, settings_.leastRoughness);
}

void VirtualLightPath::enterSurface(const Ray& ray, const RayHit& hit, Vertex& vertex) const {
    vertex.before = ray.direction;
    vertex.point = scene_.surfaces->pointAt(ray, hit);
    Surface& surface = vertex.point.surface;
    surface.roughness = std::max(surface.roughness, settings_.leastRoughness);
    vertex.position = vertex.point.position;
    vertex.bsdf.emplace(surface, -ray.direction);
}

bool VirtualLightPath::nextVertexInMedia(const Ray& ray, double distance, Vertex& vertex) {
    segment_.start(ray, distance);
    const MediaSegment::Flight flight =
        segment_.fly(*sampler_, weights_, mediumPoint_, emitted_);
    if (!flight.collided || weights_.throughput == dvec3(0)) return false;
    vertex.before = ray.direction;
    vertex.bsdf.reset();
    vertex.position = ray.at(flight.distance);
    history_.add(Scattering::Medium);
    return true;
}

bool VirtualLightPath::nextVertex(Ray& ray, double nearest, RayKind kind, Vertex& vertex) {
    ++counts_.segments;
    const RayHit hit = scene_.surfaces->intersect(ray, nearest, kInfinity, kind, sampler_->bits());
    if (!scene_.media->empty() && nextVertexInMedia(ray, hit.distance, vertex)) return true;
    if (!hit.found() || weights_.throughput == dvec3(0)) return false;
    enterSurface(ray, hit, vertex);
    if (vertex.point.unlit) return false;
    history_.add(Scattering::Surface);
    return true;
}

bool VirtualLightPath::nearVertex(Vertex& vertex, const ClampDistances& clamped) {
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
    const double within = vertex.onSurface() ? clamped.ofSurfaces : clamped.ofMedia;
    const double cosines = from.cosine(direction) * vertex.cosine(-direction);
    const double missing =
        cosines > 0 ? std::max(0.0, 1 - glm::dot(way, way) / (within * within * cosines)) : 0;
    weights_.throughput *= missing;
    return weights_.throughput != dvec3(0);
}

bool VirtualLightPath::survives() {
    if (history_.count() < 3) return true;
    const double chance = std::clamp(maximumOf(weights_.carried()), kLeastSurvival, kMostSurvival);
    if (!(sampler_->random() < chance)) return false;
    weights_.throughput /= chance;
    return true;
}

void VirtualLightPath::gatherWalk(const Vertex& vertex) {
    const double clamped = settings_.clampDistance * scaleAt(vertex.position),
                 least = clamped * clamped;
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

void VirtualLightPath::gatherLights(const Vertex& vertex) {
    scene_.lights->choose(vertex.position, true, choice_);
    if (choice_.empty()) return;
    double u = sampler_->next1();
    const size_t light = Lights::pick(choice_, u);
    const LightSample sample = scene_.lights->sample(light, vertex.position, u, sampler_->next2());
    if (!sample.valid()) return;
    const dvec3 scattered = vertex.onSurface()
                                ? vertex.bsdf->evaluate(sample.direction)
                                : mediumPoint_.phase(vertex.before, sample.direction);
    if (scattered == dvec3(0)) return;
    const Ray shadow = vertex.rayTowards(sample.direction);
    ++counts_.shadowRays;
    if (sample.shadowed && scene_.surfaces->occluded(shadow, sample.distance, sampler_->bits()))
        return;
    const dvec3 through = transmittance(*scene_.media, {vertex.position, sample.direction},
                                        sample.distance, TransmittanceMode::Ratio, *sampler_);
    see(history_, weights_.carried() * scattered * sample.radiance * through /
                      (sample.density * choice_.chance(light)));
}

} // namespace tyndall::tracing
