#include "framegraph/gl/gl_pass_context.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/check.h"
#include "framegraph/gl/gl_format.h"
#include "gl/context.h"

namespace tyndall::fg {

Storage& GlWorld::storageAt(StoragePlace place, uint32_t index) const {
    const ResourceRecord& resource = graph.resources()[index];
    switch (place.kind) {
    case PlaceKind::Absent:
        return resource.isBuffer ? storage.absentBuffer(poison)
                                 : storage.absentTexture(resource.texture, poison);
    case PlaceKind::Slot: return storage.slot(place.index);
    case PlaceKind::Persistent:
        return storage.persistent(persistentTable, place.index, resource.name);
    case PlaceKind::Static:
        return resource.isBuffer ? statics.buffer(place.index).storage
                                 : statics.texture(place.index).storage;
    case PlaceKind::None: break;
    }
    CHECK(false, fmt::format("'{}' has no storage: no pass that ran made it", resource.name));
}

GlPassContext::GlPassContext(const GlWorld& world) : world_(world) {
    GLuint id = 0;
    glCreateVertexArrays(1, &id);
    emptyVertexArray_ = gl::Object(gl::ObjectKind::VertexArray, id);
    emptyVertexArray_.label("no attributes");
}

void GlPassContext::beginFrame() {
    failure_.reset();
    barrierCount_ = 0;
    glClipControl(
        GL_LOWER_LEFT,
        GL_ZERO_TO_ONE); // reversed depth keeps its precision only without the remapping of −1..1
    glDisable(GL_RASTERIZER_DISCARD);
    discards_ = false;
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_STENCIL_TEST);
    glDisable(GL_MULTISAMPLE);
    glDisable(GL_FRAMEBUFFER_SRGB);
    glDisable(GL_DITHER);
    glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
    glEnable(GL_PROGRAM_POINT_SIZE);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
}

void GlPassContext::beginPass(uint32_t pass) {
    pass_ = pass;
    program_ = nullptr;
    stateApplied_ = false;
    hasTargets_ = false;
    depthTarget_ = {};
    state_ = {};
}

void GlPassContext::endPass() {
    capture_.end();
    setDiscard(false);
}

void GlPassContext::memoryBarrier(uint32_t bits) {
    if (bits == 0) return;
    glMemoryBarrier(bits);
    ++barrierCount_;
}

void GlPassContext::barrier(Access next) {
    capture_.end();
    memoryBarrier(barrierBits(Access::StorageWrite, next, false) |
                  barrierBits(Access::StorageWrite, next, true));
}

void GlPassContext::check(uint32_t resource, uint32_t version, Touch touch,
                          std::string_view place) const {
    const std::string problem = checkTouch(world_.graph, pass_, resource, version, touch, place);
    CHECK(problem.empty(), problem);
}

// --- programs ---

void GlPassContext::begin(std::span<const char* const> files, const Define* defines,
                          uint32_t defineCount) {
    capture_.end(); // GL changes no program meanwhile
    program_ = nullptr;
    bound_.fill(false);
    allBound_ = false;
    hasTargets_ = false;
    stateApplied_ = false;
    Result<const gl::Program*> found =
        world_.programs.find(passName(), files, {defines, defineCount});
    if (!found.ok()) {
        if (!failure_) failure_ = found.error();
        return;
    }
    program_ = *found;
    CHECK(program_->resources().size() <= bound_.size(),
          fmt::format("'{}' has too many resources", program_->name()));
    glUseProgram(program_->id());
}

void GlPassContext::beginCompute(const char* shader, const Define* defines, uint32_t defineCount) {
    begin({&shader, 1}, defines, defineCount);
}

