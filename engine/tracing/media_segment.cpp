#include "tracing/media_segment.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace tyndall::tracing {

void MediumPoint::clear() {
    scattering = extinction = dvec3(0);
    parts_.clear();
}

void MediumPoint::add(const MediumSource& medium, double density) {
    extinction += density * medium.extinction;
    if (!(density > 0) || medium.scattering == dvec3(0)) return;
    scattering += density * medium.scattering;
    parts_.push_back({&medium, density});
}

dvec3 MediumPoint::phase(const dvec3& before, const dvec3& after) const {
    const dvec3 apart = after - before;
    const double oneMinusCosine = 0.5 * glm::dot(apart, apart);
    if (parts_.size() == 1) return dvec3(parts_[0].medium->phaseValue(oneMinusCosine));
    dvec3 sum(0);
    for (const Part& part : parts_)
        sum += part.density * part.medium->scattering * part.medium->phaseValue(oneMinusCosine);
    for (int c = 0; c < 3; ++c) sum[c] = scattering[c] > 0 ? sum[c] / scattering[c] : 0;
    return sum;
}

const MediumSource& MediumPoint::pick(int hero, double u, dvec3& share) const {
    CHECK(!parts_.empty(), "nothing scatters here");
    share = dvec3(1);
    if (parts_.size() == 1) return *parts_[0].medium;
    const Part* chosen = nullptr;
    double target = u * scattering[hero], chance = 0;
    for (const Part& part : parts_) {
        const double weight = part.density * part.medium->scattering[hero];
        if (!(weight > 0)) continue;
        chosen = &part;
        chance = weight / scattering[hero];
        if (target < weight) break;
        target -= weight;
    }
    CHECK(chosen != nullptr, "nothing scatters the hero here");
    for (int c = 0; c < 3; ++c)
        share[c] = scattering[c] > 0
                       ? chosen->density * chosen->medium->scattering[c] / scattering[c] / chance
                       : 0;
    return *chosen->medium;
}

dvec3 MediumPoint::samplePhase(int hero, const dvec3& before, double choice, const dvec2& u) const {
    const Part* chosen = &parts_.back();
    if (parts_.size() > 1) {
        double target = choice * scattering[hero];
        for (const Part& part : parts_) {
            const double weight = part.density * part.medium->scattering[hero];
            if (!(weight > 0)) continue;
            chosen = &part;
            if (target < weight) break;
            target -= weight;
        }
    }
    const double cosine = std::clamp(chosen->medium->samplePhase(u.x), -1.0, 1.0);
    return glm::normalize(Frame(before).toWorld(directionAround(cosine, u.y)));
}

void MediaSegment::start(const Ray& ray, double length) {
    ray_ = ray;
    length_ = length;
    position_ = depth_ = 0;
    walks_.clear();
    pieces_.clear();
    parts_.clear();
    for (const MediumSource& medium : media_.media()) {
        const Interval inside = medium.clip(ray, length);
        if (!inside.empty()) walks_.emplace_back(medium, ray, inside);
    }
    ended_ = walks_.empty();
}

bool MediaSegment::extend() {
    while (!ended_) {
        SegmentPiece piece;
        piece.begin = position_;
        double stop = length_;
        bool left = false;
        piece.uniform = true;
        piece.firstPart = uint32_t(parts_.size());
        for (MediumWalk& walk : walks_) {
            while (!walk.done() && walk.end() <= position_) walk.next();
            if (walk.done()) continue;
            left = true;
            if (walk.begin() > position_) {
                stop = std::min(stop, walk.begin());
                continue;
            }
            stop = std::min(stop, walk.end());
            if (!(walk.maximum() > 0)) continue;
            const MediumSource& medium = walk.medium();
            piece.majorant += walk.maximum() * medium.extinction;
            piece.estimate += walk.mean() * meanOf(medium.extinction);
            const bool constant = walk.minimum() == walk.maximum();
            piece.uniform = piece.uniform && constant && !medium.emits();
            parts_.push_back({&medium, constant ? walk.maximum() : -1});
        }
        if (!left || !(stop > position_)) {
            ended_ = ended_ || !left || position_ >= length_;
            if (ended_) break;
            position_ =
                std::nextafter(position_, kInfinity); // a piece without length: on to the next
            continue;
        }
        position_ = stop;
        piece.end = stop;
        piece.partCount = uint32_t(parts_.size()) - piece.firstPart;
        if (piece.partCount == 0) continue; // empty space
        addEmissionMajorants(piece);
        piece.depthBefore = depth_;
        if (piece.estimate > 0) depth_ += piece.estimate * (piece.end - piece.begin);
        pieces_.push_back(piece);
        return true;
    }
    return false;
}

