// Buffer views and accessors: every read is checked against the bytes that are there.
#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/format.h>
#include <meshoptimizer.h>

#include "core/check.h"
#include "scene/gltf_file.h"

namespace tyndall {
namespace {

constexpr int kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123,
              kUnsignedInt = 5125, kFloat = 5126;
constexpr uint64_t kMaxUnpackedBytes = uint64_t(1) << 31;

/// Is [offset, offset + length) inside size bytes? No sum can overflow.
bool inside(uint64_t offset, uint64_t length, uint64_t size) {
    return offset <= size && length <= size - offset;
}

template <typename T> T load(const char* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return value;
}

template <typename T> float integerToFloat(const char* bytes, bool normalized) {
    const auto value = float(load<T>(bytes));
    if (!normalized) return value;
    return std::max(value / float(std::numeric_limits<T>::max()), -1.0f);
}

float component(const char* bytes, int type, bool normalized) {
    switch (type) {
    case kByte: return integerToFloat<int8_t>(bytes, normalized);
    case kUnsignedByte: return integerToFloat<uint8_t>(bytes, normalized);
    case kShort: return integerToFloat<int16_t>(bytes, normalized);
    case kUnsignedShort: return integerToFloat<uint16_t>(bytes, normalized);
    case kUnsignedInt: return integerToFloat<uint32_t>(bytes, normalized);
    default: return load<float>(bytes);
    }
}

uint32_t unsignedComponent(const char* bytes, int type) {
    if (type == kUnsignedByte) return load<uint8_t>(bytes);
    if (type == kUnsignedShort) return load<uint16_t>(bytes);
    return load<uint32_t>(bytes);
}

/// Columns of matrices begin at multiples of four bytes (glTF 2.0 section 3.6.2.4).
struct Layout {
    size_t columns = 1, rows = 1, componentSize = 1;
    [[nodiscard]] size_t columnBytes() const {
        return columns == 1 ? rows * componentSize : (rows * componentSize + 3) / 4 * 4;
    }
    [[nodiscard]] size_t bytes() const { return columns * columnBytes(); }
};

Layout layoutOf(const gltf::Accessor& accessor) {
    Layout layout;
    layout.componentSize = componentBytes(accessor.componentType);
    if (accessor.type.starts_with("MAT"))
        layout.columns = layout.rows = size_t(accessor.type[3] - '0');
    else
        layout.rows = size_t(componentCount(accessor.type));
    return layout;
}

bool listed(std::string_view list, std::string_view word) {
    for (size_t begin = 0; begin < list.size();) {
        const size_t end = std::min(list.find(' ', begin), list.size());
        if (list.substr(begin, end - begin) == word) return true;
        begin = end + 1;
    }
    return false;
}

/// The parameters that the decoders assert on. Empty when they are right.
std::string wrongMeshopt(const gltf::PackedView& packed) {
    const auto& [buffer, offset, length, stride, count, mode, filter] = packed;
    if (mode == "ATTRIBUTES" && stride % 4 != 0)
        return "needs a byteStride that is a multiple of 4";
    if (mode != "ATTRIBUTES" && stride != 2 && stride != 4) return "needs a byteStride of 2 or 4";
    if (mode == "TRIANGLES" && count % 3 != 0) return "needs a count that is a multiple of 3";
    if (mode != "ATTRIBUTES" && filter != "NONE")
        return "has a filter, which only ATTRIBUTES may have";
    if (filter == "OCTAHEDRAL" && stride != 4 && stride != 8)
        return "needs a byteStride of 4 or 8 for the filter OCTAHEDRAL";
    if (filter == "QUATERNION" && stride != 8)
        return "needs a byteStride of 8 for the filter QUATERNION";
    return {};
}

} // namespace

size_t componentBytes(int componentType) {
    switch (componentType) {
    case kByte:
    case kUnsignedByte: return 1;
    case kShort:
    case kUnsignedShort: return 2;
    case kUnsignedInt:
    case kFloat: return 4;
    default: CHECK(false, "component type " + std::to_string(componentType));
    }
}

int componentCount(std::string_view type) {
    if (type == "SCALAR") return 1;
    if (type.starts_with("VEC")) return type[3] - '0';
    if (type.starts_with("MAT")) return (type[3] - '0') * (type[3] - '0');
    return 0;
}

Result<std::span<const uint8_t>> GltfFile::viewBytes(size_t index) {
    const gltf::BufferView& view = document_.views[index];
    if (view.packed) {
        if (!unpacked_.contains(index))
            if (auto unpacked = unpackMeshopt(index); !unpacked) return unpacked.error();
        return std::span<const uint8_t>(unpacked_.at(index));
    }
    const SharedBytes& buffer = buffers_[view.buffer];
    if (!inside(view.offset, view.length, buffer->size()))
        return at(fmt::format("/bufferViews/{}", index),
                  fmt::format("spans bytes {} to {} of a buffer of {}", view.offset,
                              view.offset + view.length, buffer->size()));
    return std::span<const uint8_t>(reinterpret_cast<const uint8_t*>(buffer->data()) + view.offset,
                                    view.length);
}

Result<void> GltfFile::unpackMeshopt(size_t view) {
    const gltf::PackedView& packed = *document_.views[view].packed;
    const auto& [index, offset, length, stride, count, mode, filter] = packed;
    const std::string pointer =
        fmt::format("/bufferViews/{}/extensions/EXT_meshopt_compression", view);
    const SharedBytes& buffer = buffers_[index];
    if (!inside(offset, length, buffer->size()))
        return at(pointer, fmt::format("spans bytes {} to {} of a buffer of {}", offset,
                                       offset + length, buffer->size()));
    if (const std::string wrong = wrongMeshopt(packed); !wrong.empty()) return at(pointer, wrong);
    if (count * stride > kMaxUnpackedBytes)
        return at(pointer, fmt::format("unpacks to {} bytes, more than is read", count * stride));
    if (auto fits = charge(count * stride / 4, pointer); !fits) return fits;
    std::vector<uint8_t> bytes(count * stride);
    const auto* from = reinterpret_cast<const unsigned char*>(buffer->data()) + offset;
    int failed = 0;
    if (mode == "ATTRIBUTES")
        failed = meshopt_decodeVertexBuffer(bytes.data(), count, stride, from, length);
    else if (mode == "TRIANGLES")
        failed = meshopt_decodeIndexBuffer(bytes.data(), count, stride, from, length);
    else
        failed = meshopt_decodeIndexSequence(bytes.data(), count, stride, from, length);
    if (failed != 0) return at(pointer, "holds data that is damaged");
    if (filter == "OCTAHEDRAL") meshopt_decodeFilterOct(bytes.data(), count, stride);
    if (filter == "QUATERNION") meshopt_decodeFilterQuat(bytes.data(), count, stride);
    if (filter == "EXPONENTIAL") meshopt_decodeFilterExp(bytes.data(), count, stride);
    unpacked_[view] = std::move(bytes);
    return {};
}

/// The accessor's elements, tightly packed, sparse substitution done.
Result<std::string> GltfFile::elementBytes(size_t index) {
    const gltf::Accessor& accessor = document_.accessors[index];
    const std::string pointer = fmt::format("/accessors/{}", index);
    const size_t size = layoutOf(accessor).bytes();
    const uint64_t count = accessor.count, offset = accessor.offset;
    if (auto fits = charge(count * size_t(componentCount(accessor.type)), pointer); !fits)
        return fits.error();
    std::string elements(count * size, '\0');
    if (accessor.view != kNone) {
        const auto bytes = viewBytes(size_t(accessor.view));
        if (!bytes) return bytes.error();
        const gltf::BufferView& view = document_.views[size_t(accessor.view)];
        uint64_t stride = view.packed ? view.packed->stride : view.stride;
        if (stride == 0) stride = size;
        if (stride < size)
            return at(pointer,
                      fmt::format("has elements of {} bytes, but its buffer view a stride of {}",
                                  size, stride));
        // count < 2³² and stride ≤ 256: no overflow.
        if (count > 0 && !inside(offset, (count - 1) * stride + size, bytes->size()))
            return at(pointer,
                      fmt::format("needs {} bytes from byte {} on, but its buffer view has {}",
                                  (count - 1) * stride + size, offset, bytes->size()));
        for (uint64_t i = 0; i < count; ++i)
            std::memcpy(elements.data() + i * size, bytes->data() + offset + i * stride, size);
    }
    if (auto sparse = applySparse(index, elements); !sparse) return sparse.error();
    return elements;
}

Result<void> GltfFile::applySparse(size_t index, std::string& elements) {
    const gltf::Accessor& accessor = document_.accessors[index];
    if (!accessor.sparse) return {};
    const std::string pointer = fmt::format("/accessors/{}/sparse", index);
    const auto& [count, indexView, valueView, indexOffset, valueOffset, indexType] =
        *accessor.sparse;
    const size_t size = layoutOf(accessor).bytes();
    if (count > accessor.count)
        return at(pointer, fmt::format("replaces {} of {} elements", count, accessor.count));
    const auto indexBytes = viewBytes(indexView);
    if (!indexBytes) return indexBytes.error();
    const auto valueBytes = viewBytes(valueView);
    if (!valueBytes) return valueBytes.error();
    const size_t indexSize = componentBytes(indexType);
    if (!inside(indexOffset, count * indexSize, indexBytes->size()) ||
        !inside(valueOffset, count * size, valueBytes->size()))
        return at(pointer, "reaches beyond its buffer views");
    for (uint64_t i = 0; i < count; ++i) {
        const uint32_t target = unsignedComponent(
            reinterpret_cast<const char*>(indexBytes->data()) + indexOffset + i * indexSize,
            indexType);
        if (target >= accessor.count)
            return at(pointer, fmt::format("replaces element {} of {}", target, accessor.count));
        std::memcpy(elements.data() + target * size, valueBytes->data() + valueOffset + i * size,
                    size);
    }
    return {};
}

Result<SharedFloats> GltfFile::floats(size_t index, std::string_view types) {
    const gltf::Accessor& accessor = document_.accessors[index];
    const std::string pointer = fmt::format("/accessors/{}", index);
    if (!listed(types, accessor.type))
        return at(pointer + "/type",
                  fmt::format("is {} but {} is wanted here", accessor.type, types));
    if (const auto found = decoded_.find(index); found != decoded_.end()) return found->second;
    const auto elements = elementBytes(index);
    if (!elements) return elements.error();
    const Layout layout = layoutOf(accessor);
    const size_t count = elements->size() / layout.bytes();
    auto data = std::make_shared<FloatData>();
    data->components = int(layout.columns * layout.rows);
    data->values.reserve(count * size_t(data->components));
    size_t repaired = 0;
    for (size_t i = 0; i < count; ++i)
        for (size_t c = 0; c < layout.columns; ++c)
            for (size_t r = 0; r < layout.rows; ++r) {
                float value = component(elements->data() + i * layout.bytes() +
                                            c * layout.columnBytes() + r * layout.componentSize,
                                        accessor.componentType, accessor.normalized);
                if (!(std::abs(value) <=
                      1e18f)) { // squares of what is kept stay finite in single precision
                    value = 0;
                    ++repaired;
                }
                data->values.push_back(value);
            }
    if (repaired > 0)
        note(fmt::format("{} has {} values that are not finite or beyond 1e18; they are read as 0",
                         pointer, repaired));
    decoded_[index] = data;
    return SharedFloats(data);
}

Result<std::vector<uint32_t>> GltfFile::indices(size_t index) {
    const std::string pointer = fmt::format("/accessors/{}", index);
    const int type = document_.accessors[index].componentType;
    if (document_.accessors[index].type != "SCALAR")
        return at(pointer + "/type", "must be SCALAR for indices");
    if (type != kUnsignedByte && type != kUnsignedShort && type != kUnsignedInt)
        return at(pointer + "/componentType",
                  fmt::format("is {} but indices must be 5121, 5123 or 5125", type));
    const auto elements = elementBytes(index);
    if (!elements) return elements.error();
    const size_t size = componentBytes(type);
    std::vector<uint32_t> values(elements->size() / size);
    for (size_t i = 0; i < values.size(); ++i)
        values[i] = unsignedComponent(elements->data() + i * size, type);
    return values;
}

} // namespace tyndall