void GlPassContext::beginRaster(const RasterShaders& shaders, const Define* defines,
                                uint32_t defineCount) {
    CHECK(shaders.vertex != nullptr,
          fmt::format("pass '{}' draws without a vertex shader", passName()));
    CHECK(
        (shaders.tessControl != nullptr) == (shaders.tessEvaluation != nullptr),
        fmt::format("pass '{}' draws '{}' with one stage of tessellation: it needs both or neither",
                    passName(), shaders.vertex));
    std::array<const char*, 4> files{};
    size_t count = 0;
    for (const char* file :
         {shaders.vertex, shaders.tessControl, shaders.tessEvaluation, shaders.fragment})
        if (file != nullptr) files[count++] = file;
    begin({files.data(), count}, defines, defineCount);
    state_ = {};
}

const gl::ProgramResource* GlPassContext::resourceOf(const char* name) {
    if (const gl::ProgramResource* resource = program_->find(name)) return resource;
    CHECK(program_->mentions(name), fmt::format("pass '{}' binds '{}', which '{}' does not have",
                                                passName(), name, program_->name()));
    return nullptr;
}

void GlPassContext::markBound(const gl::ProgramResource& resource) {
    bound_[size_t(&resource - program_->resources().data())] = true;
}

void GlPassContext::checkAllBound() {
    if (allBound_) return;
    for (size_t i = 0; i < program_->resources().size(); ++i) {
        const gl::ProgramResource& resource = program_->resources()[i];
        CHECK(bound_[i] || resource.kind == gl::ResourceKind::Uniform,
              fmt::format("pass '{}' runs '{}' without binding its {} '{}'", passName(),
                          program_->name(), gl::resourceKindName(resource.kind), resource.name));
    }
    allBound_ = true;
}

// --- bindings ---

bool GlPassContext::writesByShader(uint32_t resource) const {
    for (const ResourceUse& use : world_.compiled.usesOf(world_.compiled.passes[pass_]))
        if (use.resource == resource && use.access == Access::StorageWrite) return true;
    return false;
}

void GlPassContext::bindSampler(const gl::ProgramResource& sampler, Storage& storage,
                                const gl::SamplerSpec* spec, int32_t mip, int32_t layer) {
    const bool shadow = isShadowSampler(sampler.type);
    const gl::Texture& texture = storage.view(mip, layer, isSampler2D(sampler.type));
    const gl::SamplerSpec own =
        samplerFor(texture.spec().internalFormat, texture.spec().mips, shadow);
    glBindTextureUnit(GLuint(sampler.binding), texture.id());
    glBindSampler(GLuint(sampler.binding), world_.samplers.get(spec ? *spec : own));
    markBound(sampler);
}

void GlPassContext::bindImage(const gl::ProgramResource& image, const Storage& storage, bool writes,
                              int32_t mip, int32_t layer) {
    glBindImageTexture(GLuint(image.binding), storage.texture.id(), std::max(mip, 0),
                       layer < 0 ? GL_TRUE : GL_FALSE, std::max(layer, 0),
                       writes ? GL_READ_WRITE : GL_READ_ONLY,
                       storage.texture.spec().internalFormat);
    markBound(image);
}

/// `bytes` is what the shader may see: its array's length() follows from it.
void GlPassContext::bindBlock(const gl::ProgramResource& block, const gl::Buffer& buffer,
                              uint64_t bytes) {
    const bool uniform = block.kind == gl::ResourceKind::UniformBlock;
    const uint64_t whole = (bytes + 15) / 16 * 16; // some drivers round a block's size up to this
    CHECK(int64_t(whole) >= block.bytes,
          fmt::format("pass '{}' binds {} bytes to the {} '{}' of '{}', which has {}", passName(),
                      bytes, gl::resourceKindName(block.kind), block.name, program_->name(),
                      block.bytes));
    glBindBufferRange(uniform ? GL_UNIFORM_BUFFER : GL_SHADER_STORAGE_BUFFER, GLuint(block.binding),
                      buffer.id(), 0, GLsizeiptr(bytes));
    markBound(block);
}