void MediaSegment::addEmissionMajorants(SegmentPiece& piece) const {
    for (uint32_t i = 0; i < piece.partCount; ++i) {
        const MediumSource& medium = *parts_[piece.firstPart + i].medium;
        // An endless medium that glows without extinction would emit without limit: it stays dark.
        const bool ends = std::isfinite(piece.end) ||
                          std::min({piece.majorant.x, piece.majorant.y, piece.majorant.z}) > 0;
        if (medium.emits() && ends) piece.majorant += dvec3(medium.emissionMajorant());
    }
}

void MediaSegment::densitiesAt(const SegmentPiece& piece, double t, MediumPoint& point,
                               dvec3& emission) const {
    const dvec3 position = ray_.at(t);
    point.clear();
    emission = dvec3(0);
    for (uint32_t i = 0; i < piece.partCount; ++i) {
        const Part& part = parts_[piece.firstPart + i];
        const MediumSource& medium = *part.medium;
        const double density = part.density >= 0 ? part.density : medium.density(position);
        point.add(medium, density);
        if (medium.emits()) emission += medium.emitted(position, density);
    }
}

MediaSegment::Flight MediaSegment::fly(Sampler& sampler, PathWeights& weights, MediumPoint& point,
                                       std::vector<EmittedLight>& emitted) {
    emitted.clear();
    const bool grey = media_.grey();
    const int hero = weights.hero;
    double depth =
        -std::log1p(-sampler.next1()); // of the hero, left until the next tentative collision
    // The hero's attenuation is in the density of this collision; differences of channels are in PathWeights::ratio.
    const auto attenuate = [&](const dvec3& majorant, double distance) {
        if (grey) return;
        for (int c = 0; c < 3; ++c) {
            if (majorant[c] == majorant[hero]) continue;
            const double factor = std::exp(-(majorant[c] - majorant[hero]) * distance);
            weights.throughput[c] *= factor;
            weights.ratio[c] *= factor;
        }
    };
    for (size_t i = 0; i < pieces_.size() || extend(); ++i) {
        const SegmentPiece piece = pieces_[i];
        double t = piece.begin;
        for (;;) {
            const double rate = piece.majorant[hero], reach = rate * (piece.end - t);
            if (!(depth < reach)) {
                attenuate(piece.majorant, piece.end - t);
                depth -= reach;
                break;
            }
            const double distance = depth / rate;
            t += distance;
            attenuate(piece.majorant, distance);
            dvec3 emission;
            densitiesAt(piece, t, point, emission);
            if (emission != dvec3(0))
                emitted.push_back({ray_.at(t), weights.throughput * (emission / rate) /
                                                   meanOf(weights.ratio * piece.majorant / rate)});
            // Rounding may take a density over its bound by some 10⁻¹⁶ of it.
            const dvec3 empty = glm::max(piece.majorant - point.extinction, dvec3(0));
            const double real = point.extinction[hero] / (point.extinction[hero] + empty[hero]);
            if (piece.uniform || sampler.random() < real) {
                weights.scale(point.scattering, point.extinction);
                return {true, t};
            }
            if (!grey) weights.scale(empty, empty);
            depth = -std::log1p(-sampler.random());
        }
    }
    return {false, length_};
}

void MediaSegment::extendToReach() {
    while (depth_ < kDeepest && extend()) {
    }
}

