#include "renderer/media_system.h"

#include <algorithm>
#include <bit>

#include "framegraph/hash.h"
#include "gl/buffer.h"
#include "gl/texture.h"
#include "media/blackbody.h"

namespace tyndall {
namespace {

constexpr const char* kNoMedium = "no medium in the scene";
constexpr const char* kNoEffect = "no visible medium absorbs, scatters or emits";
constexpr const char* kUnseen = "no medium in view or on a light's path";
constexpr const char* kNotInView = "no medium in view";
constexpr const char* kSwitchedOff = "setting media.enabled is off";

uint64_t hashBytes(std::span<const std::byte> bytes, uint64_t seed) {
    return fg::hashName({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, seed);
}

void append(std::vector<std::byte>& bytes, const void* data, size_t count) {
    const auto* first = static_cast<const std::byte*>(data);
    bytes.insert(bytes.end(), first, first + count);
}

std::vector<vec4> blackbodyBlock() {
    const BlackbodyTable table = makeBlackbodyTable();
    std::vector<vec4> block;
    block.emplace_back(
        float(BlackbodyTable::kCoolest), float(BlackbodyTable::kHottest),
        float(1.0 / (1.0 / BlackbodyTable::kCoolest - 1.0 / BlackbodyTable::kHottest)),
        float(table.entries.size() - 1));
    block.insert(block.end(), table.entries.begin(), table.entries.end());
    return block;
}

bool placementChanged(const SceneVersions& a, const SceneVersions& b) {
    return a.structure != b.structure || a.transforms != b.transforms || a.media != b.media;
}

bool positive(const vec4& v) { return v.x > 0 || v.y > 0 || v.z > 0; }

} // namespace

void MediaSystem::registerSettings(SettingsRegistry& registry) {
    registry.add({mediaSettingsTable(), &settings_});
    registry.addPreset(mediaPresets());
}

MediaSystem::MediaSystem(fg::Executor& executor) : executor_(executor), atlas_(executor) {
    SettingsRegistry defaults;
    defaults.add({mediaSettingsTable(), &settings_});
    const std::vector<vec4> block = blackbodyBlock();
    blackbodyBytes_ = block.size() * sizeof(vec4);
    blackbodyBuffer_ = executor_.registerBuffer(
        "media.blackbody", gl::Buffer("media.blackbody", std::as_bytes(std::span(block))));
    blackbodyVersion_ = nextVersion();
    gl::Texture nothing("media.noOpticalDepth", {GL_TEXTURE_3D, GL_RGBA16F, 1, 1, 1, 1});
    nothing.clear(0);
    noOpticalDepth_ = executor_.registerTexture("media.noOpticalDepth", std::move(nothing));
}

MediaSystem::~MediaSystem() {
    for (const fg::StaticBuffer buffer : {tableBuffer_, viewsBuffer_, blackbodyBuffer_})
        if (buffer.id) executor_.release(buffer);
    executor_.release(noOpticalDepth_);
}

Result<void> MediaSystem::update(const Scene& scene, const dvec3& renderOrigin) {
    if (scene_ == &scene && renderOrigin_ == renderOrigin &&
        !placementChanged(seenVersions_, scene.versions))
        return {};
    scene_ = &scene;
    seenVersions_ = scene.versions;
    renderOrigin_ = renderOrigin;
    notes_.clear();
    placed_ = placeMedia(scene, renderOrigin, notes_);
    sceneHasMedia_ = std::any_of(scene.nodes.begin(), scene.nodes.end(),
                                 [](const Node& node) { return node.medium != kNone; });
    std::vector<std::shared_ptr<const BrickGrid>> grids;
    for (const PlacedMedium& placed : placed_) {
        if (placed.data.kind != gpu::kMediumGrid) continue;
        grids.push_back(placed.medium->density);
        if (placed.data.emission.w > 0) grids.push_back(placed.medium->temperature);
    }
    const Version before = atlas_.version();
    if (Result<void> done = atlas_.update(grids); !done) {
        placed_.clear();
        scene_ = nullptr; // tried again with the next call
        return done;
    }
    // A grid in the place of one of the same shape leaves every byte of the table as it was.
    if (atlas_.version() != before) tableVersion_ = nextVersion();
    for (PlacedMedium& placed : placed_) {
        if (placed.data.kind != gpu::kMediumGrid) continue;
        placed.data.gridBricks.w = int(atlas_.firstBrick(*placed.medium->density));
        if (placed.data.emission.w > 0)
            placed.data.temperatureBricks.w = int(atlas_.firstBrick(*placed.medium->temperature));
    }
    return {};
}

Bounds MediaSystem::bounds() const {
    Bounds all;
    for (const PlacedMedium& placed : placed_)
        if (placed.data.kind != gpu::kMediumEverywhere && placed.data.kind != gpu::kMediumHeight)
            all.include(placed.bounds);
    return all;
}

std::vector<PlacedMedium> MediaSystem::choose(const MediaFrameRequest& request,
                                              MediaFrame& frame) const {
    if (!sceneHasMedia_)
        frame.skipReason = kNoMedium;
    else if (!settings_.enabled)
        frame.skipReason = kSwitchedOff;
    else if (placed_.empty())
        frame.skipReason = kNoEffect;
    if (frame.skipReason) return {};
    const std::vector<MediumUse> uses =
        classifyMedia(placed_, {&request.view->data, request.surfaces, request.lights});
    std::vector<PlacedMedium> chosen;
    bool inView = false;
    for (size_t i = 0; i < placed_.size(); ++i) {
        const bool seen = uses[i] == MediumUse::InView;
        if (uses[i] != MediumUse::Dropped || request.keepUnseen || !settings_.dropUnseen)
            chosen.push_back(placed_[i]);
        inView = inView || seen;
        frame.scatters = frame.scatters || (seen && positive(placed_[i].data.scattering));
        frame.emits =
            frame.emits ||
            (seen && (positive(placed_[i].data.emission) || placed_[i].data.emission.w > 0));
    }
    if (chosen.empty())
        frame.skipReason = kUnseen;
    else if (!inView)
        frame.marchSkipReason = kNotInView;
    return chosen;
}

/// Cell by cell a ray through a grid has hundreds of segments, and each light asked for at each of them is a march of its own: frames
/// that are averaged ask for so many times fewer of the environment's lights. It is not speed alone: llvmpipe ends all loops of a
/// shader after 65,535 rounds in all (LP_MAX_TGSI_LOOP_ITERATIONS), and the rest of the ray would be missing.
constexpr uint32_t kFewerPerCell = 8;

gpu::MediaHeader MediaSystem::makeHeader(const MediaFrameRequest& request,
                                         std::vector<PlacedMedium>& chosen) {
    const bool converge = (request.view->data.flags & gpu::kViewConverge) != 0;
    gpu::MediaHeader header{};
    std::vector<std::string> notes;
    header.phaseGroupCount = assignPhaseGroups(chosen, header, notes);
    for (const std::string& note : notes)
        if (std::find(notes_.begin(), notes_.end(), note) == notes_.end()) notes_.push_back(note);
    header.mediumCount = uint32_t(chosen.size());
    header.gridCount =
        uint32_t(std::count_if(chosen.begin(), chosen.end(), [](const PlacedMedium& m) {
            return m.data.kind == gpu::kMediumGrid;
        }));
    const bool exact = settings_.integration == MediaIntegration::Exact ||
                       (settings_.integration == MediaIntegration::Auto && converge);
    const bool marchToLights = settings_.lightOpticalDepth == LightOpticalDepth::Exact ||
                               (settings_.lightOpticalDepth == LightOpticalDepth::Auto && converge);
    header.flags =
        (exact ? gpu::kMediaExact : 0u) | (marchToLights ? 0u : gpu::kMediaLightDepthVolume);
    header.stepVoxels = settings_.stepScale;
    header.analyticSteps = uint32_t(settings_.steps);
    header.minTransmittance = settings_.minTransmittance;
    const auto fromEnvironment = [](const gpu::LightData& light) {
        return (light.flags & gpu::kLightFromEnvironment) != 0;
    };
    header.environmentFirst =
        uint32_t(std::find_if(request.lights.begin(), request.lights.end(), fromEnvironment) -
                 request.lights.begin());
    header.environmentLights =
        uint32_t(std::count_if(request.lights.begin(), request.lights.end(), fromEnvironment));
    for (const gpu::LightData& light : request.lights)
        if (converge && (light.flags & gpu::kLightFromMedium) != 0)
            header.nearGlow = light.intensity.w; // the same for all
    const auto atOnce = uint32_t(settings_.environmentLights);
    header.environmentStride = (header.environmentLights + atOnce - 1) / atOnce;
    if (converge && exact && header.gridCount > 0) header.environmentStride *= kFewerPerCell;
    return header;
}

void MediaSystem::layOut(const MediaFrameRequest& request, const std::vector<PlacedMedium>& chosen,
                         bool volumes, MediaFrame& frame) {
    Bounds grids;
    uint64_t key = fg::mixHash(atlas_.version(), volumes);
    for (const PlacedMedium& medium : chosen) {
        if (medium.data.kind != gpu::kMediumGrid) continue;
        grids.include(medium.bounds);
        key = hashBytes(std::as_bytes(std::span(&medium.data, 1)), key);
    }
    if (grids.empty())
        frame.depthSkipReason = "no grid medium in view or on a light's path";
    else if (!volumes)
        frame.depthSkipReason = "grids are marched for every point (media.lightOpticalDepth)";
    layout_ = layOutOpticalDepth(
        frame.depthSkipReason ? std::span<const gpu::LightData>{} : request.lights, grids,
        settings_.opticalDepthResolution, settings_.opticalDepthLights);
    if (!frame.depthSkipReason && layout_.volumeCount == 0)
        frame.depthSkipReason = "no light shines through a grid";
    // At least one entry: an empty buffer cannot be bound.
    if (layout_.views.empty()) layout_.views.emplace_back();
    uploadViews();
    opticalDepthKey_ =
        fg::mixHash(hashBytes(views_, key), std::bit_cast<uint32_t>(settings_.stepScale));
}

fg::StaticBuffer MediaSystem::upload(const char* name, std::span<const std::byte> data,
                                     std::vector<std::byte>& last, fg::StaticBuffer buffer,
                                     Version& version) {
    if (buffer.id && std::equal(data.begin(), data.end(), last.begin(), last.end())) return buffer;
    if (buffer.id && data.size() == last.size()) {
        executor_.buffer(buffer).write(0, data.data(), data.size());
    } else {
        if (buffer.id) executor_.release(buffer);
        gl::Buffer storage(name, data, gl::BufferAccess::CpuUpdates);
        buffer = executor_.registerBuffer(name, std::move(storage));
    }
    last.assign(data.begin(), data.end());
    version = nextVersion();
    return buffer;
}

void MediaSystem::uploadTable(const gpu::MediaHeader& header,
                              const std::vector<PlacedMedium>& chosen) {
    std::vector<std::byte> bytes;
    append(bytes, &header, sizeof header);
    for (const PlacedMedium& medium : chosen) append(bytes, &medium.data, sizeof medium.data);
    tableBuffer_ = upload("media.table", bytes, table_, tableBuffer_, tableVersion_);
}

void MediaSystem::uploadViews() {
    viewsBuffer_ = upload("media.opticalDepthViews", std::as_bytes(std::span(layout_.views)),
                          views_, viewsBuffer_, viewsVersion_);
}

MediaFrame MediaSystem::beginFrame(fg::FrameGraph& graph, const MediaFrameRequest& request) {
    CHECK(request.view);
    CHECK(scene_, "update() comes before beginFrame()");
    MediaFrame frame;
    frame.settings = &settings_;
    std::vector<PlacedMedium> chosen = choose(request, frame);
    if (frame.skipReason) {
        frame.marchSkipReason = frame.depthSkipReason = frame.skipReason;
        return frame;
    }
    const gpu::MediaHeader header = makeHeader(request, chosen);
    layOut(request, chosen, (header.flags & gpu::kMediaLightDepthVolume) != 0, frame);
    uploadTable(header, chosen);
    MediaResources& r = frame.resources;
    r.media = graph.importBuffer("media.table", tableBuffer_, {table_.size()}, tableVersion_);
    r.bricks = graph.importBuffer("media.bricks", atlas_.bricks(), {atlas_.brickBytes()},
                                  atlas_.version());
    r.blackbody = graph.importBuffer("media.blackbody", blackbodyBuffer_, {blackbodyBytes_},
                                     blackbodyVersion_);
    r.opticalDepthViews =
        graph.importBuffer("media.opticalDepthViews", viewsBuffer_, {views_.size()}, viewsVersion_);
    r.atlas = atlas_.texture();
    r.noOpticalDepth = noOpticalDepth_;
    r.count = header.mediumCount;
    r.kinds = (header.mediumCount > header.gridCount ? gpu::kMediaShapes : 0u) |
              (header.gridCount > 0 ? gpu::kMediaGrids : 0u);
    if (header.gridCount > 0 && (header.flags & gpu::kMediaExact) != 0)
        r.kinds |= gpu::kMediaExactGrids;
    if (header.mediumCount == 1) r.kinds |= gpu::kMediaSingle;
    const bool marched =
        std::any_of(layout_.views.begin(), layout_.views.end(),
                    [](const gpu::OpticalDepthView& v) { return v.kind == gpu::kDepthViewMarch; });
    if (header.gridCount > 0 && (header.flags & gpu::kMediaLightDepthVolume) != 0 && !marched)
        r.kinds |= gpu::kMediaLightVolumes;
    r.phaseGroups = header.phaseGroupCount == 1 ? 1 : gpu::kMaxPhaseGroups;
    countOnRays(chosen, header, uint32_t(request.lights.size()), r);
    return frame;
}

} // namespace tyndall
