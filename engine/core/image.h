#pragma once
// A linear image in memory and its files. Rows run from the top; channels are named as in OpenEXR.

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

namespace tyndall {

/// ".exr" of "PICTURE.EXR"; "" where there is none.
std::string lowerExtension(const std::filesystem::path& path);

/// width × height × channels floats, interleaved, top row first. No unit is implied.
struct Image {
    int width = 0;
    int height = 0;
    int channels = 0;
    std::vector<float> pixels;

    Image() = default;
    Image(int columns, int rows, int channelCount)
        : width(columns), height(rows), channels(channelCount),
          pixels(size_t(columns) * size_t(rows) * size_t(channelCount), 0.0f) {}

    [[nodiscard]] float* at(int x, int y) {
        return pixels.data() + (size_t(y) * size_t(width) + size_t(x)) * size_t(channels);
    }
    [[nodiscard]] const float* at(int x, int y) const { return const_cast<Image*>(this)->at(x, y); }
};

/// A layer of an EXR: `beauty`, a transport term, `depth` … with 1 (Y), 3 (R G B) or 4 (R G B A) channels.
struct ImageLayer {
    std::string name; // "" is the main layer (channels R, G, B); others are NAME.R …
    Image image;
    bool alwaysFloat = false; // 32 bits even in a file of 16-bit floats: for what is very small or very large
};

using ImageMetadata = std::map<std::string, std::string>;

enum class ExrDepth { Half = 0, Float = 1 };

/// Writes to a temporary name beside `path` and renames, so that a failure leaves the last good file.
/// All layers must have one size. Errors: unwritable path, full disk.
Result<void> writeExr(const std::filesystem::path& path, std::span<const ImageLayer> layers,
                      const ImageMetadata& metadata = {}, ExrDepth depth = ExrDepth::Float);

struct ExrFile {
    std::vector<ImageLayer> layers; // main layer first, if there is one
    ImageMetadata metadata;
};
/// Reads every layer as float. The picture is the file's display window: 0 where the data window does not reach, and without
/// what lies outside (OpenEXR, Technical Introduction). Errors: missing or damaged file, absurd size (a window over 2^28 pixels).
Result<ExrFile> readExr(const std::filesystem::path& path);

/// 8-bit PNG from display-referred RGB or RGBA bytes, top row first. Atomic as writeExr.
Result<void> writePng(const std::filesystem::path& path, int width, int height, int channels,
                      std::span<const uint8_t> bytes);
/// The colours of a PNG as its values over the largest (8 or 16 bits): RGB in [0,1], encoded as they are in the file.
/// Grey becomes RGB, transparency is left out. Errors: missing or damaged file, absurd size (over 2^28 pixels).
Result<Image> readPng(const std::filesystem::path& path);
/// An HDR latitude-longitude image (.hdr or .exr) as linear RGB.
Result<Image> readHdr(const std::filesystem::path& path);

/// `path` made atomically: `write` fills a temporary file beside it, which then takes its name.
Result<void> writeFileAtomically(const std::filesystem::path& path, std::string_view content);
/// The whole file. Errors: missing, unreadable, a folder, over `maxBytes`.
Result<std::string> readFile(const std::filesystem::path& path, size_t maxBytes = size_t(1) << 31);

} // namespace tyndall
