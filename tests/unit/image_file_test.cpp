#include "core/image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/content.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wold-style-cast"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#pragma GCC diagnostic ignored "-Wimplicit-fallthrough"
#pragma GCC diagnostic ignored "-Wdouble-promotion"
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#include <stb/stb_image.h> // a decoder that shares nothing with the encoder under test
#pragma GCC diagnostic pop

namespace tyndall {
namespace {
namespace fs = std::filesystem;
using ::testing::HasSubstr;

size_t filesIn(const fs::path& folder) {
    return size_t(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

struct FileTest : ::testing::Test {
    fs::path folder = test::scratchDir("file");
};

TEST_F(FileTest, WritesReplacesAndLeavesNothingBeside) {
    const fs::path path = folder / "a.txt";
    const std::string binary("one\0two", 7);
    ASSERT_TRUE(writeFileAtomically(path, binary).ok());
    EXPECT_EQ(readFile(path).value(), binary);
    ASSERT_TRUE(writeFileAtomically(path, "").ok());
    EXPECT_EQ(readFile(path).value(), "");
    EXPECT_EQ(filesIn(folder), 1u);
}

TEST_F(FileTest, FollowsASymbolicLinkToTheFileBehindIt) {
    ASSERT_TRUE(writeFileAtomically(folder / "real.txt", "old").ok());
    fs::create_symlink("real.txt", folder / "link.txt");
    ASSERT_TRUE(writeFileAtomically(folder / "link.txt", "new").ok());
    EXPECT_TRUE(fs::is_symlink(folder / "link.txt"));
    EXPECT_EQ(readFile(folder / "real.txt").value(), "new");
}

TEST_F(FileTest, FailuresNameTheFileAndTheReason) {
    EXPECT_THAT(writeFileAtomically(folder / "no" / "such" / "a.txt", "x").message(),
                HasSubstr((folder / "no/such/a.txt").string() + "': No such file"));
    EXPECT_THAT(writeFileAtomically(folder, "x").message(), HasSubstr("Is a directory"));
    EXPECT_THAT(readFile(folder / "missing").message(), HasSubstr("No such file"));
    EXPECT_THAT(readFile(folder).message(), HasSubstr("Is a directory"));
    ASSERT_TRUE(writeFileAtomically(folder / "ten", "0123456789").ok());
    EXPECT_THAT(readFile(folder / "ten", 9).message(), HasSubstr("10 bytes"));
    EXPECT_TRUE(readFile(folder / "ten", 10).ok());
    EXPECT_EQ(filesIn(folder), 1u) << "no temporary file stays behind";
}

TEST_F(FileTest, AFullDiskIsASentence) {
    if (!fs::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
    EXPECT_THAT(writeFileAtomically("/dev/full", "x").message(), HasSubstr("No space left"));
}

TEST_F(FileTest, PngHoldsTheBytesTopRowFirst) {
    const std::vector<uint8_t> rgb = {255, 0, 0, 0,      255, 0, /**/ 0, 0,   255,
                                      1,   2, 3, /**/ 9, 8,   7, 254,    253, 252};
    ASSERT_TRUE(writePng(folder / "a.png", 2, 3, 3, rgb).ok());
    int width = 0, height = 0, channels = 0;
    const std::string file = readFile(folder / "a.png").value();
    uint8_t* decoded = stbi_load_from_memory(reinterpret_cast<const uint8_t*>(file.data()),
                                             int(file.size()), &width, &height, &channels, 0);
    ASSERT_NE(decoded, nullptr);
    EXPECT_EQ(width, 2);
    EXPECT_EQ(height, 3);
    EXPECT_EQ(channels, 3);
    EXPECT_EQ(std::vector<uint8_t>(decoded, decoded + rgb.size()), rgb);
    stbi_image_free(decoded);
    EXPECT_THROW((void)writePng(folder / "b.png", 2, 3, 3, std::span(rgb).first(5)), CheckFailure);
    EXPECT_FALSE(writePng(folder / "no" / "b.png", 2, 3, 3, rgb).ok());
}

TEST_F(FileTest, PngReadsBackAsItsValuesOverTheLargest) {
    const std::vector<uint8_t> rgba = {255, 0, 51, 255, 1, 2, 3, 0};
    ASSERT_TRUE(writePng(folder / "a.png", 2, 1, 4, rgba).ok());
    const Image image = readPng(folder / "a.png").value();
    ASSERT_EQ(image.channels, 3) << "transparency is left out";
    const std::vector<int> expected = {255, 0, 51, 1, 2, 3};
    for (size_t i = 0; i < 6; ++i) EXPECT_FLOAT_EQ(image.pixels[i], float(expected[i]) / 255.0f);
}

TEST_F(FileTest, DamagedPngsAreRefusedByName) {
    const std::vector<uint8_t> rgb(64 * 64 * 3, 77);
    ASSERT_TRUE(writePng(folder / "a.png", 64, 64, 3, rgb).ok());
    const std::string whole = readFile(folder / "a.png").value();
    for (size_t length : {size_t(0), size_t(7), size_t(20), whole.size() / 2}) {
        ASSERT_TRUE(writeFileAtomically(folder / "b.png", whole.substr(0, length)).ok());
        EXPECT_THAT(readPng(folder / "b.png").message(), HasSubstr("b.png")) << length;
    }
    std::string vast = whole; // the header's width: bytes 16 to 19
    vast.replace(16, 4, std::string("\x00\xff\xff\xff", 4));
    ASSERT_TRUE(writeFileAtomically(folder / "c.png", vast).ok());
    EXPECT_FALSE(readPng(folder / "c.png").ok());
    EXPECT_THAT(readPng(folder / "none.png").message(), HasSubstr("none.png"));
}

} // namespace
} // namespace tyndall