Interval MediaSegment::reach() {
    extendToReach();
    if (pieces_.empty()) return {};
    Interval result{pieces_.front().begin, pieces_.back().end};
    const SegmentPiece& last = pieces_.back();
    if (depth_ > kDeepest && last.depthBefore < kDeepest)
        result.end = std::min(last.end, last.begin + (kDeepest - last.depthBefore) / last.estimate);
    return result;
}

double MediaSegment::collisionChance() {
    extendToReach();
    return -std::expm1(-std::min(depth_, kDeepest));
}

const SegmentPiece* MediaSegment::pieceAt(double t) {
    while ((pieces_.empty() || pieces_.back().end < t) && extend()) {
    }
    const auto after = std::upper_bound(
        pieces_.begin(), pieces_.end(), t,
        [](double value, const SegmentPiece& piece) { return value < piece.begin; });
    if (after == pieces_.begin()) return nullptr;
    const SegmentPiece& piece = *std::prev(after);
    return t <= piece.end ? &piece : nullptr;
}

double MediaSegment::flightDensity(double t) {
    const SegmentPiece* piece = pieceAt(t);
    if (!piece) return 0;
    return piece->estimate * std::exp(-(piece->depthBefore + piece->estimate * (t - piece->begin)));
}

double MediaSegment::collisionDensity(double t) {
    const double chance = collisionChance();
    if (!(chance > 0)) return 0;
    const SegmentPiece* piece = pieceAt(t);
    if (!piece) return 0;
    const double depth = piece->depthBefore + piece->estimate * (t - piece->begin);
    return depth <= kDeepest ? piece->estimate * std::exp(-depth) / chance : 0;
}

MediaSegment::Draw MediaSegment::drawCollision(double u) {
    const double chance = collisionChance();
    if (!(chance > 0)) return {};
    const double target = -std::log1p(-u * chance);
    auto piece =
        std::upper_bound(pieces_.begin(), pieces_.end(), target,
                         [](double value, const SegmentPiece& p) { return value < p.depthBefore; });
    if (piece != pieces_.begin()) --piece;
    while (!(piece->estimate > 0) && piece != pieces_.begin()) --piece;
    if (!(piece->estimate > 0)) return {};
    const double t = std::clamp(piece->begin + (target - piece->depthBefore) / piece->estimate,
                                piece->begin, piece->end);
    return {t, collisionDensity(t)};
}

namespace {

/// Residual ratio tracking (Novák et al. 2014) with each brick's mean as control.
dvec3 ratioTransmittance(const MediumSource& medium, const Ray& ray, Interval interval,
                         Sampler& sampler) {
    dvec3 weight(1);
    double control = 0; // ∫ of the means
    const double strongest = maximumOf(medium.extinction);
    for (MediumWalk walk(medium, ray, interval); !walk.done(); walk.next()) {
        const double mean = walk.mean();
        control += mean * (walk.end() - walk.begin());
        const double rate = strongest * std::max(walk.maximum() - mean, mean - walk.minimum());
        if (!(rate > 0)) continue;
        for (double t = walk.begin();;) {
            t += -std::log1p(-sampler.random()) / rate;
            if (!(t < walk.end())) break;
            weight *= 1.0 - medium.extinction * ((walk.density(t) - mean) / rate);
        }
    }
    return weight * glm::exp(-medium.extinction * control);
}

} // namespace

dvec3 transmittance(const MediaField& media, const Ray& ray, double length, TransmittanceMode mode,
                    Sampler& sampler) {
    dvec3 result(1);
    dvec3 depth(0);
    for (const MediumSource& medium : media.media()) {
        if (medium.extinction == dvec3(0)) continue;
        const Interval inside = medium.clip(ray, length);
        if (inside.empty()) continue;
        if (medium.isGrid() && mode == TransmittanceMode::Ratio) {
            result *= ratioTransmittance(medium, ray, inside, sampler);
            continue;
        }
        const double integral = medium.densityIntegral(ray, inside);
        for (int c = 0; c < 3; ++c)
            if (medium.extinction[c] > 0) depth[c] += medium.extinction[c] * integral;
    }
    return result * glm::exp(-depth);
}

} // namespace tyndall::tracing
