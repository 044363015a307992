// Light lists of the view's clusters: one thread a cluster, lights in ascending order, so that the lists are the same in
// every run. A cluster is the axis-aligned box, in view space, around its part of the frustum; a light is the ball that it
// reaches (LightBalls: view-independent centre in render space and radius).
#include "common/view.glsl"
#include "shared/cluster.h"

layout(local_size_x = 64) in;

layout(std140) uniform Params { ClusterParams params; };
layout(std430) readonly buffer LightBalls { vec4 lightBalls[]; }; // of the lights that are in lists
layout(std430) buffer Clusters {
    ClusterHeader clusterHeader;
    uint clusterLists[];
};

shared vec4 balls[64];

/// Point of the view-space ray through `ndc` where it crosses the plane at `distance` along the axis.
vec3 onRay(vec2 ndc, float distance) {
    vec4 direction = view.viewFromRender * vec4((view.renderFromClip * vec4(ndc, 0.0, 1.0)).xyz, 0.0);
    return direction.xyz * (distance / -direction.z);
}

void main() {
    uvec3 grid = params.header.grid.xyz;
    uint capacity = params.header.grid.w;
    uint cluster = gl_GlobalInvocationID.x;
    bool inside = cluster < grid.x * grid.y * grid.z;
    uvec3 cell = uvec3(cluster % grid.x, (cluster / grid.x) % grid.y, cluster / (grid.x * grid.y));

    vec2 low = vec2(cell.xy) / vec2(grid.xy) * 2.0 - 1.0;
    vec2 high = vec2(cell.xy + 1u) / vec2(grid.xy) * 2.0 - 1.0;
    // Slices overlap by a little, as lookups round differently.
    float front = cell.z == 0u ? 0.0 : params.header.depth.x * exp2((float(cell.z) - 1.001) * params.header.depth.y);
    float back = cell.z + 1u == grid.z ? 1e30 : params.header.depth.x * exp2((float(cell.z) + 0.001) * params.header.depth.y);
    vec3 boxLow = vec3(1e30), boxHigh = vec3(-1e30);
    for (int i = 0; i < 8; ++i) {
        vec3 corner = onRay(vec2((i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y), (i & 4) != 0 ? back : front);
        boxLow = min(boxLow, corner);
        boxHigh = max(boxHigh, corner);
    }
    float slack = 1e-5 * (back < 1e29 ? back : front);

    uint ballCount = params.header.counts.x - params.header.counts.y;
    uint base = cluster * (capacity + 1u);
    uint count = 0u;
    for (uint first = 0u; first < ballCount; first += 64u) {
        uint mine = first + gl_LocalInvocationID.x;
        if (mine < ballCount) balls[gl_LocalInvocationID.x] = vec4((view.viewFromRender * vec4(lightBalls[mine].xyz, 1.0)).xyz, lightBalls[mine].w);
        barrier();
        if (inside) {
            for (uint i = 0u; i < min(64u, ballCount - first); ++i) {
                vec3 away = max(max(boxLow - balls[i].xyz, balls[i].xyz - boxHigh), vec3(0.0));
                float reach = balls[i].w + slack;
                if (dot(away, away) > reach * reach) continue;
                if (count < capacity) clusterLists[base + 1u + count] = params.header.counts.y + first + i;
                ++count;
            }
        }
        barrier();
    }
    if (!inside) return;
    clusterLists[base] = count <= capacity ? count : kClusterOverflow;
    if (count > capacity) atomicAdd(clusterHeader.counts.z, 1u);
    atomicMax(clusterHeader.counts.w, count);
}
