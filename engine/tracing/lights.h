#pragma once
// All light of a scene: lamps, glowing triangles, the environment, glowing media; and which of them to sample.

#include <vector>

#include "tracing/environment_source.h"
#include "tracing/glow_source.h"
#include "tracing/light_source.h"
#include "tracing/surface_scene.h"

namespace tyndall::tracing {

/// A sample of any kind of light. In Lights::sample() `density` does not include the probability of choosing that light.
struct LightSample : LampSample {
    bool delta = false;   // no ray hits it
    bool shadowed = true; // surfaces block it
    /// Of glowing media: radiance is per metre, density per steradian and metre, and a ray that passes collects at this many points a metre.
    double pointsPerMetre = 1;
    bool valid() const { return density > 0 && maximumOf(radiance) > 0; }
};

/// How likely each light is to be sampled, from a point or from along a piece of a ray.
class LightChoice {
public:
    /// Of light number `light`; 0 if there is no light at all.
    [[nodiscard]] double chance(size_t light) const {
        return total_ > 0 ? weights_[light] / total_ : 0;
    }
    [[nodiscard]] bool empty() const { return !(total_ > 0); }
    void clear() { total_ = 0; }

private:
    friend class Lights;
    std::vector<double> weights_;
    double total_ = 0;
};

class Lights {
public:
    /// Marks the instances' emitting triangles in `surfaces`; it and `media` must outlive this. `origin` as in SurfaceScene::build.
    Lights(const Scene& scene, const dvec3& origin, SurfaceScene& surfaces,
           const MediaField& media);

    /// Lamps first, then the glowing triangles as one, then the environment, then all glowing media as one.
    [[nodiscard]] size_t count() const { return lamps_.size() + 3; }
    [[nodiscard]] const std::vector<LightSource>& lamps() const { return lamps_; }
    [[nodiscard]] size_t trianglesIndex() const { return lamps_.size(); }
    [[nodiscard]] size_t environmentIndex() const { return lamps_.size() + 1; }
    [[nodiscard]] size_t glowIndex() const { return lamps_.size() + 2; }
    [[nodiscard]] const GlowSource& glow() const { return glow_; }
    [[nodiscard]] const EnvironmentSource& environment() const { return environment_; }
    [[nodiscard]] bool black() const;

    /// From a point. `constantEnvironment`: whether to sample an environment that is the same in all directions.
    void choose(const dvec3& from, bool constantEnvironment, LightChoice& choice) const;
    /// From along [0,length] of the ray, a finite one.
    void chooseAlong(const Ray& ray, double length, LightChoice& choice) const;
    /// Which light `u` picks, and u rescaled for another use.
    [[nodiscard]] static size_t pick(const LightChoice& choice, double& u);
    /// A sample of light number `light` as seen from a point; its density without the probability of that light.
    [[nodiscard]] LightSample sample(size_t light, const dvec3& from, double u0,
                                     const dvec2& u) const;

    /// Watts that all glowing triangles emit, the mean of the channels; an upper bound where textures dim them.
    [[nodiscard]] double emittedPower() const { return kPi * emitterSums_.back(); }
    /// A ray of one of them, drawn by that bound. CHECKs that there are any.
    [[nodiscard]] EmittedRay emitFromTriangle(double u0, const dvec2& where,
                                              const dvec2& way) const;

    /// Density per steradian with which sample() finds this point of a glowing triangle from `from`.
    [[nodiscard]] double emitterDensity(uint32_t emitter, const dvec3& from, const dvec3& at) const;

private:
    struct Emitter {
        uint32_t instance, triangle;
    };
    void collectEmitters(SurfaceScene& surfaces);
    [[nodiscard]] LightSample sampleGlow(const dvec3& from, double u0, const dvec2& u) const;
    /// The triangle that `u` picks, and a point of it.
    struct PointOfTriangle {
        size_t emitter = 0;
        RayHit hit;
        dvec3 position{0};
    };
    [[nodiscard]] PointOfTriangle pickPoint(double u0, const dvec2& u) const;
    [[nodiscard]] LightSample sampleTriangle(const dvec3& from, double u0, const dvec2& u) const;

    std::vector<LightSource> lamps_;
    EnvironmentSource environment_;
    GlowSource glow_;
    const SurfaceScene& surfaces_;
    std::vector<Emitter> emitters_;
    std::vector<double> emitterSums_{0}; // cumulative power, emitters + 1
    Bounds emitterBounds_;
};

} // namespace tyndall::tracing
