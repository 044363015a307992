#include "gl/texture.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>

#include "gl/gl_fixture.h"
#include "gl/read_back.h"

namespace tyndall::gl {
namespace {

using ::testing::HasSubstr;

class TextureTest : public test::GlTest {};
TYNDALL_GL_TESTS(TextureTest);

std::vector<float> ramp(size_t count, float step) {
    std::vector<float> values(count);
    for (size_t i = 0; i < count; ++i) values[i] = float(i) * step;
    return values;
}

TEST_P(TextureTest, FloatsComeBackAsTheyWere) {
    for (const TextureSpec& spec :
         {TextureSpec{GL_TEXTURE_2D, GL_RGBA32F, 5, 3, 1, 1},
          TextureSpec{GL_TEXTURE_2D_ARRAY, GL_R32F, 4, 3, 5, 1},
          TextureSpec{GL_TEXTURE_3D, GL_RG32F, 3, 4, 5, 1},
          TextureSpec{GL_TEXTURE_2D, GL_DEPTH_COMPONENT32F, 7, 2, 1, 1}}) {
        Texture texture("ramp", spec);
        const std::vector<float> values = ramp(size_t(textureBytes(spec)) / 4, 1.0f / 256.0f);
        texture.write(values.data(), values.size() * 4);
        EXPECT_EQ(readFloats(texture), values) << formatInfo(spec.internalFormat).name;
        EXPECT_EQ(texture.bytes(), int64_t(values.size() * 4));
    }
}

TEST_P(TextureTest, NormalisedIntegersBecomeFractions) {
    Texture bytes("bytes", {.internalFormat = GL_RGBA8, .width = 2, .height = 1});
    const uint8_t texels[8] = {0, 51, 102, 255, 1, 2, 3, 4};
    bytes.write(texels, sizeof texels);
    const std::vector<float> values = readFloats(bytes);
    for (size_t i = 0; i < 8; ++i) EXPECT_NEAR(values[i], float(texels[i]) / 255.0f, 1e-6f);

    Texture shorts("shorts", {.internalFormat = GL_RGBA16, .width = 1, .height = 1});
    const uint16_t words[4] = {0, 1, 32768, 65535};
    shorts.write(words, sizeof words);
    const std::vector<float> fractions = readFloats(shorts);
    for (size_t i = 0; i < 4; ++i) EXPECT_NEAR(fractions[i], float(words[i]) / 65535.0f, 1e-6f);
}

TEST_P(TextureTest, IntegersComeBackAsTheyWere) {
    Texture texture("integers", {.internalFormat = GL_RG32UI, .width = 3, .height = 2});
    const std::vector<uint32_t> values = {0,  1,  0xffffffffu, 7,  8,  9,
                                          10, 11, 12,          13, 14, 0x80000000u};
    texture.write(values.data(), values.size() * 4);
    EXPECT_EQ(readIntegers(texture), values);
    texture.clearInteger(3, 4);
    const std::vector<uint32_t> cleared = readIntegers(texture);
    for (size_t i = 0; i < cleared.size(); i += 2) {
        EXPECT_EQ(cleared[i], 3u);
        EXPECT_EQ(cleared[i + 1], 4u);
    }
    EXPECT_THROW(readFloats(texture), CheckFailure);
}

TEST_P(TextureTest, ClearReachesEveryMip) {
    Texture texture("mips", {.target = GL_TEXTURE_3D,
                             .internalFormat = GL_RGBA16F,
                             .width = 4,
                             .height = 4,
                             .depth = 4,
                             .mips = 3});
    texture.clear(0.5f, 1.0f, 2.0f, 4.0f);
    for (int mip = 0; mip < 3; ++mip) {
        const std::vector<float> values = readFloats(texture, mip);
        EXPECT_EQ(values.size(), size_t((4 >> mip) * (4 >> mip) * (4 >> mip) * 4));
        for (size_t i = 0; i < values.size(); i += 4) EXPECT_EQ(values[i + 2], 2.0f);
    }
    Texture depth("depth", {.internalFormat = GL_DEPTH_COMPONENT32F, .width = 3, .height = 3});
    depth.clear(0.25f);
    EXPECT_EQ(readFloats(depth), std::vector<float>(9, 0.25f));
}

TEST_P(TextureTest, ARegionIsWrittenAlone) {
    Texture texture("region", {.target = GL_TEXTURE_2D_ARRAY,
                               .internalFormat = GL_R32F,
                               .width = 4,
                               .height = 4,
                               .depth = 2,
                               .mips = 2});
    texture.clear(0.0f);
    const float two[2] = {1.0f, 2.0f};
    texture.write({.mip = 1, .x = 1, .y = 0, .z = 1, .width = 1, .height = 2}, two, sizeof two);
    EXPECT_EQ(readFloats(texture, 1), (std::vector<float>{0, 0, 0, 0, 0, 1, 0, 2}));
    EXPECT_EQ(readFloats(texture, 0), std::vector<float>(32, 0.0f));
    EXPECT_THROW(
        texture.write({.mip = 1, .x = 1, .y = 0, .width = 2, .height = 1}, two, sizeof two),
        CheckFailure);
    EXPECT_THROW(texture.write({.mip = 2, .width = 1, .height = 1}, two, 4), CheckFailure);
    EXPECT_THROW(texture.write({.width = 2, .height = 1}, two, 4), CheckFailure);
}

/// The mean of a 2×2 block, by definition of a box filter on a square power of two.
TEST_P(TextureTest, ABoxOfTexelsIsCopiedAlone) {
    Texture source("source", {GL_TEXTURE_3D, GL_R32F, 4, 3, 3, 1});
    const std::vector<float> values = ramp(36, 1);
    source.write(values.data(), values.size() * 4);
    Texture copy("copy", {GL_TEXTURE_3D, GL_R32F, 2, 5, 4, 1});
    copy.clear(-1);
    copy.copyFrom(source, {0, 1, 0, 2, 2, 3, 1}, 0, 2, 3);
    const std::vector<float> texels = readFloats(copy);
    for (int z = 0; z < 4; ++z)
        for (int y = 0; y < 5; ++y)
            for (int x = 0; x < 2; ++x) {
                const bool copied = z == 3 && y >= 2;
                const float expected = copied ? float((2 * 3 + y - 2) * 4 + x + 1) : -1.0f;
                EXPECT_EQ(texels[size_t((z * 5 + y) * 2 + x)], expected) << x << y << z;
            }
    EXPECT_THROW(copy.copyFrom(source, {0, 1, 0, 2, 2, 3, 1}, 0, 3, 3), CheckFailure);
}

TEST_P(TextureTest, MipsAreMeans) {
    Texture texture("mips", {.internalFormat = GL_R32F, .width = 4, .height = 4, .mips = 3});
    const std::vector<float> values = ramp(16, 1.0f);
    texture.write(values.data(), 64);
    texture.generateMips();
    EXPECT_EQ(readFloats(texture, 1), (std::vector<float>{2.5f, 4.5f, 10.5f, 12.5f}));
    EXPECT_EQ(readFloats(texture, 2), std::vector<float>{7.5f});
}

TEST_P(TextureTest, AViewSeesTheSameTexels) {
    Texture array("array", {.target = GL_TEXTURE_2D_ARRAY,
                            .internalFormat = GL_R32F,
                            .width = 4,
                            .height = 2,
                            .depth = 3,
                            .mips = 2});
    array.clear(1.0f);
    Texture layer = array.view("layer", GL_TEXTURE_2D, GL_R32F, 0, 1, 1, 1);
    EXPECT_EQ(layer.bytes(), 0) << "storage is counted once";
    layer.clear(0x1p-3f);
    std::vector<float> expected(24, 1.0f);
    std::fill(expected.begin() + 8, expected.begin() + 16, 0.125f);
    EXPECT_EQ(readFloats(array), expected);
    const Texture bits = array.view("bits", GL_TEXTURE_2D, GL_R32UI, 0, 1, 1, 1);
    EXPECT_EQ(readIntegers(bits), std::vector<uint32_t>(8, 0x3e000000u))
        << "the bits of 1/8 in IEEE 754";
    EXPECT_EQ(array.view("mip", GL_TEXTURE_2D_ARRAY, GL_R32F, 1, 1, 0, 3).spec().width, 2);
    array = {};
    EXPECT_EQ(readFloats(layer), std::vector<float>(8, 0.125f)) << "a view keeps the storage";
    EXPECT_THROW((void)layer.view("wrong", GL_TEXTURE_2D, GL_RGBA32F, 0, 1, 0, 1), CheckFailure);
    EXPECT_THROW((void)layer.view("wrong", GL_TEXTURE_2D, GL_R32F, 1, 1, 0, 1), CheckFailure);
}

TEST_P(TextureTest, TooLargeIsAnErrorWithNameAndLimit) {
    const int limit = context().capabilities().limits.textureSize;
    const Result<Texture> texture = Texture::create("panorama", {.width = limit + 1, .height = 1});
    ASSERT_FALSE(texture.ok());
    EXPECT_THAT(texture.message(), HasSubstr("panorama"));
    EXPECT_THAT(texture.message(), HasSubstr(std::to_string(limit)));
    EXPECT_THROW(Texture("none", {.width = 0}), CheckFailure);
    EXPECT_THROW(Texture("mips", {.width = 4, .height = 4, .mips = 4}), CheckFailure);
}

TEST_P(TextureTest, FullChainsEndAtOneTexel) {
    EXPECT_EQ(fullMipCount(1, 1), 1);
    EXPECT_EQ(fullMipCount(2, 1), 2);
    EXPECT_EQ(fullMipCount(1280, 720), 11);
    EXPECT_EQ(fullMipCount(9, 9, 17), 5);
    EXPECT_EQ(textureBytes({.target = GL_TEXTURE_3D,
                            .internalFormat = GL_R32F,
                            .width = 4,
                            .height = 4,
                            .depth = 4,
                            .mips = 3}),
              4 * (64 + 8 + 1));
    EXPECT_EQ(textureBytes({.target = GL_TEXTURE_2D_ARRAY,
                            .internalFormat = GL_R32F,
                            .width = 4,
                            .height = 4,
                            .depth = 4,
                            .mips = 3}),
              4 * (64 + 16 + 4));
}

TEST_P(TextureTest, MovedFromIsEmpty) {
    Texture first("first", {.width = 2, .height = 2});
    const uint64_t serial = first.serial();
    Texture second = std::move(first);
    EXPECT_FALSE(first); // NOLINT: that is the point
    EXPECT_EQ(second.serial(), serial);
    const Texture third("third", {.width = 2, .height = 2});
    EXPECT_NE(third.serial(), serial);
}

/// GL counts rows from the bottom, images from the top.
TEST_P(TextureTest, AnImageHasTheTopRowFirst) {
    Texture texture("rows", {.target = GL_TEXTURE_2D_ARRAY,
                             .internalFormat = GL_R32F,
                             .width = 2,
                             .height = 3,
                             .depth = 2});
    const std::vector<float> values = ramp(12, 1.0f);
    texture.write(values.data(), 48);
    const Image image = readImage(texture, 1);
    EXPECT_EQ(image.width, 2);
    EXPECT_EQ(image.height, 3);
    EXPECT_EQ(image.channels, 1);
    EXPECT_EQ(image.pixels, (std::vector<float>{10, 11, 8, 9, 6, 7}));
}

TEST_P(TextureTest, AReadBackHoldsWhatWasThereWhenItStarted) {
    Texture texture("changing", {.internalFormat = GL_RGBA32F, .width = 64, .height = 64});
    texture.clear(1.0f, 2.0f, 3.0f, 4.0f);
    ReadBack readBack = ReadBack::start(texture);
    texture.clear(9.0f, 9.0f, 9.0f, 9.0f);
    glFinish();
    EXPECT_TRUE(readBack.ready());
    ReadBack moved = std::move(readBack);
    EXPECT_FALSE(readBack); // NOLINT: that is the point
    const std::vector<float> values = moved.takeFloats();
    ASSERT_EQ(values.size(), size_t(64 * 64 * 4));
    for (size_t i = 0; i < values.size(); i += 4) ASSERT_EQ(values[i + 2], 3.0f);
    EXPECT_FALSE(moved);
    EXPECT_THROW((void)moved.takeFloats(), CheckFailure);
}

} // namespace
} // namespace tyndall::gl
