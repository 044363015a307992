#include "reference/render.h"

#include <atomic>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <fmt/format.h>

#include "core/cpu_profiler.h"

#include "reference/simple_path_tracer.h"

namespace tyndall::reference {
namespace {

constexpr int kTile = 16; // pixels

int tilesAcross(int pixels) { return (pixels + kTile - 1) / kTile; }

/// Better now than by a system that ends the process: the sums, and while they are written an image of floats for each layer.
Result<void> checkRoom(const RenderSettings& settings) {
    const uint64_t film = Film::bytes(settings.width, settings.height, settings.path.terms),
                   needed = film + film / 4, free = availableMemoryBytes();
    if (needed <= free) return {};
    return Error{fmt::format(
        "a reference of {}x{} pixels needs {:.1f} GiB of memory, of which {:.1f} GiB are free; a smaller --size needs less",
        settings.width, settings.height, double(needed) / (1 << 30), double(free) / (1 << 30))};
}

} // namespace

/// One thread's integrators, of which one is at work.
class ReferenceRender::Tracers {
public:
    Tracers(const TracerScene& scene, const LightEmission& emission, const RenderSettings& settings)
        : integrator_(settings.integrator), volume_(scene, settings.path),
          simple_(scene, settings.path),
          radiosity_(scene, emission,
                     {settings.path.terms, settings.clampDistance, settings.compensate}) {}

    void trace(const CameraRays::CameraRay& ray, Sampler& sampler, TermLight& light) {
        switch (integrator_) {
        case Integrator::Simple: return simple_.trace(ray, sampler, light);
        case Integrator::InstantRadiosity: return radiosity_.trace(ray, sampler, light);
        case Integrator::Volume: return volume_.trace(ray, sampler, light);
        }
    }
    [[nodiscard]] PathCounts counts() const {
        return integrator_ == Integrator::InstantRadiosity ? radiosity_.counts() : volume_.counts();
    }

private:
    Integrator integrator_;
    VolumePathTracer volume_;
    SimplePathTracer simple_;
    InstantRadiosity radiosity_;
};

Result<ReferenceRender> ReferenceRender::start(const Scene& scene, int cameraNode,
                                               const RenderSettings& settings) {
    if (Result<void> room = checkRoom(settings); !room.ok()) return room.error();
    const CameraRays camera(scene, cameraNode, settings.width, settings.height);
    auto traced = TracerScene::build(scene, camera.origin(), settings.threads);
    if (!traced.ok()) return traced.error();
    return ReferenceRender(std::move(*traced), camera, settings);
}

void ReferenceRender::renderTile(int tile, uint32_t first, uint32_t count, Tracers& tracers,
                                 Film& film) const {
    const int columns = tilesAcross(settings_.width), left = tile % columns * kTile,
              top = tile / columns * kTile;
    const int right = std::min(left + kTile, settings_.width),
              bottom = std::min(top + kTile, settings_.height);
    for (int y = top; y < bottom; ++y)
        for (int x = left; x < right; ++x) {
            const uint64_t pixel = (uint64_t(uint32_t(y)) << 32) | uint32_t(x);
            for (uint32_t sample = first; sample < first + count; ++sample) {
                Sampler sampler(settings_.seed, pixel, sample);
                const CameraRays::CameraRay ray = camera_.through(x, y, sampler.next2());
                TermLight light;
                tracers.trace(ray, sampler, light);
                film.add(x, y, sample, light);
            }
        }
}

bool ReferenceRender::addSamples(uint32_t samples, const std::function<bool()>& stop) {
    const LightEmission emission(scene_);
    tbb::enumerable_thread_specific<Tracers> tracers(
        [&] { return Tracers(scene_, emission, settings_); });
    std::atomic<bool> stopped{false};
    const int tiles = tilesAcross(settings_.width) * tilesAcross(settings_.height);
    const uint32_t first = film_.samples();
    tbb::task_arena arena(settings_.threads > 0 ? settings_.threads : tbb::task_arena::automatic);
    arena.execute([&] {
        tbb::parallel_for(
            tbb::blocked_range<int>(0, tiles, 1),
            [&](const tbb::blocked_range<int>& range) {
                for (int tile = range.begin(); tile < range.end(); ++tile) {
                    if (stopped || (stop && stop())) {
                        stopped = true;
                        return;
                    }
                    renderTile(tile, first, samples, tracers.local(), film_);
                }
            },
            tbb::simple_partitioner());
    });
    if (stopped) return false;
    film_.setSamples(first + samples);
    for (const Tracers& one : tracers) counts_.add(one.counts());
    return true;
}

} // namespace tyndall::reference
