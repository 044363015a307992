#include "renderer/inspect_pass.h"

#include <algorithm>

#include "shared/post.h"

namespace tyndall {
namespace {

constexpr const char* kChannelNames[] = {"rgb", "r", "g", "b", "a"};

const SettingDesc kInspectSettings[] = {
    TYNDALL_ENUM(InspectSettings, channel, "inspect.channel", "Channel", kChannelNames,
                 InspectChannel::Rgb, "Channels of the resource to show."),
    TYNDALL_INT(InspectSettings, slice, "inspect.slice", "Slice", "", 0, 4095, 0,
                "Layer of an array, or slice of a volume, to show."),
    TYNDALL_INT(InspectSettings, mip, "inspect.mip", "Mip level", "", 0, 15, 0,
                "Mip level to show."),
    TYNDALL_FLOAT(InspectSettings, minimum, "inspect.minimum", "Black at", "", -1e9, 1e9, 0,
                  "Value that is shown as black."),
    TYNDALL_FLOAT(InspectSettings, maximum, "inspect.maximum", "White at", "", -1e9, 1e9, 1,
                  "Value that is shown as white."),
};

} // namespace

std::span<const SettingDesc> inspectSettings() { return kInspectSettings; }

fg::TextureHandle addInspectPass(fg::FrameGraph& graph, fg::TextureHandle resource, int width,
                                 int height, const InspectSettings& settings) {
    struct Data {
        fg::TextureHandle resource, display;
        gpu::InspectParams params;
        int32_t kind;
    };
    return graph
        .addPass<Data>(
            "inspect",
            [&](fg::Builder& builder, Data& data) {
                const fg::TextureDesc desc = graph.desc(resource);
                data.resource = builder.read(resource);
                data.display = builder.create("inspect.display",
                                              fg::texture2D(fg::Format::RGBA8, width, height));
                data.kind = int32_t(desc.kind);
                data.params = {settings.minimum,
                               settings.maximum,
                               uint32_t(settings.channel),
                               std::clamp(settings.slice, 0, desc.depth - 1),
                               std::clamp(settings.mip, 0, desc.mips - 1),
                               0,
                               0,
                               0};
            },
            [](const Data& data, fg::PassContext& context) {
                context.compute("post/inspect.comp", {{"KIND", data.kind}})
                    .bind("shown", data.resource)
                    .bind("display", data.display)
                    .params(data.params)
                    .dispatchOver(data.display);
            })
        .display;
}

} // namespace tyndall
