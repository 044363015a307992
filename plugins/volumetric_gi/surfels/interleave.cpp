#include "volumetric_gi/surfels/interleave.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "shared/surfels.h"

namespace tyndall::volumetric_gi {
namespace {

/// Points set in a tile that repeats, and how crowded each place is by them.
class Crowd {
public:
    explicit Crowd(uint32_t side) : side_(side), set_(side * side), crowded_(side * side) {
        constexpr double kSigma = 1.5; // as in the paper
        kernel_.resize(side * side);
        for (uint32_t y = 0; y < side; ++y)
            for (uint32_t x = 0; x < side; ++x) {
                const double dx = std::min(x, side - x), dy = std::min(y, side - y);
                kernel_[y * side + x] = std::exp(-(dx * dx + dy * dy) / (2 * kSigma * kSigma));
            }
    }
    void change(uint32_t place, bool on) {
        set_[place] = on;
        const uint32_t px = place % side_, py = place / side_;
        for (uint32_t y = 0; y < side_; ++y)
            for (uint32_t x = 0; x < side_; ++x)
                crowded_[y * side_ + x] +=
                    (on ? 1 : -1) * kernel_[(y + side_ - py) % side_ * side_ + (x + side_ - px) % side_];
    }
    /// The most crowded of the set places, or the least crowded of the others.
    [[nodiscard]] uint32_t extreme(bool ofSet) const {
        uint32_t best = ~0u;
        for (uint32_t i = 0; i < set_.size(); ++i) {
            if (set_[i] != ofSet) continue;
            if (best == ~0u || (ofSet ? crowded_[i] > crowded_[best] : crowded_[i] < crowded_[best]))
                best = i;
        }
        return best;
    }
    [[nodiscard]] bool isSet(uint32_t place) const { return set_[place]; }

private:
    uint32_t side_;
    std::vector<bool> set_;
    std::vector<double> crowded_, kernel_;
};

/// A tenth of all places, spread until the most crowded one is also the emptiest when it is taken away.
Crowd startingPoints(uint32_t side, uint32_t& count) {
    Crowd crowd(side);
    count = std::max(side * side / 10, 1u);
    uint32_t state = 1;
    for (uint32_t made = 0; made < count;) {
        state = state * 1664525u + 1013904223u; // Numerical Recipes
        const uint32_t place = (state >> 8) % (side * side);
        if (crowd.isSet(place)) continue;
        crowd.change(place, true);
        ++made;
    }
    for (;;) {
        const uint32_t tightest = crowd.extreme(true);
        crowd.change(tightest, false);
        const uint32_t emptiest = crowd.extreme(false);
        crowd.change(emptiest, true);
        if (emptiest == tightest) return crowd;
    }
}

} // namespace

std::vector<uint32_t> blueNoiseRanks(uint32_t side) {
    uint32_t count = 0;
    const Crowd start = startingPoints(side, count);
    std::vector<uint32_t> ranks(side * side);
    Crowd crowd = start;
    for (uint32_t rank = count; rank-- > 0;) {
        const uint32_t place = crowd.extreme(true);
        crowd.change(place, false);
        ranks[place] = rank;
    }
    crowd = start;
    for (uint32_t rank = count; rank < side * side; ++rank) {
        const uint32_t place = crowd.extreme(false);
        crowd.change(place, true);
        ranks[place] = rank;
    }
    return ranks;
}

std::vector<uint32_t> interleaveTables(uint32_t levels) {
    constexpr uint32_t kSide = gpu::kSurfelTile, kArea = kSide * kSide;
    static const std::vector<uint32_t> ranks = blueNoiseRanks(kSide);
    std::vector<uint32_t> tables(size_t(2 * levels) * kArea);
    std::vector<uint32_t> places;
    for (uint32_t level = 0; level < levels; ++level) {
        uint32_t* rankOf = &tables[size_t(2 * level) * kArea];
        uint32_t* offsetOf = rankOf + kArea;
        const uint32_t across = 1u << level, cells = kSide >> level;
        places.resize(across * across);
        for (uint32_t cell = 0; cell < cells * cells; ++cell) {
            const uint32_t x0 = cell % cells * across, y0 = cell / cells * across;
            const auto tilePlace = [&](uint32_t i) { return (y0 + i / across) * kSide + x0 + i % across; };
            std::iota(places.begin(), places.end(), 0u);
            std::sort(places.begin(), places.end(), [&](uint32_t a, uint32_t b) {
                return ranks[tilePlace(a)] < ranks[tilePlace(b)];
            });
            for (uint32_t rank = 0; rank < places.size(); ++rank) {
                rankOf[tilePlace(places[rank])] = rank;
                offsetOf[cell * places.size() + rank] =
                    places[rank] % across | places[rank] / across << 8;
            }
        }
    }
    return tables;
}

} // namespace tyndall::volumetric_gi
