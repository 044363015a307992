// How the bytes of a glTF file are found: .gltf or .glb, buffers and images beside it, in data URIs or in the file itself.
#include <algorithm>
#include <array>
#include <cstring>

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

/// A relative path out of a URI. Errors: a scheme, an absolute path, a bad escape, a control character.
Result<std::string> pathOfUri(const std::string& uri) {
    std::string path;
    for (size_t i = 0; i < uri.size(); ++i) {
        char c = uri[i];
        if (c == '%') {
            if (i + 2 >= uri.size() || hexDigit(uri[i + 1]) < 0 || hexDigit(uri[i + 2]) < 0)
                return Error{"holds a '%' without two hexadecimal digits"};
            c = char(hexDigit(uri[i + 1]) * 16 + hexDigit(uri[i + 2]));
            i += 2;
        }
        if (static_cast<unsigned char>(c) < 32) return Error{"holds a control character"};
        path += c == '\\' ? '/' : c;
    }
    const size_t colon = path.find(':'), slash = path.find('/');
    if (path.empty()) return Error{"is empty"};
    if (slash == 0 || (colon != std::string::npos && (slash == std::string::npos || colon < slash)))
        return Error{"is not relative, and only data URIs and relative paths are read"};
    return path;
}

std::array<int8_t, 256> base64Table() {
    std::array<int8_t, 256> table;
    table.fill(-1);
    constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < kDigits.size(); ++i)
        table[static_cast<unsigned char>(kDigits[i])] = int8_t(i);
    return table;
}

/// The payload of "data:…;base64,…". Errors: another encoding, a character that is not base64.
Result<std::string> dataOfUri(std::string_view uri) {
    static const std::array<int8_t, 256> table = base64Table();
    const size_t comma = uri.find(',');
    if (comma == std::string_view::npos || !uri.substr(0, comma).ends_with(";base64"))
        return Error{"is a data URI that is not base64"};
    std::string_view text = uri.substr(comma + 1);
    while (text.ends_with('=')) text.remove_suffix(1);
    std::string bytes;
    bytes.reserve(text.size() / 4 * 3 + 3);
    uint32_t bits = 0;
    int count = 0;
    for (const char c : text) {
        const int8_t digit = table[static_cast<unsigned char>(c)];
        if (digit < 0) return Error{"is a data URI with a character that is not base64"};
        bits = (bits << 6) | uint32_t(digit);
        if ((count += 6) >= 8) bytes += char((bits >> (count -= 8)) & 255);
    }
    return bytes;
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
    if (auto opened = file.openContainer(*bytes); !opened) return opened.error();
    std::vector<std::string> notes;
    if (auto valid = checkGltfRules(file.json()); !valid)
        return Error{path.string() + ": " + valid.message()};
    if (auto valid = checkGltfExtensions(file.json(), notes); !valid)
        return Error{path.string() + ": " + valid.message()};
    for (const std::string& note : notes) file.note(note);
    if (auto loaded = file.loadBuffers(); !loaded) return loaded.error();
    // Legitimate files hold at least some bytes for each element, but instancing of accessors, strips and packing need room.
    file.allowance_ = std::max<size_t>(size_t(1) << 22, size_t(file.loadedBytes_) * 64);
    file.allowance_ = std::min(file.allowance_, size_t(1) << 30);
    return file;
}

