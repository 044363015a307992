#pragma once
// Descriptions of the graph in GL's words.

#include "framegraph/resource_desc.h"
#include "gl/sampler.h"
#include "gl/texture.h"

namespace tyndall::fg {

GLenum glFormat(Format format);
GLenum glTarget(TextureKind kind);
gl::TextureSpec glSpec(const TextureDesc& desc);
/// True for formats of floating-point colours: those that can hold NaN.
bool isFloatColor(Format format);

/// What a texture of the graph is read through: bilinear and trilinear where the format has filters, else nearest; always
/// clamped. Shadow samplers pass where the reference is at least the stored, reversed depth.
gl::SamplerSpec samplerFor(GLenum internalFormat, int mips, bool shadow);
bool isShadowSampler(GLenum uniformType);
/// sampler2D and its integer and shadow kinds.
bool isSampler2D(GLenum uniformType);

} // namespace tyndall::fg
