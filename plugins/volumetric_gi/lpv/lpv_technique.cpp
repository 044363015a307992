#include "volumetric_gi/lpv/lpv_technique.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

#include "framegraph/hash.h"
#include "volumetric_gi/lpv/lattice_params.h"
#include "volumetric_gi/lpv/lpv_injection.h"
#include "volumetric_gi/lpv/lpv_light.h"

namespace tyndall::volumetric_gi {
namespace {

constexpr double kLeastPower = 1e-25; // watts of all lights; units for less would overflow
constexpr uint64_t kMostCells = 128ull * 1024 * 1024 / (gpu::kLpvFluxPlanes * sizeof(float));

uint64_t hashFloats(uint64_t seed, const float* values, size_t count) {
    for (size_t i = 0; i < count; ++i) seed = fg::mixHash(seed, std::bit_cast<uint32_t>(values[i]));
    return seed;
}

Bounds boundsOf(const plugin::SceneChange& scene) {
    Bounds bounds;
    for (int axis = 0; axis < 3; ++axis) {
        bounds.minimum[axis] = double(scene.boundsMinimum[axis]);
        bounds.maximum[axis] = double(scene.boundsMaximum[axis]);
    }
    return bounds;
}

/// Cubes of one size around everything, with one more on each side. Where everything begins a cell does, so that walls there stand
/// between cells; but for a thousandth, lest what is a whole number of cells away lies on middles and edges.
gpu::LpvParams placeLattice(const Bounds& bounds, int resolution) {
    const dvec3 extent = bounds.extent();
    const double longest = std::max({extent.x, extent.y, extent.z, 1e-6});
    double cell = longest / (resolution - 2);
    ivec3 size;
    for (;; cell *= 1.05) {
        size = ivec3(glm::ceil(extent / cell - 0.01)) + 2;
        if (uint64_t(size.x) * uint64_t(size.y) * uint64_t(size.z) <= kMostCells) break;
    }
    const dvec3 lowest = bounds.minimum - cell * dvec3(1.001, 1.0013, 1.0017);
    return latticeParams(size, 0, vec3(lowest), float(cell));
}

} // namespace

/// Of everything that the lattice's light follows from.
uint64_t LpvTechnique::sourceKey(const plugin::FrameInputs& inputs) const {
    uint64_t key = fg::mixHash(latticeKey_, inputs.scene.geometry);
    for (const uint64_t version :
         {inputs.scene.materials, inputs.scene.media, uint64_t(settings_.rsmSize),
          uint64_t(settings_.rsmLights), uint64_t(settings_.rsmRectPoints),
          uint64_t(settings_.reflected), uint64_t(settings_.scattered)})
        key = fg::mixHash(key, version);
    const char* bytes = reinterpret_cast<const char*>(inputs.lightData);
    return fg::hashName({bytes, inputs.lights.lightCount * sizeof(gpu::LightData)}, key);
}

fg::BufferHandle LpvTechnique::addMedium(fg::FrameGraph& graph,
                                         const plugin::FrameInputs& inputs) const {
    struct Data {
        MediaResources media;
        fg::BufferHandle medium;
        gpu::LpvParams params;
    };
    return graph
        .addPass<Data>(
            "gi.lpv.medium",
            [&](fg::Builder& builder, Data& data) {
                data.media = inputs.media;
                if (inputs.media.count > 0) data.media = readMedia(builder, inputs.media);
                data.medium =
                    builder.create("gi.lpv.medium",
                                   fg::BufferDesc{cells_ * sizeof(vec4) * gpu::kLpvMediumVectors});
                data.params = params_;
                builder.cacheBy(fg::mixHash(latticeKey_, inputs.scene.media));
            },
            [](const Data& data, fg::PassContext& context) {
                auto command =
                    context.compute("gi/lpv/medium.comp", {{"MEDIA", data.media.count > 0}});
                if (data.media.count > 0) bindMedia(command, data.media);
                command.params(data.params)
                    .bind("LpvMedium", data.medium)
                    .dispatchOver(uint32_t(data.params.size.x), uint32_t(data.params.size.y),
                                  uint32_t(data.params.size.z));
            })
        .medium;
}

fg::BufferHandle LpvTechnique::addLinks(fg::FrameGraph& graph,
                                        const plugin::FrameInputs& inputs) const {
    struct Data {
        fg::BufferHandle links;
        const plugin::SurfaceDrawer* surfaces;
        gpu::LpvParams params;
    };
    return graph
        .addPass<Data>(
            "gi.lpv.links",
            [&](fg::Builder& builder, Data& data) {
                data.links =
                    builder.create("gi.lpv.links",
                                   fg::BufferDesc{cells_ * sizeof(uint32_t) * gpu::kLpvLinkPlanes});
                data.surfaces = inputs.surfaces;
                data.params = params_;
                builder.cacheBy(fg::mixHash(latticeKey_, inputs.scene.geometry));
            },
            [](const Data& data, fg::PassContext& context) {
                context.clearBuffer(data.links, 0);
                context.barrier(fg::Access::StorageWrite);
                for (uint32_t i = 0; i < data.surfaces->triangleSetCount(); ++i) {
                    const plugin::SurfaceTriangles set = data.surfaces->triangles(i);
                    if (set.triangleCount == 0) continue;
                    constexpr uint32_t kMostGroups = 32768; // along one axis; GL promises 65,535
                    context.compute("gi/lpv/links.comp")
                        .params(data.params)
                        .params(
                            gpu::LpvTriangles{set.strideFloats, set.triangleCount, set.object, 0},
                            "Triangles")
                        .bind("Vertices", set.vertices)
                        .bind("Indices", set.indices)
                        .bind("Objects", data.surfaces->objects())
                        .bind("Materials", data.surfaces->materials())
                        .bind("baseColorTexture", set.baseColor)
                        .bind("LpvLinks", data.links)
                        .dispatch(std::min(set.triangleCount, kMostGroups),
                                  (set.triangleCount + kMostGroups - 1) / kMostGroups);
                }
            })
        .links;
}

fg::BufferHandle LpvTechnique::addSources(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                                          const Lattice& lattice, plugin::Host& host) {
    const RsmPlan plan =
        planRsm({inputs.lightData, inputs.lights.lightCount}, boundsOf(inputs.scene),
                settings_.rsmSize, settings_.rsmLights, settings_.rsmRectPoints);
    if (plan.lightsLeftOut > 0 && plan.lightsLeftOut != saidLeftOut_)
        host.log(("lpv: " + std::to_string(plan.lightsLeftOut) + " of " +
                  std::to_string(inputs.lights.lightCount) +
                  " lights light directly alone: gi.lpv.rsmLights is " +
                  std::to_string(settings_.rsmLights))
                     .c_str());
    saidLeftOut_ = plan.lightsLeftOut;
    gpu::LpvInjectParams inject{};
    for (int c = 0; c < 3; ++c)
        inject.scale[c] =
            plan.power[c] > kLeastPower ? float(double(1 << 30) / plan.power[c]) : 0.0f;

    fg::BufferHandle deposits = addEmptyDeposits(graph, cells_);
    for (const RsmView& rsm : plan.views) {
        inject.light = rsm.light;
        inject.share = rsm.share;
        inject.texelArea = rsm.texelArea;
        deposits = addInjection(graph, inputs, settings_, rsm.view,
                                {lattice.medium, lattice.links, deposits, params_, inject});
    }
    return addCollection(graph, {{}, {}, deposits, params_, inject}, cells_);
}

/// Light goes on from where the last frame left it only where nothing has changed since: a picture never shows what was.
fg::BufferHandle LpvTechnique::addSteps(fg::FrameGraph& graph, const Lattice& lattice,
                                        uint64_t key) {
    const fg::BufferDesc desc{cells_ * gpu::kLpvFluxPlanes * sizeof(float)};
    const fg::PersistentBuffer here = graph.persistentBuffer("gi.lpv.flux", desc),
                               there = graph.persistentBuffer("gi.lpv.flux2", desc);
    struct Data {
        Lattice lattice;
        fg::BufferHandle flux[2];
        gpu::LpvParams params;
        int steps;
        bool clear;
    };
    const Data& pass = graph.addPass<Data>(
        "gi.lpv.propagate",
        [&](fg::Builder& builder, Data& data) {
            data.lattice.medium = builder.read(lattice.medium);
            data.lattice.sources = builder.read(lattice.sources);
            data.lattice.links = builder.read(lattice.links);
            data.flux[0] = builder.write(here.handle);
            data.flux[1] = builder.write(there.handle);
            data.params = params_;
            data.steps = (settings_.steps + 1) / 2 * 2; // ends in the first buffer
            data.clear = here.wasReset || there.wasReset || stateKey_ != key;
        },
        [](const Data& data, fg::PassContext& context) {
            if (data.clear) {
                context.clearBuffer(data.flux[0], 0);
                context.barrier(fg::Access::StorageRead);
            }
            for (int step = 0; step < data.steps; ++step) {
                context.compute("gi/lpv/propagate.comp")
                    .params(data.params)
                    .bind("LpvMedium", data.lattice.medium)
                    .bind("LpvSources", data.lattice.sources)
                    .bind("LpvLinks", data.lattice.links)
                    .bind("LpvFlux", data.flux[step % 2])
                    .bind("LpvSent", data.flux[1 - step % 2])
                    .dispatchOver(uint32_t(data.params.size.x), uint32_t(data.params.size.y),
                                  uint32_t(data.params.size.z));
                context.barrier(fg::Access::StorageRead);
            }
        });
    stateKey_ = key;
    return pass.flux[0];
}

plugin::FrameOutputs LpvTechnique::addPasses(fg::FrameGraph& graph,
                                             const plugin::FrameInputs& inputs,
                                             plugin::Host& host) {
    const Bounds bounds = boundsOf(inputs.scene);
    if (bounds.empty() || inputs.lights.lightCount == 0) return {};
    params_ = placeLattice(bounds, settings_.resolution);
    cells_ = uint64_t(params_.size.x) * uint64_t(params_.size.y) * uint64_t(params_.size.z);
    latticeKey_ = hashFloats(cells_, &params_.lowest.x, 4);
    for (int axis = 0; axis < 3; ++axis)
        latticeKey_ = fg::mixHash(latticeKey_, uint64_t(params_.size[axis]));

    Lattice lattice;
    lattice.medium = addMedium(graph, inputs);
    lattice.links = addLinks(graph, inputs);
    lattice.sources = addSources(graph, inputs, lattice, host);
    lattice.flux = addSteps(graph, lattice, sourceKey(inputs));
    const LatticeLight light = addLatticeLight(graph, params_, lattice.medium, lattice.sources,
                                               lattice.links, lattice.flux);
    plugin::FrameOutputs outputs;
    if (inputs.terms & kIndirectOnSurfaces)
        outputs.surfaceRadiance = addSurfaceLookup(graph, inputs, params_, lattice.links, light);
    if (inputs.terms & ~kIndirectOnSurfaces)
        outputs.inScatter = addMediumLookup(graph, inputs, params_, lattice.links, light);
    return outputs;
}

} // namespace tyndall::volumetric_gi
