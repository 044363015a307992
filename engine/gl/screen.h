#pragma once
// What stands between a finished picture and a window: a copy that outlives the frame, and the window's own framebuffer.

#include "gl/texture.h"

namespace tyndall::gl {

/// A copy of the RGBA8 texture `source` (a GL name), remade when the size changes. Its alpha reads as one, so that it can be
/// blended over a window without showing through.
void copyPicture(GLuint source, int width, int height, Texture& copy);

/// Draws into the window from now on: binds its framebuffer, sets the viewport, clears to this colour.
void beginWindowFrame(int width, int height, float red, float green, float blue);

} // namespace tyndall::gl
