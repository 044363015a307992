// Textures on their way to a driver that takes less than the picture has.
#include "gl/gl_fixture.h"

#include <mutex>

#include "core/log.h"
#include "gl/shader_library.h"
#include "gl/texture.h"
#include "renderer/texture_upload.h"

namespace tyndall::test {
namespace {

using TextureLimits = GlTest;
TYNDALL_GL_TESTS(TextureLimits);

TEST_P(TextureLimits, WhatIsTooLargeIsScaledDownAndSaid) {
    const int limit = gl::currentCapabilities().limits.textureSize;
    Scene scene;
    ImageData image;
    image.name = "long " + std::to_string(int(GetParam())); // a warning comes once a name
    image.width = 2 * limit;
    image.height = 4;
    for (int i = 0; i < image.width * image.height; ++i)
        image.rgba.insert(image.rgba.end(), {200, 40, 10, 255});
    scene.images.push_back(image);
    scene.textures.push_back({0, {}});

    std::string said;
    const log::Sink before =
        log::setSink([&](log::Level, std::string_view message) { said += message; });
    gl::ShaderLibrary library;
    fg::Executor executor(library);
    TextureUpload upload(executor);
    const Result<fg::StaticTexture> texture = upload.obtain(scene, 0, ColorSpace::Srgb);
    log::setSink(before);
    ASSERT_TRUE(texture.ok()) << texture.message();
    EXPECT_EQ(executor.texture(*texture).spec().width, limit);
    EXPECT_EQ(executor.texture(*texture).spec().height, 2) << "the sides keep their ratio";
    EXPECT_NE(said.find("is scaled down to " + std::to_string(limit) + "x2"), std::string::npos)
        << said;
}

} // namespace
} // namespace tyndall::test
