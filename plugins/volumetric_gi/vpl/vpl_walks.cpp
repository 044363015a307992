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

Walks traceWalks(const reference::TracerScene& scene, const reference::LightEmission& emission,
                 const WalkOrder& order) {
    Walks walks;
    walks.starts.resize(order.walks);
    walks.vertices.resize(order.walks);
    tbb::enumerable_thread_specific<reference::LightWalker> walkers(
        [&] { return reference::LightWalker(scene, emission, {}); });
    tbb::parallel_for(tbb::blocked_range<uint32_t>(0, order.walks, 16),
                      [&](const tbb::blocked_range<uint32_t>& range) {
                          reference::LightWalker& walker = walkers.local();
                          for (uint32_t i = range.begin(); i < range.end(); ++i) {
                              reference::Sampler sampler(order.seed, 0,
                                                         order.generation * order.walks + i);
                              walker.trace(sampler, walks.vertices[i]);
                              walks.starts[i] = walker.start();
                          }
                      });
    for (const reference::LightWalker& walker : walkers) walks.cutOff += walker.cutOff();
    return walks;
}

Walks reweighed(const Walks& walks, const reference::MediaField& from,
                const reference::MediaField& to) {
    Walks result = walks;
    tbb::parallel_for(size_t(0), walks.vertices.size(), [&](size_t i) {
        reference::reweigh(result.starts[i], result.vertices[i], from, to);
    });
    return result;
}

VplSet packWalks(const Walks& walks, const WalkOrder& order) {
    VplSet set;
    set.walks.push_back(0);
    set.cutOff = walks.cutOff;
    const double share = 1 / double(order.walks);
    for (size_t i = 0; i < walks.vertices.size(); ++i) {
        for (const reference::WalkVertex& vertex : walks.vertices[i]) {
            if (!(vertex.medium ? order.fromMedia : order.fromSurfaces)) continue;
            set.lights.push_back(pack(vertex, share));
            set.places.push_back({set.lights.back().position, set.lights.back().normal});
            set.positions.push_back(vertex.position);
            set.margins.push_back(vertex.medium ? 0 : vertex.point.margin);
        }
        if ((i + 1) % order.together == 0 && set.lights.size() > set.walks.back())
            set.walks.push_back(uint32_t(set.lights.size()));
    }
    return set;
}

} // namespace tyndall::volumetric_gi
