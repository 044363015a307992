#include "renderer/optical_depth_pass.h"

namespace tyndall {

void addOpticalDepthPass(fg::FrameGraph& graph, const MediaSystem& media, MediaFrame& frame) {
    struct Data {
        MediaResources media;
        fg::TextureHandle volume;
        const OpticalDepthLayout* layout; // lives in the MediaSystem until the next frame
    };
    const Data& pass = graph.addPass<Data>(
        "media.opticalDepth",
        [&](fg::Builder& builder, Data& data) {
            if (frame.depthSkipReason) return builder.skip(frame.depthSkipReason);
            data.media = readMedia(builder, frame.resources);
            data.layout = &media.opticalDepthLayout();
            data.volume = builder.create("media.opticalDepth", data.layout->volume);
            builder.cacheBy(media.opticalDepthKey());
        },
        [](const Data& data, fg::PassContext& context) {
            for (size_t light = 0; light < data.layout->views.size(); ++light) {
                const gpu::OpticalDepthView& view = data.layout->views[light];
                if (view.kind == gpu::kDepthViewNone || view.kind == gpu::kDepthViewMarch) continue;
                auto command = context.compute("media/optical_depth.comp");
                bindMedia(command, data.media);
                const uint32_t size = uint32_t(view.block.w);
                command.params(gpu::OpticalDepthParams{uint32_t(light), 0, 0, 0})
                    .bind("volume", data.volume)
                    .dispatchOver(size, size);
            }
        });
    frame.resources.opticalDepth = pass.volume;
}

} // namespace tyndall
