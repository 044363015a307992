#include "renderer/gbuffer_pass.h"

#include "renderer/view.h"

namespace tyndall {
namespace {

struct GBufferData {
    const GpuScene* scene;
    ViewResources view;
    float textureLodBias;
    bool bothSides;
    GBuffer gbuffer;
};

fg::RasterState stateOf(const DrawItem& item, bool bothSides) {
    fg::RasterState state;
    // One-sided surfaces are invisible from behind to the camera, and to nothing else.
    state.cull = item.doubleSided || bothSides ? fg::CullMode::None : fg::CullMode::Back;
    state.depth = fg::DepthMode::TestAndWrite;
    state.compare = fg::CompareMode::Greater;
    state.topology = item.topology;
    state.frontFaceClockwise = item.mirrored;
    return state;
}

bool sameState(const DrawItem& a, const DrawItem& b) {
    return a.doubleSided == b.doubleSided && a.mirrored == b.mirrored && a.topology == b.topology;
}

void clearGBuffer(const GBuffer& gbuffer, fg::PassContext& context) {
    static constexpr float kZero[4] = {0, 0, 0, 0};
    for (const fg::TextureHandle texture :
         {gbuffer.depth, gbuffer.normal, gbuffer.base, gbuffer.material, gbuffer.emissive})
        context.clearTexture(texture, kZero);
}

void drawMode(const GBufferData& data, AlphaMode mode, fg::PassContext& context) {
    const std::span<const DrawItem> items = data.scene->items(mode);
    if (items.empty()) return;
    auto command = context.raster("gbuffer/gbuffer.vert", "gbuffer/gbuffer.frag",
                                  {{"MASK", mode == AlphaMode::Mask ? 1 : 0}});
    const fg::Target depth{data.gbuffer.depth, 0, 0};
    command.colors({fg::Target{data.gbuffer.normal, 0, 0}, fg::Target{data.gbuffer.base, 0, 0},
                    fg::Target{data.gbuffer.material, 0, 0},
                    fg::Target{data.gbuffer.emissive, 0, 0}},
                   &depth);
    command.viewport(0, 0, data.view.width, data.view.height);
    bindView(command, data.view);
    command.bind("Objects", data.scene->objects()).bind("Materials", data.scene->materials());
    command.set("textureLodBias", data.textureLodBias);
    if (mode == AlphaMode::Mask) command.set("textureAnisotropy", data.scene->anisotropy());
    const DrawItem* last = nullptr;
    const std::array<vec4, 5> planes = frustumPlanes(data.view.data);
    forEachVisibleRun(items, planes, [&](const DrawRun& run) {
        const DrawItem& item = *run.first;
        if (!last || !sameState(*last, item)) {
            command.state(stateOf(item, data.bothSides));
            command.set("isTriangle", item.topology == fg::Topology::Triangles ? 1 : 0);
        }
        if (!last || last->material != item.material)
            bindMaterial(context, data.scene->textures(item.material));
        command.set("firstObject", int(item.object));
        command.drawGeometry(item.geometry, 0, item.indexCount, run.count);
        last = &item;
    });
}

} // namespace

GBuffer addGBufferPass(fg::FrameGraph& graph, const GpuScene& scene, const ViewResources& view,
                       const GBufferSettings& settings, const char* name, bool bothSides) {
    return graph
        .addPass<GBufferData>(
            name,
            [&](fg::Builder& builder, GBufferData& data) {
                data.scene = &scene;
                data.view = view;
                data.textureLodBias = settings.textureLodBias;
                data.bothSides = bothSides;
                const auto create = [&](const char* texture, fg::Format format, fg::Access access) {
                    return builder.create(texture, fg::texture2D(format, view.width, view.height),
                                          access);
                };
                data.gbuffer.depth =
                    create("gbuffer.depth", fg::Format::Depth32F, fg::Access::DepthTarget);
                // 16 bits a channel: with 8 a base colour would be off by up to half a percent of white.
                data.gbuffer.normal =
                    create("gbuffer.normal", fg::Format::RGBA16, fg::Access::ColorTarget);
                data.gbuffer.base =
                    create("gbuffer.base", fg::Format::RGBA16, fg::Access::ColorTarget);
                data.gbuffer.material =
                    create("gbuffer.material", fg::Format::RGBA16, fg::Access::ColorTarget);
                data.gbuffer.emissive =
                    create("gbuffer.emissive", fg::Format::RGBA32F, fg::Access::ColorTarget);
            },
            [](const GBufferData& data, fg::PassContext& context) {
                clearGBuffer(data.gbuffer, context);
                drawMode(data, AlphaMode::Opaque, context);
                drawMode(data, AlphaMode::Mask, context);
            })
        .gbuffer;
}

} // namespace tyndall
