#include "tracing/lights.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace tyndall::tracing {
namespace {

/// Estimates ignore shadows and media, so each light keeps this part of the probability.
constexpr double kEvenPart = 0.1;

dvec3 corner(const MeshInstance& instance, uint32_t triangle, size_t i) {
    return dvec3(instance.positions[instance.mesh->indices[3 * size_t(triangle) + i]]);
}

dvec3 doubledArea(const MeshInstance& instance, uint32_t triangle) {
    const dvec3 a = corner(instance, triangle, 0);
    return glm::cross(corner(instance, triangle, 1) - a, corner(instance, triangle, 2) - a);
}

/// Of a light of this power that fills a box, as seen from a point: softened inside and close by.
double boxImportance(double power, const Bounds& box, const dvec3& from, double softening2) {
    const dvec3 nearest = glm::clamp(from, box.minimum, box.maximum), half = 0.5 * box.extent();
    const double near2 = glm::dot(nearest - from, nearest - from);
    return power / std::max(near2 + 0.25 * glm::dot(half, half) + softening2, 1e-30);
}

} // namespace

Lights::Lights(const Scene& scene, const dvec3& origin, SurfaceScene& surfaces,
               const MediaField& media)
    : environment_(scene.environment), glow_(media.media()), surfaces_(surfaces) {
    const std::vector<dmat4> world = scene.worldTransforms();
    const std::vector<bool> visible = scene.worldVisibility();
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        if (!visible[i] || scene.nodes[i].light == kNone) continue;
        dmat4 rayFromNode = world[i];
        rayFromNode[3] -= dvec4(origin, 0);
        const LightSource lamp(scene.lights[size_t(scene.nodes[i].light)], rayFromNode);
        if (!lamp.black()) lamps_.push_back(lamp);
    }
    collectEmitters(surfaces);
}

void Lights::collectEmitters(SurfaceScene& surfaces) {
    auto& instances = surfaces.mutableInstances();
    for (uint32_t i = 0; i < instances.size(); ++i) {
        MeshInstance& instance = instances[i];
        if (instance.material->unlit) continue; // shows a colour, lights nothing
        const double brightest = surfaces.materials().brightestEmission(*instance.material);
        if (!(brightest > 0) || !std::isfinite(brightest)) continue;
        instance.firstEmitter = uint32_t(emitters_.size());
        const uint32_t triangles = uint32_t(instance.mesh->indices.size() / 3);
        for (uint32_t triangle = 0; triangle < triangles; ++triangle) {
            const double area = 0.5 * glm::length(doubledArea(instance, triangle));
            const double sides = instance.material->doubleSided ? 2 : 1;
            emitters_.push_back({i, triangle});
            emitterSums_.push_back(emitterSums_.back() + area * brightest * sides);
            for (size_t c = 0; c < 3; ++c) emitterBounds_.include(corner(instance, triangle, c));
        }
    }
}

bool Lights::black() const {
    return lamps_.empty() && !(emitterSums_.back() > 0) && environment_.black() && glow_.black();
}

void Lights::choose(const dvec3& from, bool constantEnvironment, LightChoice& choice) const {
    choice.weights_.assign(count(), 0);
    for (size_t i = 0; i < lamps_.size(); ++i) choice.weights_[i] = lamps_[i].importance(from);
    if (emitterSums_.back() > 0)
        choice.weights_[trianglesIndex()] =
            boxImportance(emitterSums_.back(), emitterBounds_, from, 0);
    if (!glow_.black())
        choice.weights_[glowIndex()] = boxImportance(glow_.intensity(), glow_.bounds(), from, 0);
    if (!environment_.black() && (constantEnvironment || !environment_.constant()))
        choice.weights_[environmentIndex()] = kPi * environment_.meanLuminance();
    double sum = 0;
    size_t lit = 0;
    for (const double weight : choice.weights_) {
        sum += weight;
        lit += weight > 0;
    }
    // A lamp may light this point although its estimate is 0 (a spot's ball): all lamps keep some probability.
    const size_t kept = std::max<size_t>(lit, lamps_.size());
    if (kept == 0) {
        choice.total_ = 0;
        return;
    }
    const double even = sum > 0 ? kEvenPart * sum / double(kept) : 1;
    choice.total_ = 0;
    for (size_t i = 0; i < choice.weights_.size(); ++i) {
        if (i < lamps_.size() || choice.weights_[i] > 0) choice.weights_[i] += even;
        choice.total_ += choice.weights_[i];
    }
}

