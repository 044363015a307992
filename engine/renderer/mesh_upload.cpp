#include "renderer/mesh_upload.h"

#include "core/check.h"
#include "gl/buffer.h"

namespace tyndall {
namespace {

/// Interleaves one attribute; `values` has N floats a vertex.
template <int N, typename Vector>
void packAttribute(PackedVertices& packed, const std::vector<Vector>& values, size_t count,
                   uint32_t offsetFloats) {
    CHECK(values.size() == count,
          "a mesh has an attribute with another number of values than it has positions");
    for (size_t i = 0; i < count; ++i)
        for (int c = 0; c < N; ++c)
            packed.values[i * packed.layout.strideFloats + offsetFloats + size_t(c)] = values[i][c];
}

} // namespace

PackedVertices packVertices(const Mesh& mesh) {
    PackedVertices packed;
    const auto declare = [&](VertexLocation location, uint32_t set, uint32_t components,
                             bool present) -> uint32_t {
        if (!present) return 0;
        const uint32_t offset = packed.layout.strideFloats;
        packed.attributes.push_back(
            {uint32_t(location) + set, components, fg::AttributeType::Float32, offset * 4});
        packed.layout.strideFloats += components;
        return offset;
    };
    declare(VertexLocation::Position, 0, 3, true);
    const uint32_t normal = declare(VertexLocation::Normal, 0, 3, !mesh.normals.empty());
    const uint32_t tangent = declare(VertexLocation::Tangent, 0, 4, !mesh.tangents.empty());
    auto& uv = packed.layout.uvFloats;
    for (uint32_t set = 0; set < uint32_t(kMaxUvSets); ++set)
        uv[set] = declare(VertexLocation::Uv0, set, 2, !mesh.uvs[set].empty());
    const uint32_t color = packed.layout.colorFloats =
        declare(VertexLocation::Color, 0, 4, !mesh.colors.empty());

    const size_t count = mesh.positions.size();
    packed.values.resize(count * packed.layout.strideFloats);
    packAttribute<3>(packed, mesh.positions, count, 0);
    if (!mesh.normals.empty()) packAttribute<3>(packed, mesh.normals, count, normal);
    if (!mesh.tangents.empty()) packAttribute<4>(packed, mesh.tangents, count, tangent);
    for (size_t set = 0; set < size_t(kMaxUvSets); ++set)
        if (!mesh.uvs[set].empty()) packAttribute<2>(packed, mesh.uvs[set], count, uv[set]);
    if (!mesh.colors.empty()) packAttribute<4>(packed, mesh.colors, count, color);
    return packed;
}

MeshUpload::~MeshUpload() { trim(0); }

void MeshUpload::release(Entry& entry) {
    if (entry.geometry.id) executor_.release(entry.geometry);
    if (entry.vertices.id) executor_.release(entry.vertices);
    if (entry.indices.id) executor_.release(entry.indices);
    entry = {};
}

void MeshUpload::trim(size_t meshCount) {
    for (size_t i = meshCount; i < entries_.size(); ++i) release(entries_[i]);
    entries_.resize(std::min(entries_.size(), meshCount));
}

Result<fg::StaticGeometry> MeshUpload::obtain(const Scene& scene, int index) {
    const Mesh& mesh = scene.meshes.at(size_t(index));
    if (mesh.indices.empty() || mesh.positions.empty()) return fg::StaticGeometry{};
    if (entries_.size() <= size_t(index)) entries_.resize(size_t(index) + 1);
    Entry& entry = entries_[size_t(index)];
    if (entry.geometry.id && entry.version == mesh.version && entry.source == mesh.positions.data())
        return entry.geometry;
    release(entry);

    const PackedVertices packed = packVertices(mesh);
    const std::string name = "mesh " + mesh.name;
    Result<gl::Buffer> vertices =
        gl::Buffer::create(name + " vertices", packed.values.size() * sizeof(float),
                           gl::BufferAccess::GpuOnly, packed.values.data());
    if (!vertices) return vertices.error();
    Result<gl::Buffer> indices =
        gl::Buffer::create(name + " indices", mesh.indices.size() * sizeof(uint32_t),
                           gl::BufferAccess::GpuOnly, mesh.indices.data());
    if (!indices) return indices.error();
    entry.vertices = executor_.registerBuffer(name + " vertices", std::move(*vertices));
    entry.indices = executor_.registerBuffer(name + " indices", std::move(*indices));
    fg::GeometryDesc desc;
    desc.vertices = entry.vertices;
    desc.strideBytes = packed.layout.strideFloats * 4;
    desc.attributes = packed.attributes;
    desc.indices = entry.indices;
    entry.geometry = executor_.registerGeometry(name, desc);
    entry.layout = packed.layout;
    entry.version = mesh.version;
    entry.source = mesh.positions.data();
    return entry.geometry;
}

} // namespace tyndall
