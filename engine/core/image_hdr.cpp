// Radiance RGBE pictures ("Real Pixels", Ward, Graphics Gems II, 1991; the file format of the Radiance reference manual),
// decoded strictly: a file that ends early or runs over a scan line is refused, not padded with black. (stb_image pads it,
// takes the repeats of files from before 1991 for dark pixels, and does not know EXPOSURE.)

#include "core/image.h"

#include <array>
#include <cctype>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "core/log.h"

namespace tyndall {
namespace {

constexpr int64_t kMaxSide = 1 << 16;
constexpr float kLargestHalf = 65504.0f;

using Rgbe = std::array<uint8_t, 4>;

/// Walks through the file; every read says whether there was something to read.
class Cursor {
public:
    explicit Cursor(std::string_view content) : rest_(content) {}
    [[nodiscard]] size_t left() const { return rest_.size(); }
    bool line(std::string_view& text) {
        const size_t end = rest_.find('\n');
        if (end == std::string_view::npos) return false;
        text = rest_.substr(0, end);
        rest_.remove_prefix(end + 1);
        return true;
    }
    bool bytes(uint8_t* out, size_t count) {
        if (rest_.size() < count) return false;
        std::copy_n(rest_.begin(), count, out);
        rest_.remove_prefix(count);
        return true;
    }
    [[nodiscard]] bool startsNewRunLength(int width) const {
        const auto at = [&](size_t i) { return int(uint8_t(rest_[i])); };
        return rest_.size() >= 4 && at(0) == 2 && at(1) == 2 && at(2) * 256 + at(3) == width;
    }
    void skip(size_t count) { rest_.remove_prefix(count); }

private:
    std::string_view rest_;
};

struct Header {
    int width = 0, height = 0;
    float exposure = 1; // already multiplied into the pixels, to be divided out
};

bool parseResolution(std::string_view text, Header& header) {
    // The one orientation in use for environment maps: rows from the top, columns from the left.
    if (!text.starts_with("-Y ")) return false;
    const size_t middle = text.find(" +X ");
    if (middle == std::string_view::npos) return false;
    const auto number = [](std::string_view digits, int& out) {
        const auto [end, error] =
            std::from_chars(digits.data(), digits.data() + digits.size(), out);
        return error == std::errc() && end != digits.data() &&
               (end == digits.data() + digits.size() || *end == '\r');
    };
    return number(text.substr(3, middle - 3), header.height) &&
           number(text.substr(middle + 4), header.width);
}

/// Empty, or what is wrong with the header.
std::string readHeader(Cursor& cursor, Header& header) {
    std::string_view text;
    if (!cursor.line(text) || !(text.starts_with("#?RADIANCE") || text.starts_with("#?RGBE")))
        return "it does not begin with '#?RADIANCE'";
    bool formatSeen = false;
    for (;;) {
        if (!cursor.line(text)) return "its header does not end";
        if (text.empty() || text == "\r") break;
        if (text.starts_with("FORMAT=")) {
            if (!text.starts_with("FORMAT=32-bit_rle_rgbe"))
                return fmt::format("its pixels are '{}', not 32-bit_rle_rgbe", text.substr(7));
            formatSeen = true;
        } else if (text.starts_with("EXPOSURE=")) {
            float factor = 1;
            const std::string_view digits = text.substr(text.find_first_not_of(' ', 9));
            std::from_chars(digits.data(), digits.data() + digits.size(), factor);
            if (std::isfinite(factor) && factor > 0) header.exposure *= factor;
        }
    }
    if (!formatSeen) return "its header names no FORMAT";
    if (!cursor.line(text) || !parseResolution(text, header))
        return "its resolution is not of the form '-Y HEIGHT +X WIDTH'";
    if (header.width < 1 || header.height < 1 || header.width > kMaxSide ||
        header.height > kMaxSide)
        return fmt::format("it is {}x{} pixels: each side is 1 to {}", header.width, header.height,
                           kMaxSide);
    return {};
}

/// Since 1991: four planes, each in runs (count > 128) and literals.
bool readPlanes(Cursor& cursor, std::vector<Rgbe>& line) {
    cursor.skip(4);
    for (size_t plane = 0; plane < 4; ++plane) {
        for (size_t x = 0; x < line.size();) {
            uint8_t count = 0, value = 0;
            if (!cursor.bytes(&count, 1)) return false;
            const bool run = count > 128;
            const size_t length = run ? count - 128u : count;
            if (length == 0 || length > line.size() - x) return false;
            if (run && !cursor.bytes(&value, 1)) return false;
            for (size_t i = 0; i < length; ++i) {
                if (!run && !cursor.bytes(&value, 1)) return false;
                line[x++][plane] = value;
            }
        }
    }
    return true;
}

/// Before: pixels one after the other, where (1,1,1,n) repeats the one before, each further one 256 times as often.
bool readPixels(Cursor& cursor, std::vector<Rgbe>& line) {
    unsigned shift = 0;
    for (size_t x = 0; x < line.size();) {
        Rgbe pixel;
        if (!cursor.bytes(pixel.data(), 4)) return false;
        if (pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1) {
            if (x == 0 || shift > 16) return false;
            const size_t repeat = size_t(pixel[3]) << shift;
            if (repeat > line.size() - x) return false;
            std::fill_n(line.begin() + std::ptrdiff_t(x), repeat, line[x - 1]);
            x += repeat;
            shift += 8;
        } else {
            line[x++] = pixel;
            shift = 0;
        }
    }
    return true;
}

void toFloat(const std::vector<Rgbe>& line, float scale, float* out) {
    for (const Rgbe& pixel : line) {
        const float unit = pixel[3] ? std::ldexp(scale, int(pixel[3]) - 136) : 0.0f;
        for (size_t c = 0; c < 3; ++c) *out++ = float(pixel[c]) * unit;
    }
}

Result<Image> readRadiance(const std::filesystem::path& path) {
    const Result<std::string> content = readFile(path);
    if (!content.ok()) return content.error();
    Cursor cursor(*content);
    Header header;
    if (const std::string wrong = readHeader(cursor, header); !wrong.empty())
        return Error{
            fmt::format("'{}' is not a readable Radiance picture: {}", path.string(), wrong)};
    // A scan line takes at least 4·(2 bytes per 127 pixels): a promise beyond that is not worth its memory.
    if (size_t(header.width) * size_t(header.height) / 128 > cursor.left())
        return Error{
            fmt::format("'{}' promises {}x{} pixels, which its {} bytes cannot hold: it is damaged",
                        path.string(), header.width, header.height, content->size())};
    Image image(header.width, header.height, 3);
    std::vector<Rgbe> line(size_t(header.width));
    for (int y = 0; y < header.height; ++y) {
        const bool whole = cursor.startsNewRunLength(header.width) ? readPlanes(cursor, line)
                                                                   : readPixels(cursor, line);
        if (!whole)
            return Error{fmt::format("'{}' is damaged or cut off at row {} of {}", path.string(), y,
                                     header.height)};
        toFloat(line, 1.0f / header.exposure, image.at(0, y));
    }
    return image;
}

Result<Image> mainLayerAsRgb(const std::filesystem::path& path) {
    Result<ExrFile> file = readExr(path);
    if (!file.ok()) return file.error();
    for (const ImageLayer& layer : file->layers) {
        const Image& from = layer.image;
        if (!layer.name.empty() || (from.channels != 1 && from.channels < 3)) continue;
        Image rgb(from.width, from.height, 3);
        for (size_t i = 0; i < size_t(from.width) * size_t(from.height); ++i)
            for (size_t c = 0; c < 3; ++c)
                rgb.pixels[i * 3 + c] =
                    from.pixels[i * size_t(from.channels) + (from.channels == 1 ? 0 : c)];
        return rgb;
    }
    return Error{
        fmt::format("'{}' has no main layer with the channels R, G, B or Y", path.string())};
}

/// Light is finite and not negative. A sun that overflowed while the map was made becomes as bright as half floats go.
void sanitise(Image& image, const std::filesystem::path& path) {
    size_t mended = 0;
    for (float& value : image.pixels) {
        if (value >= 0 && std::isfinite(value)) continue;
        value = value > 0 ? kLargestHalf : 0.0f;
        ++mended;
    }
    if (mended)
        log::warning(
            fmt::format("'{}': {} values were negative or not finite; they were set to 0 or {}",
                        path.string(), mended, kLargestHalf));
}

} // namespace

Result<Image> readHdr(const std::filesystem::path& path) {
    const std::string extension = lowerExtension(path);
    if (extension != ".hdr" && extension != ".exr")
        return Error{fmt::format(
            "'{}' is not an environment image: its name must end in .hdr or .exr", path.string())};
    Result<Image> image = extension == ".hdr" ? readRadiance(path) : mainLayerAsRgb(path);
    if (image.ok()) sanitise(*image, path);
    return image;
}

} // namespace tyndall