Result<void> GltfFile::openContainer(std::string_view bytes) {
    std::string_view text = bytes;
    if (bytes.size() >= 12 && readWord(bytes, 0) == kGlbMagic) {
        if (readWord(bytes, 4) != 2)
            return Error{fmt::format("{}: GLB version {} is not read, only 2", path_.string(),
                                     readWord(bytes, 4))};
        const size_t length = readWord(bytes, 8);
        if (length > bytes.size())
            return Error{
                fmt::format("{}: the file has {} bytes but its header says {}; it is cut short",
                            path_.string(), bytes.size(), length)};
        bool haveJson = false;
        for (size_t offset = 12; offset + 8 <= length;) {
            const size_t size = readWord(bytes, offset);
            const uint32_t type = readWord(bytes, offset + 4);
            offset += 8;
            if (size > length - offset)
                return Error{
                    fmt::format("{}: a chunk at byte {} reaches beyond the end of the file",
                                path_.string(), offset - 8)};
            const std::string_view chunk = bytes.substr(offset, size);
            if (!haveJson && type != kJsonChunk)
                return Error{path_.string() + ": the first chunk of a GLB file must be JSON"};
            if (!haveJson)
                text = chunk;
            else if (type == kBinaryChunk && !binaryChunk_)
                binaryChunk_ = std::make_shared<const std::string>(chunk);
            haveJson = true;
            offset += size;
        }
        if (!haveJson) return Error{path_.string() + ": the GLB file holds no JSON chunk"};
        while (!text.empty() && (text.back() == ' ' || text.back() == '\0')) text.remove_suffix(1);
    }
    if (text.starts_with("\xef\xbb\xbf"))
        return Error{path_.string() +
                     ": the JSON begins with a byte order mark, which glTF forbids"};
    if (text.size() > kMaxJsonBytes)
        return Error{
            fmt::format("{}: {} bytes of JSON are more than is read", path_.string(), text.size())};
    auto json = parseJson(text);
    if (!json) return Error{path_.string() + ": " + json.message()};
    json_ = std::make_shared<Json>(std::move(*json));
    return {};
}

Result<void> GltfFile::loadBuffers() {
    const Json& buffers = array("buffers");
    for (size_t i = 0; i < buffers.size(); ++i) {
        const std::string pointer = fmt::format("/buffers/{}", i);
        const uint64_t length = buffers[i].at("byteLength").get<uint64_t>();
        const auto uri = buffers[i].find("uri");
        if (uri == buffers[i].end()) {
            // Only the first one of a GLB is its binary chunk; another without a URI (a fallback of
            // EXT_meshopt_compression) has no bytes, and reading from it is the error.
            buffers_.push_back(i == 0 && binaryChunk_ ? binaryChunk_
                                                      : std::make_shared<const std::string>());
            continue;
        }
        auto bytes = uriBytes(uri->get_ref<const std::string&>(), pointer);
        if (!bytes) return bytes.error();
        if ((*bytes)->size() < length)
            return at(pointer + "/byteLength",
                      fmt::format("is {}, but there are {} bytes", length, (*bytes)->size()));
        buffers_.push_back(*bytes);
    }
    return {};
}

Result<SharedBytes> GltfFile::uriBytes(const std::string& uri, const std::string& pointer) {
    if (uri.starts_with("data:")) {
        auto bytes = dataOfUri(uri);
        if (!bytes) return at(pointer + "/uri", bytes.message());
        return std::make_shared<const std::string>(std::move(*bytes));
    }
    if (const auto found = files_.find(uri); found != files_.end()) return found->second;
    const auto relative = pathOfUri(uri);
    if (!relative) return at(pointer + "/uri", relative.message());
    const fs::path file = path_.parent_path() / *relative;
    std::error_code problem;
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

Result<SharedBytes> GltfFile::imageBytes(size_t image) {
    const Json& json = array("images")[image];
    const std::string pointer = fmt::format("/images/{}", image);
    if (const auto uri = json.find("uri"); uri != json.end())
        return uriBytes(uri->get_ref<const std::string&>(), pointer);
    const auto view = json.find("bufferView");
    if (view == json.end()) return at(pointer, "has neither 'uri' nor 'bufferView'");
    const auto bytes = viewBytes(view->get<size_t>());
    if (!bytes) return bytes.error();
    return std::make_shared<const std::string>(reinterpret_cast<const char*>(bytes->data()),
                                               bytes->size());
}

const Json& GltfFile::array(std::string_view name) const {
    static const Json none = Json::array();
    const auto found = json_->find(std::string(name));
    return found == json_->end() ? none : *found;
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
