#include "gl/screen.h"

namespace tyndall::gl {

void copyPicture(GLuint source, int width, int height, Texture& copy) {
    CHECK(source != 0, "there is no picture to copy");
    TextureSpec spec;
    spec.internalFormat = GL_RGBA8;
    spec.width = width;
    spec.height = height;
    if (!copy || !(copy.spec() == spec)) {
        copy = Texture("editor.picture", spec);
        copy.swizzle(GL_RED, GL_GREEN, GL_BLUE, GL_ONE);
    }
    glCopyImageSubData(source, GL_TEXTURE_2D, 0, 0, 0, 0, copy.id(), GL_TEXTURE_2D, 0, 0, 0, 0,
                       width, height, 1);
}

void beginWindowFrame(int width, int height, float red, float green, float blue) {
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, width, height);
    const float color[4] = {red, green, blue, 1};
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glClearBufferfv(GL_COLOR, 0, color);
}

} // namespace tyndall::gl
