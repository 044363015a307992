#include "renderer/shadow_pass.h"

#include <algorithm>
#include <array>
#include <bit>

#include "framegraph/hash.h"
#include "plugin/cache_key.h"
#include "plugin/cached_upload.h"
#include "renderer/gpu_scene.h"

namespace tyndall {

struct ShadowPass::Data {
    fg::TextureHandle atlas;
    ShadowPass* pass;
    const GpuScene* scene;
    const ShadowPlan* plan;
    ViewResources view;
    uint64_t castersKey;
    bool wasReset;
};

namespace {

/// Left, right, bottom, top, and for perspective maps what is before the light. Nothing is cut off away from the light, and
/// towards it only what lies within a lamp's ball: whatever stands in the way casts a shadow.
std::array<vec4, 5> mapPlanes(const mat4& clipFromRender) {
    const mat4 rows = glm::transpose(clipFromRender);
    return {rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1], rows[3] - rows[1], rows[3]};
}

fg::RasterState casterState(bool perspective) {
    fg::RasterState state;
    // A surface that the camera sees from one side only blocks light from both.
    state.cull = fg::CullMode::None;
    state.depth = fg::DepthMode::TestAndWrite;
    state.compare = fg::CompareMode::Greater; // reversed depth: the nearest to the light stays
    state.depthClamp = !perspective;
    return state;
}

/// Nothing there: depth 0, written where anything lies nearer.
fg::RasterState emptyState() {
    fg::RasterState state = casterState(false);
    state.compare = fg::CompareMode::Less;
    return state;
}

fg::BufferHandle addViewUpload(fg::FrameGraph& graph, const ShadowPlan& plan) {
    return addCachedUpload(graph, "shadow.views", plan.views,
                           cacheKey(std::as_bytes(std::span(plan.views))));
}

} // namespace

/// What the casters look like from anywhere: the scene's version also moves with what casts no shadow, as lights and cameras.
uint64_t ShadowPass::castersKey(const GpuScene& scene) {
    if (casterVersion_ == scene.version()) return castersKey_;
    uint64_t key = fg::kHashStart;
    for (const DrawItem& item : scene.items()) {
        if (item.topology != fg::Topology::Triangles) continue;
        key = fg::mixHash(key, uint64_t(item.geometry.id) << 32 | uint64_t(item.alphaMode));
        key = fg::mixHash(key, scene.scene().meshes[size_t(item.mesh)].version);
        const mat4& m = scene.objectData()[item.object].renderFromLocal;
        for (int c = 0; c < 4; ++c)
            for (int r = 0; r < 4; r += 2)
                key = fg::mixHash(key, uint64_t(std::bit_cast<uint32_t>(m[c][r])) << 32 |
                                           std::bit_cast<uint32_t>(m[c][r + 1]));
        if (item.alphaMode == AlphaMode::Opaque) continue;
        const gpu::MaterialData& material = scene.materialData()[item.material];
        key = fg::hashName({reinterpret_cast<const char*>(&material), sizeof material},
                           fg::mixHash(key, scene.textures(item.material).baseColor.id));
    }
    casterVersion_ = scene.version();
    return castersKey_ = key;
}

void ShadowPass::drawMap(const Data& data, size_t index, fg::PassContext& context) const {
    const gpu::ShadowView& view = data.plan->views[index];
    const fg::Target depth{data.atlas, view.layer, 0};
    const int x = int(view.atlas.x), y = int(view.atlas.y), side = int(view.atlas.z);
    context.raster("lighting/shadow_clear.vert", "lighting/shadow_clear.frag")
        .depthOnly(depth)
        .viewport(x, y, side, side)
        .state(emptyState())
        .draw(3);

    const gpu::ShadowDrawParams params{data.plan->clipFromRender[index], data.plan->balls[index]};
    const int ball = params.ball.w > 0 ? 1 : 0;
    const std::array<vec4, 5> planes = mapPlanes(params.clipFromRender);
    for (const AlphaMode mode : {AlphaMode::Opaque, AlphaMode::Mask, AlphaMode::Blend}) {
        const bool mask = mode != AlphaMode::Opaque;
        forEachVisibleRun(data.scene->items(mode), planes, [&](const DrawRun& run) {
            if (run.first->topology != fg::Topology::Triangles)
                return; // lines and points have no area
            auto command = context.raster("lighting/shadow.vert", "lighting/shadow.frag",
                                          {{"MASK", mask ? 1 : 0}, {"BALL", ball}});
            command.depthOnly(depth)
                .viewport(x, y, side, side)
                .state(casterState(view.bias.y > 0.0f))
                .params(params)
                .bind("Objects", data.scene->objects());
            command.set("firstObject", int(run.first->object));
            if (mask) {
                bindView(command, data.view)
                    .bind("Materials", data.scene->materials())
                    .set("textureLodBias", 0.0f)
                    .set("textureAnisotropy", data.scene->anisotropy());
                command.bind("baseColorTexture",
                             data.scene->textures(run.first->material).baseColor);
            }
            command.drawGeometry(run.first->geometry, 0, run.first->indexCount, run.count);
        });
    }
}

