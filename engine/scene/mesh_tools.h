#pragma once
// What a mesh needs before it can be drawn and a file may have left out: bounds, normals, tangents.

#include <span>

#include "scene/scene.h"

namespace tyndall {

Bounds boundsOf(std::span<const vec3> positions);

/// Flat normals as glTF 2.0 section 3.7.2.1 asks where a mesh has none: every triangle gets its own three vertices
/// (all other attributes are copied, given tangents dropped, as the specification says). A triangle
/// without area gets +Z. CHECKs that the mesh is triangles.
void makeFlatNormals(Mesh& mesh);

/// Tangents from `uvSet`, per vertex: the angle-weighted mean over the triangles around it of the direction in which u grows,
/// made perpendicular to the normal; w is the handedness (bitangent = w · cross(normal, tangent)). Where a vertex
/// is shared by triangles of both handednesses it is split first, so that mirrored UVs keep their seam.
/// Vertices without usable UVs get any direction perpendicular to the normal. CHECKs triangles, normals and the UV set.
///
/// glTF asks for MikkTSpace; this differs from it only inside a smoothing group whose UV charts meet at one vertex without a split.
void makeTangents(Mesh& mesh, int uvSet);

} // namespace tyndall
