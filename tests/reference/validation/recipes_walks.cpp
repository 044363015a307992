// Random walks of the tracer's own free flight and phase functions, without lights: moments, and mean path lengths.

#include <cmath>

#include "validation/recipes.h"
#include "validation/scenes.h"

namespace tyndall::validation {
namespace {

using tracing::MediaSegment;
using tracing::MediumPoint;
using tracing::PathWeights;
using tracing::Ray;
using tracing::Sampler;
using Tracers = std::vector<reference::VolumePathTracer>;

/// A walker in a stage's media.
class Walk {
public:
    Walk(const Stage& stage, const Ray& start, Sampler& sampler)
        : ray_(start), sampler_(sampler), segment_(*stage.traced.media) {}

    /// Flies as far as `length`: did it collide before? It then stands at the collision, not yet turned.
    bool fly(double length) {
        std::vector<tracing::EmittedLight> emitted;
        segment_.start(ray_, length);
        const MediaSegment::Flight flight = segment_.fly(sampler_, weights_, point_, emitted);
        travelled_ += flight.distance;
        if (flight.collided) ray_.origin = ray_.at(flight.distance);
        return flight.collided;
    }
    void turn() {
        const double choice = sampler_.random();
        const dvec2 u(sampler_.random(), sampler_.random());
        ray_.direction = point_.samplePhase(weights_.hero, ray_.direction, choice, u);
    }
    [[nodiscard]] const Ray& ray() const { return ray_; }
    [[nodiscard]] double travelled() const { return travelled_; }
    [[nodiscard]] double carried() const { return weights_.carried().y; }

private:
    Ray ray_;
    Sampler& sampler_;
    MediaSegment segment_;
    MediumPoint point_;
    PathWeights weights_;
    double travelled_ = 0;
};

std::shared_ptr<const Stage> endless(double albedo, double anisotropy) {
    SceneMaker maker;
    maker.addMedium(matter(MediumKind::Everywhere, albedo, anisotropy));
    return Stage::make(maker.take());
}

/// Squared distance from the start after exactly `collisions`.
Recipe meanSquareRecipe(const Row& row) {
    const int collisions = int(*Row::numberAfter(row.tau, "n="));
    Probe probe;
    probe.stage = endless(1, Row::number(row.anisotropy));
    probe.segmentsPerSample = collisions;
    probe.sample = [stage = probe.stage, collisions](Tracers&, Sampler& sampler) {
        Walk walk(*stage, {}, sampler);
        for (int i = 0; i < collisions; ++i) {
            if (i > 0) walk.turn();
            walk.fly(kInfinity);
        }
        return glm::dot(walk.ray().origin, walk.ray().origin);
    };
    return {"a walk of the tracer's free flights and phase function", probe};
}

/// Squared distances weighed by fluence: every collision counts as much as the walk still carries when it gets there.
Recipe fluenceMomentRecipe(const Row& row) {
    const double albedo = Row::number(row.albedo);
    constexpr double kNothing = 1e-10;
    Probe probe;
    probe.stage = endless(albedo, Row::number(row.anisotropy));
    probe.segmentsPerSample = std::log(kNothing) / std::log(albedo);
    probe.sample = [stage = probe.stage, albedo](Tracers&, Sampler& sampler) {
        Walk walk(*stage, {}, sampler);
        double sum = 0;
        for (double carried = 1; carried > kNothing; carried = walk.carried()) {
            walk.fly(kInfinity);
            sum += carried * glm::dot(walk.ray().origin, walk.ray().origin);
            walk.turn();
        }
        return (1 - albedo) * sum;
    };
    return {"a walk of the tracer's free flights and phase function, weighed by what it carries",
            probe};
}

double exponentialIntegral(double x) { return -std::expint(-x); } // E₁

/// What a collision at distance x from the source sends unscattered to all points at distance r from it, on average:
/// ∫ e^-s/(4πs²) over the sphere = (E₁(|r-x|) - E₁(r+x))/(8πrx).
Recipe farFluenceRecipe(const Row& row) {
    const double albedo = Row::number(row.albedo), r = *Row::numberAfter(row.tau, "r=");
    constexpr double kNothing = 1e-9;
    Probe probe;
    probe.stage = endless(albedo, 0);
    probe.segmentsPerSample = 0.3 * std::log(kNothing) / std::log(albedo);
    probe.sample = [stage = probe.stage, r](Tracers&, Sampler& sampler) {
        Walk walk(*stage, {}, sampler);
        double sum = 0;
        for (double carried = 1; carried > kNothing;) {
            walk.fly(kInfinity);
            walk.turn();
            carried = walk.carried(); // less what this collision absorbs
            const double x = glm::length(walk.ray().origin);
            if (x > 0 && x != r)
                sum += carried *
                       (exponentialIntegral(std::abs(r - x)) - exponentialIntegral(r + x)) /
                       (8 * kPi * r * x);
        }
        return sum;
    };
    probe.value = [r](double mean) { return mean + std::exp(-r) / (4 * kPi * r * r); };
    return {"walks of the tracer's free flights from the source on; what each collision sends to "
            "the sphere of radius r, and what the source does, in closed form",
            probe};
}

/// Where a ray from within leaves the cube [-½,½]³.
double exitOf(const Ray& ray) {
    double exit = kInfinity;
    for (int axis = 0; axis < 3; ++axis) {
        const double d = ray.direction[axis], face = d > 0 ? 0.5 : -0.5;
        if (d != 0) exit = std::min(exit, (face - ray.origin[axis]) / d);
    }
    return std::max(exit, 0.0);
}

/// Uniform over the whole surface, cosine-distributed inwards.
Ray intoCube(Sampler& sampler) {
    const dvec2 at = sampler.next2(), u = sampler.next2();
    const int face = std::min(5, int(6 * sampler.next1()));
    const int axis = face / 2;
    const double side = face % 2 == 0 ? 1 : -1;
    Ray ray;
    ray.origin[axis] = -0.5 * side;
    ray.origin[(axis + 1) % 3] = at.x - 0.5;
    ray.origin[(axis + 2) % 3] = at.y - 0.5;
    dvec3 normal(0);
    normal[axis] = side;
    ray.direction = glm::normalize(
        tracing::Frame(normal).toWorld(tracing::directionAround(std::sqrt(1 - u.x), u.y)));
    return ray;
}

Recipe invarianceRecipe() {
    SceneMaker maker;
    Medium smoke = matter(MediumKind::Grid, 1, 0.8), haze = matter(MediumKind::Box, 1, -0.5);
    smoke.density = lumpyGrid(1.4, 40, 11);
    haze.size = dvec3(0.6, 1.2, 1.2);
    maker.addMedium(smoke);
    maker.addMedium(haze, dvec3(-0.25, 0, 0));
    Probe probe;
    probe.stage = Stage::make(maker.take());
    probe.segmentsPerSample = 20;
    probe.sample = [stage = probe.stage](Tracers&, Sampler& sampler) {
        Walk walk(*stage, intoCube(sampler), sampler);
        while (walk.fly(exitOf(walk.ray()))) walk.turn();
        return walk.travelled();
    };
    return {
        "walks into the unit cube, filled with an uneven grid (g 0.8) and half with even matter "
        "(g -0.5), through all of its surface",
        probe};
}

} // namespace

std::optional<Recipe> walkRecipe(const Row& row) {
    if (row.name == "random-walk-msd") return meanSquareRecipe(row);
    if (row.name == "infinite-moment") return fluenceMomentRecipe(row);
    if (row.name == "infinite-point" || row.name == "infinite-point-MC")
        return farFluenceRecipe(row);
    if (row.name == "Blanco-Fournier") return invarianceRecipe();
    return std::nullopt;
}

} // namespace tyndall::validation
