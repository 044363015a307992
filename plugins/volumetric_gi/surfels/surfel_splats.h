#pragma once
// Light of surfels, splatted into the interleaved framebuffer: what splats onto media and onto surfaces share.

#include "volumetric_gi/shared/traced_scene.h"
#include "volumetric_gi/surfels/surfel_points.h"

namespace tyndall::volumetric_gi {

struct SplatRequest {
    SurfelLight surfels;
    fg::BufferHandle interleave; // interleaveTables()
    TracedBuffers traced;        // null handles: visibility is not asked for
    ivec2 size{0};               // of the picture that receives light: rays through media, or pixels
    int factor = 1;              // pixels along an edge of the square that each stands for
    Bounds reached;              // what is farther away from a surfel than a shell gets none of its splats; render space; empty: everywhere
    uint32_t levels = 1;
    double threshold = 0;
    SurfelRays rays = SurfelRays::None;
    bool attenuation = false, visibility = false;
    bool paper = false; // as printed
    double nearest = 0; // δ of the printed kernel, m²
    bool blur = false;
    uint64_t chance = 0; // of this frame
};

[[nodiscard]] gpu::SurfelSplatParams splatParams(const plugin::FrameInputs& inputs,
                                                 const SplatRequest& request);

/// Which surfels are splatted on which level. For shaders that include gi/surfels/splat.glsl, with gi/surfels/splat.vert.
struct SplatList {
    fg::BufferHandle list, draws; // draws: fg::DrawArguments of each level, six vertices a surfel
    SurfelLight surfels;
    fg::BufferHandle interleave;
    gpu::SurfelSplatParams params{};
};

/// Adds the pass `gi.surfels.list`.
[[nodiscard]] SplatList addSplatList(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                                     const SplatRequest& request);

/// Declares that a pass draws it; the result is what drawSplats() takes.
[[nodiscard]] SplatList readSplatList(fg::Builder& builder, const SplatList& list);

/// Of what splats are drawn into: RGBA32F array, a layer a level; w: how many surfels have come to a ray or a pixel.
[[nodiscard]] fg::TextureDesc splatLevels(const SplatList& list);

/// Draws all levels into `levels`. `bind(params)` begins a command, with what the fragment shader needs, for one level.
template <typename Bind>
void drawSplats(fg::PassContext& context, const SplatList& list, fg::TextureHandle levels,
                const Bind& bind) {
    constexpr float kDark[4] = {};
    context.clearTexture(levels, kDark);
    fg::RasterState state;
    state.blend = fg::BlendMode::Add;
    for (uint32_t level = 0; level < list.params.levels; ++level) {
        gpu::SurfelSplatParams params = list.params;
        params.level = level;
        fg::RasterCommand command = bind();
        command.params(params, "Splat")
            .bind("Interleave", list.interleave)
            .bind("LitSurfels", list.surfels.lit)
            .bind("Brightness", list.surfels.brightness)
            .bind("SplatList", list.list)
            .colors({fg::Target{levels, int32_t(level), 0}})
            .state(state)
            .drawIndirect(list.draws, level * sizeof(fg::DrawArguments));
    }
}

/// Calls `add(params, coarser)` for each step of the filter that sums up levels, from the coarsest to the finest, with what the step before has returned.
template <typename Add>
fg::TextureHandle addCollectSteps(const SplatRequest& request, const Add& add) {
    fg::TextureHandle sum;
    // One step more to blur the finest level: what its receivers gather differs from one to the next.
    for (int level = int(request.levels) - 1; level >= (request.blur ? -1 : 0); --level) {
        gpu::SurfelCollectParams params{};
        params.size = request.size;
        params.plain = request.paper;
        params.level = std::max(level, 0);
        params.spacing = request.blur ? 1 << params.level : 0;
        params.hasCoarser = sum ? 1 : 0;
        params.hasOwn = level >= 0;
        params.last = level == (request.blur ? -1 : 0);
        sum = add(params, sum);
    }
    return sum;
}

/// Numbers about a frame, in this order: of lit surfels, of quads drawn, of pairs of a surfel and a ray, of surfels, and what their sizes have grown by.
constexpr uint32_t kSurfelCounts = 5;

/// Adds the pass `gi.surfels.count`: float[kSurfelCounts]. `of`: the last two, which must live until the frame has been executed.
[[nodiscard]] fg::BufferHandle addSurfelCounts(fg::FrameGraph& graph, const SplatList& list,
                                               fg::TextureHandle levels, const float (&of)[2]);

} // namespace tyndall::volumetric_gi
