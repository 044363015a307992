#include "volumetric_gi/surfels/surfels_technique.h"

#include <algorithm>
#include <cmath>

#include "framegraph/hash.h"
#include "plugin/cache_key.h"
#include "plugin/cached_upload.h"
#include "scene/scene.h"
#include "volumetric_gi/shared/scene_bounds.h"
#include "volumetric_gi/surfels/interleave.h"
#include "volumetric_gi/surfels/surfel_media.h"
#include "volumetric_gi/surfels/surfel_surfaces.h"

namespace tyndall::volumetric_gi {
namespace {

/// Surfels are no smaller than this part of the content's radius, where the eye is right before a surface.
constexpr double kSmallest = 1e-4;

/// A surfel is no larger than this part of the picture's height: a small picture of a scene needs no fewer of them.
constexpr double kLargest = 1.0 / 30;

/// Of the printed march: "the depth of the wall in our test scene corresponded to roughly 200 steps".
constexpr double kStepsThroughScene = 200;

bool converges(const plugin::FrameInputs& inputs) {
    return (inputs.view.data.flags & gpu::kViewConverge) != 0;
}

/// Chances of this frame: the same in all frames that are not averaged.
uint64_t chanceOf(const plugin::FrameInputs& inputs) {
    return fg::mixHash(inputs.view.data.seed, converges(inputs) ? inputs.view.data.frameIndex : 0);
}

/// Of the view, without the frame's offset.
SurfelSize sizeOf(const plugin::FrameInputs& inputs, const SurfelsSettings& settings) {
    const gpu::ViewData& view = inputs.view.data;
    SurfelSize size;
    size.eye = dvec3(view.cameraPosition);
    const dmat4 clipFromView = dmat4(view.clipFromRender) * glm::inverse(dmat4(view.viewFromRender));
    const double height = double(view.size.y),
                 pixels = std::min(double(settings.size), kLargest * height),
                 pixel = pixels * 2 / (clipFromView[1][1] * height);
    const Bounds content = boundsOf(inputs.scene.contentMinimum, inputs.scene.contentMaximum);
    size.least = content.empty() ? 0 : kSmallest * 0.5 * glm::length(content.extent());
    if ((view.flags & gpu::kViewOrthographic) != 0)
        size.least = std::max(size.least, pixel);
    else
        size.perDistance = pixel;
    size.perMediumDistance = double(settings.far);
    return size;
}

/// The paper has neither attenuation nor visibility, and surfels of one size on the screen.
SurfelsSettings asInThePaper(SurfelsSettings settings) {
    settings.far = 0;
    settings.rays = int32_t(SurfelRays::None);
    settings.attenuation = settings.visibility = false;
    return settings;
}

/// A skipped pass, of a frame without light of surfels.
fg::TextureHandle addNothing(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                             const char* pass, const char* reason) {
    struct Data {
        fg::TextureHandle light;
    };
    return graph
        .addPass<Data>(
            pass,
            [&](fg::Builder& builder, Data& data) {
                data.light = builder.create(
                    "gi.surfels.nothing",
                    fg::texture2D(fg::Format::RGBA32F, inputs.view.width, inputs.view.height));
                builder.skip(reason);
            },
            [](const Data&, fg::PassContext&) {})
        .light;
}

constexpr plugin::Statistic kStatistics[] = {{"surfels_lit.gi.surfels", 0},
                                             {"splats.gi.surfels", 1},
                                             {"pairs.gi.surfels", 2},
                                             {"surfels.gi.surfels", 3},
                                             {"size_growth.gi.surfels", 4}};

} // namespace

const plugin::TechniqueInfo& SurfelsTechnique::info() const {
    static constexpr plugin::TechniqueInfo kInfo{
        .name = "surfels",
        .title = "Surfels in a deep screen space",
        .help = "Splats light of surfaces onto the media beside them, in detail near the eye ray.",
        .claims = terms(Term::LSVE, Term::LSSE),
        .sets = nullptr,
        .setCount = 0,
        .media = kAllMedia,
        .separatesMedia = 1,
        .automatic = 0,
        // It has two terms: of all light, docs/measured/auto.md has no figure for it.
        .expected = {{11, 0.06f, 1}, {8, 0.3f, 0.04f}, {9, 0.3f, 0.2f}, {1, 1, 1}}};
    return kInfo;
}

plugin::SettingsTable SurfelsTechnique::settings() {
    return table(surfelsSettings(), &settings_, surfelsPresets());
}

void SurfelsTechnique::updateTriangles(const plugin::FrameInputs& inputs) {
    // A material decides whether its object is drawn in this way at all.
    const uint64_t key = cacheKey(inputs.scene.geometry, inputs.scene.materials, inputs.origin[0],
                                  inputs.origin[1], inputs.origin[2]);
    if (key == trianglesKey_) return;
    trianglesKey_ = key;
    corners_.clear();
    triangles_.clear();
    std::vector<size_t> starts;
    for (uint32_t set = 0; set < inputs.surfaces->triangleSetCount(); ++set) {
        const plugin::SurfaceTriangles from = inputs.surfaces->triangles(set);
        const Mesh& mesh = inputs.whole->meshes[from.mesh];
        starts.push_back(corners_.size());
        for (const uint32_t index : mesh.indices)
            corners_.push_back(dvec3(from.renderFromLocal * vec4(mesh.positions[index], 1)));
    }
    starts.push_back(corners_.size());
    for (size_t set = 0; set + 1 < starts.size(); ++set)
        triangles_.push_back({std::span(corners_).subspan(starts[set], starts[set + 1] - starts[set]),
                              uint32_t(set)});
}

/// Empty where a medium has no end.
Bounds SurfelsTechnique::mediaBounds() const {
    Bounds bounds;
    for (const tracing::MediumSource& medium : scene_.media().media()) {
        if (medium.endless()) return {};
        bounds.include(medium.bounds());
    }
    return bounds;
}

void SurfelsTechnique::makePlan(const plugin::FrameInputs& inputs) {
    updateTriangles(inputs);
    SurfelSize size = sizeOf(inputs, used_);
    size.media = mediaBounds();
    const uint64_t chance = chanceOf(inputs);
    const uint64_t key = cacheKey(trianglesKey_, size.eye, size.perDistance, size.least, size.media,
                                  size.perMediumDistance, used_.most, chance);
    if (key == planKey_) return;
    plan_ = planSurfels(triangles_, size, uint32_t(used_.most), chance);
    planKey_ = key;
}

/// Whether anything can receive light is up to the receivers.
const char* SurfelsTechnique::whyNothing(const plugin::FrameInputs& inputs) {
    if (inputs.lights.lightCount == 0) return "no light in the scene";
    if (inputs.surfaces->triangleSetCount() == 0) return "no surface in the scene";
    if (Result<void> ready = scene_.update(inputs, {}); !ready.ok()) {
        if (said_ != ready.message()) host().log(("surfels: " + ready.message()).c_str());
        said_ = ready.message();
        return "the surfaces do not fit into memory";
    }
    makePlan(inputs);
    return plan_.surfels == 0 ? "no surface is as large as a surfel" : nullptr;
}

IntervalRequest SurfelsTechnique::intervals(const plugin::FrameInputs& inputs) const {
    IntervalRequest request;
    request.factor = 1 << used_.march;
    request.count = intervalCount(used_);
    request.jitter = used_.jitter;
    request.paper = asPrinted();
    const Bounds content = boundsOf(inputs.scene.contentMinimum, inputs.scene.contentMaximum);
    request.step = content.empty() ? 1 : glm::length(content.extent()) / kStepsThroughScene;
    for (const tracing::MediumSource& medium : scene_.media().media())
        request.densest += medium.densestBound() * double(maximumOf(vec3(medium.scattering)));
    return request;
}

SplatRequest SurfelsTechnique::splats(fg::FrameGraph& graph, const plugin::FrameInputs& inputs) {
    SplatRequest request;
    request.rays = SurfelRays(used_.rays);
    if (request.rays != SurfelRays::None) request.traced = scene_.buffers(graph);
    request.levels = SurfelPairs(used_.pairs) == SurfelPairs::All ? 1 : uint32_t(used_.levels);
    request.threshold = double(used_.threshold);
    request.attenuation = used_.attenuation;
    request.visibility = used_.visibility && request.rays != SurfelRays::None;
    request.paper = asPrinted();
    request.blur = used_.blur && !converges(inputs);
    request.chance = chanceOf(inputs);
    const fg::BufferHandle surfels =
        addSurfels(graph, inputs, plan_, Surfelizer(used_.surfelizer), planKey_);
    request.surfels = addSurfelLight(graph, inputs, surfels, plan_.surfels);
    if (interleave_.empty()) interleave_ = interleaveTables(gpu::kSurfelMostLevels);
    request.interleave = addCachedUpload(graph, "gi.surfels.interleave", interleave_, 1);
    return request;
}

void SurfelsTechnique::addMedia(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                                SplatRequest request, plugin::FrameOutputs& outputs) {
    const IntervalRequest intervals = this->intervals(inputs);
    const SurfelIntervals map = addSurfelIntervals(graph, inputs, intervals);
    request.size = map.params.size;
    request.factor = intervals.factor;
    request.reached = mediaBounds();
    request.nearest = intervals.step * intervals.step;
    const SplatList list = addSplatList(graph, inputs, request);
    const fg::TextureHandle levels = addMediaSplats(graph, inputs, request, map, list);
    outputs.inMedia = addMediaCollect(graph, inputs, request, map, levels);
    made_.map = map;
    made_.levels = levels;
    if (inputs.statistics) {
        numbers_[0] = float(plan_.surfels);
        numbers_[1] = float(plan_.scale);
        outputs.statistics = addSurfelCounts(graph, list, levels, numbers_);
        outputs.statistic = kStatistics;
        outputs.statisticCount = uint32_t(std::size(kStatistics));
    }
}

plugin::FrameOutputs SurfelsTechnique::addPasses(fg::FrameGraph& graph,
                                                 const plugin::FrameInputs& inputs) {
    plugin::FrameOutputs outputs;
    made_ = {};
    used_ = asPrinted() ? asInThePaper(settings_) : settings_;
    const bool inMedia = (inputs.terms & ~kIndirectOnSurfaces) != 0;
    const char* reason = whyNothing(inputs);
    const char* noMedium = reason ? reason
                           : inputs.media.count == 0 || !inputs.transmittance
                               ? "no medium in view"
                               : nullptr;
    if (inMedia && noMedium) outputs.inMedia = addNothing(graph, inputs, "gi.surfels.splat", noMedium);
    const bool onSurfaces = (inputs.terms & kIndirectOnSurfaces) != 0;
    if (onSurfaces && reason)
        outputs.onSurfaces = addNothing(graph, inputs, "gi.surfels.splatSurfaces", reason);
    if (reason || (noMedium && !onSurfaces)) return outputs;

    SplatRequest request = splats(graph, inputs);
    made_.surfels = request.surfels;
    made_.interleave = request.interleave;
    if (inMedia && !noMedium) addMedia(graph, inputs, request, outputs);
    if (onSurfaces) {
        request.size = ivec2(inputs.view.width, inputs.view.height);
        request.paper = false; // the paper has none
        outputs.onSurfaces =
            addSurfaceSplats(graph, inputs, request, addSplatList(graph, inputs, request));
    }
    return outputs;
}

fg::TextureHandle SurfelsTechnique::addDebugView(fg::FrameGraph& graph,
                                                 const plugin::FrameInputs& inputs,
                                                 fg::TextureHandle color) {
    const fg::TextureHandle shown =
        addSurfelsShow(graph, inputs, made_, uint32_t(used_.show), color);
    made_ = {};
    return shown;
}

std::unique_ptr<GiTechnique> makeSurfels(SharedParts& shared) {
    return std::make_unique<SurfelsTechnique>(shared);
}

} // namespace tyndall::volumetric_gi