void ShadowPass::draw(const Data& data, fg::PassContext& context) {
    if (data.wasReset) {
        const float nothing[4] = {0, 0, 0, 0};
        context.clearTexture(data.atlas, nothing);
    }
    if (data.wasReset) held_.clear();
    std::vector<Held> holds;
    for (size_t i = 0; i < data.plan->views.size(); ++i) {
        const gpu::ShadowView& view = data.plan->views[i];
        if (view.atlas.z <= 0) continue;
        const Held wanted{view.layer, view.atlas, fg::mixHash(data.castersKey, data.plan->keys[i])};
        const bool there = std::any_of(held_.begin(), held_.end(), [&](const Held& h) {
            return h.key == wanted.key && h.layer == wanted.layer && h.square == wanted.square;
        });
        if (!there) {
            drawMap(data, i, context);
            ++mapsDrawn_;
        }
        holds.push_back(wanted);
    }
    held_ = std::move(holds); // what else was there may have been drawn over
}

ShadowResources ShadowPass::addPasses(fg::FrameGraph& graph, const GpuScene& scene,
                                      const ShadowPlan& plan, const ViewResources& view,
                                      bool wanted) {
    ShadowResources resources;
    resources.views = addViewUpload(graph, plan);
    if (!wanted)
        resources.atlas = addNoMaps(graph, "only emission is rendered");
    else if (plan.views.empty())
        resources.atlas = addNoMaps(graph, scene.items().empty() ? "no surface in the scene"
                                                                 : "no light casts a shadow");
    else
        resources.atlas = addMaps(graph, scene, plan, view);
    return resources;
}

/// An atlas that is absent, and a pass that says why.
fg::TextureHandle ShadowPass::addNoMaps(fg::FrameGraph& graph, const char* reason) {
    return graph
        .addPass<Data>(
            "shadow.maps",
            [&](fg::Builder& builder, Data& data) {
                data.atlas = builder.create("shadow.atlas",
                                            fg::texture2DArray(fg::Format::Depth32F, 1, 1, 1),
                                            fg::Access::DepthTarget);
                builder.skip(reason);
            },
            [](const Data&, fg::PassContext&) {})
        .atlas;
}

fg::TextureHandle ShadowPass::addMaps(fg::FrameGraph& graph, const GpuScene& scene,
                                      const ShadowPlan& plan, const ViewResources& view) {
    const uint64_t casters = castersKey(scene);
    uint64_t key = fg::mixHash(casters, plan.views.size());
    for (const uint64_t k : plan.keys) key = fg::mixHash(key, k);
    const fg::PersistentTexture atlas = graph.persistentTexture(
        "shadow.atlas",
        fg::texture2DArray(fg::Format::Depth32F, plan.atlasSize, plan.atlasSize, plan.layers));
    return graph
        .addPass<Data>(
            "shadow.maps",
            [&](fg::Builder& builder, Data& data) {
                data.pass = this;
                data.scene = &scene;
                data.plan = &plan;
                data.view = view;
                data.castersKey = casters;
                data.wasReset = atlas.wasReset;
                data.atlas = builder.write(atlas.handle, fg::Access::DepthTarget);
                builder.cacheBy(key);
            },
            [](const Data& data, fg::PassContext& context) { data.pass->draw(data, context); })
        .atlas;
}

} // namespace tyndall
