#include "reference/simple_path_tracer.h"

#include <cmath>

namespace tyndall::reference {
namespace {

struct Collision {
    double distance = kInfinity;
    const MediumSource* scatterer = nullptr; // null: absorbed
    double emitted = 0;                      // nits, on the way
};

/// Woodcock's free flight against one bound for each medium: among all media the earliest real collision counts.
Collision fly(const MediaField& media, const Ray& ray, double length, int c, Sampler& sampler) {
    Collision first;
    first.distance = length;
    for (const MediumSource& medium : media.media()) {
        const Interval inside = medium.clip(ray, length);
        if (inside.empty()) continue;
        const double majorant = medium.densestBound() * medium.extinction[c];
        if (!(majorant > 0)) continue;
        for (double t = inside.begin;;) {
            t += -std::log1p(-sampler.random()) / majorant;
            if (!(t < std::min(inside.end, first.distance))) break;
            const double density = medium.density(ray.at(t));
            if (!(sampler.random() * medium.densestBound() < density)) continue;
            const bool scattered = sampler.random() * medium.extinction[c] < medium.scattering[c];
            first.distance = t;
            first.scatterer = scattered ? &medium : nullptr;
            break;
        }
    }
    // What glows before the collision: points spread evenly at random over each medium's part of the way.
    for (const MediumSource& medium : media.media()) {
        if (!medium.emits()) continue;
        const Interval inside = medium.clip(ray, first.distance);
        if (inside.empty() || std::isinf(inside.end)) continue;
        const double rate = medium.emissionMajorant();
        for (double t = inside.begin;;) {
            t += -std::log1p(-sampler.random()) / rate;
            if (!(t < inside.end)) break;
            const dvec3 position = ray.at(t);
            first.emitted += medium.emitted(position, medium.density(position))[c] / rate;
        }
    }
    return first;
}

} // namespace

void SimplePathTracer::trace(const CameraRays::CameraRay& start, Sampler& sampler,
                             TermLight& light) const {
    for (int c = 0; c < 3; ++c) traceChannel(c, start, sampler, light);
}

void SimplePathTracer::traceChannel(int c, const CameraRays::CameraRay& start, Sampler& sampler,
                                    TermLight& light) const {
    Ray ray = start.ray;
    double nearest = start.nearest;
    PathHistory history;
    const auto see = [&](double nits) { light.terms[size_t(history.term())][c] += nits; };
    double weight =
        1; // stays 1 but for surfaces that reflect more than they receive in one direction
    for (;;) {
        const RayKind kind = history.count() == 0 ? RayKind::Camera : RayKind::Path;
        const RayHit hit =
            scene_.surfaces->intersect(ray, nearest, kInfinity, kind, sampler.bits());
        const Collision collision = fly(*scene_.media, ray, hit.distance, c, sampler);
        const bool collided = collision.distance < hit.distance;
        see(weight * collision.emitted);
        if (history.count() > 0) // lamps are not seen directly
            for (const LightSource& lamp : scene_.lights->lamps()) {
                const LampSample met = lamp.meet(ray);
                if (met.density > 0 &&
                    (met.distance < collision.distance || (!collided && !hit.found())))
                    see(weight * met.radiance[c]);
            }
        if (collided) {
            if (!collision.scatterer || history.count() == settings_.maxScatterings) return;
            history.add(Scattering::Medium);
            const double cosine = collision.scatterer->samplePhase(sampler.random());
            ray = {ray.at(collision.distance),
                   glm::normalize(
                       Frame(ray.direction).toWorld(directionAround(cosine, sampler.random())))};
        } else if (!hit.found()) {
            see(weight * scene_.lights->environment().radiance(ray.direction)[c]);
            return;
        } else {
            const SurfacePoint point = scene_.surfaces->pointAt(ray, hit);
            if (!point.unlit || history.count() == 0) see(weight * point.emission[c]);
            if (point.unlit || history.count() == settings_.maxScatterings) return;
            history.add(Scattering::Surface);
            const double z = std::sqrt(1 - sampler.random());
            const dvec3 direction = glm::normalize(
                Frame(point.surface.normal).toWorld(directionAround(z, sampler.random())));
            // Cosine-weighted: what is left of the weight is π·BSDF.
            const double reflected =
                Bsdf(point.surface, -ray.direction).evaluate(direction)[c] * kPi / z;
            const double survival = std::min(1.0, reflected);
            if (!(sampler.random() < survival)) return;
            weight *= reflected / survival;
            ray = rayFrom(point, direction);
        }
        nearest = 0;
    }
}

} // namespace tyndall::reference