void Lights::chooseAlong(const Ray& ray, double length, LightChoice& choice) const {
    choice.weights_.assign(count(), 0);
    for (size_t i = 0; i < lamps_.size(); ++i)
        choice.weights_[i] = lamps_[i].importanceAlong(ray, length);
    const dvec3 middle = ray.at(0.5 * length);
    const double softening2 = 0.25 * length * length;
    if (emitterSums_.back() > 0)
        choice.weights_[trianglesIndex()] =
            length * boxImportance(emitterSums_.back(), emitterBounds_, middle, softening2);
    if (!glow_.black())
        choice.weights_[glowIndex()] =
            length * boxImportance(glow_.intensity(), glow_.bounds(), middle, softening2);
    if (!environment_.black())
        choice.weights_[environmentIndex()] = kPi * environment_.meanLuminance() * length;
    double sum = 0;
    size_t lit = 0;
    for (const double weight : choice.weights_) {
        sum += weight;
        lit += weight > 0;
    }
    choice.total_ = 0;
    for (double& weight : choice.weights_) {
        if (weight > 0) weight += kEvenPart * sum / double(lit);
        choice.total_ += weight;
    }
}

size_t Lights::pick(const LightChoice& choice, double& u) {
    double target = u * choice.total_;
    size_t last = 0;
    for (size_t i = 0; i < choice.weights_.size(); ++i) {
        if (!(choice.weights_[i] > 0)) continue;
        last = i;
        if (target < choice.weights_[i]) break;
        target -= choice.weights_[i];
    }
    u = std::clamp(target / choice.weights_[last], 0.0, 0x1.fffffffffffffp-1);
    return last;
}

LightSample Lights::sample(size_t light, const dvec3& from, double u0, const dvec2& u) const {
    LightSample result;
    if (light < lamps_.size()) {
        static_cast<LampSample&>(result) = lamps_[light].sample(from, u);
        result.delta = lamps_[light].delta() || !lamps_[light].castsShadows();
        result.shadowed = lamps_[light].castsShadows();
    } else if (light == trianglesIndex()) {
        result = sampleTriangle(from, u0, u);
    } else if (light == glowIndex()) {
        result = sampleGlow(from, u0, u);
    } else {
        const DirectionSample sample = environment_.sample(u);
        result.direction = sample.direction;
        result.distance = kInfinity;
        result.radiance = sample.radiance;
        result.density = sample.density;
    }
    return result;
}

LightSample Lights::sampleGlow(const dvec3& from, double u0, const dvec2& u) const {
    LightSample result;
    const GlowSample sample = glow_.sample(u0, u);
    const dvec3 way = sample.position - from;
    const double squared = glm::dot(way, way);
    if (!(squared > 0)) return result;
    result.distance = std::sqrt(squared);
    result.direction = way / result.distance;
    result.radiance = sample.emission;
    result.density = sample.density * squared;
    result.pointsPerMetre = glow_.pointsPerMetre();
    return result;
}

