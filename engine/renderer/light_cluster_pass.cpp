#include "renderer/light_cluster_pass.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "framegraph/hash.h"
#include "shared/cluster.h"

namespace tyndall {
namespace {

std::string_view bytesOf(const void* data, size_t bytes) {
    return {static_cast<const char*>(data), bytes};
}

gpu::ClusterHeader makeHeader(const ViewResources& view, std::span<const vec4> balls,
                              uint32_t globalCount, const LightSettings& settings) {
    gpu::ClusterHeader header{};
    header.counts = uvec4(uint32_t(balls.size()) + globalCount, globalCount, 0, 0);
    const bool parallel = (view.data.flags & gpu::kViewOrthographic) != 0;
    if (parallel || balls.empty() || balls.size() <= size_t(std::max(settings.clusterMinimum, 0)))
        return header;
    header.grid = uvec4(uint32_t(settings.clusterColumns), uint32_t(settings.clusterRows),
                        uint32_t(settings.clusterSlices), uint32_t(settings.clusterCapacity));
    // Slices from the nearest place that any light reaches to the farthest, in equal ratios of distance.
    const vec3 eye(view.data.cameraPosition), forward(view.data.cameraForward);
    float farthest = 0;
    for (const vec4& ball : balls)
        farthest = std::max(farthest, glm::dot(forward, vec3(ball) - eye) + ball.w);
    farthest = std::max(farthest, 2.0f * view.data.cameraPosition.w);
    const float first = std::max(view.data.cameraPosition.w, 2e-3f * farthest);
    header.depth.x = first;
    header.depth.y = settings.clusterSlices > 2 ? std::log2(std::max(farthest / first, 1.001f)) /
                                                      float(settings.clusterSlices - 2)
                                                : 1.0f;
    return header;
}

struct Upload {
    fg::BufferHandle clusters, balls;
    gpu::ClusterHeader header;
    const vec4* data;
    uint32_t count;
};

struct Build {
    fg::BufferHandle clusters, balls;
    gpu::ClusterParams params;
    ViewResources view;
};

uint64_t clusterCount(const gpu::ClusterHeader& header) {
    return uint64_t(header.grid.x) * header.grid.y * header.grid.z;
}

const Upload& addUpload(fg::FrameGraph& graph, const gpu::ClusterHeader& header,
                        std::span<const vec4> balls, uint64_t key) {
    static_assert(sizeof(gpu::ClusterHeader) == 48, "header as in std430");
    const uint64_t clusters = clusterCount(header);
    const uint64_t bytes =
        sizeof(gpu::ClusterHeader) +
        std::max<uint64_t>(clusters * (header.grid.w + 1) * sizeof(uint32_t), 16);
    return graph.addPass<Upload>(
        "lights.clusters.upload",
        [&](fg::Builder& builder, Upload& data) {
            data = {{}, {}, header, balls.data(), clusters > 0 ? uint32_t(balls.size()) : 0u};
            data.clusters =
                builder.create("lights.clusters", fg::BufferDesc{bytes}, fg::Access::TransferWrite);
            data.balls = builder.create(
                "lights.balls", fg::BufferDesc{std::max<uint64_t>(balls.size(), 1) * sizeof(vec4)},
                fg::Access::TransferWrite);
            builder.cacheBy(key);
        },
        [](const Upload& data, fg::PassContext& context) {
            context.upload(data.clusters, 0, &data.header, sizeof data.header);
            if (data.count > 0) context.upload(data.balls, 0, data.data, data.count * sizeof(vec4));
        });
}

} // namespace

fg::BufferHandle addLightClusterPass(fg::FrameGraph& graph, const ViewResources& view,
                                     std::span<const vec4> balls, uint32_t globalCount,
                                     const LightSettings& settings) {
    const gpu::ClusterHeader header = makeHeader(view, balls, globalCount, settings);
    // Lists follow from where the view and the lights are, and from nothing else.
    uint64_t key = fg::hashName(bytesOf(&header, sizeof header));
    key = fg::hashName(bytesOf(balls.data(), balls.size_bytes()), key);
    key = fg::hashName(bytesOf(&view.data.renderFromClip, sizeof(mat4)), key);
    const Upload& upload = addUpload(graph, header, balls, key);
    return graph
        .addPass<Build>(
            "lights.clusters",
            [&](fg::Builder& builder, Build& data) {
                data.params.header = header;
                data.view = view;
                data.balls = builder.read(upload.balls);
                data.clusters = builder.write(upload.clusters);
                builder.cacheBy(key);
                if (clusterCount(header) == 0)
                    builder.skip(
                        "few lights, or none with a limit to their reach: every light is looked at everywhere");
            },
            [](const Build& data, fg::PassContext& context) {
                auto command = context.compute("lighting/clusters.comp");
                bindView(command, data.view)
                    .params(data.params)
                    .bind("LightBalls", data.balls)
                    .bind("Clusters", data.clusters)
                    .dispatchOver(data.params.header.grid.x * data.params.header.grid.y *
                                  data.params.header.grid.z);
            })
        .clusters;
}

} // namespace tyndall
