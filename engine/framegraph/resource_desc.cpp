#include "framegraph/resource_desc.h"

#include <algorithm>
#include <iterator>

#include "core/check.h"

namespace tyndall::fg {
namespace {

struct FormatInfo {
    const char* name;
    uint32_t bytes;
    bool integer;
};

constexpr FormatInfo kFormats[] = {
    {"R8", 1, false},        {"RGBA8", 4, false},      {"SRGBA8", 4, false},
    {"RG16Snorm", 4, false}, {"RGBA16", 8, false},     {"R16F", 2, false},
    {"RG16F", 4, false},     {"RGBA16F", 8, false},    {"R32F", 4, false},
    {"RG32F", 8, false},     {"RGBA32F", 16, false},   {"R16UI", 2, true},
    {"R32UI", 4, true},      {"RG32UI", 8, true},      {"RGBA32UI", 16, true},
    {"R32I", 4, true},       {"R11G11B10F", 4, false}, {"Depth32F", 4, false},
};

const FormatInfo& info(Format format) {
    CHECK(size_t(format) < std::size(kFormats), "not a format");
    return kFormats[size_t(format)];
}

} // namespace

uint32_t bytesPerTexel(Format format) { return info(format).bytes; }
const char* formatName(Format format) { return info(format).name; }
bool isIntegerFormat(Format format) { return info(format).integer; }

uint64_t byteSize(const TextureDesc& desc) {
    uint64_t texels = 0;
    for (int32_t mip = 0; mip < desc.mips; ++mip) {
        const uint64_t width = uint64_t(std::max(1, desc.width >> mip));
        const uint64_t height = uint64_t(std::max(1, desc.height >> mip));
        const bool volume = desc.kind == TextureKind::Tex3D; // layers of an array do not shrink
        const uint64_t depth = uint64_t(std::max(1, volume ? desc.depth >> mip : desc.depth));
        texels += width * height * depth;
    }
    return texels * bytesPerTexel(desc.format);
}

} // namespace tyndall::fg
