// OpenEXR, scan lines, one part. Files are encoded and decoded in memory: writing stays atomic, and what a hostile
// header promises is compared with what the file can hold before any pixel is allocated.

#include "core/check.h"
#include "core/image.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>

#include <fmt/format.h>

namespace tyndall {
namespace {

constexpr uint64_t kMaxPixels = uint64_t(1) << 28;
/// What the densest codec reaches on a constant picture, with a margin: more than that, and the header lies.
constexpr uint64_t kMaxCompression = 20000; // samples per byte

class MemoryOutput : public Imf::OStream {
public:
    MemoryOutput() : OStream("memory") {}
    void write(const char bytes[], int count) override {
        if (position_ + size_t(count) > content_.size()) content_.resize(position_ + size_t(count));
        std::memcpy(content_.data() + position_, bytes, size_t(count));
        position_ += size_t(count);
    }
    uint64_t tellp() override { return position_; }
    void seekp(uint64_t position) override { position_ = position; }
    [[nodiscard]] const std::string& content() const { return content_; }

private:
    std::string content_;
    size_t position_ = 0;
};

class MemoryInput : public Imf::IStream {
public:
    explicit MemoryInput(std::string_view content) : IStream("memory"), content_(content) {}
    bool read(char bytes[], int count) override {
        if (count < 0 || position_ > content_.size() || size_t(count) > content_.size() - position_)
            throw std::runtime_error("it ends too early");
        std::memcpy(bytes, content_.data() + position_, size_t(count));
        position_ += size_t(count);
        return position_ < content_.size();
    }
    uint64_t tellg() override { return position_; }
    void seekg(uint64_t position) override { position_ = position; }
    void clear() override {}

private:
    std::string_view content_;
    size_t position_ = 0;
};

const char* channelLetter(int channels, int channel) {
    return channels == 1 ? "Y" : &"R\0G\0B\0A"[2 * channel];
}

std::string channelName(const ImageLayer& layer, int channel) {
    const std::string letter = channelLetter(layer.image.channels, channel);
    return layer.name.empty() ? letter : layer.name + "." + letter;
}

std::string encode(std::span<const ImageLayer> layers, const ImageMetadata& metadata,
                   ExrDepth depth) {
    const Image& first = layers.front().image;
    Imf::Header header(first.width, first.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    for (const auto& [key, value] : metadata) header.insert(key, Imf::StringAttribute(value));

    std::vector<std::vector<half>> halves; // Imf does not convert on writing
    Imf::FrameBuffer frame;
    for (const ImageLayer& layer : layers) {
        const Image& image = layer.image;
        const char* base = reinterpret_cast<const char*>(image.pixels.data());
        size_t sampleBytes = sizeof(float);
        const bool isHalf = depth == ExrDepth::Half && !layer.alwaysFloat;
        const Imf::PixelType type = isHalf ? Imf::HALF : Imf::FLOAT;
        if (isHalf) {
            std::vector<half>& converted = halves.emplace_back(image.pixels.size());
            std::transform(image.pixels.begin(), image.pixels.end(), converted.begin(),
                           [](float v) { return half(v); });
            base = reinterpret_cast<const char*>(converted.data());
            sampleBytes = sizeof(half);
        }
        for (int c = 0; c < image.channels; ++c) {
            const std::string name = channelName(layer, c);
            CHECK(!header.channels().findChannel(name), "two layers are called " + name);
            header.channels().insert(name, Imf::Channel(type));
            const size_t pixelBytes = sampleBytes * size_t(image.channels);
            frame.insert(name, Imf::Slice(type, const_cast<char*>(base) + sampleBytes * size_t(c),
                                          pixelBytes, pixelBytes * size_t(image.width)));
        }
    }
    MemoryOutput memory;
    {
        Imf::OutputFile file(memory, header);
        file.setFrameBuffer(frame);
        file.writePixels(first.height);
    } // the destructor writes the table of line offsets
    return memory.content();
}

/// A layer to be filled: which channels of the file, in which order.
struct Plan {
    std::string layer;
    std::vector<std::string> channels;
};

int letterRank(std::string_view letter) {
    const size_t rank = std::string_view("RGBA").find(letter);
    return letter.size() == 1 && rank != std::string_view::npos ? int(rank) : -1;
}

/// R, G, B (and A) of one prefix are one layer; a lone Y too; every other channel is a layer of its own.
std::vector<Plan> planLayers(const Imf::ChannelList& channels) {
    std::map<std::string, std::vector<std::string>> byPrefix;
    for (auto it = channels.begin(); it != channels.end(); ++it) {
        const std::string name = it.name();
        const size_t dot = name.rfind('.');
        byPrefix[dot == std::string::npos ? "" : name.substr(0, dot)].push_back(
            dot == std::string::npos ? name : name.substr(dot + 1));
    }
    std::vector<Plan> plans;
    for (auto& [prefix, letters] : byPrefix) {
        const auto full = [&prefix = prefix](const std::string& letter) {
            return prefix.empty() ? letter : prefix + "." + letter;
        };
        const auto isColor = [](const std::string& letter) { return letterRank(letter) >= 0; };
        std::vector<std::string> color, alone;
        std::partition_copy(letters.begin(), letters.end(), std::back_inserter(color),
                            std::back_inserter(alone), isColor);
        std::sort(color.begin(), color.end(),
                  [](const auto& a, const auto& b) { return letterRank(a) < letterRank(b); });
        const bool isRgb =
            color.size() >= 3 && color[0] == "R" && color[1] == "G" && color[2] == "B";
        if (isRgb) {
            Plan& plan = plans.emplace_back(Plan{prefix, {}});
            for (const std::string& letter : color) plan.channels.push_back(full(letter));
        } else {
            alone.insert(alone.end(), color.begin(), color.end());
        }
        for (const std::string& letter : alone)
            plans.push_back({!isRgb && letter == "Y" ? prefix : full(letter), {full(letter)}});
    }
    return plans; // "" sorts first: the main layer leads
}

/// Pixels of a window, both ends inclusive. In 64 bits: the corners are any 32-bit numbers.
struct Extent {
    int64_t width, height;
    explicit Extent(const Imath::Box2i& window)
        : width(int64_t(window.max.x) - window.min.x + 1),
          height(int64_t(window.max.y) - window.min.y + 1) {}
    [[nodiscard]] bool sensible() const {
        return width > 0 && height > 0 && uint64_t(width) <= kMaxPixels / uint64_t(height);
    }
    [[nodiscard]] uint64_t pixels() const { return uint64_t(width) * uint64_t(height); }
};

Result<void> checkSize(const std::filesystem::path& path, const Imf::Header& header,
                       size_t fileBytes, size_t channelCount) {
    const Extent data(header.dataWindow()), display(header.displayWindow());
    for (const Extent& extent : {data, display})
        if (!extent.sensible())
            return Error{
                fmt::format("'{}' is {}x{} pixels: an image has at least one and at most {} pixels",
                            path.string(), extent.width, extent.height, kMaxPixels)};
    const uint64_t stored = data.pixels() * channelCount, shown = display.pixels() * channelCount;
    if (stored > kMaxPixels * 16 || stored / kMaxCompression > fileBytes)
        return Error{fmt::format(
            "'{}' promises {}x{} pixels in {} channels, which its {} bytes cannot hold: it is damaged",
            path.string(), data.width, data.height, channelCount, fileBytes)};
    // Black pixels around a crop cost the file nothing, and this process four bytes each.
    if (shown > kMaxPixels && shown > stored)
        return Error{fmt::format(
            "'{}' has a display window of {}x{} pixels in {} channels around {}x{} that it stores: "
            "at most {} values are made black; crop its display window",
            path.string(), display.width, display.height, channelCount, data.width, data.height,
            kMaxPixels)};
    return {};
}

/// One row of a layer as the file has it: as wide as the data window.
struct StoredRow {
    std::vector<float> values;
    Image* picture;
};

/// Fills the pictures, which are black and as large as the display window, with what the file has for them. Row by row:
/// what lies outside the display window then takes no more memory than a row of it.
void readInto(Imf::InputFile& file, std::span<const Plan> plans, std::span<ImageLayer> layers) {
    const Imath::Box2i data = file.header().dataWindow(), display = file.header().displayWindow();
    const int left = std::max(data.min.x, display.min.x),
              right = std::min(data.max.x, display.max.x),
              top = std::max(data.min.y, display.min.y),
              bottom = std::min(data.max.y, display.max.y);
    if (left > right || top > bottom) return;

    std::vector<StoredRow> rows;
    Imf::FrameBuffer frame;
    for (size_t i = 0; i < plans.size(); ++i) {
        const size_t channels = plans[i].channels.size(), pixelBytes = sizeof(float) * channels;
        StoredRow& row = rows.emplace_back(
            StoredRow{std::vector<float>(size_t(Extent(data).width) * channels), &layers[i].image});
        for (size_t c = 0; c < channels; ++c) {
            // Where the pixel of x = 0 would be; every row has the same place.
            const auto first = reinterpret_cast<intptr_t>(row.values.data() + c);
            char* origin =
                reinterpret_cast<char*>(first - intptr_t(data.min.x) * intptr_t(pixelBytes));
            frame.insert(plans[i].channels[c], Imf::Slice(Imf::FLOAT, origin, pixelBytes, 0));
        }
    }
    file.setFrameBuffer(frame);
    for (int y = top; y <= bottom; ++y) {
        file.readPixels(y);
        for (const StoredRow& row : rows) {
            const auto channels = size_t(row.picture->channels);
            std::copy_n(row.values.data() + size_t(left - data.min.x) * channels,
                        size_t(right - left + 1) * channels,
                        row.picture->at(left - display.min.x, y - display.min.y));
        }
    }
}

Result<ExrFile> decode(const std::filesystem::path& path, std::string_view content) {
    MemoryInput memory(content);
    Imf::InputFile file(memory);
    const Imf::Header& header = file.header();
    size_t channelCount = 0;
    for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
        ++channelCount;
        if (it.channel().xSampling != 1 || it.channel().ySampling != 1)
            return Error{fmt::format(
                "'{}' stores channel '{}' at a lower resolution: only full-resolution channels are read",
                path.string(), it.name())};
    }
    if (channelCount == 0) return Error{fmt::format("'{}' has no channels", path.string())};
    if (Result<void> size = checkSize(path, header, content.size(), channelCount); !size.ok())
        return size.error();

    ExrFile result;
    const Extent picture(header.displayWindow());
    const std::vector<Plan> plans = planLayers(header.channels());
    for (const Plan& plan : plans)
        result.layers.push_back({plan.layer, Image(int(picture.width), int(picture.height),
                                                   int(plan.channels.size()))});
    readInto(file, plans, result.layers);
    for (auto it = header.begin(); it != header.end(); ++it)
        if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&it.attribute()))
            result.metadata[it.name()] = text->value();
    return result;
}

} // namespace

