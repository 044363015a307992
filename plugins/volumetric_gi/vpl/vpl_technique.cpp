#include "volumetric_gi/vpl/vpl_technique.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "framegraph/hash.h"
#include "plugin/cache_key.h"
#include "volumetric_gi/vpl/vpl_choice.h"
#include "volumetric_gi/vpl/vpl_maps.h"
#include "volumetric_gi/vpl/vpl_rounds.h"

namespace tyndall::volumetric_gi {
namespace {

/// Radius of a light in the debug view, over the mean distance between lights.
constexpr double kBall = 0.08;

/// As addStatistics() fills them in; milliseconds are of this frame, on the processor.
constexpr plugin::Statistic kStatistics[] = {
    {"virtual_lights.gi.vpl", 0}, {"walks.gi.vpl", 1},    {"walks_cut_off.gi.vpl", 2},
    {"walks_traced.gi.vpl", 3},   {"walks_ms.gi.vpl", 4}, {"choice_ms.gi.vpl", 5},
    {"maps_ms.gi.vpl", 6},        {"near_ms.gi.vpl", 7},  {"near_nonfinite.gi.vpl", 8},
};

/// Adds the time that it lives to a number of milliseconds.
class Stopwatch {
public:
    explicit Stopwatch(float& milliseconds) : milliseconds_(milliseconds) {}
    ~Stopwatch() {
        const std::chrono::duration<float, std::milli> passed =
            std::chrono::steady_clock::now() - start_;
        milliseconds_ += passed.count();
    }
    Stopwatch(const Stopwatch&) = delete;
    Stopwatch& operator=(const Stopwatch&) = delete;

private:
    float& milliseconds_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Of points that are splatted into maps: lights side by side have different ones, so that their errors differ.
constexpr uint32_t kPointSets = 8;

/// Clamp distance of the walks that paths gather, over the content's radius. One walk carries all power of the lights: clamped nearer, it outshines the picture (at 0.3
/// paths in a sunlit hall have 1.4 to 1.7 times the noise); clamped farther, dense media are noisier (at 1 the cloud and fog of τ 8 have 1.3 to 1.5 times the noise of 0.3).
constexpr double kClampOfPaths = 0.6;

/// Visible points that the importance of lights is measured at.
constexpr uint32_t kSeenPoints = 256;

/// Mean distance between lights, metres: (V/M)^(1/3) of the M lights in the content and their box, of volume V; of all lights if none is there.
/// `times`: multiplies M.
double meanDistanceOf(const std::vector<dvec3>& lights, const Bounds& content, double times) {
    Bounds around[2];
    double count[2] = {};
    for (const dvec3& position : lights)
        for (const int i : {0, 1}) {
            if (i == 0 && !content.contains(position)) continue;
            around[i].include(position);
            ++count[i];
        }
    const int i = count[0] > 0 ? 0 : 1;
    if (around[i].empty()) return 0;
    const dvec3 extent = glm::max(around[i].extent(), 1e-3 * glm::length(around[i].extent()));
    return std::cbrt(extent.x * extent.y * extent.z / (count[i] * times));
}

/// Which virtual lights count at a receiver: the terms LSrE, LVrE, LXSrE and LXVrE in the order of kVplOfSurfaces and so on.
uint32_t termBits(TermSet given, const Term (&terms)[4]) {
    uint32_t bits = 0;
    for (uint32_t i = 0; i < 4; ++i)
        if (given & bit(terms[i])) bits |= 1u << i;
    return bits;
}

/// As in the paper (docs/techniques/vpl-explained.md, "Corrections to the paper"): the lights of every walk, one clamping distance for all light, and compensation by
/// one step in media that does not gather direct light.
VplSettings asInThePaper(VplSettings settings) {
    settings.candidates = 1;
    settings.surfaceClamp = settings.clamp;
    settings.compensationPaths = 0;
    settings.incremental = false;
    return settings;
}

bool converges(const plugin::FrameInputs& inputs) {
    return (inputs.view.data.flags & gpu::kViewConverge) != 0;
}

} // namespace

void VplTechnique::makeLights(const plugin::FrameInputs& inputs) {
    const uint32_t generation = converges(inputs) ? inputs.view.data.frameIndex : 0;
    // Importance changes with the media: where walks are kept while media change, all lights are.
    const bool inTurns = used_.renewed > 0 && !used_.incremental && !converges(inputs);
    const uint32_t candidates =
        used_.incremental || inTurns ? 1 : uint32_t(used_.candidates);
    const uint64_t order =
        cacheKey(generation, inputs.view.data.seed, used_.walks, used_.mapSide,
                 used_.maps, used_.points, used_.fromSurfaces, used_.fromMedia,
                 candidates, candidates > 1 ? viewKey(inputs.view.data) : 0);
    const uint64_t walksKey = cacheKey(order, scene_.walksKey()),
                   lightsKey = cacheKey(order, scene_.key()),
                   surfacesKey = cacheKey(order, scene_.surfacesKey());
    times_ = {};
    walksTraced_ = 0;
    if (lightsKey == lightsKey_ && used_.keep) return;
    const WalkOrder what{uint32_t(used_.walks) * candidates,
                         candidates,
                         inputs.view.data.seed,
                         generation,
                         used_.fromSurfaces,
                         used_.fromMedia};
    if (inTurns && surfacesKey == turnsKey_ && used_.keep) {
        renewSome(what, lightsKey);
        return;
    }
    const bool anew = walksKey != walksKey_ || !used_.keep;
    if (anew) {
        const Stopwatch watch(times_.walks);
        walks_ = traceWalks(scene_.scene(), scene_.emission(), what, 0, what.walks);
        walksTraced_ = what.walks;
    }
    if (anew && candidates > 1) {
        const Stopwatch watch(times_.choice);
        choose(inputs, what, candidates);
    }
    set_ = packWalks(
        scene_.usesProxies() ? reweighed(walks_, *scene_.scene().media, scene_.media()) : walks_, what);
    if (!scene_.usesProxies()) walks_ = {}; // they point to media that are not kept
    if (anew) makeMaps(generation);
    walksKey_ = walksKey;
    lightsKey_ = wantedKey_ = lightsKey;
    turnsKey_ = inTurns ? surfacesKey : 0;
    stale_ = nextTurn_ = 0;
}

/// Visibility maps of all lights.
void VplTechnique::makeMaps(uint32_t generation) {
    const Stopwatch watch(times_.maps);
    const tracing::SurfaceScene& surfaces = *scene_.scene().surfaces;
    maps_.clear();
    points_ = {};
    if (used_.mapSide > 0 && used_.maps == kVplMapsOfPoints)
        points_ = makeSurfacePoints(surfaces, set_.positions, uint32_t(used_.points),
                                    kPointSets, generation);
    else if (used_.mapSide > 0 && surfaces.triangleCount() > 0)
        maps_ = makeVisibilityMaps(surfaces, set_, uint32_t(used_.mapSide), generation);
}

/// After a change of lights or media: renews this many walks a frame, in turn, until all belong to the present scene. Maps of the other lights stay.
void VplTechnique::renewSome(const WalkOrder& order, uint64_t lightsKey) {
    if (lightsKey != wantedKey_) {
        wantedKey_ = lightsKey;
        stale_ = order.walks;
    }
    if (stale_ == 0) return;
    const uint32_t first = nextTurn_,
                   count = std::min({uint32_t(used_.renewed), stale_, order.walks - first});
    VplSet others;
    {
        const Stopwatch watch(times_.walks);
        others =
            packWalks(traceWalks(scene_.scene(), scene_.emission(), order, first, count), order);
    }
    const uint32_t begin = set_.starts[first], end = set_.starts[first + count];
    replaceWalks(set_, first, others);
    if (points_.points.empty() && !maps_.empty()) {
        const Stopwatch watch(times_.maps);
        const auto side = uint32_t(used_.mapSide);
        const auto stride = std::ptrdiff_t(side) * side + 1;
        const std::vector<uint32_t> maps =
            makeVisibilityMaps(*scene_.scene().surfaces, others, side, order.generation);
        maps_.erase(maps_.begin() + begin * stride, maps_.begin() + end * stride);
        maps_.insert(maps_.begin() + begin * stride, maps.begin(), maps.end());
    } else {
        makeMaps(order.generation);
    }
    walksTraced_ = count;
    stale_ -= count;
    nextTurn_ = first + count < order.walks ? first + count : 0;
    lightsKey_ = walksKey_ = cacheKey(lightsKey, stale_);
}

/// Chooses among the lights of all candidates by importance.
void VplTechnique::choose(const plugin::FrameInputs& inputs, const WalkOrder& order,
                          uint32_t candidates) {
    const tracing::SurfaceScene& surfaces = *scene_.scene().surfaces;
    const uint64_t seed = fg::mixHash(order.seed, order.generation);
    std::vector<dvec3> lights;
    for (const auto& walk : walks_.vertices)
        for (const tracing::WalkVertex& light : walk) lights.push_back(light.position);
    chooseLights(walks_, seenPoints(inputs.view.data, surfaces, scene_.media(), kSeenPoints, seed),
                 surfaces, scene_.media(), double(lights.size()) / candidates,
                 meanDistanceOf(lights, scene_.content(), 1.0 / candidates), seed);
}

/// Compensation paths on the processor: in averaged frames alone, because they are noisy. Not if walks go through proxy media.
bool VplTechnique::followsWhatIsMissed(const plugin::FrameInputs& inputs) const {
    return used_.compensationPaths > 0 && std::max(used_.clamp, used_.surfaceClamp) > 0 &&
           used_.fromSurfaces && used_.fromMedia &&
           used_.compensation == int32_t(gpu::kVplTraced) &&
           used_.show != int32_t(gpu::kVplShowLost) && converges(inputs) && !scene_.usesProxies();
}

void VplTechnique::makePathLight(const plugin::FrameInputs& inputs) {
    const gpu::VplParams& params = gather_.params;
    if (!pathLight_.onSurfaces.empty() || !pathLight_.inMedia.empty() || params.pathLight != 0)
        ++pathLightVersion_;
    pathLight_ = {};
    if (params.pathLight == 0) return;
    const auto metres = [](float squared) { return std::sqrt(double(squared)); };
    CompensationOrder order;
    order.surfaceFactor = gather_.surfaceFactor;
    order.mediaFactor = gather_.mediaFactor;
    order.paths = uint32_t(used_.compensationPaths);
    order.first = inputs.view.data.frameIndex * order.paths;
    order.onSurfaces = (inputs.terms & kIndirectOnSurfaces) != 0;
    order.inMedia = (inputs.terms & ~kIndirectOnSurfaces) != 0 &&
                    (params.pathLight & gpu::kVplPathsInMedia) != 0 && inputs.media.count > 0 &&
                    inputs.transmittance; // else none is in view
    order.clamps = {metres(params.surfaceClampSquared), metres(params.clampSquared),
                    metres(params.mediumClampSquared), double(params.relaxed)};
    tracing::VirtualLightPathSettings& path = order.path;
    path.terms = inputs.terms & ~kDirectTerms;
    path.clampDistance = order.clamps.betweenSurfaces;
    path.middle = dvec3(params.content);
    if (params.content.w > 0) {
        path.radius = 1 / std::sqrt(double(params.content.w));
        path.clampDistance = kClampOfPaths * path.radius;
    }
    path.leastRoughness = double(params.leastRoughness);
    const Stopwatch watch(times_.near);
    pathLight_ = compensationLight(inputs.view.data, scene_.scene(), scene_.emission(), order);
}

/// Clamping distances, and what compensates for the clamped light.
void VplTechnique::setClamps(const plugin::FrameInputs& inputs, gpu::VplParams& params) const {
    // The clamping distance follows from all lights of an average: the clamped light tends to 0 with more frames.
    const double frames =
        converges(inputs) && !asPrinted() ? double(inputs.view.data.frameIndex) + 1 : 1;
    const double mean = meanDistanceOf(set_.positions, scene_.content(), frames);
    const auto squared = [](double x) { return float(x * x); };
    params.clampSquared = squared(mean * double(used_.clamp));
    // The solid angle of a lobe goes with the fourth power of roughness: it may narrow while lights in it become more. The same holds for the relaxed clamping.
    // Not between surfaces: the distance d below which one light in d² outshines the average must fall more slowly than the root of the number of frames.
    const double finer = std::pow(frames, 1.0 / 6);
    params.mediumClampSquared = squared(mean * double(used_.surfaceClamp));
    // Where paths compensate for it no light is lost, and the distance stays large for less noise.
    params.pathLight = 0;
    if (followsWhatIsMissed(inputs)) {
        params.pathLight = gpu::kVplPathsOnSurfaces;
        if (inputs.kinds == kAllMedia) params.pathLight |= gpu::kVplPathsInMedia; // paths see all media
    }
    params.surfaceClampSquared = params.pathLight != 0
                                     ? squared(meanDistanceOf(set_.positions, scene_.content(), 1) *
                                               double(used_.surfaceClamp) / finer)
                                     : params.mediumClampSquared;
    params.leastRoughness = float(double(used_.roughness) / finer);
    params.relaxed = float(double(used_.relaxed) * finer);
    const Bounds& content = scene_.content();
    const double radius = content.empty() ? 0 : 0.5 * glm::length(content.extent());
    if (radius > 0 && !asPrinted()) params.content = vec4(vec3(content.centre()), squared(1 / radius));
}

VplGather VplTechnique::gather(const plugin::FrameInputs& inputs) const {
    VplGather gather;
    gpu::VplParams& params = gather.params;
    params.lightCount = uint32_t(set_.lights.size());
    params.walkCount = uint32_t(set_.walks.size()) - 1;
    Bounds grids;
    for (const tracing::MediumSource& medium : scene_.media().media())
        if (medium.isGrid()) grids.include(medium.bounds());
    params.samples = uint32_t(used_.samples);
    const VplRounds rounds(inputs.media, !grids.empty(), scene_, params);
    params.subsets = rounds.subsets(used_.subsets, 2 * double(used_.samples)); // with compensation
    params.surfaceSubsets = rounds.subsets(used_.surfaceSubsets, 1);
    params.mapSide = maps_.empty() && points_.points.empty() ? 0 : uint32_t(used_.mapSide);
    setClamps(inputs, params);
    params.lost = used_.show == int32_t(gpu::kVplShowLost) ? 1 : 0;
    params.compensation = params.lost != 0 ? gpu::kVplClamped : uint32_t(used_.compensation);
    params.surfaceTerms =
        termBits(inputs.terms, {Term::LSSE, Term::LVSE, Term::LXSSE, Term::LXVSE});
    params.mediaTerms = termBits(inputs.terms, {Term::LSVE, Term::LVVE, Term::LXSVE, Term::LXVVE});
    // The closed form needs all terms around a point, and all media.
    if (params.compensation == gpu::kVplClosedForm &&
        (params.mediaTerms != gpu::kVplAllTerms || inputs.kinds != kAllMedia))
        params.compensation = gpu::kVplTraced;
    params.lightsOfScene = asPrinted() ? 0 : inputs.lights.lightCount;
    params.upToFreePath = asPrinted() ? 0 : 1;
    gather.pointsATurn = rounds.pointsATurn();
    if (!grids.empty() && inputs.media.count > 0) {
        params.depthSide = uint32_t(used_.depthSide);
        params.gridsMinimum = vec4(vec3(grids.minimum), 0);
        params.gridsMaximum = vec4(vec3(grids.maximum), 0);
    }
    gather.mediaFactor = 1 << used_.march;
    gather.surfaceFactor = 1 << used_.surfaces;
    return gather;
}

const plugin::TechniqueInfo& VplTechnique::info() const {
    static constexpr plugin::TechniqueInfo kInfo{
        .name = "vpl",
        .title = "Virtual point lights",
        .help = "Gathers virtual lights that random walks leave: all indirect light, noisy in single frames.",
        .claims = kIndirectOnSurfaces | kIndirectInMedia,
        .sets = nullptr,
        .setCount = 0,
        .media = kAllMedia,
        .separatesMedia = 1,
        .automatic = 1,
        .expected = {{8, 0.1f, 1}, {12, 1, 0.36f}, {3, 2.9f, 0.54f}, {11, 1, 0.53f}}};
    return kInfo;
}

plugin::SettingsTable VplTechnique::settings() {
    return table(vplSettings(), &settings_, vplPresets());
}

plugin::FrameOutputs VplTechnique::addPasses(fg::FrameGraph& graph,
                                             const plugin::FrameInputs& inputs) {
    used_ = asPrinted() ? asInThePaper(settings_) : settings_;
    if (Result<void> ready = scene_.update(inputs, {used_.incremental}); !ready.ok()) {
        if (said_ != ready.message()) host().log(("vpl: " + ready.message()).c_str());
        said_ = ready.message();
        return {};
    }
    makeLights(inputs);
    gather_ = gather(inputs);
    makePathLight(inputs);
    TracedBuffers traced = scene_.buffers(graph);
    if (settings_.mapSide == 0) traced.params.treeSize = 0;
    buffers_ = addVplUpload(graph, inputs,
                            {&set_, &maps_, &points_, traced, &pathLight_.onSurfaces,
                             &pathLight_.inMedia, lightsKey_, walksKey_, pathLightVersion_},
                            gather_.params);
    plugin::FrameOutputs outputs;
    if (inputs.terms & kIndirectOnSurfaces)
        outputs.onSurfaces = addVplSurfaces(graph, inputs, buffers_, gather_);
    if (inputs.terms & ~kIndirectOnSurfaces)
        outputs.inMedia = addVplMedia(graph, inputs, buffers_, gather_);
    gathered_ = {outputs.onSurfaces, outputs.inMedia};
    if (inputs.statistics) {
        outputs.statistics = addStatistics(graph);
        outputs.statistic = kStatistics;
        outputs.statisticCount = uint32_t(std::size(kStatistics));
    }
    return outputs;
}

fg::BufferHandle VplTechnique::addStatistics(fg::FrameGraph& graph) {
    statistics_ = {float(set_.lights.size()),
                   float(used_.walks),
                   float(set_.cutOff),
                   float(walksTraced_),
                   times_.walks,
                   times_.choice,
                   times_.maps,
                   times_.near,
                   float(pathLight_.nonFinite)};
    struct Data {
        fg::BufferHandle values;
        const float* data;
    };
    return graph
        .addPass<Data>(
            "gi.vpl.statistics",
            [&](fg::Builder& builder, Data& data) {
                data.data = statistics_.data();
                data.values =
                    builder.create("gi.vpl.statistics", fg::BufferDesc{sizeof statistics_},
                                   fg::Access::TransferWrite);
            },
            [](const Data& data, fg::PassContext& context) {
                context.upload(data.values, 0, data.data, sizeof statistics_);
            })
        .values;
}

fg::TextureHandle VplTechnique::addDebugView(fg::FrameGraph& graph,
                                              const plugin::FrameInputs& inputs,
                                              fg::TextureHandle color) {
    const float radius = used_.show == 0
                             ? 0.0f
                             : float(kBall * meanDistanceOf(set_.positions, scene_.content(), 1));
    const fg::TextureHandle shown =
        addVplShow(graph, inputs, used_, buffers_, gather_.params, radius, gathered_, color);
    buffers_ = {}; // of this frame alone
    gathered_ = {};
    return shown;
}

std::unique_ptr<GiTechnique> makeVpl(SharedParts& shared) {
    return std::make_unique<VplTechnique>(shared);
}

} // namespace tyndall::volumetric_gi
