// How the bytes of a glTF file are found: .gltf or .glb, buffers and images beside it, in data URIs or in the file itself.
#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/image.h"
#include "scene/gltf_file.h"
#include "scene/gltf_rules.h"

namespace tyndall {
namespace fs = std::filesystem;
namespace {

constexpr uint32_t kGlbMagic = 0x46546C67, kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;
constexpr size_t kMaxJsonBytes = size_t(1) << 29; // in memory it takes some ten times as much
constexpr uint64_t kMaxLoadedBytes = uint64_t(16) << 30;

uint32_t readWord(std::string_view bytes, size_t offset) {
    uint32_t word = 0;
    for (size_t i = 0; i < 4; ++i)
        word |= uint32_t(static_cast<unsigned char>(bytes[offset + i])) << (8 * i);
    return word;
}

int hexDigit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

/// "%20" as ' '. A '%' without two hexadecimal digits stays: exporters write names as they are.
std::string unescaped(const std::string& uri) {
    std::string text;
    for (size_t i = 0; i < uri.size(); ++i) {
        const bool escape = uri[i] == '%' && i + 2 < uri.size() && hexDigit(uri[i + 1]) >= 0 &&
                            hexDigit(uri[i + 2]) >= 0;
        text += escape ? char(hexDigit(uri[i + 1]) * 16 + hexDigit(uri[i + 2])) : uri[i];
        if (escape) i += 2;
    }
    return text;
}

/// Of an unescaped URI, its dots resolved (RFC 3986, section 5.2.4). Errors: a scheme, an absolute path, a control character.
Result<fs::path> relativePath(std::string text) {
    for (char& c : text) {
        if (static_cast<unsigned char>(c) < 32) return Error{"holds a control character"};
        if (c == '\\') c = '/';
    }
    const size_t colon = text.find(':'), slash = text.find('/');
    if (text.empty()) return Error{"is empty"};
    if (slash == 0 || (colon != std::string::npos && (slash == std::string::npos || colon < slash)))
        return Error{"is not relative, and only data URIs and relative paths are read"};
    return fs::path(text).lexically_normal();
}

} // namespace

Result<GltfFile> GltfFile::open(const fs::path& path, const LoadOptions& options) {
    GltfFile file;
    file.path_ = path;
    file.options_ = &options;
    if (auto goOn = file.progress(0, path.filename().string()); !goOn) return goOn.error();
    const auto bytes = readFile(path);
    if (!bytes) return bytes.error();
    file.loadedBytes_ = bytes->size();
    const auto text = file.openContainer(*bytes);
    if (!text) return Error{path.string() + ": " + text.message()};
    if (auto read = file.readDocument(*text); !read)
        return Error{path.string() + ": " + read.message()};
    if (auto loaded = file.loadBuffers(); !loaded) return loaded.error();
    // Legitimate files hold at least some bytes for each element, but instancing of accessors, strips and packing need room.
    file.allowance_ = std::max<size_t>(size_t(1) << 22, size_t(file.loadedBytes_) * 64);
    file.allowance_ = std::min(file.allowance_, size_t(1) << 30);
    return file;
}

/// The JSON, and keeps a GLB's binary chunk. Errors are without the file's name.
Result<std::string_view> GltfFile::openContainer(std::string_view bytes) {
    if (bytes.size() < 12 || readWord(bytes, 0) != kGlbMagic) return bytes;
    if (readWord(bytes, 4) != 2)
        return Error{fmt::format("GLB version {} is not read, only 2", readWord(bytes, 4))};
    const size_t length = readWord(bytes, 8);
    if (length > bytes.size())
        return Error{fmt::format("the file has {} bytes but its header says {}; it is cut short",
                                 bytes.size(), length)};
    std::optional<std::string_view> text;
    for (size_t offset = 12; offset + 8 <= length;) {
        const size_t size = readWord(bytes, offset);
        const uint32_t type = readWord(bytes, offset + 4);
        offset += 8;
        if (size > length - offset)
            return Error{
                fmt::format("a chunk at byte {} reaches beyond the end of the file", offset - 8)};
        const std::string_view chunk = bytes.substr(offset, size);
        if (!text && type != kJsonChunk) return Error{"the first chunk of a GLB file must be JSON"};
        if (!text)
            text = chunk;
        else if (type == kBinaryChunk && !binaryChunk_)
            binaryChunk_ = std::make_shared<const std::string>(chunk);
        offset += size;
    }
    if (!text) return Error{"the GLB file holds no JSON chunk"};
    while (!text->empty() && (text->back() == ' ' || text->back() == '\0')) text->remove_suffix(1);
    return *text;
}

/// Errors are without the file's name.
Result<void> GltfFile::readDocument(std::string_view text) {
    if (text.starts_with("\xef\xbb\xbf"))
        return Error{"the JSON begins with a byte order mark, which glTF forbids"};
    if (text.size() > kMaxJsonBytes)
        return Error{fmt::format("{} bytes of JSON are more than is read", text.size())};
    auto json = parseJson(text);
    if (!json) return json.error();
    std::vector<std::string> sentences;
    if (auto valid = checkGltfRules(*json, sentences); !valid) return valid;
    if (auto valid = checkGltfExtensions(*json, sentences); !valid) return valid;
    for (const std::string& sentence : sentences) note(sentence);
    auto document = gltf::parse(std::move(*json));
    if (!document) return document.error();
    document_ = std::move(*document);
    return {};
}

Result<void> GltfFile::loadBuffers() {
    for (const gltf::Buffer& buffer : document_.buffers) {
        const std::string pointer = fmt::format("/buffers/{}", buffers_.size());
        if (!buffer.uri) {
            // Only the first one of a GLB is its binary chunk; another without a URI (a fallback of
            // EXT_meshopt_compression) has no bytes, and reading from it is the error.
            buffers_.push_back(buffers_.empty() && binaryChunk_
                                   ? binaryChunk_
                                   : std::make_shared<const std::string>());
            continue;
        }
        auto bytes = uriBytes(*buffer.uri, pointer);
        if (!bytes) return bytes.error();
        if ((*bytes)->size() < buffer.byteLength)
            return at(pointer + "/byteLength", fmt::format("is {}, but there are {} bytes",
                                                           buffer.byteLength, (*bytes)->size()));
        buffers_.push_back(*bytes);
    }
    return {};
}

Result<SharedBytes> GltfFile::uriBytes(const std::string& uri, const std::string& pointer) {
    if (uri.starts_with("data:")) {
        auto bytes = gltf::dataOfUri(uri);
        if (!bytes) return at(pointer + "/uri", bytes.message());
        return std::make_shared<const std::string>(std::move(*bytes));
    }
    if (const auto found = files_.find(uri); found != files_.end()) return found->second;
    const auto relative = relativePath(unescaped(uri));
    if (!relative) return at(pointer + "/uri", relative.message());
    fs::path file = path_.parent_path() / *relative;
    std::error_code problem;
    if (!fs::is_regular_file(file, problem)) // a name that was written without escaping its '%'
        if (const auto literal = relativePath(uri)) file = path_.parent_path() / *literal;
    if (!fs::is_regular_file(file, problem))
        return at(pointer + "/uri",
                  fmt::format("is '{}', but there is no such file", uri.substr(0, 200)));
    if (auto goOn = progress(0.1f, file.filename().string()); !goOn) return goOn.error();
    auto bytes = readFile(file);
    if (!bytes) return at(pointer + "/uri:", bytes.message());
    loadedBytes_ += bytes->size();
    if (loadedBytes_ > kMaxLoadedBytes)
        return at(pointer, "brings the file over 16 GiB, more than is read");
    return files_[uri] = std::make_shared<const std::string>(std::move(*bytes));
}

Result<SharedBytes> GltfFile::imageBytes(size_t index) {
    const gltf::Image& image = document_.images[index];
    const std::string pointer = fmt::format("/images/{}", index);
    if (image.uri) return uriBytes(*image.uri, pointer);
    if (image.view == kNone) return at(pointer, "has neither 'uri' nor 'bufferView'");
    const auto bytes = viewBytes(size_t(image.view));
    if (!bytes) return bytes.error();
    return std::make_shared<const std::string>(reinterpret_cast<const char*>(bytes->data()),
                                               bytes->size());
}

Error GltfFile::at(const std::string& pointer, const std::string& sentence) const {
    return Error{path_.string() + ": " + pointer + " " + sentence};
}

void GltfFile::note(const std::string& sentence) {
    std::string full = path_.filename().string() + ": " + sentence;
    if (std::find(notes.begin(), notes.end(), full) == notes.end())
        notes.push_back(std::move(full));
}

Result<void> GltfFile::progress(float fraction, const std::string& what) const {
    if (options_->progress && !options_->progress(fraction, what)) return Error{"cancelled"};
    return {};
}

Result<void> GltfFile::charge(size_t elements, const std::string& pointer) {
    if (elements > allowance_)
        return at(pointer,
                  fmt::format(
                      "would unpack to {} elements, far more than the file's {} bytes account for",
                      elements, loadedBytes_));
    allowance_ -= elements;
    return {};
}

} // namespace tyndall
