#include "gl/framebuffer.h"

#include <fmt/format.h>

#include <algorithm>

namespace tyndall::gl {
namespace {

void attach(GLuint framebuffer, GLenum point, const Attachment& attachment) {
    const Texture& texture = *attachment.texture;
    const bool layered = texture.spec().target != GL_TEXTURE_2D;
    if (layered && attachment.layer >= 0)
        glNamedFramebufferTextureLayer(framebuffer, point, texture.id(), attachment.mip,
                                       attachment.layer);
    else
        glNamedFramebufferTexture(framebuffer, point, texture.id(), attachment.mip);
}

const char* statusName(GLenum status) {
    switch (status) {
    case GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT: return "an attachment cannot be drawn to";
    case GL_FRAMEBUFFER_INCOMPLETE_MISSING_ATTACHMENT: return "nothing is attached";
    case GL_FRAMEBUFFER_INCOMPLETE_LAYER_TARGETS: return "layered and other attachments are mixed";
    case GL_FRAMEBUFFER_UNSUPPORTED:
        return "the driver does not support this combination of formats";
    default: return "it is incomplete";
    }
}

std::string describe(std::span<const Attachment> colors, const Attachment* depth) {
    std::string text;
    const auto add = [&](const Attachment& attachment) {
        const TextureSpec& spec = attachment.texture->spec();
        text += fmt::format("{}{} {}x{}x{} mip {} layer {}", text.empty() ? "" : ", ",
                            formatInfo(spec.internalFormat).name, spec.width, spec.height,
                            spec.depth, attachment.mip, attachment.layer);
    };
    for (const Attachment& color : colors) add(color);
    if (depth != nullptr) add(*depth);
    return text.empty() ? "no targets" : text;
}

constexpr uint64_t kKeptFrames = 16;

} // namespace

GLuint FramebufferCache::get(std::span<const Attachment> colors, const Attachment* depth) {
    CHECK(colors.size() <= kMostColors,
          fmt::format("{} colour attachments, of at most {}", colors.size(), kMostColors));
    Key key{};
    const auto part = [](const Attachment& attachment) {
        CHECK(attachment.texture != nullptr && *attachment.texture, "an attachment is empty");
        return Part{attachment.texture->serial(), attachment.mip, attachment.layer};
    };
    for (size_t i = 0; i < colors.size(); ++i) key[i] = part(colors[i]);
    if (depth != nullptr) key[kMostColors] = part(*depth);

    Entry& entry = entries_[key];
    entry.lastUsed = frame_;
    if (entry.object) return entry.object.id();
    GLuint id = 0;
    glCreateFramebuffers(1, &id);
    entry.object = Object(ObjectKind::Framebuffer, id);
    std::array<GLenum, kMostColors> drawBuffers{};
    for (size_t i = 0; i < colors.size(); ++i) {
        drawBuffers[i] = GL_COLOR_ATTACHMENT0 + GLenum(i);
        attach(id, drawBuffers[i], colors[i]);
    }
    if (depth != nullptr) attach(id, GL_DEPTH_ATTACHMENT, *depth);
    if (colors.empty() && depth == nullptr) { // OpenGL 4.5, section 9.2.1
        glNamedFramebufferParameteri(id, GL_FRAMEBUFFER_DEFAULT_WIDTH, 1);
        glNamedFramebufferParameteri(id, GL_FRAMEBUFFER_DEFAULT_HEIGHT, 1);
    }
    glNamedFramebufferDrawBuffers(id, GLsizei(colors.size()), drawBuffers.data());
    entry.object.label(describe(colors, depth));
    const GLenum status = glCheckNamedFramebufferStatus(id, GL_DRAW_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE) entries_.erase(key);
    CHECK(status == GL_FRAMEBUFFER_COMPLETE,
          fmt::format("framebuffer ({}): {}", describe(colors, depth), statusName(status)));
    return id;
}

void FramebufferCache::forget(const Texture& texture) {
    std::erase_if(entries_, [&](const auto& entry) {
        return std::ranges::any_of(
            entry.first, [&](const Part& part) { return part.serial == texture.serial(); });
    });
}

void FramebufferCache::endFrame() {
    ++frame_;
    std::erase_if(entries_, [this](const auto& entry) {
        return frame_ - entry.second.lastUsed > kKeptFrames;
    });
}

} // namespace tyndall::gl
