// What can be known to be wrong while a pass is declared: sentences for compile() to report.
#include <algorithm>

#include <fmt/format.h>

#include "framegraph/frame_graph_impl.h"

namespace tyndall::fg {

bool FrameGraphImpl::checkHandle(uint32_t resource, uint32_t number, const char* verb,
                                 const std::source_location& where) {
    if (versionOf(resource, number) != kNoIndex) return true;
    if (resource == 0)
        errors_.push_back(fmt::format("pass '{}' {} a null handle ({}): nothing has produced it",
                                      passName(), verb, placeText(where)));
    else
        errors_.push_back(fmt::format(
            "pass '{}' {} a handle (resource {}, version {}) that this frame does not have ({}): handles end "
            "with their frame",
            passName(), verb, resource, number, placeText(where)));
    return false;
}

void FrameGraphImpl::checkAccess(uint32_t resource, Access access, bool wantWrite,
                                 const std::source_location& where) {
    const ResourceRecord& record = resources_[resource];
    const bool depth = !record.isBuffer && record.texture.format == Format::Depth32F;
    const char* problem = nullptr;
    if (isWrite(access) != wantWrite) {
        problem = wantWrite ? "is an access that reads" : "is an access that writes";
    } else if (record.isBuffer) {
        if (access == Access::ColorTarget || access == Access::DepthTarget ||
            access == Access::DepthRead)
            problem = "needs a texture, and this is a buffer";
    } else if (access == Access::Uniform || access == Access::Indirect ||
               access == Access::Vertex || access == Access::Capture) {
        problem = "needs a buffer, and this is a texture";
    } else if (depth && (access == Access::ColorTarget || access == Access::StorageRead ||
                         access == Access::StorageWrite)) {
        problem = "is not possible with a depth format";
    } else if (!depth && (access == Access::DepthTarget || access == Access::DepthRead)) {
        problem = "needs the format Depth32F";
    }
    if (problem)
        errors_.push_back(fmt::format("pass '{}' declares '{}' as {} ({}), which {}", passName(),
                                      record.name, accessName(access), placeText(where), problem));
}

void FrameGraphImpl::checkDesc(uint32_t resource, const std::source_location& where) {
    const ResourceRecord& record = resources_[resource];
    if (record.isBuffer) {
        if (record.buffer.bytes == 0)
            errors_.push_back(
                fmt::format("buffer '{}' has no bytes ({})", record.name, placeText(where)));
        return;
    }
    const TextureDesc& d = record.texture;
    if (d.width < 1 || d.height < 1 || d.depth < 1 || d.mips < 1)
        errors_.push_back(
            fmt::format("texture '{}' is {}×{}×{} with {} mips ({}): each must be at least 1",
                        record.name, d.width, d.height, d.depth, d.mips, placeText(where)));
    else if (d.kind == TextureKind::Tex2D && d.depth != 1)
        errors_.push_back(
            fmt::format("texture '{}' is 2D but has depth {} ({}): make it an array or 3D",
                        record.name, d.depth, placeText(where)));
    else if ((std::max({d.width, d.height, d.kind == TextureKind::Tex3D ? d.depth : 1}) >>
              (d.mips - 1)) == 0)
        errors_.push_back(
            fmt::format("texture '{}' is {}×{} but has {} mips ({}), more than its size can have",
                        record.name, d.width, d.height, d.mips, placeText(where)));
}

} // namespace tyndall::fg
