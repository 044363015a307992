#pragma once
// The environment's radiance on the GPU: a latitude-longitude map with mip levels, each texel of a level the mean over its
// solid angle.

#include <vector>

#include "core/result.h"
#include "framegraph/gl/executor.h"
#include "scene/scene.h"
#include "shared/deferred.h"

namespace tyndall {

/// What a pass needs of the map; copied into its data.
struct EnvironmentResources {
    fg::StaticTexture map;
    gpu::EnvironmentData data;
};

template <typename Command>
Command& bindEnvironment(Command& command, const EnvironmentResources& environment) {
    return command.params(environment.data, "Environment").bind("environmentMap", environment.map);
}

/// RGB levels from the image's size to 1×1, top row first.
struct EnvironmentLevels {
    std::vector<Image> levels;
    bool black = true;
};
/// Pixels that are not finite or negative count as 0, as they do for the environment's lights. A constant environment is one texel.
EnvironmentLevels makeEnvironmentLevels(const Environment& environment);

class EnvironmentMap {
public:
    explicit EnvironmentMap(fg::Executor& executor) : executor_(executor) {}
    ~EnvironmentMap();
    EnvironmentMap(const EnvironmentMap&) = delete;
    EnvironmentMap& operator=(const EnvironmentMap&) = delete;

    /// Uploads the scene's environment if it changed. Errors: an image larger than the driver takes.
    Result<void> update(const Scene& scene);
    /// No light comes from it: passes leave it out.
    [[nodiscard]] bool black() const { return black_; }
    /// CHECKs that it is not black.
    [[nodiscard]] EnvironmentResources resources() const;

private:
    fg::Executor& executor_;
    const Scene* scene_ = nullptr;
    Version seen_ = 0;
    bool black_ = true;
    fg::StaticTexture map_;
    gpu::EnvironmentData data_{};
};

} // namespace tyndall
