#pragma once
// Framebuffer objects, made once per set of attachments.

#include <array>
#include <map>
#include <span>

#include "gl/object.h"
#include "gl/texture.h"

namespace tyndall::gl {

/// One image of a texture to draw to.
struct Attachment {
    const Texture* texture = nullptr;
    int mip = 0;
    int layer =
        -1; // of an array, slice of a 3D texture, face of a cube map; -1: all of them (layered), or a 2D texture
};

/// Owns framebuffers, found by what is attached. A framebuffer that was not asked for in a while is dropped, and with
/// it its hold on textures that are gone. Empty when moved from.
class FramebufferCache {
public:
    FramebufferCache() = default;
    FramebufferCache(FramebufferCache&&) = default;
    FramebufferCache& operator=(FramebufferCache&&) = default;

    /// The GL name of a framebuffer with these colour attachments, in order, drawn to all of them, and `depth` if not
    /// null. Without any it is one of 1x1 pixels that keeps nothing, for draws that are not rasterised: a context without a
    /// surface has no complete framebuffer of its own. CHECKs: at most eight colours, and that the driver calls it complete.
    GLuint get(std::span<const Attachment> colors, const Attachment* depth = nullptr);
    /// Drops framebuffers with this texture; needed before a texture goes only for its memory to be freed at once.
    void forget(const Texture& texture);
    /// Drops what was not used in the last 16 frames.
    void endFrame();
    [[nodiscard]] size_t size() const { return entries_.size(); }

    static constexpr size_t kMostColors = 8;

private:
    struct Part {
        uint64_t serial = 0; // of the texture
        int mip = 0, layer = -1;
        auto operator<=>(const Part&) const = default;
    };
    using Key = std::array<Part, kMostColors + 1>; // colours, then depth
    struct Entry {
        Object object;
        uint64_t lastUsed = 0;
    };
    std::map<Key, Entry> entries_;
    uint64_t frame_ = 0;
};

} // namespace tyndall::gl
