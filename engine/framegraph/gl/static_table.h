#pragma once
// Things that live longer than a frame and need no ordering: material textures, meshes, tables. Ids are never reused.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>

#include "framegraph/gl/executor.h"
#include "framegraph/gl/storage.h"
#include "gl/sampler.h"
#include "gl/vertex_array.h"

namespace tyndall::fg {

struct StaticTextureEntry {
    std::string name;
    Storage storage;
    std::optional<gl::SamplerSpec> sampler;
};
struct StaticBufferEntry {
    std::string name;
    Storage storage;
};
struct StaticGeometryEntry {
    std::string name;
    gl::VertexArray vertexArray;
    bool indexed = false;
    uint64_t indexOffsetBytes = 0;
};

class StaticTable {
public:
    StaticTexture add(std::string_view name, gl::Texture&& texture, const gl::SamplerSpec* sampler);
    StaticBuffer add(std::string_view name, gl::Buffer&& buffer);
    StaticGeometry add(std::string_view name, const GeometryDesc& desc);
    void release(StaticTexture texture, gl::FramebufferCache& framebuffers);
    void release(StaticBuffer buffer);
    void release(StaticGeometry geometry);

    // CHECK that the id is registered.
    StaticTextureEntry& texture(uint32_t id);
    StaticBufferEntry& buffer(uint32_t id);
    StaticGeometryEntry& geometry(uint32_t id);

    [[nodiscard]] StorageSet::Totals totals() const;

private:
    std::unordered_map<uint32_t, std::unique_ptr<StaticTextureEntry>> textures_;
    std::unordered_map<uint32_t, std::unique_ptr<StaticBufferEntry>> buffers_;
    std::unordered_map<uint32_t, std::unique_ptr<StaticGeometryEntry>> geometries_;
    uint32_t lastId_ = 0;
};

} // namespace tyndall::fg
