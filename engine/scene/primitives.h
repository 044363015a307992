#pragma once
// The primitives of scene files as meshes: centred at the node's origin, sizes baked into the vertices, with normals
// and one UV set. Triangles wind counter-clockwise seen from outside.

#include <array>
#include <string_view>

#include "scene/scene.h"

namespace tyndall {

/// In the order of PrimitiveShape.
inline constexpr std::array<std::string_view, 5> kPrimitiveShapeNames = {"box", "sphere", "plane",
                                                                         "disk", "cylinder"};

/// Box: `size` is the full extent. Sphere: diameters (64×128 faces, vertices on the ellipsoid, exact normals).
/// Plane and disk: in XZ, facing +Y, extents size.x and size.z. Cylinder: axis Y, diameters x and z, height y, capped.
/// CHECKs that the sizes used are positive.
Mesh makePrimitive(const Primitive& primitive);

} // namespace tyndall
