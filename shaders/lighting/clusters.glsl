// Which lights can matter at a place. The view's frustum is cut into clusters; each has a list, made by clusters.comp.
//
//   uint cluster = clusterOfPosition(position);
//   for (uint i = 0u; i < clusterLightCount(cluster); ++i) { uint light = clusterLight(cluster, i); … }
#ifndef TYNDALL_LIGHTING_CLUSTERS_GLSL
#define TYNDALL_LIGHTING_CLUSTERS_GLSL
#include "common/view.glsl"
#include "shared/cluster.h"

layout(std430) readonly buffer Clusters {
    ClusterHeader clusterHeader;
    uint clusterLists[]; // for each cluster its count, then `grid.w` light indices
};

/// Not a cluster: every light is looked at. Outside of the view, without lists, and where a list overflowed.
const uint kEveryLight = 0xffffffffu;

/// The slice for a distance along the view's axis: the first reaches from the camera to `depth.x`, the last to infinity.
uint clusterSlice(float viewDistance) {
    if (viewDistance < clusterHeader.depth.x) return 0u;
    float slice = 1.0 + log2(viewDistance / clusterHeader.depth.x) / clusterHeader.depth.y;
    return min(uint(min(slice, 65536.0)), clusterHeader.grid.z - 1u);
}

uint clusterOfPosition(vec3 position) {
    if (clusterHeader.grid.x == 0u) return kEveryLight;
    vec4 clip = view.clipFromRender * vec4(position, 1.0);
    float viewDistance = -(view.viewFromRender * vec4(position, 1.0)).z;
    if (!(clip.w > 0.0) || any(greaterThan(abs(clip.xy), vec2(clip.w)))) return kEveryLight;
    uvec2 tile = min(uvec2((clip.xy / clip.w * 0.5 + 0.5) * vec2(clusterHeader.grid.xy)), clusterHeader.grid.xy - 1u);
    uint cluster = tile.x + clusterHeader.grid.x * (tile.y + clusterHeader.grid.y * clusterSlice(viewDistance));
    return clusterLists[cluster * (clusterHeader.grid.w + 1u)] == kClusterOverflow ? kEveryLight : cluster;
}

/// `pixel` as gl_FragCoord.xy, `depth` as in the depth buffer.
uint clusterOfPixel(vec2 pixel, float depth) {
    return depth > 0.0 ? clusterOfPosition(renderPosition(pixel, depth)) : kEveryLight;
}

uint clusterLightCount(uint cluster) {
    if (cluster == kEveryLight) return clusterHeader.counts.x;
    return clusterHeader.counts.y + clusterLists[cluster * (clusterHeader.grid.w + 1u)];
}

/// Light number of entry `i` < clusterLightCount(cluster); ascending.
uint clusterLight(uint cluster, uint i) {
    if (cluster == kEveryLight || i < clusterHeader.counts.y) return i;
    return clusterLists[cluster * (clusterHeader.grid.w + 1u) + 1u + i - clusterHeader.counts.y];
}

#endif
