#include "tracing/tracer_scene.h"

namespace tyndall::tracing {

Result<TracerScene> TracerScene::build(const Scene& scene, const dvec3& origin, int threads) {
    TracerScene result;
    auto surfaces = SurfaceScene::build(scene, origin, threads);
    if (!surfaces.ok()) return surfaces.error();
    result.surfaces = std::move(*surfaces);
    result.media = std::make_unique<MediaField>(scene, origin);
    result.lights = std::make_unique<Lights>(scene, origin, *result.surfaces, *result.media);
    return result;
}

std::vector<std::string> TracerScene::notes() const { return surfaces->notes(); }

} // namespace tyndall::tracing
