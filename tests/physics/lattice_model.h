#pragma once
// The slow, obvious version of the propagation in a lattice: one channel, double precision, every cell and every direction in a loop.
// The oracle of shaders/gi/lpv; what it computes is explained in docs/techniques/lpv-explained.md.

#include <array>
#include <cstdint>
#include <vector>

#include "volumetric_gi/lpv/lattice_directions.h"

namespace tyndall::test {

using volumetric_gi::kLatticeDirections;

/// Power that arrives in a cell in one step, and its first moment (power times mean direction).
struct Arrival {
    double power = 0;
    dvec3 moment{0};
};

struct LatticeCell {
    double depth = 0;  // transport extinction times the cell's edge
    double albedo = 0; // transport scattering over transport extinction
    uint32_t blocked =
        0; // bit j: a surface stands between this cell and its neighbour in direction j
    std::array<double, kLatticeDirections> reflectance{}; // of what stands there
    // Sources, a step: power scattered or emitted inside the cell to all sides, and light that enters it.
    double emission = 0;
    Arrival entering;
};

/// Powers in one step, all in the sources' unit.
struct LatticeBalance {
    double injected = 0, absorbed = 0, escaped = 0, blocked = 0;
    double stored = 0; // in the lattice after the step
};

class LatticeModel {
public:
    /// `repeats[a]`: what leaves along axis a comes in again on the other side.
    LatticeModel(const ivec3& size, const std::array<bool, 3>& repeats);

    [[nodiscard]] LatticeCell& cell(const ivec3& at) { return cells_[indexOf(at)]; }
    [[nodiscard]] const std::vector<Arrival>& state() const { return state_; }
    std::vector<Arrival>& state() { return state_; }
    [[nodiscard]] size_t indexOf(const ivec3& at) const;

    /// One step of the corrected scheme: state' = P(state) + sources. Returns where the power went.
    LatticeBalance step();
    /// Steps until the state changes by less than `tolerance` of itself; returns how many.
    int settle(double tolerance, int most);

    /// What the state leaves in each direction of a cell: at least 0, `state.power` in sum.
    [[nodiscard]] static std::array<double, kLatticeDirections> lobe(const Arrival& state);
    /// Of the present state, in each cell: fluence times volume over edge (power times track length in cells), and the same for the
    /// vector flux. Light that a source sends out counts after its first way out of the emitting spot.
    [[nodiscard]] std::vector<Arrival> tracks() const;
    /// Power that the cell sends in each direction in the next step.
    [[nodiscard]] std::array<double, kLatticeDirections> sends(const ivec3& at) const;
    /// Power leaving through the lower and the upper end of `axis` in the next step.
    [[nodiscard]] std::array<double, 2> leaving(int axis) const;

private:
    struct Sent {
        std::array<double, kLatticeDirections> power{};
        double collided = 0, emitted = 0;
    };
    /// What the cell sends on of its state, in each direction, before any of it collides: of what came along that direction a part goes
    /// straight on, the rest of the state leaves as a lobe.
    [[nodiscard]] std::array<double, kLatticeDirections> passing(size_t cell) const;
    [[nodiscard]] Sent send(size_t cell) const;
    [[nodiscard]] bool neighbour(const ivec3& at, const ivec3& offset, ivec3& result) const;
    template <typename Visit> void forEachCell(Visit&& visit) const;

    ivec3 size_;
    std::array<bool, 3> repeats_;
    std::vector<LatticeCell> cells_;
    std::vector<Arrival> state_;
    std::vector<std::array<double, kLatticeDirections>>
        along_; // of the state's power, what came along each direction
};

/// Billeter, Sintorn and Assarsson 2012, equation 3, as printed: no blockers, one channel, coefficients in two bands of harmonics.
class PrintedLatticeModel {
public:
    /// `lambda` = σt d, `lambdaS` = σs d, d the mean distance of two neighbours.
    PrintedLatticeModel(int size, double lambda, double lambdaS);
    std::vector<std::array<double, 4>>& state() { return state_; }
    void step(); // the lattice repeats along all axes
    [[nodiscard]] double power() const;

private:
    int size_;
    double lambda_, lambdaS_;
    std::vector<std::array<double, 4>> state_;
};

} // namespace tyndall::test