void GlPassContext::bindTexture(const char* name, TextureHandle handle, int32_t mip,
                                int32_t layer) {
    if (!program_) return;
    const gl::ProgramResource* resource = resourceOf(name);
    if (!resource) return;
    const bool sampled = resource->kind == gl::ResourceKind::Sampler;
    CHECK(sampled || resource->kind == gl::ResourceKind::Image,
          fmt::format("pass '{}' binds a texture to '{}' of '{}', which is a {}", passName(), name,
                      program_->name(), gl::resourceKindName(resource->kind)));
    // GL does not tell whether a shader only reads an image, so either declaration allows binding it.
    check(handle.resource, handle.version, sampled ? Touch::Sample : Touch::ReadStorage, name);
    Storage& storage = world_.storageOf(handle.resource, handle.version);
    if (world_.graph.isAbsent(handle))
        mip = -1, layer = -1; // the stand-in has one level and one layer
    if (!sampled) return bindImage(*resource, storage, writesByShader(handle.resource), mip, layer);
    const ResourceRecord& record = world_.graph.resources()[handle.resource];
    const std::optional<gl::SamplerSpec>* spec =
        record.origin == ResourceOrigin::Imported ? &world_.statics.texture(record.staticId).sampler
                                                  : nullptr;
    bindSampler(*resource, storage, spec && *spec ? &**spec : nullptr, mip, layer);
}

void GlPassContext::bindStaticTexture(const char* name, StaticTexture texture) {
    if (!program_) return;
    const gl::ProgramResource* resource = resourceOf(name);
    if (!resource) return;
    CHECK(resource->kind == gl::ResourceKind::Sampler,
          fmt::format("pass '{}' binds a static texture to '{}' of '{}', which is no sampler",
                      passName(), name, program_->name()));
    StaticTextureEntry& entry = world_.statics.texture(texture.id);
    bindSampler(*resource, entry.storage, entry.sampler ? &*entry.sampler : nullptr, -1, -1);
}

void GlPassContext::bindBuffer(const char* name, BufferHandle handle) {
    if (!program_) return;
    const gl::ProgramResource* resource = resourceOf(name);
    if (!resource) return;
    const bool uniform = resource->kind == gl::ResourceKind::UniformBlock;
    CHECK(uniform || resource->kind == gl::ResourceKind::StorageBlock,
          fmt::format("pass '{}' binds a buffer to '{}' of '{}', which is a {}", passName(), name,
                      program_->name(), gl::resourceKindName(resource->kind)));
    check(handle.resource, handle.version, uniform ? Touch::UniformBlock : Touch::ReadStorage,
          name);
    const gl::Buffer& buffer = world_.storageOf(handle.resource, handle.version).buffer;
    uint64_t bytes = desc(handle).bytes;
    if (isAbsent(handle))
        bytes = std::min(std::max(bytes, uint64_t(resource->bytes)), StorageSet::kAbsentBytes);
    bindBlock(*resource, buffer, bytes);
}

void GlPassContext::bindStaticBuffer(const char* name, StaticBuffer buffer) {
    if (!program_) return;
    const gl::ProgramResource* resource = resourceOf(name);
    if (!resource) return;
    CHECK(resource->kind == gl::ResourceKind::UniformBlock ||
              resource->kind == gl::ResourceKind::StorageBlock,
          fmt::format("pass '{}' binds a static buffer to '{}' of '{}', which is no block",
                      passName(), name, program_->name()));
    const gl::Buffer& storage = world_.statics.buffer(buffer.id).storage.buffer;
    bindBlock(*resource, storage, storage.bytes());
}