Result<void> writeExr(const std::filesystem::path& path, std::span<const ImageLayer> layers,
                      const ImageMetadata& metadata, ExrDepth depth) {
    CHECK(!layers.empty(), "an EXR has at least one layer");
    const Image& first = layers.front().image;
    for (const ImageLayer& layer : layers) {
        CHECK(layer.image.width == first.width && layer.image.height == first.height,
              "all layers have one size: " + layer.name);
        CHECK(layer.image.channels == 1 || layer.image.channels == 3 || layer.image.channels == 4,
              "1, 3 or 4 channels: " + layer.name);
        CHECK(layer.image.pixels.size() ==
                  size_t(first.width) * size_t(first.height) * size_t(layer.image.channels),
              layer.name);
    }
    std::string encoded;
    try {
        encoded = encode(layers, metadata, depth);
    } catch (const std::exception& failure) {
        return Error{fmt::format("cannot write '{}': {}", path.string(), failure.what())};
    }
    return writeFileAtomically(path, encoded);
}

Result<ExrFile> readExr(const std::filesystem::path& path) {
    const Result<std::string> content = readFile(path);
    if (!content.ok()) return content.error();
    Imf::Header::setMaxImageSize(1 << 20, 1 << 20); // refused before the library allocates a line
    Imf::Header::setMaxTileSize(1 << 14, 1 << 14);
    try {
        return decode(path, *content);
    } catch (const std::exception& failure) {
        std::string reason = failure.what();
        std::replace(reason.begin(), reason.end(), '\n', ' ');
        return Error{fmt::format("'{}' is not a readable OpenEXR file: {}", path.string(), reason)};
    }
}

} // namespace tyndall
