#include "gl/capabilities.h"

#include "gl/api.h"

namespace tyndall::gl {
namespace {

int integer(GLenum name) {
    GLint value = 0;
    glGetIntegerv(name, &value);
    return value;
}

int64_t integer64(GLenum name) {
    GLint64 value = 0;
    glGetInteger64v(name, &value);
    return value;
}

ivec3 integer3(GLenum name) {
    ivec3 value{0};
    for (GLuint i = 0; i < 3; ++i) glGetIntegeri_v(name, i, &value[int(i)]);
    return value;
}

std::string text(GLenum name) {
    const auto* value = reinterpret_cast<const char*>(glGetString(name));
    return value ? value : "";
}

Limits queryLimits(bool anisotropic) {
    Limits limits;
    limits.textureSize = integer(GL_MAX_TEXTURE_SIZE);
    limits.texture3DSize = integer(GL_MAX_3D_TEXTURE_SIZE);
    limits.textureLayers = integer(GL_MAX_ARRAY_TEXTURE_LAYERS);
    limits.textureUnitsPerStage = integer(GL_MAX_TEXTURE_IMAGE_UNITS);
    limits.combinedTextureUnits = integer(GL_MAX_COMBINED_TEXTURE_IMAGE_UNITS);
    limits.imageUnits = integer(GL_MAX_IMAGE_UNITS);
    limits.uniformBufferBindings = integer(GL_MAX_UNIFORM_BUFFER_BINDINGS);
    limits.uniformBlockBytes = integer64(GL_MAX_UNIFORM_BLOCK_SIZE);
    limits.uniformBufferAlignment = integer(GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT);
    limits.storageBufferBindings = integer(GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS);
    limits.computeStorageBlocks = integer(GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS);
    limits.storageBlockBytes = integer64(GL_MAX_SHADER_STORAGE_BLOCK_SIZE);
    limits.storageBufferAlignment = integer(GL_SHADER_STORAGE_BUFFER_OFFSET_ALIGNMENT);
    limits.computeSharedBytes = integer(GL_MAX_COMPUTE_SHARED_MEMORY_SIZE);
    limits.computeInvocations = integer(GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS);
    limits.computeGroups = integer3(GL_MAX_COMPUTE_WORK_GROUP_COUNT);
    limits.computeGroupSize = integer3(GL_MAX_COMPUTE_WORK_GROUP_SIZE);
    limits.colorAttachments = integer(GL_MAX_COLOR_ATTACHMENTS);
    limits.patchVertices = integer(GL_MAX_PATCH_VERTICES);
    glGetQueryiv(GL_TIMESTAMP, GL_QUERY_COUNTER_BITS, &limits.timestampBits);
    if (anisotropic) glGetFloatv(GL_MAX_TEXTURE_MAX_ANISOTROPY_EXT, &limits.anisotropy);
    limits.labelLength = integer(GL_MAX_LABEL_LENGTH);
    return limits;
}

struct WorkaroundRow {
    Workaround workaround;
    std::string_view renderer; // the part of GL_RENDERER that it applies to
};
constexpr WorkaroundRow kWorkarounds[] = {
    // Mesa 22.3's anisotropic filter loops over the footprint without a bound: Sponza's floor, seen at a grazing angle, took over
    // 15 minutes of CPU time at 160x90 and did not end.
    {Workaround::NoAnisotropy, "llvmpipe"},
    // Compute shaders run while they are recorded, but timestamps are taken when the draws recorded with them are rasterised:
    // without a flush after each timestamp, compute work seems to take no time (Mesa 22.3; GpuTimerTest.ComputeWorkHasItsTime).
    {Workaround::FlushTimestamps, "llvmpipe"},
};

} // namespace

Capabilities Capabilities::query(const std::set<std::string, std::less<>>& disabled) {
    Capabilities capabilities;
    capabilities.vendor = text(GL_VENDOR);
    capabilities.renderer = text(GL_RENDERER);
    capabilities.version = text(GL_VERSION);
    capabilities.shadingLanguageVersion = text(GL_SHADING_LANGUAGE_VERSION);
    const int count = integer(GL_NUM_EXTENSIONS);
    for (int i = 0; i < count; ++i) {
        const auto* name = reinterpret_cast<const char*>(glGetStringi(GL_EXTENSIONS, GLuint(i)));
        if (name != nullptr && !disabled.contains(name)) capabilities.extensions_.insert(name);
    }
    capabilities.limits = queryLimits(capabilities.has("GL_EXT_texture_filter_anisotropic"));
    return capabilities;
}

bool Capabilities::needs(Workaround workaround) const {
    for (const WorkaroundRow& row : kWorkarounds)
        if (row.workaround == workaround && renderer.find(row.renderer) != std::string::npos)
            return true;
    return false;
}

bool Capabilities::isSoftware() const {
    for (std::string_view name : {"llvmpipe", "softpipe", "SWR", "swrast"})
        if (renderer.find(name) != std::string::npos) return true;
    return false;
}

} // namespace tyndall::gl
