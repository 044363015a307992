#include "volumetric_gi/vpl/vpl_technique.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "framegraph/hash.h"
#include "volumetric_gi/vpl/vpl_maps.h"

namespace tyndall::volumetric_gi {
namespace {

/// Rounds of loops that one invocation of a shader may run: llvmpipe ends them all at 65,535, and each light gathered takes some.
constexpr double kMostRounds = 16000;
/// Segments of a ray through media, for that.
constexpr double kSegments = 64;

bool converges(const plugin::FrameInputs& inputs) {
    return (inputs.view.data.flags & gpu::kViewConverge) != 0;
}

} // namespace

void VplTechnique::makeLights(const plugin::FrameInputs& inputs) {
    uint64_t key = scene_.key();
    const uint32_t generation = converges(inputs) ? inputs.view.data.frameIndex : 0;
    for (const uint64_t value : {uint64_t(generation), uint64_t(inputs.view.data.seed),
                                 uint64_t(settings_.walks), uint64_t(settings_.mapSide),
                                 uint64_t(settings_.fromSurfaces), uint64_t(settings_.fromMedia)})
        key = fg::mixHash(key, value);
    if (key == lightsKey_ && settings_.keep) return;
    set_ = makeWalks(scene_.scene(), scene_.emission(),
                     {uint32_t(settings_.walks), inputs.view.data.seed, generation,
                      settings_.fromSurfaces, settings_.fromMedia});
    const reference::SurfaceScene& surfaces = *scene_.scene().surfaces;
    maps_.clear();
    if (settings_.mapSide > 0 && surfaces.triangleCount() > 0)
        maps_ = makeVisibilityMaps(surfaces, set_, uint32_t(settings_.mapSide), generation);
    if (planesKey_ != scene_.surfacesKey()) planes_ = surfaces.planes();
    planesKey_ = scene_.surfacesKey();
    lightsKey_ = key;
}

/// gi.vpl.clamp times the mean distance between virtual lights: (V/M)^(1/3) (transport.md, 5.1 i).
double VplTechnique::clampDistance() const {
    Bounds around;
    for (const dvec3& position : set_.positions) around.include(position);
    if (around.empty()) return 0;
    const dvec3 extent = glm::max(around.extent(), 1e-3 * glm::length(around.extent()));
    const double volume = extent.x * extent.y * extent.z;
    return double(settings_.clamp) * std::cbrt(volume / double(set_.positions.size()));
}

gpu::VplParams VplTechnique::params(const plugin::FrameInputs& inputs) const {
    gpu::VplParams params{};
    params.lightCount = uint32_t(set_.lights.size());
    params.walkCount = uint32_t(set_.walks.size()) - 1;
    const double least = double(params.lightCount) * kSegments / kMostRounds;
    params.classes = uint32_t(std::clamp(std::max(double(settings_.classes), std::ceil(least)), 1.0,
                                         double(std::max(params.walkCount, 1u))));
    params.mapSide = maps_.empty() ? 0 : uint32_t(settings_.mapSide);
    const double reach = clampDistance();
    params.clampSquared = float(reach * reach);
    params.leastRoughness = settings_.roughness;
    params.compensation = uint32_t(settings_.compensation);
    params.lightsOfScene = inputs.lights.lightCount;
    params.factor = 1u << uint32_t(settings_.march);
    params.relaxed = settings_.relaxed;
    return params;
}

plugin::FrameOutputs VplTechnique::addPasses(fg::FrameGraph& graph,
                                             const plugin::FrameInputs& inputs,
                                             plugin::Host& host) {
    if (Result<void> ready = scene_.update(inputs); !ready.ok()) {
        if (said_ != ready.message()) host.log(("vpl: " + ready.message()).c_str());
        said_ = ready.message();
        return {};
    }
    makeLights(inputs);
    const VplBuffers buffers =
        addVplUpload(graph, {&set_, &maps_, &planes_, lightsKey_, planesKey_});
    plugin::FrameOutputs outputs;
    if (inputs.terms & kIndirectOnSurfaces)
        outputs.surfaceRadiance = addVplSurfaces(graph, inputs, buffers, params(inputs));
    if (inputs.terms & ~kIndirectOnSurfaces)
        outputs.inScatter = addVplMedia(graph, inputs, buffers, params(inputs));
    return outputs;
}

} // namespace tyndall::volumetric_gi
