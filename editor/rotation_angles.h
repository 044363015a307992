#pragma once
// The angles by which a person turns a node. A rotation has many triples of angles: the inspector keeps the triple that was typed or dragged.

#include "core/math.h"

namespace tyndall::editor {

class RotationAngles {
public:
    /// Degrees about X, then Y, then Z that give `rotation`: those that were last set for this node, as long as they give it. Otherwise (it was undone,
    /// or another node is shown) they are found anew, and of the two triples within ±180° it is the one that turns less.
    const dvec3& of(int node, const dquat& rotation);
    /// Keeps these degrees for the node, and returns the rotation that they give.
    dquat set(int node, const dvec3& degrees);

private:
    int node_ = -1;
    dvec3 degrees_{0};
};

} // namespace tyndall::editor
