#include "scene/primitives.h"

#include <cmath>

#include "core/check.h"
#include "scene/mesh_tools.h"

namespace tyndall {
namespace {

constexpr uint32_t kRound =
    128; // segments around a sphere, disk or cylinder: chord error 0.03 % of the radius
constexpr uint32_t kSphereRows = 64;

uint32_t addVertex(Mesh& mesh, const dvec3& position, const dvec3& normal, const dvec2& uv) {
    mesh.positions.emplace_back(position);
    mesh.normals.emplace_back(glm::normalize(normal));
    mesh.uvs[0].emplace_back(uv);
    return uint32_t(mesh.positions.size() - 1);
}

void addTriangle(Mesh& mesh, uint32_t a, uint32_t b, uint32_t c) {
    mesh.indices.insert(mesh.indices.end(), {a, b, c});
}

/// A parallelogram around `centre`; `right` and `up` are half edges, right × up points outward.
/// UVs have v downwards, as images do.
void addQuad(Mesh& mesh, const dvec3& centre, const dvec3& right, const dvec3& up) {
    const dvec3 normal = glm::cross(right, up);
    const uint32_t a = addVertex(mesh, centre - right - up, normal, {0, 1});
    const uint32_t b = addVertex(mesh, centre + right - up, normal, {1, 1});
    const uint32_t c = addVertex(mesh, centre + right + up, normal, {1, 0});
    const uint32_t d = addVertex(mesh, centre - right + up, normal, {0, 0});
    addTriangle(mesh, a, b, c);
    addTriangle(mesh, a, c, d);
}

dvec2 onCircle(uint32_t segment) {
    // The last segment is the first again, to the bit, so that the seam has no crack.
    const double angle = 2 * kPi * double(segment % kRound) / kRound;
    return {std::cos(angle), std::sin(angle)};
}

void addBox(Mesh& mesh, const dvec3& half) {
    const dvec3 x(half.x, 0, 0), y(0, half.y, 0), z(0, 0, half.z);
    addQuad(mesh, x, -z, y);
    addQuad(mesh, -x, z, y);
    addQuad(mesh, y, x, -z);
    addQuad(mesh, -y, x, z);
    addQuad(mesh, z, x, y);
    addQuad(mesh, -z, -x, y);
}

void addSphere(Mesh& mesh, const dvec3& half) {
    for (uint32_t row = 0; row <= kSphereRows; ++row) {
        const double polar = kPi * row / kSphereRows;
        const bool pole = row == 0 || row == kSphereRows;
        const double ring = pole ? 0.0 : std::sin(polar);
        const double height = row == 0 ? 1.0 : row == kSphereRows ? -1.0 : std::cos(polar);
        for (uint32_t segment = 0; segment <= kRound; ++segment) {
            const dvec2 circle = onCircle(segment);
            const dvec3 unit(ring * circle.x, height, -ring * circle.y);
            addVertex(mesh, unit * half, unit / half,
                      {double(segment) / kRound, double(row) / kSphereRows});
        }
    }
    for (uint32_t row = 0; row < kSphereRows; ++row)
        for (uint32_t segment = 0; segment < kRound; ++segment) {
            const uint32_t a = row * (kRound + 1) + segment, b = a + kRound + 1;
            if (row > 0) addTriangle(mesh, a, b, a + 1);
            if (row + 1 < kSphereRows) addTriangle(mesh, a + 1, b, b + 1);
        }
}

/// In the plane y = height, facing `up` (+1 or -1) along Y.
void addDisk(Mesh& mesh, const dvec3& half, double height, double up) {
    const uint32_t centre = addVertex(mesh, {0, height, 0}, {0, up, 0}, {0.5, 0.5});
    for (uint32_t segment = 0; segment <= kRound; ++segment) {
        const dvec2 circle = onCircle(segment);
        addVertex(mesh, {half.x * circle.x, height, -half.z * circle.y}, {0, up, 0},
                  {0.5 + 0.5 * circle.x, 0.5 - 0.5 * up * circle.y});
    }
    for (uint32_t segment = 0; segment < kRound; ++segment) {
        const uint32_t a = centre + 1 + segment;
        if (up > 0)
            addTriangle(mesh, centre, a, a + 1);
        else
            addTriangle(mesh, centre, a + 1, a);
    }
}

void addCylinder(Mesh& mesh, const dvec3& half) {
    const auto first = uint32_t(mesh.positions.size());
    for (uint32_t segment = 0; segment <= kRound; ++segment) {
        const dvec2 circle = onCircle(segment);
        const dvec3 normal(circle.x / half.x, 0, -circle.y / half.z);
        for (const double side : {-1.0, 1.0})
            addVertex(mesh, {half.x * circle.x, side * half.y, -half.z * circle.y}, normal,
                      {double(segment) / kRound, 0.5 - 0.5 * side});
    }
    for (uint32_t segment = 0; segment < kRound; ++segment) {
        const uint32_t a = first + 2 * segment;
        addTriangle(mesh, a, a + 2, a + 3);
        addTriangle(mesh, a, a + 3, a + 1);
    }
    addDisk(mesh, half, half.y, 1);
    addDisk(mesh, half, -half.y, -1);
}

} // namespace

Mesh makePrimitive(const Primitive& primitive) {
    const bool flat =
        primitive.shape == PrimitiveShape::Plane || primitive.shape == PrimitiveShape::Disk;
    CHECK(primitive.size.x > 0 && primitive.size.z > 0 && (flat || primitive.size.y > 0));
    Mesh mesh;
    mesh.name = kPrimitiveShapeNames[size_t(primitive.shape)];
    const dvec3 half = 0.5 * primitive.size;
    switch (primitive.shape) {
    case PrimitiveShape::Box: addBox(mesh, half); break;
    case PrimitiveShape::Sphere: addSphere(mesh, half); break;
    case PrimitiveShape::Plane:
        addQuad(mesh, dvec3(0), dvec3(half.x, 0, 0), dvec3(0, 0, -half.z));
        break;
    case PrimitiveShape::Disk: addDisk(mesh, half, 0, 1); break;
    case PrimitiveShape::Cylinder: addCylinder(mesh, half); break;
    }
    mesh.bounds = boundsOf(mesh.positions);
    mesh.version = nextVersion();
    return mesh;
}

} // namespace tyndall
