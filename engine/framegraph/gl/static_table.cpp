#include "framegraph/gl/static_table.h"

#include <fmt/format.h>

#include <vector>

#include "core/check.h"

namespace tyndall::fg {
namespace {

template <typename Map> auto& entryOf(Map& map, uint32_t id, const char* kind) {
    const auto found = map.find(id);
    CHECK(found != map.end(),
          fmt::format("{} {} is not registered with this executor, or was released", kind, id));
    return *found->second;
}

struct GlType {
    GLenum type;
    GLboolean normalised;
    bool integer;
};

GlType glType(AttributeType type) {
    switch (type) {
    case AttributeType::Float32: return {GL_FLOAT, GL_FALSE, false};
    case AttributeType::Unorm8: return {GL_UNSIGNED_BYTE, GL_TRUE, false};
    case AttributeType::Unorm16: return {GL_UNSIGNED_SHORT, GL_TRUE, false};
    case AttributeType::Snorm8: return {GL_BYTE, GL_TRUE, false};
    case AttributeType::Snorm16: return {GL_SHORT, GL_TRUE, false};
    case AttributeType::UInt32: return {GL_UNSIGNED_INT, GL_FALSE, true};
    }
    CHECK(false, "not a type of vertex attribute");
}

} // namespace

StaticTexture StaticTable::add(std::string_view name, gl::Texture&& texture,
                               const gl::SamplerSpec* sampler) {
    CHECK(texture, fmt::format("static texture '{}' is empty", name));
    auto entry = std::make_unique<StaticTextureEntry>();
    entry->name = name;
    entry->storage.texture = std::move(texture);
    if (sampler) entry->sampler = *sampler;
    textures_.emplace(++lastId_, std::move(entry));
    return {lastId_};
}

StaticBuffer StaticTable::add(std::string_view name, gl::Buffer&& buffer) {
    CHECK(buffer, fmt::format("static buffer '{}' is empty", name));
    auto entry = std::make_unique<StaticBufferEntry>();
    entry->name = name;
    entry->storage.buffer = std::move(buffer);
    buffers_.emplace(++lastId_, std::move(entry));
    return {lastId_};
}

StaticGeometry StaticTable::add(std::string_view name, const GeometryDesc& desc) {
    CHECK(desc.strideBytes > 0, fmt::format("geometry '{}' has a stride of 0 bytes", name));
    const GLuint vertices = buffer(desc.vertices.id).storage.buffer.id();
    std::vector<gl::VertexAttribute> attributes;
    for (const VertexAttribute& attribute : desc.attributes) {
        const GlType type = glType(attribute.type);
        gl::VertexAttribute out;
        out.location = attribute.location;
        out.components = GLint(attribute.components);
        out.type = type.type;
        out.normalised = type.normalised;
        out.integer = type.integer;
        out.buffer = vertices;
        out.offset = desc.vertexOffsetBytes + attribute.offset;
        out.stride = GLsizei(desc.strideBytes);
        attributes.push_back(out);
    }
    auto entry = std::make_unique<StaticGeometryEntry>();
    entry->name = name;
    entry->indexed = desc.indices.id != 0;
    entry->indexOffsetBytes = desc.indexOffsetBytes;
    const GLuint indices = entry->indexed ? buffer(desc.indices.id).storage.buffer.id() : 0;
    entry->vertexArray = gl::VertexArray(name, attributes, indices);
    geometries_.emplace(++lastId_, std::move(entry));
    return {lastId_};
}

void StaticTable::release(StaticTexture texture, gl::FramebufferCache& framebuffers) {
    framebuffers.forget(this->texture(texture.id).storage.texture);
    textures_.erase(texture.id);
}
void StaticTable::release(StaticBuffer buffer) {
    CHECK(buffers_.erase(buffer.id) == 1, "release() of a buffer that is not registered");
}
void StaticTable::release(StaticGeometry geometry) {
    CHECK(geometries_.erase(geometry.id) == 1, "release() of a geometry that is not registered");
}

StaticTextureEntry& StaticTable::texture(uint32_t id) {
    return entryOf(textures_, id, "static texture");
}
StaticBufferEntry& StaticTable::buffer(uint32_t id) {
    return entryOf(buffers_, id, "static buffer");
}
StaticGeometryEntry& StaticTable::geometry(uint32_t id) {
    return entryOf(geometries_, id, "geometry");
}

StorageSet::Totals StaticTable::totals() const {
    StorageSet::Totals totals;
    for (const auto& [id, entry] : textures_) totals.bytes += entry->storage.bytes();
    for (const auto& [id, entry] : buffers_) totals.bytes += entry->storage.bytes();
    totals.textures = uint32_t(textures_.size());
    totals.buffers = uint32_t(buffers_.size());
    return totals;
}

} // namespace tyndall::fg
