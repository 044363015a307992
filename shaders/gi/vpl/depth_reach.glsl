// How far a virtual light's map of optical depth goes: the same for who makes it and who reads it.
#ifndef TYNDALL_GI_VPL_DEPTH_REACH
#define TYNDALL_GI_VPL_DEPTH_REACH

/// Metres from a light to beyond the last grid.
float vplDepthReach(vec3 position, VplParams params) {
    return length(max(abs(position - params.gridsMinimum.xyz), abs(position - params.gridsMaximum.xyz)));
}

#endif
