#include "reference/light_emission.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tyndall::reference {
namespace {

dvec3 uniformDirection(const dvec2& u) { return directionAround(1 - 2 * u.x, u.y); }

/// Of light from infinity, so much goes to the content, where that is smaller than all there is.
constexpr double kToContent = 0.9;

} // namespace

LightEmission::LightEmission(const TracerScene& scene, const Bounds& content) : scene_(scene) {
    Bounds bounds = scene.surfaces->bounds();
    for (const MediumSource& medium : scene.media->media()) bounds.include(medium.bounds());
    const auto ballAround = [](const Bounds& box) {
        return box.empty() ? Ball{} : Ball{box.centre(), 0.5 * glm::length(box.extent())};
    };
    whole_ = ballAround(bounds);
    content_ = content.empty() ? whole_ : ballAround(content);
    const Lights& lights = *scene.lights;
    const auto add = [this](double power) { sums_.push_back(sums_.back() + std::max(0.0, power)); };
    for (const LightSource& lamp : lights.lamps()) add(lamp.power(content_.discArea()));
    add(lights.emittedPower());
    add(lights.environment().black()
            ? 0
            : 4 * kPi * lights.environment().meanLuminance() * content_.discArea());
    add(lights.glow().black() ? 0 : 4 * kPi * lights.glow().intensity());
}

bool LightEmission::Ball::inDisc(const dvec3& position, const dvec3& direction) const {
    const dvec3 off = position - centre;
    const dvec3 across = off - glm::dot(off, direction) * direction;
    return glm::dot(across, across) <= radius * radius;
}

/// From a disc across `direction` outside of the ball around everything.
Ray LightEmission::fromInfinity(const dvec3& direction, double choice, const dvec2& u,
                                double& area) const {
    const bool aimed = content_.radius < whole_.radius;
    const Ball& ball = aimed && choice < kToContent ? content_ : whole_;
    const double r = ball.radius * std::sqrt(u.x), angle = 2 * kPi * u.y;
    dvec3 position =
        ball.centre + Frame(direction).toWorld({r * std::cos(angle), r * std::sin(angle), 0});
    double density = 0;
    for (const auto& [part, of] : {std::pair{aimed ? kToContent : 0.0, &content_},
                                   std::pair{aimed ? 1 - kToContent : 1.0, &whole_}})
        if (part > 0 && of->radius > 0 && of->inDisc(position, direction))
            density += part / of->discArea();
    area = density > 0 ? 1 / density : 0;
    position -= (glm::dot(position - whole_.centre, direction) + whole_.radius) * direction;
    return {position, direction};
}

EmittedRay LightEmission::sample(Sampler& sampler) const {
    EmittedRay out;
    if (black()) return out;
    const dvec2 choice = sampler.next2(), where = sampler.next2(), way = sampler.next2();
    const double target = choice.x * sums_.back();
    size_t light = size_t(std::upper_bound(sums_.begin(), sums_.end(), target) - sums_.begin());
    light = std::clamp<size_t>(light, 1, sums_.size() - 1) - 1;
    while (light > 0 && !(sums_[light + 1] > sums_[light])) --light; // never one without power
    const double chance = (sums_[light + 1] - sums_[light]) / sums_.back();

    const Lights& lights = *scene_.lights;
    double area = 0;
    if (light < lights.lamps().size()) {
        const LightSource& lamp = lights.lamps()[light];
        if (lamp.local()) {
            out = lamp.emit(where, way);
        } else {
            const LightSample sun = lamp.sample(whole_.centre, way);
            out.ray = fromInfinity(-sun.direction, choice.y, where, area);
            if (sun.density > 0) out.power = sun.radiance * (area / sun.density);
            out.distant = true;
        }
    } else if (light == lights.trianglesIndex()) {
        out = lights.emitFromTriangle(choice.y, where, way);
    } else if (light == lights.environmentIndex()) {
        const DirectionSample sky = lights.environment().sample(way);
        out.ray = fromInfinity(-sky.direction, choice.y, where, area);
        if (sky.density > 0) out.power = sky.radiance * (area / sky.density);
        out.distant = true;
    } else {
        const GlowSample glow = lights.glow().sample(choice.y, where);
        out.ray = {glow.position, uniformDirection(way)};
        if (glow.density > 0) out.power = glow.emission * (4 * kPi / glow.density);
    }
    out.power /= chance;
    if (out.distant && out.power != dvec3(0)) {
        const Ray back{out.ray.origin, -out.ray.direction};
        out.power *=
            transmittance(*scene_.media, back, kInfinity, TransmittanceMode::Exact, sampler);
    }
    return out;
}

} // namespace tyndall::reference
