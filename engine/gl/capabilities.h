#pragma once
// What the driver can do: limits, extensions, and the work-arounds that it needs.

#include <cstdint>
#include <set>
#include <string>
#include <string_view>

#include "core/math.h"

namespace tyndall::gl {

/// Numbers that the wrappers check against. OpenGL 4.5 guarantees a least value for each.
struct Limits {
    int textureSize = 0; // texels along an edge, 2D
    int texture3DSize = 0;
    int textureLayers = 0;
    int textureUnitsPerStage = 0;
    int combinedTextureUnits = 0;
    int imageUnits = 0;
    int uniformBufferBindings = 0;
    int64_t uniformBlockBytes = 0;
    int uniformBufferAlignment = 0; // bytes
    int storageBufferBindings = 0;
    int computeStorageBlocks = 0;
    int64_t storageBlockBytes = 0;
    int storageBufferAlignment = 0; // bytes
    int computeSharedBytes = 0;
    int computeInvocations = 0; // of one group
    ivec3 computeGroups{0};     // of one dispatch
    ivec3 computeGroupSize{0};
    int colorAttachments = 0;
    int patchVertices = 0;   // of one patch
    int timestampBits = 0;   // 0: no GPU times
    float anisotropy = 1.0f; // 1: no anisotropic filter
    int labelLength = 0;     // bytes
};

/// Behaviour of a driver that the code avoids. Each has a row in the table in capabilities.cpp with driver and reason.
enum class Workaround : uint32_t {
    FlushTimestamps = 0, // a timestamp must be flushed to be taken in its place among the commands
    NoAnisotropy = 1,    // the anisotropic filter must not be used
};

class Capabilities {
public:
    /// Asks the current context. Extensions in `disabled` count as absent.
    static Capabilities query(const std::set<std::string, std::less<>>& disabled);

    std::string vendor, renderer, version, shadingLanguageVersion;
    Limits limits;

    /// True when the driver has the extension and it was not switched off. Core features of 4.5 need no asking.
    [[nodiscard]] bool has(std::string_view extension) const {
        return extensions_.contains(extension);
    }
    [[nodiscard]] const std::set<std::string, std::less<>>& extensions() const {
        return extensions_;
    }
    [[nodiscard]] bool needs(Workaround workaround) const;
    /// A CPU does the work (llvmpipe, softpipe, swr).
    [[nodiscard]] bool isSoftware() const;

private:
    std::set<std::string, std::less<>> extensions_;
};

} // namespace tyndall::gl
