#include "reference/volume_path_tracer.h"

#include <algorithm>
#include <cmath>

#include "core/sampling.h"

namespace tyndall::reference {
namespace {

/// Paths are ended by chance once they carry less than this, and raised to it when they go on.
constexpr double kRouletteWeight = 0.25;
constexpr double kLeastSurvival = 0.05;
/// From so many scatterings on, all paths are ended by chance, whatever they carry.
constexpr int kLongPath = 1000;
/// Behind the first segment, the chance of next-event estimation from a segment is so many times what it scatters of the path, but not
/// less than that.
/// Measured on fog in a box: 4 needs a tenth less time for an error than 2 or 8.
constexpr double kSamplesPerScattering = 4;
constexpr double kLeastSegmentChance = 0.1;

} // namespace

VolumePathTracer::VolumePathTracer(const TracerScene& scene, const PathSettings& settings)
    : scene_(scene), settings_(settings), segment_(*scene.media) {
    const int longest = longestPath(settings_.terms);
    if (longest >= 0 && (settings_.maxScatterings < 0 || longest < settings_.maxScatterings))
        settings_.maxScatterings = longest;
}

void VolumePathTracer::see(Term term, const dvec3& light) {
    if (!(settings_.terms & bit(term))) return;
    if (counts_.takes(light)) light_->add(term, light);
}

void VolumePathTracer::trace(const CameraRays::CameraRay& start, Sampler& sampler,
                             TermLight& light) {
    ++counts_.paths;
    sampler_ = &sampler;
    light_ = &light;
    weights_ = {};
    if (!scene_.media->grey()) weights_.hero = std::min(2, int(3 * sampler.next1()));
    history_ = {};
    origin_ = {};
    const bool hasMedia = !scene_.media->empty();
    Ray ray = start.ray;
    double nearest = start.nearest;
    for (;; nearest = 0) {
        ++counts_.segments;
        const RayKind kind = history_.count() == 0 ? RayKind::Camera : RayKind::Path;
        const RayHit hit =
            scene_.surfaces->intersect(ray, nearest, kInfinity, kind, sampler.bits());
        MediaSegment::Flight flight{false, hit.distance};
        const bool last = history_.count() == settings_.maxScatterings;
        segmentChance_ = 0;
        if (hasMedia) {
            segment_.start(ray, hit.distance);
            if (!last) sampleLightFromSegment(ray);
            if (!origin_.camera) meetLamps(ray, hit.distance);
            flight = segment_.fly(sampler, weights_, point_, emitted_);
            meetGlow();
        } else if (!origin_.camera) {
            meetLamps(ray, hit.distance);
        }
        if (flight.collided) {
            if (last || weights_.throughput == dvec3(0)) return;
            scatterInMedium(flight.distance, ray);
        } else if (!hit.found()) {
            meetEnvironment(ray);
            return;
        } else {
            const SurfacePoint point = scene_.surfaces->pointAt(ray, hit);
            meetEmitter(point);
            if (last || point.unlit) return;
            scatterAtSurface(point, ray);
        }
        if (weights_.throughput == dvec3(0) || !survives()) return;
        if (history_.count() >= PathSettings::kLongest) {
            ++counts_.cutOff;
            return;
        }
    }
}

bool VolumePathTracer::survives() {
    const double carried = maximumOf(weights_.carried());
    if (!(carried > 0)) return false;
    double survival = 1;
    if (carried < kRouletteWeight && history_.count() >= 3)
        survival = std::max(carried / kRouletteWeight, kLeastSurvival);
    // Matter that absorbs nothing may hold a path for ever. The part that is still followed falls as 1/n, so weights
    // grow as n at most.
    if (history_.count() >= kLongPath)
        survival *= double(history_.count()) / double(history_.count() + 1);
    if (survival == 1) return true;
    if (!(sampler_->random() < survival)) return false;
    weights_.throughput /= survival;
    return true;
}

dvec3 VolumePathTracer::arriving(const LightSample& sample, const Ray& ray) {
    ++counts_.shadowRays;
    if (sample.shadowed && scene_.surfaces->occluded(ray, sample.distance, sampler_->bits()))
        return dvec3(0);
    if (scene_.media->empty()) return sample.radiance;
    return sample.radiance *
           transmittance(*scene_.media, ray, sample.distance, settings_.transmittance, *sampler_);
}

// --- Surfaces.

void VolumePathTracer::scatterAtSurface(const SurfacePoint& point, Ray& ray) {
    const dvec3 before = ray.direction;
    history_.add(Scattering::Surface);
    const Bsdf bsdf(point.surface, -before);
    fromPoint_.clear();
    if (settings_.nextEventEstimation) sampleLightFromSurface(point, bsdf);
    const double choice = sampler_->next1();
    const BsdfSample sample = bsdf.sample(choice, sampler_->next2());
    weights_.throughput *= sample.weight;
    origin_ = {};
    origin_.camera = false;
    origin_.directionDensity = sample.density;
    origin_.position = point.position;
    ray = rayFrom(point, sample.direction);
}

void VolumePathTracer::sampleLightFromSurface(const SurfacePoint& point, const Bsdf& bsdf) {
    scene_.lights->choose(point.position, false, fromPoint_);
    if (fromPoint_.empty()) return;
    double u = sampler_->next1();
    const size_t light = Lights::pick(fromPoint_, u);
    const LightSample sample = scene_.lights->sample(light, point.position, u, sampler_->next2());
    if (!sample.valid()) return;
    // The shadow ray starts off the surface. It still ends at the sampled point, or a glowing triangle would shadow itself.
    Ray shadow = rayFrom(point, sample.direction);
    LightSample way = sample;
    if (std::isfinite(sample.distance)) {
        const dvec3 rest = point.position + sample.distance * sample.direction - shadow.origin;
        way.distance = glm::length(rest);
        if (way.distance > 0) shadow.direction = rest / way.distance;
    }
    const dvec3 reflected = bsdf.evaluate(sample.direction);
    if (!(maximumOf(reflected) > 0)) return;
    const double density = sample.density * fromPoint_.chance(light);
    const double met = sample.delta ? 0 : bsdf.density(sample.direction) * sample.pointsPerMetre;
    const dvec3 light3 = arriving(way, shadow);
    see(history_.term(), weights_.carried() * reflected * light3 / (density + met));
}

// --- Media.

void VolumePathTracer::scatterInMedium(double distance, Ray& ray) {
    const dvec3 before = ray.direction, position = ray.at(distance);
    history_.add(Scattering::Medium);
    Origin next;
    next.camera = false;
    next.inMedium = true;
    next.position = position;
    next.segment = ray;
    next.distance = distance;
    next.flightDensity = segment_.flightDensity(distance);
    next.chanceFromSegment = segmentChance_;
    if (segmentChance_ > 0) {
        next.reach = reach_;
        next.collisionDensity = segment_.collisionDensity(distance);
        std::swap(fromSegment_, alongSegment_);
    }
    origin_ = next;
    fromPoint_.clear();
    if (settings_.nextEventEstimation) sampleLightFromCollision(position, before);
    const double choice = sampler_->next1();
    const dvec3 after = point_.samplePhase(weights_.hero, before, choice, sampler_->next2());
    const dvec3 density = point_.phase(before, after);
    // MIS needs any density that all techniques can evaluate: the mean over the channels.
    origin_.directionDensity = meanOf(density);
    weights_.scale(density, density);
    ray = {position, after};
}

void VolumePathTracer::sampleLightFromCollision(const dvec3& position, const dvec3& before) {
    scene_.lights->choose(position, false, fromPoint_);
    if (fromPoint_.empty()) return;
    double u = sampler_->next1();
    const size_t light = Lights::pick(fromPoint_, u);
    const LightSample sample = scene_.lights->sample(light, position, u, sampler_->next2());
    if (!sample.valid()) return;
    const dvec3 phase = point_.phase(before, sample.direction);
    const double density = sample.density * fromPoint_.chance(light);
    double met = 0;
    if (!sample.delta) met = meanOf(phase) * sample.pointsPerMetre;
    double drawn = 0; // by sampleLightFromSegment, in units of flightDensity
    if (origin_.chanceFromSegment > 0 && origin_.flightDensity > 0)
        drawn = sample.density * origin_.chanceFromSegment * fromSegment_.chance(light) *
                distanceDensity(light, origin_.segment, origin_.reach, origin_.distance,
                                origin_.collisionDensity) /
                origin_.flightDensity;
    const double weight = density / (density + met + drawn);
    const dvec3 light3 = arriving(sample, {position, sample.direction});
    see(history_.term(), weights_.carried() * phase * light3 * (weight / density));
}

/// Per metre, of the place that sampleLightFromSegment draws for this light.
double VolumePathTracer::distanceDensity(size_t light, const Ray& ray, Interval reach, double t,
                                         double collisionDensity) const {
    const auto& lamps = scene_.lights->lamps();
    if (light >= lamps.size() || !lamps[light].local()) return collisionDensity;
    if (!(t >= reach.begin && t <= reach.end)) return 0;
    const dvec3 start = ray.at(reach.begin);
    const double nearest = glm::dot(lamps[light].centre() - start, ray.direction);
    const double height = glm::length(lamps[light].centre() - start - nearest * ray.direction);
    return equiangularDensity(t - reach.begin, nearest, height, reach.end - reach.begin);
}

/// Whether this path samples a light from its present segment; sets reach_, alongSegment_ and segmentChance_.
bool VolumePathTracer::decideToSampleFromSegment(const Ray& ray) {
    if (!settings_.nextEventFromSegments || !settings_.nextEventEstimation ||
        !scene_.media->scatters())
        return false;
    reach_ = segment_.reach();
    if (reach_.empty() || !std::isfinite(reach_.end)) return false;
    scene_.lights->chooseAlong({ray.at(reach_.begin), ray.direction}, reach_.end - reach_.begin,
                               alongSegment_);
    if (alongSegment_.empty()) return false;
    segmentChance_ = history_.count() == 0
                         ? 1
                         : std::clamp(kSamplesPerScattering * segment_.collisionChance() *
                                          maximumOf(weights_.carried()),
                                      kLeastSegmentChance, 1.0);
    return segmentChance_ == 1 || sampler_->random() < segmentChance_;
}

/// Where along the segment that light is sampled from; distanceDensity() has its density.
double VolumePathTracer::placeToSampleFrom(size_t light, const Ray& ray, double u) {
    const auto& lamps = scene_.lights->lamps();
    if (light >= lamps.size() || !lamps[light].local()) return segment_.drawCollision(u).distance;
    const dvec3 start = ray.at(reach_.begin);
    const double nearest = glm::dot(lamps[light].centre() - start, ray.direction);
    const double height = glm::length(lamps[light].centre() - start - nearest * ray.direction);
    return reach_.begin + sampleEquiangular(u, nearest, height, reach_.end - reach_.begin).distance;
}

/// Samples a light from a point of the segment, where segmentPoint_ is.
VolumePathTracer::SegmentSample VolumePathTracer::sampleLightFrom(const dvec3& position,
                                                                  const Ray& ray, size_t light,
                                                                  double u, const dvec2& w) {
    SegmentSample result;
    LightSample& sample = result.sample;
    const EnvironmentSource& environment = scene_.lights->environment();
    if (light == scene_.lights->environmentIndex() && environment.constant()) {
        // Light from all around: the phase function is the best to draw from.
        sample.direction = segmentPoint_.samplePhase(weights_.hero, ray.direction, u, w);
        result.phase = segmentPoint_.phase(ray.direction, sample.direction);
        sample.distance = kInfinity;
        sample.radiance = environment.radiance(sample.direction);
        sample.density = result.met = meanOf(result.phase);
        // The hero draws it; all heroes together, as likely as their channels' paths, draw it with this density.
        result.drawnAs =
            meanOf(weights_.ratio * result.phase) / (meanOf(weights_.ratio) * result.met);
        return result;
    }
    sample = scene_.lights->sample(light, position, u, w);
    if (!sample.valid()) return result;
    result.phase = segmentPoint_.phase(ray.direction, sample.direction);
    result.met = sample.delta ? 0 : meanOf(result.phase) * sample.pointsPerMetre;
    scene_.lights->choose(position, false, fromCollision_);
    result.collided = sample.density * fromCollision_.chance(light);
    return result;
}

void VolumePathTracer::sampleLightFromSegment(const Ray& ray) {
    if (!decideToSampleFromSegment(ray)) return;
    double u = sampler_->next1();
    const double v = sampler_->next1();
    const dvec2 w = sampler_->next2();
    const size_t light = Lights::pick(alongSegment_, u);
    const double t = placeToSampleFrom(light, ray, v);
    const double distance = distanceDensity(light, ray, reach_, t, segment_.collisionDensity(t));
    if (!(distance > 0)) return;
    const dvec3 position = ray.at(t);
    segmentPoint_.clear();
    for (const MediumSource& medium : scene_.media->media())
        segmentPoint_.add(medium, medium.density(position));
    if (segmentPoint_.scattering == dvec3(0)) return;
    const SegmentSample way = sampleLightFrom(position, ray, light, u, w);
    if (!way.sample.valid()) return;
    const double density =
        way.sample.density * distance * segmentChance_ * alongSegment_.chance(light);
    const double others = segment_.flightDensity(t) * (way.met + way.collided);
    const dvec3 toHere = transmittance(*scene_.media, ray, t, settings_.transmittance, *sampler_);
    const dvec3 light3 = arriving(way.sample, {position, way.sample.direction});
    see(history_.termAfter(Scattering::Medium), weights_.carried() * toHere *
                                                    segmentPoint_.scattering * way.phase * light3 /
                                                    ((density + others) * way.drawnAs));
}

// --- Light met by chance.

double VolumePathTracer::nextEventDensity(size_t light, double density) const {
    if (!settings_.nextEventEstimation || density <= 0) return 0;
    double sum =
        fromPoint_.empty() ? 0 : fromPoint_.chance(light) * density * origin_.flightDensity;
    if (origin_.inMedium && origin_.chanceFromSegment > 0)
        sum += density * origin_.chanceFromSegment * fromSegment_.chance(light) *
               distanceDensity(light, origin_.segment, origin_.reach, origin_.distance,
                               origin_.collisionDensity);
    return sum;
}

/// Balance heuristic (Veach 1997, section 9.2) of light met by the direction drawn, against next-event estimation from its origin.
double VolumePathTracer::misWeight(size_t light, double density, double pointsPerMetre) const {
    const double own = origin_.directionDensity * origin_.flightDensity * pointsPerMetre;
    const double others = nextEventDensity(light, density);
    if (!(others > 0)) return 1;
    return own > 0 ? own / (own + others) : 0;
}

// Lamps let rays pass. What comes from one is not left to whether the flight gets there: its expectation is as easily computed.
void VolumePathTracer::meetLamps(const Ray& ray, double end) {
    const auto& lamps = scene_.lights->lamps();
    for (size_t i = 0; i < lamps.size(); ++i) {
        if (lamps[i].delta()) continue;
        const LampSample met = lamps[i].meet(ray);
        if (!(met.density > 0) || !(met.distance < end || std::isinf(end))) continue;
        const dvec3 through =
            transmittance(*scene_.media, ray, met.distance, settings_.transmittance, *sampler_);
        see(history_.term(),
            weights_.carried() * through * met.radiance * misWeight(i, met.density));
    }
}

void VolumePathTracer::meetEnvironment(const Ray& ray) {
    const EnvironmentSource& environment = scene_.lights->environment();
    if (environment.black()) return;
    double weight = 1;
    if (!origin_.camera) {
        double density = environment.density(ray.direction);
        // Next-event estimation draws it from the phase function, see sampleLightFrom().
        if (environment.constant() && origin_.inMedium) density = origin_.directionDensity;
        if (!environment.constant() || origin_.inMedium)
            weight = misWeight(scene_.lights->environmentIndex(), density);
    }
    see(history_.term(), weights_.carried() * environment.radiance(ray.direction) * weight);
}

void VolumePathTracer::meetGlow() {
    const GlowSource& glow = scene_.lights->glow();
    dvec3 sum(0);
    for (const EmittedLight& emitted : emitted_) {
        double weight = 1;
        if (!origin_.camera && !glow.black()) {
            const dvec3 way = emitted.position - origin_.position;
            weight = misWeight(scene_.lights->glowIndex(),
                               glow.density(emitted.position) * glm::dot(way, way),
                               glow.pointsPerMetre());
        }
        sum += weight * emitted.light;
    }
    if (sum != dvec3(0)) see(history_.term(), sum);
}

void VolumePathTracer::meetEmitter(const SurfacePoint& point) {
    if (point.emission == dvec3(0) || (point.unlit && !origin_.camera)) return;
    double weight = 1;
    if (!origin_.camera && point.emitter != MeshInstance::kNoEmitter)
        weight = misWeight(
            scene_.lights->trianglesIndex(),
            scene_.lights->emitterDensity(point.emitter, origin_.position, point.position));
    see(history_.term(), weights_.carried() * point.emission * weight);
}

} // namespace tyndall::reference
