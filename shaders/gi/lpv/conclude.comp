// Sums up the results of measure.comp: is the light of a lattice settled? (LEDGER: the energy balance, too.)
//
// The error of light that grows by steps of ratio ρ is the last step times ρ/(1 - ρ). ρ is estimated from two looks at the residual.
#include "gi/lpv/workgroup_sums.glsl"
#include "shared/lpv.h"

layout(local_size_x = 64) in;

layout(std140) uniform Measure { LpvMeasureParams measure; };
layout(std430) buffer LpvControls { LpvControl control[]; };

const float kSlowest = 0.9999; // largest ratio from step to step; slower cannot be distinguished from rounding

void concludeLook() {
    uint lattice = measure.lattice;
    float stored = sums[1][0];
    float residual = stored > 0.0 ? sums[0][0] / stored : 0.0;
    float before = control[lattice].residual;
    bool first = control[lattice].steps == 0.0;
    float error = -1.0;
    if (residual == 0.0) {
        error = 0.0;
    } else if (!first && before > 0.0) {
        float ratio = min(pow(residual / before, 1.0 / measure.steps), kSlowest);
        error = residual * ratio / (1.0 - ratio);
    }
    control[lattice].steps += measure.steps;
    control[lattice].residual = residual;
    control[lattice].error = error;
    control[lattice].stored = stored;
    // Light that enters from a coarser lattice changes until that one is settled.
    bool outerSettled = lattice == 0u || control[lattice - 1u].settled != 0u;
    if (outerSettled && error >= 0.0 && error <= measure.tolerance) {
        control[lattice].settled = 1u;
        for (uint i = 0u; i < 3u; ++i) control[lattice].groups[i] = 0u;
    }
}

void main() {
    uint thread = gl_LocalInvocationIndex;
#if !LEDGER
    if (control[measure.lattice].settled != 0u) return;
#endif
    float values[kSums];
    for (uint i = 0u; i < kSums; ++i) {
        values[i] = 0.0;
        for (uint group = thread; group < measure.groups; group += 64u) values[i] += partials[group * kSums + i];
    }
    sumUp(values);
    if (thread != 0u) return;
#if LEDGER
    uint lattice = measure.lattice;
    float after = sums[1][0];
    float before = sums[2][0];
    control[lattice].stored = after;
    control[lattice].injected = sums[3][0];
    control[lattice].absorbed = sums[4][0];
    control[lattice].escaped = sums[5][0];
    control[lattice].blocked = sums[6][0];
    control[lattice].change = after - before;
    float difference = (before + sums[3][0]) - (after + sums[4][0] + sums[5][0] + sums[6][0]);
    control[lattice].imbalance = difference / max(abs(before + sums[3][0]), 1e-30);
#else
    concludeLook();
#endif
}
