#pragma once
// The scene's media on the GPU, and what of them a frame needs.
//
//   media.update(scene, renderOrigin);                      // when the scene or the origin changed; cheap when not
//   MediaFrame frame = media.beginFrame(graph, request);    // decides what matters, hands out MediaResources
//   addOpticalDepthPass(graph, media, frame, …);
//   MediumMarch march = addMediumMarchPass(graph, …);

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "framegraph/gl/executor.h"
#include "plugin/frame_resources.h"
#include "renderer/media_atlas.h"
#include "renderer/media_placement.h"
#include "renderer/media_settings.h"
#include "renderer/optical_depth_views.h"
#include "scene/scene.h"

namespace tyndall {

struct MediaFrameRequest {
    const ViewResources* view = nullptr;
    std::span<const Bounds> surfaces;       // render space, of everything drawn
    std::span<const gpu::LightData> lights; // as in `Lights`, environment samples included
    bool keepUnseen =
        false; // for techniques that carry light through media that the view cannot meet
};

/// What the passes of one frame know about its media. Reasons are null where there is none to skip.
struct MediaFrame {
    MediaResources resources;              // resources.count == 0: every pass over media is skipped
    const char* skipReason = nullptr;      // why no medium matters at all
    const char* marchSkipReason = nullptr; // why no ray from the eye meets one
    const char* depthSkipReason = nullptr; // why no light has a volume of optical depth
    bool scatters = false;                 // some medium in view does
    bool emits = false;
    const MediaSettings* settings = nullptr; // the system's
};

class MediaSystem {
public:
    /// `executor` must outlive the system, and its context be current here and in all that follows.
    explicit MediaSystem(fg::Executor& executor);
    ~MediaSystem();
    MediaSystem(const MediaSystem&) = delete;
    MediaSystem& operator=(const MediaSystem&) = delete;

    /// Adds `media.*` with its presets; the values live here.
    void registerSettings(SettingsRegistry& registry);
    [[nodiscard]] MediaSettings& settings() { return settings_; }

    /// Places the media and uploads grids that are new. `scene` must live until the next call.
    /// Errors: more grid data than the GPU holds.
    Result<void> update(const Scene& scene, const dvec3& renderOrigin);

    MediaFrame beginFrame(fg::FrameGraph& graph, const MediaFrameRequest& request);

    [[nodiscard]] const OpticalDepthLayout& opticalDepthLayout() const { return layout_; }
    /// Changes whenever anything changes that light-space optical depth depends on.
    [[nodiscard]] uint64_t opticalDepthKey() const { return opticalDepthKey_; }
    /// Changes whenever the media that beginFrame() hands out do.
    [[nodiscard]] Version version() const { return tableVersion_; }
    /// Box around all bounded media of the scene, render space; empty where there are none.
    [[nodiscard]] Bounds bounds() const;
    /// Sentences about media that cannot be rendered as described.
    [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

private:
    std::vector<PlacedMedium> choose(const MediaFrameRequest& request, MediaFrame& frame) const;
    gpu::MediaHeader makeHeader(const MediaFrameRequest& request,
                                std::vector<PlacedMedium>& chosen);
    void layOut(const MediaFrameRequest& request, const std::vector<PlacedMedium>& chosen,
                bool volumes, MediaFrame& frame);
    void uploadTable(const gpu::MediaHeader& header, const std::vector<PlacedMedium>& chosen);
    void uploadViews();
    fg::StaticBuffer upload(const char* name, std::span<const std::byte> data,
                            std::vector<std::byte>& last, fg::StaticBuffer buffer,
                            Version& version);

    fg::Executor& executor_;
    MediaSettings settings_{};
    MediaAtlas atlas_;
    std::vector<PlacedMedium> placed_;
    SceneVersions seenVersions_;
    dvec3 renderOrigin_{0};
    const Scene* scene_ = nullptr;
    bool sceneHasMedia_ = false;
    std::vector<std::string> notes_;

    std::vector<std::byte> table_, views_; // as last uploaded
    fg::StaticBuffer tableBuffer_, viewsBuffer_, blackbodyBuffer_;
    uint64_t blackbodyBytes_ = 0;
    fg::StaticTexture noOpticalDepth_;
    Version tableVersion_ = 0, viewsVersion_ = 0, blackbodyVersion_ = 0;
    OpticalDepthLayout layout_;
    uint64_t opticalDepthKey_ = 0;
};

} // namespace tyndall
