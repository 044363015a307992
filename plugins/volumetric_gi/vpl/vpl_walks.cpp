#include "volumetric_gi/vpl/vpl_walks.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

namespace tyndall::volumetric_gi {
namespace {

gpu::VplData pack(const tracing::WalkVertex& vertex, double share) {
    gpu::VplData light{};
    light.position = vec4(vec3(vertex.position), -1);
    light.travel = vec4(vec3(vertex.travel), 0);
    const uint32_t first = vertex.scatterings == 1 ? gpu::kVplOfSurfaces : gpu::kVplLaterOfSurfaces;
    light.power = vec4(vec3(vertex.power * share), float(first + (vertex.medium ? 1 : 0)));
    if (vertex.medium) {
        light.position.w = float(int(vertex.medium->phase));
        light.travel.w = float(vertex.medium->anisotropy);
        return light;
    }
    const tracing::Surface& surface = vertex.point.surface;
    light.normal = vec4(vec3(surface.geometricNormal), float(surface.roughness));
    light.shading = vec4(vec3(surface.normal), float(surface.specular));
    light.base = vec4(vec3(surface.baseColor), float(surface.metallic));
    return light;
}

} // namespace

Walks traceWalks(const tracing::TracerScene& scene, const tracing::LightEmission& emission,
                 const WalkOrder& order, uint32_t first, uint32_t count) {
    Walks walks;
    walks.starts.resize(count);
    walks.vertices.resize(count);
    tbb::enumerable_thread_specific<tracing::LightWalker> walkers(
        [&] { return tracing::LightWalker(scene, emission, {}); });
    tbb::parallel_for(tbb::blocked_range<uint32_t>(0, count, 16),
                      [&](const tbb::blocked_range<uint32_t>& range) {
                          tracing::LightWalker& walker = walkers.local();
                          for (uint32_t i = range.begin(); i < range.end(); ++i) {
                              tracing::Sampler sampler(
                                  order.seed, 0, order.generation * order.walks + first + i);
                              walker.trace(sampler, walks.vertices[i]);
                              walks.starts[i] = walker.start();
                          }
                      });
    for (const tracing::LightWalker& walker : walkers) walks.cutOff += walker.cutOff();
    return walks;
}

Walks reweighed(const Walks& walks, const tracing::MediaField& from,
                const tracing::MediaField& to) {
    Walks result = walks;
    tbb::parallel_for(size_t(0), walks.vertices.size(), [&](size_t i) {
        tracing::reweigh(result.starts[i], result.vertices[i], from, to);
    });
    return result;
}

VplSet packWalks(const Walks& walks, const WalkOrder& order) {
    VplSet set;
    set.walks.push_back(0);
    set.starts.push_back(0);
    set.cutOff = walks.cutOff;
    const double share = 1 / double(order.walks);
    for (size_t i = 0; i < walks.vertices.size(); ++i) {
        for (const tracing::WalkVertex& vertex : walks.vertices[i]) {
            if (!(vertex.medium ? order.fromMedia : order.fromSurfaces)) continue;
            set.lights.push_back(pack(vertex, share));
            set.places.push_back({set.lights.back().position, set.lights.back().normal});
            set.positions.push_back(vertex.position);
            set.margins.push_back(vertex.medium ? 0 : vertex.point.margin);
        }
        set.starts.push_back(uint32_t(set.lights.size()));
        if ((i + 1) % order.together == 0 && set.lights.size() > set.walks.back())
            set.walks.push_back(uint32_t(set.lights.size()));
    }
    return set;
}

void replaceWalks(VplSet& set, uint32_t first, const VplSet& others) {
    const auto count = uint32_t(others.starts.size() - 1);
    const uint32_t begin = set.starts[first], end = set.starts[first + count];
    const auto replace = [&](auto& in, const auto& by) {
        in.erase(in.begin() + begin, in.begin() + end);
        in.insert(in.begin() + begin, by.begin(), by.end());
    };
    replace(set.lights, others.lights);
    replace(set.places, others.places);
    replace(set.positions, others.positions);
    replace(set.margins, others.margins);
    for (uint32_t i = 0; i < count; ++i) set.starts[first + i] = begin + others.starts[i];
    for (size_t i = first + count; i < set.starts.size(); ++i)
        set.starts[i] += begin + uint32_t(others.lights.size()) - end;
    set.walks = {0};
    for (const uint32_t start : set.starts)
        if (start > set.walks.back()) set.walks.push_back(start);
}

} // namespace tyndall::volumetric_gi
