#include "scene/mesh_tools.h"

#include <cmath>

#include "core/check.h"

namespace tyndall {
namespace {

constexpr uint32_t kUnused = 0xffffffffu;

template <typename T> void gather(std::vector<T>& values, std::span<const uint32_t> from) {
    if (values.empty()) return;
    std::vector<T> result;
    result.reserve(from.size());
    for (const uint32_t index : from) result.push_back(values[index]);
    values = std::move(result);
}

/// New vertex i is a copy of old vertex from[i].
void gatherVertices(Mesh& mesh, std::span<const uint32_t> from) {
    gather(mesh.positions, from);
    gather(mesh.normals, from);
    gather(mesh.tangents, from);
    gather(mesh.colors, from);
    for (auto& uv : mesh.uvs) gather(uv, from);
}

dvec3 anyPerpendicular(const dvec3& normal) {
    const dvec3 axis = std::abs(normal.x) < 0.9 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
    return glm::normalize(glm::cross(normal, axis));
}

/// The length, 0 where it is not a usable number.
double usableLength(const dvec3& v) {
    const double length = glm::length(v);
    return std::isfinite(length) && length > 1e-150 ? length : 0;
}

dvec3 normalOfTriangle(const dvec3& a, const dvec3& b, const dvec3& c) {
    const dvec3 normal = glm::cross(b - a, c - a);
    const double length = usableLength(normal);
    return length > 0 ? normal / length : dvec3(0, 0, 1);
}

/// dP/du of a triangle (not normalised) and the sign of its UV area; 0 where the UVs span no area.
struct UvFrame {
    dvec3 tangent{0};
    double handedness = 0;
};

UvFrame uvFrame(const Mesh& mesh, int uvSet, const uint32_t* corner) {
    const auto& uvs = mesh.uvs[size_t(uvSet)];
    const dvec3 p0 = mesh.positions[corner[0]];
    const dvec3 e1 = dvec3(mesh.positions[corner[1]]) - p0,
                e2 = dvec3(mesh.positions[corner[2]]) - p0;
    const dvec2 d1 = dvec2(uvs[corner[1]]) - dvec2(uvs[corner[0]]),
                d2 = dvec2(uvs[corner[2]]) - dvec2(uvs[corner[0]]);
    const double area = d1.x * d2.y - d2.x * d1.y;
    if (!(std::abs(area) > 0) || !std::isfinite(area)) return {};
    const dvec3 tangent = (e1 * d2.y - e2 * d1.y) * (area > 0 ? 1.0 : -1.0);
    const double length = usableLength(tangent);
    if (length == 0) return {};
    // glTF's v runs down the image while +Y of a normal map points up in it, so that w is +1 where
    // (dP/du, -dP/dv, normal) is right-handed.
    return {tangent / length, area > 0 ? -1.0 : 1.0};
}

/// Gives triangles of the other handedness their own copies of the vertices they share.
void splitByHandedness(Mesh& mesh, const std::vector<UvFrame>& frames) {
    std::vector<double> sign(mesh.positions.size(), 0);
    std::vector<uint32_t> twin(mesh.positions.size(), kUnused), from(mesh.positions.size());
    for (size_t i = 0; i < from.size(); ++i) from[i] = uint32_t(i);
    for (size_t t = 0; t < frames.size(); ++t)
        for (size_t k = 0; k < 3; ++k) {
            uint32_t& index = mesh.indices[3 * t + k];
            if (frames[t].handedness == 0) continue;
            if (sign[index] == 0) sign[index] = frames[t].handedness;
            if (sign[index] == frames[t].handedness) continue;
            if (twin[index] == kUnused) {
                twin[index] = uint32_t(from.size());
                from.push_back(index);
            }
            index = twin[index];
        }
    if (from.size() > mesh.positions.size()) gatherVertices(mesh, from);
}

double cornerAngle(const Mesh& mesh, const uint32_t* corner, size_t k) {
    const dvec3 p = mesh.positions[corner[k]];
    const dvec3 a = dvec3(mesh.positions[corner[(k + 1) % 3]]) - p,
                b = dvec3(mesh.positions[corner[(k + 2) % 3]]) - p;
    const double lengths = usableLength(a) * usableLength(b);
    return lengths > 0 ? std::acos(glm::clamp(glm::dot(a, b) / lengths, -1.0, 1.0)) : 0;
}

} // namespace

Bounds boundsOf(std::span<const vec3> positions) {
    Bounds bounds;
    for (const vec3& position : positions) bounds.include(dvec3(position));
    return bounds;
}

void makeFlatNormals(Mesh& mesh) {
    CHECK(mesh.topology == MeshTopology::Triangles && mesh.indices.size() % 3 == 0);
    mesh.normals.clear();
    mesh.tangents.clear();
    const std::vector<uint32_t> from = std::move(mesh.indices);
    gatherVertices(mesh, from);
    mesh.indices.resize(from.size());
    mesh.normals.resize(from.size());
    for (size_t i = 0; i < from.size(); i += 3) {
        const vec3 normal(
            normalOfTriangle(mesh.positions[i], mesh.positions[i + 1], mesh.positions[i + 2]));
        for (size_t k = 0; k < 3; ++k) {
            mesh.indices[i + k] = uint32_t(i + k);
            mesh.normals[i + k] = normal;
        }
    }
}

void makeTangents(Mesh& mesh, int uvSet) {
    CHECK(mesh.topology == MeshTopology::Triangles && mesh.indices.size() % 3 == 0);
    CHECK(mesh.normals.size() == mesh.positions.size());
    CHECK(uvSet >= 0 && uvSet < kMaxUvSets &&
          mesh.uvs[size_t(uvSet)].size() == mesh.positions.size());
    mesh.tangents.clear();
    std::vector<UvFrame> frames(mesh.indices.size() / 3);
    for (size_t t = 0; t < frames.size(); ++t)
        frames[t] = uvFrame(mesh, uvSet, &mesh.indices[3 * t]);
    splitByHandedness(mesh, frames);

    std::vector<dvec3> sum(mesh.positions.size(), dvec3(0));
    std::vector<double> sign(mesh.positions.size(), 1);
    for (size_t t = 0; t < frames.size(); ++t)
        for (size_t k = 0; k < 3; ++k) {
            const uint32_t* corner = &mesh.indices[3 * t];
            if (frames[t].handedness == 0) continue;
            sum[corner[k]] += frames[t].tangent * cornerAngle(mesh, corner, k);
            sign[corner[k]] = frames[t].handedness;
        }
    mesh.tangents.resize(mesh.positions.size());
    for (size_t i = 0; i < sum.size(); ++i) {
        const dvec3 normal = mesh.normals[i];
        const dvec3 flat = sum[i] - normal * glm::dot(normal, sum[i]);
        const double length = usableLength(flat);
        const dvec3 tangent = length > 1e-12 ? flat / length : anyPerpendicular(normal);
        mesh.tangents[i] = vec4(vec3(tangent), float(sign[i]));
    }
}

} // namespace tyndall
