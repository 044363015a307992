#pragma once
// From the scene's lights and environment to what shaders see: LightData for all lights, who casts shadows, this frame's
// sample points; and the passes that upload them, draw shadow maps and make light lists.
//
//   lights.update(frame);              // each frame
//   LightResources resources = lights.addPasses(graph, gpuScene, view, true);

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "renderer/environment_lights.h"
#include "plugin/frame_resources.h"
#include "renderer/light_cluster_pass.h"
#include "renderer/light_settings.h"
#include "renderer/medium_lights.h"
#include "renderer/shadow_pass.h"
#include "renderer/shadow_views.h"
#include "scene/scene.h"

namespace tyndall {

class GpuScene;

/// What one frame's lights follow from.
struct LightFrame {
    const Scene* scene = nullptr;
    dvec3 renderOrigin{0}; // world
    std::span<const Bounds> casters; // of each surface that may cast shadows, render space
    Bounds surroundings, withLamps;  // SceneReach, render space
    const ViewResources* view = nullptr; // its flags say whether frames are averaged
    bool mediaOff = false; // media.enabled: none glows
};

class LightSystem {
public:
    /// Adds `lights.*`, `shadows.*` and `environment.lights` with their presets; the values live here.
    void registerSettings(SettingsRegistry& registry);
    [[nodiscard]] LightSettings& lightSettings() { return lightSettings_; }
    [[nodiscard]] ShadowSettings& shadowSettings() { return shadowSettings_; }

    /// Makes this frame's lights. Scene lights and the environment are read again only where their versions changed.
    void update(const LightFrame& frame);

    /// This frame's lights: first those that reach everywhere, then those that are in lists.
    [[nodiscard]] std::span<const gpu::LightData> lights() const { return lights_; }
    /// Lights that reach everywhere, at the start of lights().
    [[nodiscard]] uint32_t globalCount() const { return globalCount_; }
    /// Node of a light of lights(), kNone for environment lights.
    [[nodiscard]] int nodeOf(uint32_t light) const { return nodes_.at(light); }
    [[nodiscard]] const ShadowPlan& shadowPlan() const { return plan_; }
    [[nodiscard]] const EnvironmentSampler& environment() const { return environment_; }
    /// Maps drawn since the start, for reports and tests: a cached one is not drawn.
    [[nodiscard]] uint64_t shadowMapsDrawn() const { return shadows_.mapsDrawn(); }
    /// Sentences about this scene that a person should read once: lights left out and why, lights without shadows.
    [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

    /// Uploads, draws and lists. The frame's update() must have been called; `scene` is read when the graph runs.
    /// `shadows`: false where no term is rendered that a shadow could fall on.
    LightResources addPasses(fg::FrameGraph& graph, const GpuScene& scene,
                             const ViewResources& view, bool shadows);

private:
    struct Collected {
        gpu::LightData data{};
        int node = kNone;
        bool castsShadows = true;
        double strength = 0; // candela or lux, the largest channel: at a facing surface, no flux
        float reach = 0;     // metres from its centre; 0: everywhere
    };
    void collect(const LightFrame& frame);
    void setScale(const LightFrame& frame);
    void collectLight(const Light& light, const dmat4& worldFromNode, int node,
                      const dvec3& origin);
    void collectMedia(const LightFrame& frame);
    void addEnvironment(const LightFrame& frame, std::vector<Collected>& all);
    void addMedia(const LightFrame& frame, std::vector<Collected>& all);
    void setReach(std::vector<Collected>& all, bool converge) const;
    void chooseShadows(const LightFrame& frame, const std::vector<Collected>& all);

    LightSettings lightSettings_{};
    ShadowSettings shadowSettings_{};
    const Scene* scene_ = nullptr;
    SceneVersions seen_;
    Version seenEnvironment_ = 0;
    dvec3 seenOrigin_{0};
    double reachRadius_ = 1; // metres, of what is near and the lamps there
    std::vector<Collected> collected_;
    EnvironmentSampler environment_;
    MediumEmitters media_;
    int32_t mediaParts_ = -1; // that media_ was made for
    Version seenMedia_ = 0, seenMediaTransforms_ = 0, seenMediaStructure_ = 0;
    std::vector<gpu::LightData> lights_;
    std::vector<vec4> balls_; // of the lights from globalCount_ on: centre (render space) and reach
    std::vector<int> nodes_;
    uint32_t globalCount_ = 0;
    ShadowPlan plan_;
    ShadowPass shadows_;
    std::vector<std::string> sceneNotes_, notes_;
};

} // namespace tyndall
