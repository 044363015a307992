#pragma once
// Meshes as geometry on the GPU: interleaved vertices with the attributes that the mesh has, and its indices.

#include <array>
#include <cstdint>
#include <vector>

#include "core/result.h"
#include "framegraph/gl/executor.h"
#include "scene/scene.h"

namespace tyndall {

/// Attribute locations in shaders/gbuffer/mesh_vertex.glsl.
enum class VertexLocation : uint32_t { Position = 0, Normal = 1, Tangent = 2, Uv0 = 3, Color = 7 };

/// Where things are in a vertex, which begins with its position.
struct VertexLayout {
    uint32_t strideFloats = 0;
    std::array<uint32_t, kMaxUvSets> uvFloats{}; // from the vertex's beginning; 0: it has none
    uint32_t colorFloats = 0;
};

/// Vertices ready for a buffer.
struct PackedVertices {
    std::vector<float> values; // layout.strideFloats a vertex
    VertexLayout layout;
    std::vector<fg::VertexAttribute> attributes; // only what the mesh has
};
/// CHECKs that every attribute has as many values as there are positions, or none.
PackedVertices packVertices(const Mesh& mesh);

/// The scene's meshes, by index.
class MeshUpload {
public:
    explicit MeshUpload(fg::Executor& executor) : executor_(executor) {}
    ~MeshUpload();
    MeshUpload(const MeshUpload&) = delete;
    MeshUpload& operator=(const MeshUpload&) = delete;

    /// The geometry of mesh `index`, made again if the mesh's version is another; null for a mesh without indices.
    /// Errors: no room on the GPU.
    Result<fg::StaticGeometry> obtain(const Scene& scene, int index);
    /// Vertices and indices of a mesh that obtain() has returned a geometry for.
    struct Buffers {
        fg::StaticBuffer vertices, indices;
        VertexLayout layout;
    };
    [[nodiscard]] Buffers buffers(int index) const {
        const Entry& entry = entries_.at(size_t(index));
        return {entry.vertices, entry.indices, entry.layout};
    }
    /// Forgets meshes that the scene no longer has.
    void trim(size_t meshCount);

private:
    struct Entry {
        Version version = 0;
        const void* source =
            nullptr; // the mesh's positions: another scene may bring the same version number
        fg::StaticGeometry geometry;
        fg::StaticBuffer vertices, indices;
        VertexLayout layout;
    };
    void release(Entry& entry);
    fg::Executor& executor_;
    std::vector<Entry> entries_;
};

} // namespace tyndall
