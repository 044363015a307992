#pragma once
// Light-space optical depth of the grid media: one volume a light, stored as optical depth, not transmittance.

#include "renderer/media_system.h"

namespace tyndall {

/// Fills the volumes that the frame's lights need and hands them to `frame.resources`. Its result is kept while grids, lights and
/// settings stay the same. Skipped without grids, or where they are marched for every point instead.
void addOpticalDepthPass(fg::FrameGraph& graph, const MediaSystem& media, MediaFrame& frame);

} // namespace tyndall
