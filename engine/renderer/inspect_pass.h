#pragma once
// Any texture of the frame as a picture, for the editor's frame-graph pane.

#include "core/settings.h"
#include "framegraph/frame_graph.h"

namespace tyndall {

enum class InspectChannel : int32_t { Rgb = 0, R = 1, G = 2, B = 3, A = 4 };

struct InspectSettings {
    InspectChannel channel;
    int32_t slice, mip;
    float minimum, maximum;
};
std::span<const SettingDesc> inspectSettings();

/// `resource` (float or normalised) stretched over width × height: RGBA8; non-finite texels are magenta.
/// Slice and mip are clamped to what there is.
fg::TextureHandle addInspectPass(fg::FrameGraph& graph, fg::TextureHandle resource, int width,
                                 int height, const InspectSettings& settings);

} // namespace tyndall