Lights::PointOfTriangle Lights::pickPoint(double u0, const dvec2& u) const {
    PointOfTriangle point;
    const double target = u0 * emitterSums_.back();
    const size_t i = size_t(std::upper_bound(emitterSums_.begin(), emitterSums_.end(), target) -
                            emitterSums_.begin());
    point.emitter = std::clamp<size_t>(i, 1, emitters_.size()) - 1;
    const Emitter& emitter = emitters_[point.emitter];
    const MeshInstance& instance = surfaces_.instances()[emitter.instance];
    const double root = std::sqrt(u.x);
    point.hit.instance = emitter.instance;
    point.hit.triangle = emitter.triangle;
    point.hit.u = root * (1 - u.y);
    point.hit.v = root * u.y;
    point.position = (1 - root) * corner(instance, emitter.triangle, 0) +
                     point.hit.u * corner(instance, emitter.triangle, 1) +
                     point.hit.v * corner(instance, emitter.triangle, 2);
    return point;
}

EmittedRay Lights::emitFromTriangle(double u0, const dvec2& where, const dvec2& way) const {
    CHECK(!emitters_.empty(), "no triangle glows");
    const PointOfTriangle from = pickPoint(u0, where);
    const Emitter& emitter = emitters_[from.emitter];
    const MeshInstance& instance = surfaces_.instances()[emitter.instance];
    const dvec3 doubled = doubledArea(instance, emitter.triangle);
    const double area = 0.5 * glm::length(doubled);
    EmittedRay out;
    if (!(area > 0)) return out;
    dvec3 normal = doubled * ((instance.mirrored ? -0.5 : 0.5) / area);
    dvec2 u = way;
    const double sides = instance.material->doubleSided ? 2 : 1;
    if (sides > 1) { // one number chooses the side and, rescaled, the direction
        if (u.x >= 0.5) normal = -normal;
        u.x = std::min(2 * (u.x >= 0.5 ? u.x - 0.5 : u.x), 0x1.fffffffffffffp-1);
    }
    const dvec3 direction =
        glm::normalize(Frame(normal).toWorld(directionAround(std::sqrt(1 - u.x), u.y)));
    const SurfacePoint point = surfaces_.pointAt({from.position + normal, -normal}, from.hit);
    const double chance =
        (emitterSums_[from.emitter + 1] - emitterSums_[from.emitter]) / emitterSums_.back();
    out.ray = rayFrom(point, direction);
    out.power = point.emission *
                surfaces_.coverageAt(from.hit.instance, from.hit.triangle, from.hit.u, from.hit.v) *
                (kPi * area * sides / chance);
    return out;
}

LightSample Lights::sampleTriangle(const dvec3& from, double u0, const dvec2& u) const {
    LightSample result;
    if (emitters_.empty()) return result;
    const auto [i, hit, at] = pickPoint(u0, u);
    const dvec3 way = at - from;
    const double distance = glm::length(way);
    if (!(distance > 0)) return result;
    const Ray ray{from, way / distance};
    const SurfacePoint point = surfaces_.pointAt(ray, hit);
    const double coverage = surfaces_.coverageAt(hit.instance, hit.triangle, hit.u, hit.v);
    result.direction = ray.direction;
    // Just before the triangle, which must not shadow itself.
    const double cosine = std::abs(glm::dot(point.surface.geometricNormal, ray.direction));
    result.distance =
        distance - std::min(2 * point.margin / std::max(cosine, 0.01), 0.5 * distance);
    result.radiance = point.emission * coverage;
    result.density = emitterDensity(uint32_t(i), from, at);
    return result;
}

double Lights::emitterDensity(uint32_t emitter, const dvec3& from, const dvec3& at) const {
    const MeshInstance& instance = surfaces_.instances()[emitters_[emitter].instance];
    const dvec3 doubled = doubledArea(instance, emitters_[emitter].triangle), way = at - from;
    const double squared = glm::dot(way, way);
    // probability / area · distance² / cosine, with the projected area |doubled · way| / 2 / distance
    const double seen = 0.5 * std::abs(glm::dot(doubled, way)) / std::sqrt(squared);
    const double chance = (emitterSums_[emitter + 1] - emitterSums_[emitter]) / emitterSums_.back();
    return seen > 0 ? chance * squared / seen : 0;
}

} // namespace tyndall::tracing
