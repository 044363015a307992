#include "volumetric_gi/surfels/surfel_points.h"

#include <algorithm>
#include <bit>

#include "plugin/cache_key.h"
#include "plugin/cached_upload.h"

namespace tyndall::volumetric_gi {
namespace {

gpu::SurfelSet surfelSet(const plugin::SurfaceTriangles& from, const SurfelPlan::Set& set) {
    gpu::SurfelSet result{};
    for (int i = 0; i < 4; ++i) result.uvFloats[i] = from.uvFloats[i];
    result.strideFloats = from.strideFloats;
    result.colorFloats = from.colorFloats;
    result.object = from.object;
    result.firstPatch = set.firstPatch;
    result.patchCount = set.patches;
    return result;
}

/// For shaders that include gi/surfels/patch.glsl.
template <typename Command>
Command& bindSet(Command& command, const plugin::SurfaceDrawer& surfaces, const SurfelPlan::Set& set,
                 fg::BufferHandle patches) {
    const plugin::SurfaceTriangles triangles = surfaces.triangles(set.set);
    return command.params(surfelSet(triangles, set), "Set")
        .bind("Vertices", triangles.vertices)
        .bind("Indices", triangles.indices)
        .bind("Objects", surfaces.objects())
        .bind("Materials", surfaces.materials())
        .bind("baseColorTexture", triangles.baseColor)
        .bind("metallicRoughnessTexture", triangles.metallicRoughness)
        .bind("SurfelPatches", patches);
}

uint64_t bytesOf(uint32_t count, size_t each) { return std::bit_ceil(uint64_t(count) * each); }

} // namespace

fg::BufferHandle addSurfels(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                            const SurfelPlan& plan, Surfelizer surfelizer, uint64_t key) {
    const fg::BufferHandle patches =
        addCachedUpload(graph, "gi.surfels.patches", plan.patches, key);
    struct Data {
        fg::BufferHandle patches, surfels;
        const plugin::SurfaceDrawer* surfaces;
        const SurfelPlan* plan;
        bool compute;
    };
    return graph
        .addPass<Data>(
            "gi.surfels.tessellate",
            [&](fg::Builder& builder, Data& data) {
                data.compute = surfelizer == Surfelizer::Compute;
                data.surfels = builder.create(
                    "gi.surfels.surfels", fg::BufferDesc{bytesOf(plan.surfels, sizeof(gpu::Surfel))},
                    data.compute ? fg::Access::StorageWrite : fg::Access::Capture);
                data.patches = builder.read(patches);
                data.surfaces = inputs.surfaces;
                data.plan = &plan;
                builder.cacheBy(cacheKey(key, surfelizer, inputs.scene.geometry, inputs.scene.materials));
            },
            [](const Data& data, fg::PassContext& context) {
                for (const SurfelPlan::Set& set : data.plan->sets) {
                    if (data.compute) {
                        auto command = context.compute("gi/surfels/points.comp");
                        bindSet(command, *data.surfaces, set, data.patches)
                            .bind("Surfels", data.surfels)
                            .dispatchOver(set.patches);
                        continue;
                    }
                    auto command = context.raster({.vertex = "gi/surfels/patch.vert",
                                                   .tessControl = "gi/surfels/level.tesc",
                                                   .tessEvaluation = "gi/surfels/point.tese"});
                    fg::RasterState state;
                    state.patchVertices = 1;
                    bindSet(command, *data.surfaces, set, data.patches)
                        .state(state)
                        .capture(data.surfels, {}, 0, uint64_t(set.firstSurfel) * sizeof(gpu::Surfel))
                        .draw(set.patches);
                }
            })
        .surfels;
}

SurfelLight addSurfelLight(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                           fg::BufferHandle surfels, uint32_t count) {
    struct Data {
        LightResources lights;
        MediaResources media;
        ViewResources view;
        fg::BufferHandle surfels, lit;
        gpu::SurfelLightParams params;
    };
    const Data& pass = graph.addPass<Data>(
        "gi.surfels.light",
        [&](fg::Builder& builder, Data& data) {
            data.surfels = builder.read(surfels);
            data.lit = builder.create("gi.surfels.lit",
                                      fg::BufferDesc{bytesOf(count, sizeof(gpu::LitSurfel))});
            data.lights = readLights(builder, inputs.lights);
            if (inputs.media.count > 0) data.media = readMedia(builder, inputs.media);
            data.view = inputs.view;
            data.params = {count, inputs.lights.lightCount, 0, 0};
        },
        [](const Data& data, fg::PassContext& context) {
            auto command = context.compute("gi/surfels/light.comp",
                                           {{"MEDIA", data.media.count > 0},
                                            {"MEDIA_KINDS", surfaceMediaKinds(data.media)},
                                            {"SOFT_SHADOWS", data.lights.softShadows}});
            bindLights(bindView(command, data.view), data.lights);
            if (data.media.count > 0) bindMedia(command, data.media);
            command.params(data.params, "Lighting")
                .bind("Surfels", data.surfels)
                .bind("LitSurfels", data.lit)
                .dispatchOver(data.params.surfelCount);
        });
    struct Mean {
        fg::BufferHandle lit, brightness;
        gpu::SurfelLightParams params;
    };
    const Mean& mean = graph.addPass<Mean>(
        "gi.surfels.brightness",
        [&](fg::Builder& builder, Mean& data) {
            data.lit = builder.read(pass.lit);
            data.brightness =
                builder.create("gi.surfels.brightness", fg::BufferDesc{sizeof(gpu::SurfelBrightness)});
            data.params = pass.params;
        },
        [](const Mean& data, fg::PassContext& context) {
            context.compute("gi/surfels/brightness.comp")
                .params(data.params, "Lighting")
                .bind("LitSurfels", data.lit)
                .bind("Brightness", data.brightness)
                .dispatch(1);
        });
    return {pass.lit, mean.brightness, count};
}

} // namespace tyndall::volumetric_gi
