#include "volumetric_gi/lpv/lpv_technique.h"

#include <cstddef>
#include <string>
#include <utility>

#include "plugin/cache_key.h"
#include "volumetric_gi/lpv/lpv_injection.h"
#include "volumetric_gi/lpv/lpv_printed.h"
#include "volumetric_gi/lpv/lpv_show.h"
#include "volumetric_gi/shared/scene_bounds.h"

namespace tyndall::volumetric_gi {
namespace {

/// A lattice mixes terms, but separates receivers. Light that surfaces or media have scattered once before comes from a lattice that has no other
/// sources and does not scatter.
constexpr TermSet kFromSurfaces = terms(Term::LSSE, Term::LSVE),
                  kFromMedia = terms(Term::LVSE, Term::LVVE), kOnce = kFromSurfaces | kFromMedia;
constexpr TermSet kSets[] = {kIndirectOnSurfaces | kIndirectInMedia,
                             kIndirectOnSurfaces,
                             kIndirectInMedia,
                             kOnce,
                             kOnce & kIndirectOnSurfaces,
                             kOnce & kIndirectInMedia,
                             kFromSurfaces,
                             bit(Term::LSSE),
                             bit(Term::LSVE),
                             kFromMedia,
                             bit(Term::LVSE),
                             bit(Term::LVVE)};

constexpr double kLeastPower = 1e-25; // watts of all lights; units for less would overflow

PlacementRequest placementOf(const plugin::FrameInputs& inputs, const LpvSettings& settings) {
    PlacementRequest request;
    request.bounds = boundsOf(inputs.scene.boundsMinimum, inputs.scene.boundsMaximum);
    request.content = boundsOf(inputs.scene.contentMinimum, inputs.scene.contentMaximum);
    request.eye = dvec3(vec3(inputs.view.data.cameraPosition));
    request.forward = dvec3(vec3(inputs.view.data.cameraForward));
    request.resolution = settings.resolution;
    request.most = settings.cascades;
    request.extent = double(settings.extent);
    return request;
}

gpu::LpvInjectParams injectParams(const dvec3& power) {
    gpu::LpvInjectParams inject{};
    for (int c = 0; c < 3; ++c)
        inject.scale[c] = power[c] > kLeastPower ? float(double(1 << 30) / power[c]) : 0.0f;
    return inject;
}

} // namespace

/// Key of everything that a lattice's light depends on, coarser lattices included (`place`: their keys and that of its own place).
uint64_t LpvTechnique::sourceKey(const plugin::FrameInputs& inputs, uint64_t place) const {
    return cacheKey(place, inputs.scene.geometry, inputs.scene.materials, inputs.scene.media,
                    settings_.rsmSize, settings_.rsmLights, settings_.rsmRectPoints,
                    settings_.reflected, settings_.scattered, settings_.tolerance,
                    lightsKey({inputs.lightData, inputs.lights.lightCount}));
}

void LpvTechnique::addSources(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                              std::vector<Lattice>& lattices,
                              const LpvSettings& settings) {
    const Bounds bounds = boundsOf(inputs.scene.boundsMinimum, inputs.scene.boundsMaximum);
    std::vector<Bounds> boxes;
    for (const Lattice& lattice : lattices)
        boxes.push_back(intersection(lattice.level.box(), bounds));
    const RsmPlan plan = planRsm({inputs.lightData, inputs.lights.lightCount}, bounds, boxes,
                                 settings_.rsmSize, settings_.rsmLights, settings_.rsmRectPoints);
    if (plan.lightsLeftOut > 0 && plan.lightsLeftOut != saidLeftOut_)
        host().log(("lpv: " + std::to_string(plan.lightsLeftOut) + " of " +
                  std::to_string(inputs.lights.lightCount) +
                  " lights light directly alone: gi.lpv.rsmLights is " +
                  std::to_string(settings_.rsmLights))
                     .c_str());
    saidLeftOut_ = plan.lightsLeftOut;

    std::vector<Injection> injections;
    std::vector<bool> stale;
    for (size_t i = 0; i < lattices.size(); ++i) {
        const Lattice& lattice = lattices[i];
        const fg::PersistentBuffer kept = keptDeposits(graph, int(i), lattice.level.cells);
        const uint64_t key = sourceKey(inputs, lattice.level.key);
        stale.push_back(kept.wasReset || depositKeys_[i] != key || !settings_.keep);
        depositKeys_[i] = key;
        injections.push_back({lattice.medium, lattice.links, kept.handle, lattice.level.params,
                              injectParams(plan.power[i])});
        injections.back().params.grid.place = {0, 0, 0, 0};
        if (stale[i]) injections[i].deposits = addClear(graph, kept.handle);
    }
    for (const RsmView& rsm : plan.views) {
        const auto wants = [&](size_t i) { return stale[i] && (rsm.box < 0 || rsm.box == int(i)); };
        bool wanted = false;
        for (size_t i = 0; i < lattices.size(); ++i) wanted = wanted || wants(i);
        if (!wanted) continue;
        const Rsm map = addRsm(graph, inputs, rsm);
        for (size_t i = 0; i < lattices.size(); ++i)
            if (wants(i))
                injections[i].deposits = addInjection(graph, inputs, settings, map, injections[i]);
    }
    for (size_t i = 0; i < lattices.size(); ++i)
        lattices[i].sources = addCollection(graph, injections[i], lattices[i].level.cells);
}

/// The finest lattice is "gi.lpv", those around it "gi.lpv.outer1" and so on.
void LpvTechnique::nameStatistics(size_t lattices) {
    static constexpr std::pair<const char*, size_t> kValues[] = {
        {"energy.{}.stored", offsetof(gpu::LpvControl, stored)},
        {"energy.{}.injected", offsetof(gpu::LpvControl, injected)},
        {"energy.{}.absorbed", offsetof(gpu::LpvControl, absorbed)},
        {"energy.{}.escaped", offsetof(gpu::LpvControl, escaped)},
        {"energy.{}.blocked", offsetof(gpu::LpvControl, blocked)},
        {"energy.{}.change", offsetof(gpu::LpvControl, change)},
        {"energy.{}.imbalance", offsetof(gpu::LpvControl, imbalance)},
        {"iterations.{}", offsetof(gpu::LpvControl, steps)},
        {"residual.{}", offsetof(gpu::LpvControl, residual)},
        {"remaining.{}", offsetof(gpu::LpvControl, error)},
    };
    statisticNames_.clear();
    statistics_.clear();
    for (size_t i = 0; i < lattices; ++i)
        for (const auto& [format, offset] : kValues) {
            const size_t outer = lattices - 1 - i;
            std::string name(format);
            name.replace(name.find("{}"), 2,
                         outer == 0 ? "gi.lpv" : "gi.lpv.outer" + std::to_string(outer));
            statisticNames_.push_back(name);
            statistics_.push_back(
                {nullptr, uint32_t((i * sizeof(gpu::LpvControl) + offset) / sizeof(float))});
        }
    for (size_t k = 0; k < statistics_.size(); ++k)
        statistics_[k].name = statisticNames_[k].c_str();
}

/// The coarsest first: each lattice begins with the light of the one around it, and receives the light that enters from there.
LatticeLight LpvTechnique::addLight(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                                    std::vector<Lattice>& lattices, const SharedPlaces& places,
                                    fg::BufferHandle& control) {
    LatticeLight light;
    uint64_t place = 0;
    for (size_t i = 0; i < lattices.size(); ++i) {
        Lattice& lattice = lattices[i];
        const Lattice* outer = i > 0 ? &lattices[i - 1] : nullptr;
        place = cacheKey(place, lattice.level.key);
        const uint64_t key = sourceKey(inputs, place);
        if (outer) lattice.sources = addInflow(graph, lattice, *outer);
        // Light continues from the last frame only if nothing has changed since: a picture never has light of an earlier scene.
        const Flux flux = addSteps(graph, lattice, outer,
                                   {int(i), settings_.steps, settings_.tolerance,
                                    settings_.keep && stateKeys_[i] == key, inputs.statistics},
                                   control);
        lattice.flux = flux.now;
        lattice.fluxBefore = flux.before;
        stateKeys_[i] = key;
        if (!lattice.level.covered) light = addLatticeLight(graph, lattice, places, light);
    }
    return light;
}

const plugin::TechniqueInfo& LpvTechnique::info() const {
    static constexpr plugin::TechniqueInfo kInfo{
        .name = "lpv",
        .title = "Light propagation volume",
        .help = "Propagates light that surfaces reflect and media scatter through a lattice: all indirect light.",
        .claims = kIndirectOnSurfaces | kIndirectInMedia,
        .sets = kSets,
        .setCount = uint32_t(std::size(kSets)),
        .media = kAllMedia,
        .separatesMedia = 1,
        .automatic = 1,
        .expected = {{4, 0.05f, 1}, {4, 0.16f, 0.1f}, {2, 2, 0.18f}, {1, 1, 1}}};
    return kInfo;
}

plugin::SettingsTable LpvTechnique::settings() {
    return table(lpvSettings(), &settings_, lpvPresets());
}

plugin::FrameOutputs LpvTechnique::addPasses(fg::FrameGraph& graph,
                                             const plugin::FrameInputs& inputs) {
    const bool printed = asPrinted();
    finest_ = {};
    PlacementRequest placement = placementOf(inputs, settings_);
    if (placement.bounds.empty() || inputs.lights.lightCount == 0) return {};
    const bool once = (inputs.terms & ~kOnce) == 0;
    LpvSettings sources = settings_;
    sources.reflected &= !once || (inputs.terms & kFromSurfaces) != 0;
    sources.scattered &= inputs.media.count > 0 && (!once || (inputs.terms & kFromMedia) != 0);
    if (!sources.reflected && !sources.scattered) return {};
    if (printed) {
        placement.most = 1;
        placement.extent = 0;
        placement.content = placement.bounds;
    }
    std::vector<LatticeLevel> levels = placeLattices(placement);
    for (LatticeLevel& level : levels) {
        level.params.onward = once ? 0 : 1;
        level.key = fg::mixHash(level.key, once ? inputs.terms : 0);
    }
    const SharedPlaces places = sharePlaces(levels);
    std::vector<Lattice> lattices(levels.size());
    for (size_t i = 0; i < levels.size(); ++i) {
        lattices[i].level = levels[i];
        lattices[i].medium = addLatticeMedium(graph, inputs, levels[i]);
        lattices[i].links = addLatticeLinks(graph, inputs, levels[i]);
    }
    addSources(graph, inputs, lattices, sources);

    const fg::BufferDesc desc{gpu::kLpvMostLevels * sizeof(gpu::LpvControl)};
    fg::BufferHandle control = graph.persistentBuffer("gi.lpv.control", desc).handle;
    if (printed) stateKeys_ = {};
    const LatticeLight light =
        printed ? addPrintedLight(graph, lattices[0], places, settings_.steps, control)
                : addLight(graph, inputs, lattices, places, control);
    finest_ = lattices.back();
    light_ = light;
    plugin::FrameOutputs outputs;
    if (inputs.terms & kIndirectOnSurfaces)
        outputs.onSurfaces = addSurfaceLookup(graph, inputs, places.levels, light);
    if (inputs.terms & ~kIndirectOnSurfaces)
        outputs.inMedia =
            addMediumLookup(graph, inputs, places.levels, light, 1 << settings_.march);
    if (inputs.statistics) {
        nameStatistics(lattices.size());
        outputs.statistics = control;
        outputs.statistic = statistics_.data();
        outputs.statisticCount = uint32_t(statistics_.size());
    }
    return outputs;
}

fg::TextureHandle LpvTechnique::addDebugView(fg::FrameGraph& graph,
                                              const plugin::FrameInputs& inputs,
                                              fg::TextureHandle color) {
    const fg::TextureHandle shown =
        addLatticeSlice(graph, inputs, settings_, finest_, light_, color);
    finest_ = {}; // of this frame alone
    return shown;
}

std::unique_ptr<GiTechnique> makeLpv(SharedParts& shared) {
    return std::make_unique<LpvTechnique>(shared);
}

} // namespace tyndall::volumetric_gi
