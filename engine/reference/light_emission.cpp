#include "reference/light_emission.h"

#include <algorithm>
#include <cmath>

namespace tyndall::reference {
namespace {

dvec3 uniformDirection(const dvec2& u) { return directionAround(1 - 2 * u.x, u.y); }

/// Of the sphere around a box.
double ballRadius(const Bounds& bounds) {
    return bounds.empty() ? 0 : 0.5 * glm::length(bounds.extent());
}

} // namespace

LightEmission::LightEmission(const TracerScene& scene) : scene_(scene) {
    Bounds bounds = scene.surfaces->bounds();
    for (const MediumSource& medium : scene.media->media()) bounds.include(medium.bounds());
    if (!bounds.empty()) {
        centre_ = bounds.centre();
        radius_ = ballRadius(bounds);
    }
    const Lights& lights = *scene.lights;
    const auto add = [this](double power) { sums_.push_back(sums_.back() + std::max(0.0, power)); };
    for (const LightSource& lamp : lights.lamps()) add(lamp.power(discArea()));
    add(lights.emittedPower());
    add(lights.environment().black() ? 0
                                     : 4 * kPi * lights.environment().meanLuminance() * discArea());
    add(lights.glow().black() ? 0 : 4 * kPi * lights.glow().intensity());
}

/// On a disc across `direction`, outside of the ball.
Ray LightEmission::fromInfinity(const dvec3& direction, const dvec2& u) const {
    const double r = radius_ * std::sqrt(u.x), angle = 2 * kPi * u.y;
    const Frame frame(direction);
    return {centre_ - radius_ * direction +
                frame.toWorld({r * std::cos(angle), r * std::sin(angle), 0}),
            direction};
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
    bool distant = false;
    if (light < lights.lamps().size()) {
        const LightSource& lamp = lights.lamps()[light];
        if (lamp.local()) {
            out = lamp.emit(where, way);
        } else {
            const LightSample sun = lamp.sample(centre_, way);
            out.ray = fromInfinity(-sun.direction, where);
            if (sun.density > 0) out.power = sun.radiance * (discArea() / sun.density);
            distant = true;
        }
    } else if (light == lights.trianglesIndex()) {
        out = lights.emitFromTriangle(choice.y, where, way);
    } else if (light == lights.environmentIndex()) {
        const DirectionSample sky = lights.environment().sample(way);
        out.ray = fromInfinity(-sky.direction, where);
        if (sky.density > 0) out.power = sky.radiance * (discArea() / sky.density);
        distant = true;
    } else {
        const GlowSample glow = lights.glow().sample(choice.y, where);
        out.ray = {glow.position, uniformDirection(way)};
        if (glow.density > 0) out.power = glow.emission * (4 * kPi / glow.density);
    }
    out.power /= chance;
    if (distant && out.power != dvec3(0)) {
        const Ray back{out.ray.origin, -out.ray.direction};
        out.power *=
            transmittance(*scene_.media, back, kInfinity, TransmittanceMode::Exact, sampler);
    }
    return out;
}

} // namespace tyndall::reference
