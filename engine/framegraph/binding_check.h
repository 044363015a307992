#pragma once
// The bind list is the dependency list: what a pass touches while it runs must be what it declared.

#include <string>
#include <string_view>

#include "framegraph/frame_graph_impl.h"

namespace tyndall::fg {

/// How a running pass touches a resource.
enum class Touch : uint32_t {
    Sample = 0,       // sampler
    ReadStorage = 1,  // readonly image or storage block
    WriteStorage = 2, // any other image or storage block
    UniformBlock = 3,
    Indirect = 4,
    ColorAttachment = 5,
    DepthAttachment = 6, // with depth writes
    DepthTest = 7,       // without
    TransferRead = 8,
    TransferWrite = 9, // clear, copy, upload: any declared write allows it
    Capture = 10,      // transform feedback, and its count
};

/// Empty when pass number `pass` declared this; else a sentence that names the pass, the resource and `place` (the name in the
/// shader, or what was attempted).
std::string checkTouch(const FrameGraphImpl& graph, uint32_t pass, uint32_t resource,
                       uint32_t version, Touch touch, std::string_view place);

} // namespace tyndall::fg
