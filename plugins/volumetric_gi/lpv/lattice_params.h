#pragma once
// The lattice's parameters as its shaders take them.

#include "shared/lpv.h"
#include "volumetric_gi/lpv/lattice_directions.h"

namespace tyndall::volumetric_gi {

/// `lowest`: corner in render space, `cell`: edge in metres; `repeats`: bit a where light that leaves along axis a enters again on the other side.
[[nodiscard]] inline gpu::LpvParams latticeParams(const ivec3& size, int repeats,
                                                  const vec3& lowest = vec3(0), float cell = 1) {
    gpu::LpvParams params{};
    params.grid.size = {size, repeats};
    params.grid.lowest = {lowest, cell};
    params.onward = 1;
    for (size_t j = 0; j < kLatticeDirections; ++j) {
        const LatticeDirection& d = latticeDirections()[j];
        params.directions[j].unit = vec4(vec3(d.unit), float(d.weight));
        params.directions[j].offset = {d.offset, d.lengthClass};
        params.classWeights[d.lengthClass] += float(d.weight);
    }
    return params;
}

/// Blocks of cells, the workgroups of shaders with one thread for each cell.
[[nodiscard]] inline ivec3 blocksOf(const ivec3& size) {
    const ivec3 block(gpu::kLpvBlockX, gpu::kLpvBlockY, gpu::kLpvBlockZ);
    return (size + block - 1) / block;
}

/// The printed scheme's transfer functions.
[[nodiscard]] inline gpu::LpvTransfer latticeTransfer() {
    gpu::LpvTransfer transfer{};
    for (size_t j = 0; j < kLatticeDirections; ++j) {
        const TransferFunction& t = transferFunctions()[j];
        for (int k = 0; k < 4; ++k) transfer.harmonics[j][k] = float(t.harmonics[size_t(k)]);
        transfer.share[j / 4][int(j % 4)] = float(t.printedShare);
        transfer.meanLength += float(latticeDirections()[j].length / kLatticeDirections);
    }
    return transfer;
}

} // namespace tyndall::volumetric_gi
