// The hierarchical interleaved framebuffer: on level l, each neighbourhood of 2^l × 2^l rays has one in each of 2^l × 2^l sub-buffers. Which one follows from
// the ranks of a tile of blue noise, so that rays side by side are in sub-buffers that are far apart in the order of ranks.
#ifndef TYNDALL_GI_SURFELS_INTERLEAVE
#define TYNDALL_GI_SURFELS_INTERLEAVE
#include "shared/surfels.h"

// For each level: the tile's ranks in their neighbourhoods, row by row; then for each neighbourhood, row by row, the offset of the ray of each rank, x | y << 8.
layout(std430) readonly buffer Interleave { uint interleave[]; };

const uint kTileArea = kSurfelTile * kSurfelTile;

/// The sub-buffer of a ray.
uint subBufferOf(uint level, ivec2 ray) {
    uvec2 at = uvec2(ray) & (kSurfelTile - 1u);
    return interleave[2u * level * kTileArea + at.y * kSurfelTile + at.x];
}

/// The ray of a sub-buffer in neighbourhood `cell`.
ivec2 rayOf(uint level, uint subBuffer, ivec2 cell) {
    uint across = kSurfelTile >> level;
    uvec2 at = uvec2(cell) & (across - 1u);
    uint offset = interleave[(2u * level + 1u) * kTileArea + ((at.y * across + at.x) << (2u * level)) + subBuffer];
    return (cell << int(level)) + ivec2(offset & 255u, offset >> 8u);
}

/// Texels of a sub-buffer.
ivec2 subBufferSize(uint level, ivec2 rays) { return (rays + (1 << int(level)) - 1) >> int(level); }

/// Its lower left texel.
ivec2 subBufferCorner(uint level, uint subBuffer, ivec2 rays) {
    uint mask = (1u << level) - 1u;
    return ivec2(subBuffer & mask, subBuffer >> level) * subBufferSize(level, rays);
}

#endif
