#include "volumetric_gi/vpl/vpl_walks.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

namespace tyndall::volumetric_gi {
namespace {

gpu::VplData pack(const reference::WalkVertex& vertex, double share) {
    gpu::VplData light{};
    light.position = vec4(vec3(vertex.position), -1);
    light.travel = vec4(vec3(vertex.travel), 0);
    light.power = vec4(vec3(vertex.power * share), 0);
    if (vertex.medium) {
        light.position.w = float(int(vertex.medium->phase));
        light.travel.w = float(vertex.medium->anisotropy);
        return light;
    }
    const reference::Surface& surface = vertex.point.surface;
    light.normal = vec4(vec3(surface.geometricNormal), float(surface.roughness));
    light.shading = vec4(vec3(surface.normal), float(surface.specular));
    light.base = vec4(vec3(surface.baseColor), float(surface.metallic));
    return light;
}

} // namespace

VplSet makeWalks(const reference::TracerScene& scene, const reference::LightEmission& emission,
                 const WalkOrder& order) {
    std::vector<std::vector<reference::WalkVertex>> walks(order.walks);
    tbb::enumerable_thread_specific<reference::LightWalker> walkers(
        [&] { return reference::LightWalker(scene, emission, {}); });
    tbb::parallel_for(tbb::blocked_range<uint32_t>(0, order.walks, 16),
                      [&](const tbb::blocked_range<uint32_t>& range) {
                          for (uint32_t i = range.begin(); i < range.end(); ++i) {
                              reference::Sampler sampler(order.seed, order.generation, i);
                              walkers.local().trace(sampler, walks[i]);
                          }
                      });
    VplSet set;
    set.walks.push_back(0);
    const double share = 1 / double(order.walks);
    for (const auto& walk : walks) {
        for (const reference::WalkVertex& vertex : walk) {
            if (!(vertex.medium ? order.fromMedia : order.fromSurfaces)) continue;
            set.lights.push_back(pack(vertex, share));
            set.positions.push_back(vertex.position);
            set.margins.push_back(vertex.medium ? 0 : vertex.point.margin);
        }
        if (set.lights.size() > set.walks.back()) set.walks.push_back(uint32_t(set.lights.size()));
    }
    for (const reference::LightWalker& walker : walkers) set.cutOff += walker.cutOff();
    return set;
}

} // namespace tyndall::volumetric_gi