void GlPassContext::uniformBlock(const char* block, const void* data, size_t bytes) {
    if (!program_) return;
    const gl::ProgramResource* resource = resourceOf(block);
    if (!resource) return;
    CHECK(resource->kind == gl::ResourceKind::UniformBlock && int64_t(bytes) >= resource->bytes,
          fmt::format("pass '{}' gives {} bytes to the {} '{}' of '{}', which has {}", passName(),
                      bytes, gl::resourceKindName(resource->kind), block, program_->name(),
                      resource->bytes));
    const int alignment = gl::currentCapabilities().limits.uniformBufferAlignment;
    const gl::UploadRing::Slice slice =
        world_.ring.upload(data, bytes, uint64_t(std::max(alignment, 16)));
    glBindBufferRange(GL_UNIFORM_BUFFER, GLuint(resource->binding), slice.buffer,
                      GLintptr(slice.offset), GLsizeiptr(bytes));
    markBound(*resource);
}

void GlPassContext::uniformInt(const char* name, int32_t value) {
    if (!program_) return;
    const gl::ProgramResource* resource = resourceOf(name);
    if (!resource) return;
    CHECK(resource->kind == gl::ResourceKind::Uniform && resource->type != GL_FLOAT,
          fmt::format("pass '{}' sets '{}' of '{}' to an integer, which it is not", passName(),
                      name, program_->name()));
    if (resource->type == GL_UNSIGNED_INT)
        glProgramUniform1ui(program_->id(), resource->location, uint32_t(value));
    else
        glProgramUniform1i(program_->id(), resource->location, value);
}

void GlPassContext::uniformFloat(const char* name, float value) {
    if (!program_) return;
    const gl::ProgramResource* resource = resourceOf(name);
    if (!resource) return;
    CHECK(resource->kind == gl::ResourceKind::Uniform && resource->type == GL_FLOAT,
          fmt::format("pass '{}' sets '{}' of '{}' to a float, which it is not", passName(), name,
                      program_->name()));
    glProgramUniform1f(program_->id(), resource->location, value);
}

// --- compute ---

void GlPassContext::dispatch(uint32_t x, uint32_t y, uint32_t z) {
    if (!program_ || x == 0 || y == 0 || z == 0) return;
    CHECK(program_->isCompute(),
          fmt::format("pass '{}' dispatches '{}', which is no compute shader", passName(),
                      program_->name()));
    checkAllBound();
    const ivec3 most = gl::currentCapabilities().limits.computeGroups;
    CHECK(
        x <= uint32_t(most.x) && y <= uint32_t(most.y) && z <= uint32_t(most.z),
        fmt::format("pass '{}' dispatches {}×{}×{} groups of '{}', more than the driver's {}×{}×{}",
                    passName(), x, y, z, program_->name(), most.x, most.y, most.z));
    glDispatchCompute(x, y, z);
}

void GlPassContext::dispatchThreads(uint32_t x, uint32_t y, uint32_t z) {
    if (!program_) return;
    const uvec3 size = glm::max(program_->localSize(), uvec3(1));
    dispatch((x + size.x - 1) / size.x, (y + size.y - 1) / size.y, (z + size.z - 1) / size.z);
}

const gl::Buffer* GlPassContext::argumentsAt(BufferHandle arguments, uint64_t byteOffset,
                                             size_t bytes, const char* place) const {
    check(arguments.resource, arguments.version, Touch::Indirect, place);
    if (isAbsent(arguments)) return nullptr; // a stand-in's zeros would do nothing
    CHECK(byteOffset % 4 == 0 && byteOffset + bytes <= desc(arguments).bytes,
          fmt::format("pass '{}' reads {} at byte {} of a buffer of {}", passName(), place,
                      byteOffset, desc(arguments).bytes));
    return &world_.storageOf(arguments.resource, arguments.version).buffer;
}

void GlPassContext::dispatchIndirect(BufferHandle arguments, uint64_t byteOffset) {
    const gl::Buffer* buffer =
        argumentsAt(arguments, byteOffset, sizeof(DispatchArguments), "dispatch arguments");
    if (!program_ || !buffer) return;
    checkAllBound();
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, buffer->id());
    glDispatchComputeIndirect(GLintptr(byteOffset));
}

} // namespace tyndall::fg
