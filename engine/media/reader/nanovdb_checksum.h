#pragma once
// The checksums of NanoVDB's grids, whose definition changed with version 32.6.

#include <cstring>
#include <tuple>
#include <vector>

#include <nanovdb/NanoVDB.h>
#include <nanovdb/util/GridChecksum.h>

#include <zlib.h>

#include "media/reader/nanovdb_tree.h"

namespace tyndall::reader {

/// CRC-32 of a block's first part (grid and tree, without the magic number and the checksum) and of the rest in pieces of
/// 4 KiB, the last one longer: CRC-32 of their CRC-32s. Version 32.6.1 and later (nanovdb/tools/GridChecksum.h there).
inline nanovdb::GridChecksum blockedChecksum(const GridMemory& memory) {
    constexpr uint64_t kBegin = offsetof(nanovdb::GridData, mVersion),
                       kHead = sizeof(nanovdb::GridData) + sizeof(nanovdb::TreeData<3>),
                       kPiece = 4096;
    const auto crc = [&](uint64_t from, uint64_t bytes) {
        return uint32_t(
            crc32_z(0, reinterpret_cast<const Bytef*>(memory.data() + from), size_t(bytes)));
    };
    if (memory.size() < kHead) fail("it is damaged (a grid is too small to be one)");
    const uint64_t rest = memory.size() - kHead, pieces = rest / kPiece;
    std::vector<uint32_t> parts;
    for (uint64_t i = 0; i < pieces; ++i)
        parts.push_back(crc(kHead + i * kPiece, i + 1 < pieces ? kPiece : rest - i * kPiece));
    const auto all = uint32_t(
        crc32_z(0, reinterpret_cast<const Bytef*>(parts.data()), parts.size() * sizeof(uint32_t)));
    return {crc(kBegin, kHead - kBegin), rest == 0 ? ~uint32_t(0) : all};
}

/// Whether the grid's checksum is that of its content, as far as it has one: some record that of the head alone, or none.
/// The tree's offsets must have been checked before.
template <typename Build> bool checksumMatches(const GridMemory& memory) {
    const auto& grid = memory.at<nanovdb::NanoGrid<Build>>(memory.data());
    const nanovdb::GridData& data = *grid.data();
    const std::tuple version(data.mVersion.getMajor(), data.mVersion.getMinor(),
                             data.mVersion.getPatch());
    using Version = decltype(version);
    if (version < Version(32, 6, 0))
        return nanovdb::validateChecksum(grid, nanovdb::ChecksumMode::Full);
    // 32.6.0 has the old head, but sums up the nodes in another way than the library that is used here.
    if (version == Version(32, 6, 0))
        return nanovdb::validateChecksum(grid, nanovdb::ChecksumMode::Partial);
    const nanovdb::GridChecksum stored(data.mChecksum), right = blockedChecksum(memory);
    return stored.isEmpty() ||
           (stored.crc32(0) == right.crc32(0) &&
            (stored.mode() == nanovdb::ChecksumMode::Partial || stored.crc32(1) == right.crc32(1)));
}

} // namespace tyndall::reader
