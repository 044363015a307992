// EXR files whose data window is not the display window: crops, overscan, both at once. OpenEXR itself writes them.

#include "core/image.h"

#include <cstring>
#include <limits>
#include <string>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfTiledOutputFile.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/content.h"

namespace tyndall {
namespace {
namespace fs = std::filesystem;
using Imath::Box2i;
using Imath::V2i;

constexpr const char* kChannels[] = {"R", "G", "B", "depth.Y", "LVVE.R", "LVVE.G", "LVVE.B"};

/// What the file says at (x, y) of channel c: another whole number everywhere, exact in single precision, never 0.
float stored(int x, int y, int c) { return float(1 + c + 8 * ((x + 100) + 300 * (y + 100))); }

struct Windows {
    Box2i display, data;
};

enum class Storage { Lines = 0, LinesFromBelow = 1, Tiles = 2 };

Imf::Header headerOf(const Windows& windows, Imf::Compression compression) {
    Imf::Header header(windows.display, windows.data);
    header.compression() = compression;
    for (const char* channel : kChannels)
        header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
    return header;
}

void write(const fs::path& path, const Windows& windows, Storage storage = Storage::Lines,
           Imf::Compression compression = Imf::ZIP_COMPRESSION) {
    Imf::Header header = headerOf(windows, compression);
    const V2i size = windows.data.size() + V2i(1);
    std::vector<std::vector<float>> planes;
    Imf::FrameBuffer frame;
    for (int c = 0; c < int(std::size(kChannels)); ++c) {
        std::vector<float>& plane = planes.emplace_back();
        for (int y = windows.data.min.y; y <= windows.data.max.y; ++y)
            for (int x = windows.data.min.x; x <= windows.data.max.x; ++x)
                plane.push_back(stored(x, y, c));
        frame.insert(kChannels[c], Imf::Slice::Make(Imf::FLOAT, plane.data(), windows.data,
                                                    sizeof(float), sizeof(float) * size_t(size.x)));
    }
    if (storage == Storage::Tiles) {
        header.setTileDescription(Imf::TileDescription(8, 4, Imf::ONE_LEVEL));
        Imf::TiledOutputFile file(path.c_str(), header);
        file.setFrameBuffer(frame);
        file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
        return;
    }
    if (storage == Storage::LinesFromBelow) header.lineOrder() = Imf::DECREASING_Y;
    Imf::OutputFile file(path.c_str(), header);
    file.setFrameBuffer(frame);
    file.writePixels(size.y);
}

/// The picture as the format defines it: what is stored, inside the display window; 0 elsewhere.
void expectDisplayWindow(const fs::path& path, const Windows& windows) {
    const Result<ExrFile> file = readExr(path);
    ASSERT_TRUE(file.ok()) << file.message();
    ASSERT_EQ(file->layers.size(), 3u);
    for (const ImageLayer& layer : file->layers) {
        const int first = layer.name == "depth" ? 3 : layer.name == "LVVE" ? 4 : 0;
        const V2i size = windows.display.size() + V2i(1);
        ASSERT_EQ(layer.image.width, size.x) << layer.name;
        ASSERT_EQ(layer.image.height, size.y) << layer.name;
        ASSERT_EQ(layer.image.channels, layer.name == "depth" ? 1 : 3) << layer.name;
        for (int row = 0; row < size.y; ++row)
            for (int column = 0; column < size.x; ++column)
                for (int c = 0; c < layer.image.channels; ++c) {
                    const V2i at = windows.display.min + V2i(column, row);
                    const float right =
                        windows.data.intersects(at) ? stored(at.x, at.y, first + c) : 0.0f;
                    ASSERT_EQ(layer.image.at(column, row)[c], right)
                        << layer.name << " at " << at.x << ", " << at.y;
                }
    }
}

const Windows kCases[] = {
    {{{0, 0}, {31, 23}}, {{0, 0}, {31, 23}}},         // the ordinary one
    {{{0, 0}, {31, 23}}, {{10, 5}, {19, 14}}},        // a crop
    {{{0, 0}, {31, 23}}, {{-4, -3}, {35, 26}}},       // overscan
    {{{0, 0}, {31, 23}}, {{-7, 20}, {5, 40}}},        // both: past the left and the lower edge
    {{{0, 0}, {31, 23}}, {{31, 23}, {60, 50}}},       // one pixel in common
    {{{0, 0}, {31, 23}}, {{32, 0}, {40, 23}}},        // beside it
    {{{0, 0}, {31, 23}}, {{5, -20}, {9, -1}}},        // above it
    {{{-16, -12}, {15, 11}}, {{-16, -12}, {15, 11}}}, // neither begins at 0
    {{{-16, 40}, {15, 63}}, {{-20, 30}, {0, 50}}},
};

TEST(ExrWindows, ThePictureIsTheDisplayWindowHoweverItIsStored) {
    const fs::path path = test::scratchDir("exr-windows") / "a.exr";
    for (const Windows& windows : kCases)
        for (const Storage storage : {Storage::Lines, Storage::LinesFromBelow, Storage::Tiles})
            for (const Imf::Compression compression :
                 {Imf::NO_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION,
                  Imf::PIZ_COMPRESSION}) {
                SCOPED_TRACE(::testing::Message()
                             << "data from " << windows.data.min << " to " << windows.data.max
                             << ", storage " << int(storage) << ", codec " << int(compression));
                write(path, windows, storage, compression);
                ASSERT_NO_FATAL_FAILURE(expectDisplayWindow(path, windows));
            }
}

TEST(ExrWindows, AnEnvironmentIsItsDisplayWindowToo) {
    const fs::path path = test::scratchDir("exr-windows") / "sky.exr";
    const Windows crop{{{0, 0}, {31, 15}}, {{0, 8}, {31, 15}}}; // a ground, and no sky
    write(path, crop);
    const Result<Image> image = readHdr(path);
    ASSERT_TRUE(image.ok()) << image.message();
    ASSERT_EQ(image->width, 32);
    ASSERT_EQ(image->height, 16);
    EXPECT_EQ(image->at(3, 7)[1], 0.0f);
    EXPECT_EQ(image->at(3, 8)[1], stored(3, 8, 1));
}

/// `content` with the window called `name` replaced. An attribute is its name, its type, a 4-byte size and its value.
std::string withWindow(std::string content, const char* name, const Box2i& window) {
    const size_t value =
        content.find(std::string(name) + '\0' + "box2i") + std::strlen(name) + 1 + 6 + 4;
    const int32_t corners[] = {window.min.x, window.min.y, window.max.x, window.max.y};
    return content.replace(value, sizeof corners, reinterpret_cast<const char*>(corners),
                           sizeof corners);
}

TEST(ExrWindows, WindowsOfHostileSizesAreRefusedWithOneSentence) {
    const fs::path folder = test::scratchDir("exr-windows");
    write(folder / "good.exr", {{{0, 0}, {15, 15}}, {{4, 4}, {11, 11}}});
    const std::string good = readFile(folder / "good.exr").value();
    constexpr int kLeast = std::numeric_limits<int>::min(), kMost = std::numeric_limits<int>::max();
    const Box2i windows[] = {
        {{0, 0}, {kMost, kMost}},         {{kLeast, kLeast}, {kMost, kMost}}, // 2^64 pixels
        {{kLeast, 0}, {kLeast + 15, 15}}, {{0, 0}, {kMost - 1, 0}},           {{15, 15}, {0, 0}},
        {{0, 0}, {99999, 99999}}, // 10^10 pixels
        {{0, 0}, {16383, 16383}}, // 2^28 pixels, but of seven channels: 7 GiB of black
    };
    for (const char* name : {"displayWindow", "dataWindow"})
        for (const Box2i& window : windows) {
            SCOPED_TRACE(::testing::Message()
                         << name << " from " << window.min << " to " << window.max);
            ASSERT_TRUE(
                writeFileAtomically(folder / "bad.exr", withWindow(good, name, window)).ok());
            const Result<ExrFile> file = readExr(folder / "bad.exr");
            ASSERT_FALSE(file.ok());
            EXPECT_THAT(file.message(), ::testing::HasSubstr("bad.exr"));
            EXPECT_THAT(file.message(), ::testing::Not(::testing::HasSubstr("\n")));
        }
    // Far away, but small: nothing of it is shown.
    const Windows far{{{0, 0}, {15, 15}}, {{1000000000, 0}, {1000000007, 7}}};
    const std::string moved = withWindow(good, "dataWindow", far.data);
    ASSERT_TRUE(writeFileAtomically(folder / "far.exr", moved).ok());
    expectDisplayWindow(folder / "far.exr", far);
}

} // namespace
} // namespace tyndall
