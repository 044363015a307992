// Sums over the 64 threads of a workgroup, always in the same order: the same frame has the same bits.
#ifndef TYNDALL_GI_LPV_WORKGROUP_SUMS
#define TYNDALL_GI_LPV_WORKGROUP_SUMS

#if LEDGER
const uint kSums = 7u; // change, power after the step and before it, injected, absorbed, escaped, blocked
#else
const uint kSums = 2u; // the first of them
#endif

layout(std430) buffer LpvPartials { float partials[]; }; // kSums of each workgroup
shared float sums[kSums][64];

/// Leaves the sums in sums[…][0].
void sumUp(float values[kSums]) {
    uint thread = gl_LocalInvocationIndex;
    for (uint i = 0u; i < kSums; ++i) sums[i][thread] = values[i];
    barrier();
    for (uint reach = 32u; reach > 0u; reach /= 2u) {
        if (thread < reach)
            for (uint i = 0u; i < kSums; ++i) sums[i][thread] += sums[i][thread + reach];
        barrier();
    }
}

void leaveSums(float values[kSums]) {
    sumUp(values);
    uvec3 groups = gl_NumWorkGroups;
    uint group = gl_WorkGroupID.x + groups.x * (gl_WorkGroupID.y + groups.y * gl_WorkGroupID.z);
    if (gl_LocalInvocationIndex == 0u)
        for (uint i = 0u; i < kSums; ++i) partials[group * kSums + i] = sums[i][0];
}

#endif
