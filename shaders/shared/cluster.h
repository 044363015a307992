// Clustered light lists as shaders see them: storage buffer `Clusters`.
#ifndef TYNDALL_SHARED_CLUSTER_H
#define TYNDALL_SHARED_CLUSTER_H
#include "shared/types.h"
TYNDALL_SHARED_BEGIN

TYNDALL_CONST uint kClusterOverflow = 0xffffffffu; // stored as a count: the list did not fit, every light is looked at

/// At the start of `Clusters`. Light indices below `globalCount` reach everywhere and are in no list; the lists hold the others.
struct ClusterHeader {
    uvec4 grid;      // clusters along x, y (view), z (distance); w: list capacity of a cluster; x = 0: no lists, look at every light
    uvec4 counts;    // x: lights; y: lights that reach everywhere; z: clusters that overflowed; w: longest list that was wanted
    vec4 depth;      // x: where the second slice begins, metres along the view's axis; y: log2 of the ratio between slices; z, w: unused
};

/// Block `Params` of clusters.comp.
struct ClusterParams {
    ClusterHeader header;
};

TYNDALL_SHARED_END
#endif
