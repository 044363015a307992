#pragma once
// Runs lines of GLSL over a table with a scene's media bound, as the engine's passes see them.

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/math.h"
#include "gl/buffer.h"
#include "gl/shader_library.h"
#include "gl/texture.h"
#include "renderer/media_placement.h"
#include "scene/scene.h"
#include "shared/light.h"
#include "shared/optical_depth.h"

namespace tyndall::test {

/// A scene with one node a medium, in the order given.
Scene sceneOf(std::span<const Medium> media, std::span<const dmat4> worldFromNode);

struct MediaOptions {
    dvec3 renderOrigin{0};
    uint32_t flags = gpu::kMediaExact; // MediaHeader.flags
    float stepVoxels = 1;
    uint32_t steps = 32;
    float minTransmittance = 0;
    uint32_t viewFlags = 0, frameIndex = 0, seed = 1;
    std::vector<gpu::LightData> lights;
    uint32_t environmentFirst = 0, environmentLights = 0, environmentStride = 1; // of MediaHeader
    std::vector<gpu::OpticalDepthView> views;
};

class MediaCompute {
public:
    /// Uploads the scene's media; `scene` must outlive the object.
    MediaCompute(const Scene& scene, const MediaOptions& options);

    /// Runs `body` once for each of `count` invocations. It sees `uint id`, `vec4 inputs[]`, `vec4 outputs[]`, what `includes`
    /// (paths below shaders/) define, and the media. Throws with the driver's message where it does not compile. `library` keeps the
    /// program for the next run of the same lines.
    std::vector<vec4> run(gl::ShaderLibrary& library, const std::vector<std::string>& includes,
                          std::string_view body, std::span<const vec4> inputs, uint32_t count);

    [[nodiscard]] std::span<const PlacedMedium> placed() const { return placed_; }

private:
    void uploadGrids();
    void bind(const gl::Program& program);

    std::vector<PlacedMedium> placed_;
    gl::Buffer media_, bricks_, blackbody_, views_, lights_, view_;
    gl::Texture atlas_, volume_;
};

} // namespace tyndall::test
