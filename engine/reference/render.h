#pragma once
// Rendering with the reference path tracer: passes over all pixels, on all cores, until it is good enough.

#include <functional>

#include "core/result.h"
#include "reference/film.h"
#include "reference/instant_radiosity.h"

namespace tyndall::reference {

enum class Integrator { Volume = 0, Simple = 1, InstantRadiosity = 2 };

struct RenderSettings {
    int width = 1280, height = 720;
    PathSettings path;
    Integrator integrator = Integrator::Volume;
    double clampDistance = 0.1; // metres, InstantRadiosity: 1/√b
    bool compensate = true;     // InstantRadiosity
    uint64_t seed = 0;
    int threads = 0; // 0: all cores
};

/// A scene being rendered. The scene must outlive it.
class ReferenceRender {
public:
    /// Looks through the camera at `cameraNode`. Errors: as TracerScene::build.
    static Result<ReferenceRender> start(const Scene& scene, int cameraNode,
                                         const RenderSettings& settings);

    /// Adds `samples` to every pixel. The same samples give the same film, bit for bit, however they are divided over calls and
    /// threads. `stop` is asked for every tile; once it says so false is returned, and the film is good for nothing any more.
    bool addSamples(uint32_t samples, const std::function<bool()>& stop = {});

    [[nodiscard]] Film& film() { return film_; }
    [[nodiscard]] const Film& film() const { return film_; }
    [[nodiscard]] const PathCounts& counts() const { return counts_; }
    [[nodiscard]] const TracerScene& scene() const { return scene_; }
    [[nodiscard]] std::vector<std::string> notes() const { return scene_.notes(); }

private:
    ReferenceRender(TracerScene scene, const CameraRays& camera, const RenderSettings& settings)
        : scene_(std::move(scene)), camera_(camera), settings_(settings),
          film_(settings.width, settings.height, settings.path.terms) {}
    class Tracers;
    void renderTile(int tile, uint32_t first, uint32_t count, Tracers& tracers, Film& film) const;

    TracerScene scene_;
    CameraRays camera_;
    RenderSettings settings_;
    Film film_;
    PathCounts counts_;
};

/// Counts up whenever the pictures that this path tracer makes of the same scene change: pictures kept from before are then stale.
inline constexpr int kReferenceVersion = 2;

/// A number for all in the scene that its picture depends on: geometry, materials, textures, lights, media, camera.
uint64_t sceneHash(const Scene& scene, int cameraNode);

} // namespace tyndall::reference
