#pragma once
// Lights and shadows without pictures: probes ask the shaders what arrives at points.

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "framegraph/gl/executor.h"
#include "gl/gl_fixture.h"
#include "gl/shader_library.h"
#include "renderer/gpu_scene.h"
#include "renderer/light_system.h"
#include "renderer/view.h"
#include "scene/primitives.h"

namespace tyndall::test {

struct Probe {
    dvec3 position{0}; // world
    dvec3 normal{0};   // unit; zero: a point in a medium
};

/// What a probe sees, first channel.
struct Seen {
    float lit = 0; // sum over the lights of illuminance · cosine · visibility (cosine 1 in media)
    float open = 0;       // the same without shadows
    float clustered = 0;  // `lit` through the light lists
    float visibility = 0; // of light 0
};

/// Adds nodes, meshes and lights to a scene by hand.
class SceneMaker {
public:
    Scene scene;
    int node(const dmat4& worldFromNode);
    /// A primitive with a material of its own; returns its node.
    int primitive(PrimitiveShape shape, const dvec3& size, const dvec3& position,
                  const dquat& rotation = {1, 0, 0, 0}, const Material& material = {});
    int mesh(Mesh mesh, const Material& material = {});
    int light(const Light& light, const dmat4& worldFromNode);
    int pointLight(float candela, const dvec3& position, float radius = 0, float range = 0);
    int directionalLight(float lux, const dvec3& travel, float angularRadius = 0);
    void moveNode(int node, const dvec3& by);
    /// Everything takes a new version.
    void touch();
};

/// A transform whose -Z looks along `forward`.
dmat4 lookingAlong(const dvec3& position, const dvec3& forward);

struct ProbeOptions {
    bool converge = false;
    uint32_t frames = 1; // averaged
    uint32_t firstFrame = 0;
    int rectSamples = 1;    // points a side on rect lights
    bool everyLight = true; // false: `lit` and `open` stay 0, only the lists are used
    dvec3 eye{0, 0, 20};
    double yaw = 0;
    double sceneRadius = 10;
    bool orthographic = false;
};

class LightsTest : public GlTest {
protected:
    void SetUp() override;
    void TearDown() override;
    std::vector<Seen> look(SceneMaker& maker, const std::vector<Probe>& probes,
                           const ProbeOptions& options = {});
    /// Starts again as a new renderer would.
    void forgetEverything();
    LightSystem& lights() { return *lights_; }
    fg::Executor& executor() { return *executor_; }
    /// "ran", "cached" or "skipped: why".
    std::string statusOf(std::string_view pass);
    /// The buffer of light lists of the last look().
    const std::vector<uint32_t>& clusterWords() const { return clusterWords_; }

private:
    void lookOnce(SceneMaker& maker, const std::vector<Probe>& probes, const ProbeOptions& options,
                  uint32_t frame, std::vector<dvec4>& sums);
    std::optional<gl::ShaderLibrary> library_;
    std::optional<fg::Executor> executor_;
    std::optional<GpuScene> gpuScene_;
    std::optional<LightSystem> lights_;
    SettingsRegistry settings_;
    std::vector<uint32_t> clusterWords_;
};

} // namespace tyndall::test
