#pragma once
// A segment of a path in the media: bounds and estimates for sampling points on it, free flight along it,
// and its transmittance.

#include <vector>

#include "tracing/media_field.h"
#include "tracing/sampler.h"

namespace tyndall::tracing {

/// A path's weight under spectral multiple importance sampling: decisions follow one channel, the hero, drawn evenly for
/// each path. What channel c carries is throughput[c] / meanOf(ratio): all three channels could have drawn this
/// path, and the balance heuristic counts them all (Wilkie et al. 2014; Miller, Georgiev and Jarosz 2019).
struct PathWeights {
    dvec3 throughput{1}; // f / p(hero), for each channel
    dvec3 ratio{1};      // p(channel) / p(hero)
    int hero = 0;
    [[nodiscard]] dvec3 carried() const { return throughput / meanOf(ratio); }
    void scale(const dvec3& f,
               const dvec3& p) { // an event of contribution f that channel c draws with density p
        throughput *= f / p[hero];
        ratio *= p / p[hero];
    }
};

/// The media at one point: their coefficients added, their phase functions mixed in proportion to scattering.
class MediumPoint {
public:
    void clear();
    void add(const MediumSource& medium, double density);

    dvec3 scattering{0}, extinction{0}; // per metre

    /// Per steradian and channel; `before` and `after` are directions of travel.
    [[nodiscard]] dvec3 phase(const dvec3& before, const dvec3& after) const;
    /// One of the media there, drawn in proportion to its scattering of the hero; `share` becomes, by channel, its part of the scattering over the
    /// probability of that choice. CHECKs that something scatters.
    [[nodiscard]] const MediumSource& pick(int hero, double u, dvec3& share) const;

    /// A direction of travel drawn from the hero's mixture.
    [[nodiscard]] dvec3 samplePhase(int hero, const dvec3& before, double choice,
                                    const dvec2& u) const;

private:
    struct Part {
        const MediumSource* medium;
        double density;
    };
    std::vector<Part> parts_;
};

/// How transmittance through a grid is estimated.
enum class TransmittanceMode {
    Exact = 0, // cell by cell, no noise
    Ratio = 1, // residual ratio tracking against each brick's mean: unbiased
};

/// A part of a segment in which each medium's density has one bound.
struct SegmentPiece {
    double begin = 0, end = 0;
    dvec3 majorant{0}; // extinction bound, emission's share included, per metre
    double estimate = 0; // mean extinction, per metre, of a channel that is the mean of all three
    double depthBefore = 0; // of that channel, from the segment's start
    bool uniform = false;   // the densities are the same throughout
    uint32_t firstPart = 0, partCount = 0;
};

/// Emission collected on the way, with the path's weights.
struct EmittedLight {
    dvec3 position{0};
    dvec3 light{0};
};

class MediaSegment {
public:
    explicit MediaSegment(const MediaField& media) : media_(media) {}

    /// Starts over with the ray from 0 to `length`, which may be infinite.
    void start(const Ray& ray, double length);

    struct Flight {
        bool collided = false;
        double distance = 0;
    };
    /// Flies until the first real collision or the end, with null collisions. `emitted` becomes the emission on the way.
    /// At a collision `point` holds the media there, and the weights include their scattering.
    Flight fly(Sampler& sampler, PathWeights& weights, MediumPoint& point,
               std::vector<EmittedLight>& emitted);

    /// Draws a distance in about the distribution of free flight's collisions, up to an optical depth of kDeepest.
    struct Draw {
        double distance = 0;
        double density = 0; // per metre; 0: there is no medium on the segment
    };
    [[nodiscard]] Draw drawCollision(double u);
    /// Of drawCollision choosing `t`.
    [[nodiscard]] double collisionDensity(double t);
    /// An estimate of the density with which fly() collides at `t`: deterministic, and close to that density on average.
    [[nodiscard]] double flightDensity(double t);
    /// Where drawCollision draws.
    [[nodiscard]] Interval reach();
    /// The estimated probability of a collision within reach().
    [[nodiscard]] double collisionChance();

    static constexpr double kDeepest = 7;

private:
    struct Part {
        const MediumSource* medium;
        double density; // where it is the same throughout the piece; else -1
    };
    bool extend();        // by one piece; false at the end
    void extendToReach(); // until kDeepest
    void addEmissionMajorants(SegmentPiece& piece) const;
    const SegmentPiece* pieceAt(double t);
    void densitiesAt(const SegmentPiece& piece, double t, MediumPoint& point,
                     dvec3& emission) const;

    const MediaField& media_;
    Ray ray_;
    double length_ = 0, position_ = 0, depth_ = 0;
    bool ended_ = true;
    std::vector<MediumWalk> walks_;
    std::vector<SegmentPiece> pieces_;
    std::vector<Part> parts_; // of all pieces
};

/// Transmittance, per channel, of all media along [0,length] of the ray.
[[nodiscard]] dvec3 transmittance(const MediaField& media, const Ray& ray, double length,
                                  TransmittanceMode mode, Sampler& sampler);

} // namespace tyndall::tracing
