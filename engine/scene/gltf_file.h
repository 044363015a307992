#pragma once
// A glTF file opened and checked: its document, whose types, ranges and references are known to be right, and its bytes
// behind functions that cannot read outside them. Private to the folder.
//
// The container is taken apart here and not by tinygltf, since the rules (gltf_rules.h) judge the JSON in it before tinygltf
// may see any. Buffers are read here, so that every file goes through readFile and is kept once.

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "scene/gltf_document.h"
#include "scene/scene_file.h"

namespace tyndall {

/// Bytes that several buffers may share.
using SharedBytes = std::shared_ptr<const std::string>;

/// An accessor's elements as floats, normalised integers converted as glTF 2.0 section 3.11 says.
struct FloatData {
    int components = 0; // 1 to 4, or 16
    std::vector<float> values;
    [[nodiscard]] size_t count() const { return values.size() / size_t(components); }
    [[nodiscard]] const float* at(size_t i) const { return values.data() + i * size_t(components); }
};
using SharedFloats = std::shared_ptr<const FloatData>;

class GltfFile {
public:
    /// Reads, parses, checks, and loads the buffers. Errors name the file.
    static Result<GltfFile> open(const std::filesystem::path& path, const LoadOptions& options);

    [[nodiscard]] const gltf::Document& document() const { return document_; }
    [[nodiscard]] Error at(const std::string& pointer, const std::string& sentence) const;
    /// "FILE: sentence", once however often it is said.
    void note(const std::string& sentence);
    Result<void> progress(float fraction, const std::string& what) const;

    /// The bytes of a buffer view, unpacked if it is EXT_meshopt_compression. Valid as long as this object.
    Result<std::span<const uint8_t>> viewBytes(size_t view);
    /// Decodes an accessor (sparse ones too); kept while `uses` of it remain, see countUse.
    /// `types`: the allowed ones, "VEC3" or "VEC3 VEC4". Non-finite values become 0 with a note.
    Result<SharedFloats> floats(size_t accessor, std::string_view types);
    /// Unsigned integers of a scalar accessor.
    Result<std::vector<uint32_t>> indices(size_t accessor);

    /// The bytes of an image: from a buffer view, a data URI or a file beside this one.
    Result<SharedBytes> imageBytes(size_t image);

    /// Every element that is unpacked is charged to an allowance that grows with the file's size, so that a small file
    /// cannot ask for an absurd amount of memory. Error: it is used up.
    Result<void> charge(size_t elements, const std::string& pointer);

    std::vector<std::string> notes;

private:
    Result<std::string_view> openContainer(std::string_view bytes);
    Result<void> readDocument(std::string_view text);
    Result<void> loadBuffers();
    Result<SharedBytes> uriBytes(const std::string& uri, const std::string& pointer);
    Result<void> unpackMeshopt(size_t view);
    Result<std::string> elementBytes(size_t accessor);
    Result<void> applySparse(size_t accessor, std::string& elements);

    std::filesystem::path path_;
    const LoadOptions* options_ = nullptr;
    gltf::Document document_;
    SharedBytes binaryChunk_;
    std::vector<SharedBytes> buffers_;
    std::map<std::string, SharedBytes> files_;        // by URI
    std::map<size_t, std::vector<uint8_t>> unpacked_; // EXT_meshopt_compression, by view
    std::map<size_t, SharedFloats> decoded_;
    size_t allowance_ = 0;
    uint64_t loadedBytes_ = 0;
};

/// One accessor component type.
size_t componentBytes(int componentType);
/// "VEC3" → 3; 0 for what is unknown.
int componentCount(std::string_view type);

} // namespace tyndall
