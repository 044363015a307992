#include "physics/lattice_model.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "shared/lpv.h"

namespace tyndall::test {
namespace {

using volumetric_gi::latticeDirections;
using volumetric_gi::transferFunctions;

/// (1 - e^-x)/x.
double meanTransmittance(double x) { return x < 1e-8 ? 1 - 0.5 * x : -std::expm1(-x) / x; }

} // namespace

LatticeModel::LatticeModel(const ivec3& size, const std::array<bool, 3>& repeats)
    : size_(size), repeats_(repeats), cells_(size_t(size.x) * size_t(size.y) * size_t(size.z)),
      state_(cells_.size()), along_(cells_.size()) {}

size_t LatticeModel::indexOf(const ivec3& at) const {
    CHECK(at.x >= 0 && at.y >= 0 && at.z >= 0 && at.x < size_.x && at.y < size_.y &&
          at.z < size_.z);
    return size_t(at.x) + size_t(size_.x) * (size_t(at.y) + size_t(size_.y) * size_t(at.z));
}

template <typename Visit> void LatticeModel::forEachCell(Visit&& visit) const {
    for (ivec3 at(0); at.z < size_.z; ++at.z)
        for (at.y = 0; at.y < size_.y; ++at.y)
            for (at.x = 0; at.x < size_.x; ++at.x) visit(at);
}

bool LatticeModel::neighbour(const ivec3& at, const ivec3& offset, ivec3& result) const {
    result = at + offset;
    for (int axis = 0; axis < 3; ++axis) {
        if (result[axis] >= 0 && result[axis] < size_[axis]) continue;
        if (!repeats_[size_t(axis)]) return false;
        result[axis] = (result[axis] + size_[axis]) % size_[axis];
    }
    return true;
}

std::array<double, kLatticeDirections> LatticeModel::lobe(const Arrival& state) {
    std::array<double, kLatticeDirections> result{};
    if (!(state.power > 0)) return result;
    // Linear in the cosine while that is nowhere negative; then the part of a line above 0 that has, on the sphere, the same mean.
    const double length = glm::length(state.moment), r = length / state.power;
    const bool linear = r <= 1.0 / 3;
    const double narrow = std::min(r, 0.88);
    dvec3 slope = linear ? 3.0 * state.moment / state.power : state.moment / length;
    double offset = linear ? 1 : 2 - 3 * narrow, sum = 0;
    // Among 26 directions that mean is a little off. Steps of Newton's method, with the directions in use as they are; where the
    // lobe is too narrow, more directions come in, lest it sharpen itself from step to step.
    for (int pass = 0; pass < (linear ? 1 : 3); ++pass) {
        dvec3 moment(0);
        double used = 0;
        sum = 0;
        for (size_t j = 0; j < result.size(); ++j) {
            const auto& d = latticeDirections()[j];
            result[j] = d.weight * std::max(offset + glm::dot(slope, d.unit), 0.0);
            sum += result[j];
            moment += result[j] * d.unit;
            if (result[j] > 0) used += d.weight;
        }
        if (linear || pass == 2) break;
        const dvec3 missing = narrow * sum / length * state.moment - moment;
        slope += 3.0 / used * missing;
        offset += 2 * std::max(-glm::dot(missing, state.moment) / (length * sum), 0.0);
    }
    for (double& value : result) value *= state.power / sum;
    return result;
}

std::array<double, kLatticeDirections> LatticeModel::passing(size_t cell) const {
    const double straight = 1 - double(gpu::kLpvMixed);
    Arrival joins = state_[cell];
    for (size_t j = 0; j < kLatticeDirections; ++j) {
        joins.power -= straight * along_[cell][j];
        joins.moment -= straight * along_[cell][j] * latticeDirections()[j].unit;
    }
    joins.power = std::max(joins.power, 0.0); // rounding
    std::array<double, kLatticeDirections> result = lobe(joins);
    for (size_t j = 0; j < kLatticeDirections; ++j) result[j] += straight * along_[cell][j];
    return result;
}

LatticeModel::Sent LatticeModel::send(size_t index) const {
    const LatticeCell& cell = cells_[index];
    Sent sent;
    const std::array<double, kLatticeDirections> passing = this->passing(index);
    double escape = 0;
    for (size_t j = 0; j < passing.size(); ++j) {
        const auto& d = latticeDirections()[j];
        sent.collided += passing[j] * -std::expm1(-cell.depth * d.length);
        escape += d.weight * meanTransmittance(cell.depth * d.length);
    }
    // All that is sent out from within the cell, with what collides before it is out and is scattered again.
    sent.emitted =
        (cell.emission + cell.albedo * sent.collided) / (1 - cell.albedo + cell.albedo * escape);
    sent.collided += sent.emitted * (1 - escape);
    for (size_t j = 0; j < passing.size(); ++j) {
        const auto& d = latticeDirections()[j];
        const double depth = cell.depth * d.length;
        sent.power[j] =
            passing[j] * std::exp(-depth) + sent.emitted * d.weight * meanTransmittance(depth);
    }
    return sent;
}

LatticeBalance LatticeModel::step() {
    LatticeBalance balance;
    std::vector<Arrival> next(state_.size());
    std::vector<std::array<double, kLatticeDirections>> along(state_.size());
    forEachCell([&](const ivec3& at) {
        const LatticeCell& cell = cells_[indexOf(at)];
        const Sent sent = send(indexOf(at));
        balance.injected += cell.emission + cell.entering.power;
        balance.absorbed += (1 - cell.albedo) * sent.collided;
        // The normal of what stands around the cell, from the directions that it blocks.
        dvec3 normal(0);
        for (size_t j = 0; j < sent.power.size(); ++j)
            if (cell.blocked >> j & 1)
                normal -= latticeDirections()[j].weight * latticeDirections()[j].unit;
        if (glm::length(normal) > 1e-6) normal = glm::normalize(normal);
        Arrival& own = next[indexOf(at)];
        own.power += cell.entering.power;
        own.moment += cell.entering.moment;
        for (size_t j = 0; j < sent.power.size(); ++j) {
            const auto& d = latticeDirections()[j];
            ivec3 target;
            if (cell.blocked >> j & 1) {
                const double reflected = cell.reflectance[j] * sent.power[j];
                balance.blocked += sent.power[j] - reflected;
                own.power += reflected;
                own.moment += reflected * (2.0 / 3) * normal; // Lambert's mean direction
            } else if (neighbour(at, d.offset, target)) {
                next[indexOf(target)].power += sent.power[j];
                next[indexOf(target)].moment += sent.power[j] * d.unit;
                along[indexOf(target)][j] += sent.power[j];
            } else {
                balance.escaped += sent.power[j];
            }
        }
    });
    state_ = std::move(next);
    along_ = std::move(along);
    for (const Arrival& a : state_) balance.stored += a.power;
    return balance;
}

int LatticeModel::settle(double tolerance, int most) {
    for (int i = 1; i <= most; ++i) {
        const std::vector<Arrival> before = state_;
        const LatticeBalance balance = step();
        double change = 0;
        for (size_t c = 0; c < before.size(); ++c)
            change += std::abs(state_[c].power - before[c].power);
        if (change <= tolerance * balance.stored) return i;
    }
    return most;
}

std::vector<Arrival> LatticeModel::tracks() const {
    std::vector<Arrival> result(state_.size());
    for (size_t c = 0; c < state_.size(); ++c) {
        const LatticeCell& cell = cells_[c];
        const std::array<double, kLatticeDirections> passing = this->passing(c);
        const double emitted = send(c).emitted;
        for (size_t j = 0; j < passing.size(); ++j) {
            const auto& d = latticeDirections()[j];
            const double depth = cell.depth * d.length, mean = meanTransmittance(depth);
            // A way that begins anywhere in the cell: ∫ (1 - e^-xu)/x du over u in [0,1].
            const double inside = depth < 1e-4 ? 0.5 - depth / 6 : (1 - mean) / depth;
            const double length = d.length * (passing[j] * mean + emitted * d.weight * inside);
            result[c].power += length;
            result[c].moment += length * d.unit;
        }
    }
    return result;
}

std::array<double, kLatticeDirections> LatticeModel::sends(const ivec3& at) const {
    return send(indexOf(at)).power;
}

std::array<double, 2> LatticeModel::leaving(int axis) const {
    std::array<double, 2> result{};
    forEachCell([&](const ivec3& at) {
        if (at[axis] != 0 && at[axis] != size_[axis] - 1) return;
        const Sent sent = send(indexOf(at));
        for (size_t j = 0; j < sent.power.size(); ++j) {
            const int to = at[axis] + latticeDirections()[j].offset[axis];
            if (to < 0) result[0] += sent.power[j];
            if (to >= size_[axis]) result[1] += sent.power[j];
        }
    });
    return result;
}

PrintedLatticeModel::PrintedLatticeModel(int size, double lambda, double lambdaS)
    : size_(size), lambda_(lambda), lambdaS_(lambdaS),
      state_(size_t(size) * size_t(size) * size_t(size)) {}

void PrintedLatticeModel::step() {
    std::vector<std::array<double, 4>> next(state_.size());
    const double one = 2 * std::sqrt(kPi); // <L|1> over the first coefficient
    for (int z = 0; z < size_; ++z)
        for (int y = 0; y < size_; ++y)
            for (int x = 0; x < size_; ++x) {
                const auto& from = state_[size_t(x + size_ * (y + size_ * z))];
                for (size_t j = 0; j < kLatticeDirections; ++j) {
                    const auto& t = transferFunctions()[j];
                    const ivec3 to =
                        (ivec3(x, y, z) + latticeDirections()[j].offset + size_) % size_;
                    double value = 0;
                    for (size_t k = 0; k < 4; ++k) value += from[k] * t.harmonics[k];
                    value = (1 - lambda_) * value + t.printedShare * lambdaS_ * one * from[0];
                    auto& target = next[size_t(to.x + size_ * (to.y + size_ * to.z))];
                    for (size_t k = 0; k < 4; ++k) target[k] += value * t.harmonics[k];
                }
            }
    state_ = std::move(next);
}

double PrintedLatticeModel::power() const {
    double sum = 0;
    for (const auto& cell : state_) sum += 2 * std::sqrt(kPi) * cell[0];
    return sum;
}

} // namespace tyndall::test
