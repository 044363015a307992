// Lists of the surfels that are splatted on each level, in the order of surfels, so that sums have the same bits in every run. Three dispatches. STAGE 0: which levels a surfel is
// splatted on, and how many of a workgroup's are. 1, one workgroup: where each workgroup's part of the lists begins, and what is drawn. 2: the lists.
#include "gi/surfels/splat.glsl"

layout(local_size_x = 256) in;

// For each level the number of each workgroup; then, in place of it, the number of all before.
layout(std430) buffer GroupCounts { uint groupCounts[]; };
layout(std430) buffer SurfelLevels { uint surfelLevels[]; }; // a bit for each level
layout(std430) writeonly buffer SplatList { uint splatList[]; };
layout(std430) writeonly buffer Draws { uvec4 draws[]; }; // fg::DrawArguments, of each level

uint groupCount() { return (splat.surfelCount + 255u) / 256u; }

#if STAGE == 1
shared uint sums[256];

/// The sum of the values of all threads before this one; `total`: of all.
uint sumBefore(uint value, out uint total) {
    uint thread = gl_LocalInvocationID.x;
    barrier(); // the sums of before have been read
    sums[thread] = value;
    for (uint reach = 1u; reach < 256u; reach <<= 1u) {
        barrier();
        uint other = thread >= reach ? sums[thread - reach] : 0u;
        barrier();
        sums[thread] += other;
    }
    barrier();
    total = sums[255];
    return sums[thread] - value;
}
#else
shared uint listed[8 * kSurfelMostLevels]; // for each level a bit for each thread

void listThread(uint levels) {
    uint thread = gl_LocalInvocationID.x;
    if (thread < 8u * kSurfelMostLevels) listed[thread] = 0u;
    barrier();
    for (uint level = 0u; level < splat.levels; ++level)
        if ((levels >> level & 1u) != 0u) atomicOr(listed[8u * level + thread / 32u], 1u << (thread % 32u));
    barrier();
}

/// How many threads before this one are listed on a level.
uint listedBefore(uint level, uint thread) {
    uint count = 0u;
    for (uint word = 0u; word < thread / 32u; ++word) count += bitCount(listed[8u * level + word]);
    return thread % 32u == 0u ? count : count + bitCount(listed[8u * level + thread / 32u] << (32u - thread % 32u));
}
#endif

void main() {
    uint thread = gl_LocalInvocationID.x;
    uint surfel = gl_WorkGroupID.x * 256u + thread;
#if STAGE == 0
    uint levels = 0u;
    SplatQuad quad;
    if (surfel < splat.surfelCount) {
        for (uint level = 0u; level < splat.levels; ++level)
            if (splatQuad(surfel, level, quad)) levels |= 1u << level;
        surfelLevels[surfel] = levels;
    }
    listThread(levels);
    if (thread < splat.levels) {
        uint count = 0u;
        for (uint word = 0u; word < 8u; ++word) count += bitCount(listed[8u * thread + word]);
        groupCounts[thread * groupCount() + gl_WorkGroupID.x] = count;
    }
#elif STAGE == 1
    for (uint level = 0u; level < splat.levels; ++level) {
        uint before = 0u;
        for (uint first = 0u; first < groupCount(); first += 256u) {
            uint group = level * groupCount() + first + thread;
            bool has = first + thread < groupCount();
            uint count = has ? groupCounts[group] : 0u;
            uint total;
            uint place = before + sumBefore(count, total);
            if (has) groupCounts[group] = place;
            before += total;
        }
        if (thread == 0u) draws[level] = uvec4(6u * before, 1u, 0u, 0u);
    }
#else
    uint levels = surfel < splat.surfelCount ? surfelLevels[surfel] : 0u;
    listThread(levels);
    for (uint level = 0u; level < splat.levels; ++level)
        if ((levels >> level & 1u) != 0u)
            splatList[level * splat.surfelCount + groupCounts[level * groupCount() + gl_WorkGroupID.x] + listedBefore(level, thread)] = surfel;
#endif
}
