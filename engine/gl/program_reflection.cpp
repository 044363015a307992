#include "gl/program_reflection.h"

#include <fmt/format.h>

#include <algorithm>

#include "gl/context.h"

namespace tyndall::gl {
namespace {

std::string resourceName(GLuint program, GLenum interface, GLuint index) {
    const GLenum property = GL_NAME_LENGTH;
    GLint length = 0;
    glGetProgramResourceiv(program, interface, index, 1, &property, 1, nullptr, &length);
    std::string name(size_t(std::max(length, 1)), '\0');
    GLsizei written = 0;
    glGetProgramResourceName(program, interface, index, GLsizei(name.size()), &written,
                             name.data());
    name.resize(size_t(written));
    return name;
}

int property(GLuint program, GLenum interface, GLuint index, GLenum name) {
    GLint value = 0;
    glGetProgramResourceiv(program, interface, index, 1, &name, 1, nullptr, &value);
    return value;
}

int activeCount(GLuint program, GLenum interface) {
    GLint count = 0;
    glGetProgramInterfaceiv(program, interface, GL_ACTIVE_RESOURCES, &count);
    return count;
}

std::string withoutFirstIndex(std::string name) {
    if (name.ends_with("[0]")) name.resize(name.size() - 3);
    return name;
}

bool isSamplerType(GLenum type) {
    switch (type) {
    case GL_SAMPLER_1D:
    case GL_SAMPLER_2D:
    case GL_SAMPLER_3D:
    case GL_SAMPLER_CUBE:
    case GL_SAMPLER_2D_ARRAY:
    case GL_SAMPLER_2D_SHADOW:
    case GL_SAMPLER_2D_ARRAY_SHADOW:
    case GL_SAMPLER_CUBE_SHADOW:
    case GL_SAMPLER_BUFFER:
    case GL_SAMPLER_2D_MULTISAMPLE:
    case GL_SAMPLER_CUBE_MAP_ARRAY:
    case GL_SAMPLER_CUBE_MAP_ARRAY_SHADOW:
    case GL_INT_SAMPLER_2D:
    case GL_INT_SAMPLER_3D:
    case GL_INT_SAMPLER_2D_ARRAY:
    case GL_INT_SAMPLER_CUBE:
    case GL_INT_SAMPLER_BUFFER:
    case GL_UNSIGNED_INT_SAMPLER_2D:
    case GL_UNSIGNED_INT_SAMPLER_3D:
    case GL_UNSIGNED_INT_SAMPLER_2D_ARRAY:
    case GL_UNSIGNED_INT_SAMPLER_CUBE:
    case GL_UNSIGNED_INT_SAMPLER_BUFFER:
    case GL_SAMPLER_2D_RECT: return true;
    default: return false;
    }
}

/// Image types are one run of numbers in the specification, from GL_IMAGE_1D to
/// GL_UNSIGNED_INT_IMAGE_2D_MULTISAMPLE_ARRAY.
bool isImageType(GLenum type) {
    return type >= GL_IMAGE_1D && type <= GL_UNSIGNED_INT_IMAGE_2D_MULTISAMPLE_ARRAY;
}

std::vector<BlockMember> blockMembers(GLuint program, GLenum block, GLuint index) {
    const bool storage = block == GL_SHADER_STORAGE_BLOCK;
    const GLenum interface = storage ? GL_BUFFER_VARIABLE : GL_UNIFORM;
    std::vector<GLint> variables(size_t(property(program, block, index, GL_NUM_ACTIVE_VARIABLES)));
    const GLenum active = GL_ACTIVE_VARIABLES;
    if (!variables.empty())
        glGetProgramResourceiv(program, block, index, 1, &active, GLsizei(variables.size()),
                               nullptr, variables.data());
    std::vector<BlockMember> members;
    for (GLint variable : variables) {
        BlockMember member;
        const auto at = GLuint(variable);
        member.name = resourceName(program, interface, at);
        member.type = GLenum(property(program, interface, at, GL_TYPE));
        member.offset = property(program, interface, at, GL_OFFSET);
        member.arraySize = property(program, interface, at, GL_ARRAY_SIZE);
        member.arrayStride = property(program, interface, at, GL_ARRAY_STRIDE);
        member.matrixStride = property(program, interface, at, GL_MATRIX_STRIDE);
        if (storage)
            member.topLevelStride = property(program, interface, at, GL_TOP_LEVEL_ARRAY_STRIDE);
        members.push_back(std::move(member));
    }
    std::ranges::sort(members, {}, &BlockMember::offset);
    return members;
}

void reflectBlocks(GLuint program, GLenum interface, ResourceKind kind,
                   std::vector<ProgramResource>& resources) {
    for (GLuint i = 0; i < GLuint(activeCount(program, interface)); ++i) {
        ProgramResource resource;
        resource.kind = kind;
        resource.name = resourceName(program, interface, i);
        resource.binding = int(i);
        resource.bytes = property(program, interface, i, GL_BUFFER_DATA_SIZE);
        resource.members = blockMembers(program, interface, i);
        if (kind == ResourceKind::UniformBlock)
            glUniformBlockBinding(program, i, i);
        else
            glShaderStorageBlockBinding(program, i, i);
        resources.push_back(std::move(resource));
    }
}

/// Gives `count` units from `next` on to a sampler or image.
int assignUnits(GLuint program, const ProgramResource& resource, int& next) {
    const int first = next;
    std::vector<GLint> units;
    for (int i = 0; i < resource.count; ++i) units.push_back(next++);
    glProgramUniform1iv(program, resource.location, resource.count, units.data());
    return first;
}

void reflectUniforms(GLuint program, std::vector<ProgramResource>& resources) {
    int nextTexture = 0, nextImage = 0;
    for (GLuint i = 0; i < GLuint(activeCount(program, GL_UNIFORM)); ++i) {
        if (property(program, GL_UNIFORM, i, GL_BLOCK_INDEX) >= 0) continue;
        ProgramResource resource;
        resource.name = withoutFirstIndex(resourceName(program, GL_UNIFORM, i));
        resource.type = GLenum(property(program, GL_UNIFORM, i, GL_TYPE));
        resource.location = property(program, GL_UNIFORM, i, GL_LOCATION);
        resource.count = std::max(1, property(program, GL_UNIFORM, i, GL_ARRAY_SIZE));
        if (isSamplerType(resource.type)) {
            resource.kind = ResourceKind::Sampler;
            resource.binding = assignUnits(program, resource, nextTexture);
        } else if (isImageType(resource.type)) {
            resource.kind = ResourceKind::Image;
            resource.binding = assignUnits(program, resource, nextImage);
        }
        resources.push_back(std::move(resource));
    }
}

} // namespace

std::vector<ProgramResource> reflectAndBind(GLuint program) {
    std::vector<ProgramResource> resources;
    reflectBlocks(program, GL_UNIFORM_BLOCK, ResourceKind::UniformBlock, resources);
    reflectBlocks(program, GL_SHADER_STORAGE_BLOCK, ResourceKind::StorageBlock, resources);
    reflectUniforms(program, resources);
    return resources;
}

Result<void> checkBindingLimits(std::string_view name, std::span<const ProgramResource> resources) {
    const Limits& limits = currentCapabilities().limits;
    const std::pair<ResourceKind, int> most[] = {
        {ResourceKind::UniformBlock, limits.uniformBufferBindings},
        {ResourceKind::StorageBlock, limits.storageBufferBindings},
        {ResourceKind::Sampler, limits.combinedTextureUnits},
        {ResourceKind::Image, limits.imageUnits}};
    for (const auto& [kind, limit] : most) {
        int used = 0;
        for (const ProgramResource& resource : resources)
            if (resource.kind == kind) used += resource.count;
        if (used > limit)
            return Error{fmt::format("shader '{}' uses {} {} bindings, and this GPU has {}", name,
                                     used, resourceKindName(kind), limit)};
    }
    return {};
}

Result<int> captureStride(std::string_view name, GLuint program) {
    const int buffers = activeCount(program, GL_TRANSFORM_FEEDBACK_BUFFER);
    if (buffers == 0) return 0;
    if (buffers > 1 || property(program, GL_TRANSFORM_FEEDBACK_BUFFER, 0, GL_BUFFER_BINDING) != 0)
        return Error{fmt::format(
            "shader '{}' captures into several buffers, or not into number 0: give all its captured outputs "
            "`xfb_buffer = 0`, or none",
            name)};
    return property(program, GL_TRANSFORM_FEEDBACK_BUFFER, 0, GL_TRANSFORM_FEEDBACK_BUFFER_STRIDE);
}

GLenum tessellatedPrimitive(GLuint program) {
    GLint points = GL_FALSE, mode = GL_TRIANGLES;
    glGetProgramiv(program, GL_TESS_GEN_POINT_MODE, &points);
    glGetProgramiv(program, GL_TESS_GEN_MODE, &mode);
    if (points == GL_TRUE) return GL_POINTS;
    return mode == GL_ISOLINES ? GL_LINES : GL_TRIANGLES;
}

} // namespace tyndall::gl
