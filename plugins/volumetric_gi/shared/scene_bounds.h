#pragma once
// Boxes of plugin::SceneState.

#include "core/math.h"

namespace tyndall::volumetric_gi {

inline Bounds boundsOf(const float (&minimum)[4], const float (&maximum)[4]) {
    Bounds bounds;
    for (int axis = 0; axis < 3; ++axis) {
        bounds.minimum[axis] = double(minimum[axis]);
        bounds.maximum[axis] = double(maximum[axis]);
    }
    return bounds;
}

} // namespace tyndall::volumetric_gi
