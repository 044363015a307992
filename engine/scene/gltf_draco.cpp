// KHR_draco_mesh_compression.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>

#include <draco/compression/decode.h>
#include <fmt/format.h>

#include "scene/gltf_model.h"

namespace tyndall {
namespace {

/// What the accessor says about a normalised attribute: Draco's own flag may be missing.
float scaleOf(const gltf::Accessor& accessor, const draco::PointAttribute& attribute) {
    if (!accessor.normalized || attribute.normalized()) return 1;
    switch (accessor.componentType) {
    case 5120: return 1.0f / 127;
    case 5121: return 1.0f / 255;
    case 5122: return 1.0f / 32767;
    case 5123: return 1.0f / 65535;
    default: return 1;
    }
}

SharedFloats readAttribute(const draco::Mesh& mesh, const draco::PointAttribute& attribute,
                           const gltf::Accessor& accessor) {
    auto data = std::make_shared<FloatData>();
    data->components = componentCount(accessor.type);
    data->values.resize(size_t(mesh.num_points()) * size_t(data->components));
    const float scale = scaleOf(accessor, attribute);
    for (uint32_t i = 0; i < mesh.num_points(); ++i) {
        float values[16] = {};
        const draco::AttributeValueIndex place = attribute.mapped_index(draco::PointIndex(i));
        if (place.value() < attribute.size())
            attribute.ConvertValue<float>(place, int8_t(data->components), values);
        for (int c = 0; c < data->components; ++c) {
            const float value = values[c] * scale;
            data->values[size_t(i) * size_t(data->components) + size_t(c)] =
                std::abs(value) <= 1e18f ? value : 0;
        }
    }
    return data;
}

/// LEB128, as Draco writes sizes; false at the end of the bytes.
bool readVarint(std::span<const uint8_t> bytes, size_t& offset, uint64_t& value) {
    value = 0;
    for (int shift = 0; shift < 64 && offset < bytes.size(); shift += 7) {
        const uint8_t byte = bytes[offset++];
        value |= uint64_t(byte & 127) << shift;
        if (byte < 128) return true;
    }
    return false;
}

/// The decoder believes the numbers of faces and points at the head of the stream and takes memory for them at once, so
/// they are judged here first. Empty, or what is wrong.
std::string wrongHeader(std::span<const uint8_t> bytes) {
    constexpr size_t kHeader = 11; // "DRACO", version, encoder type, method, flags
    constexpr uint64_t kSmall = uint64_t(1) << 16, kElementsPerByte = 128,
                       kMost = uint64_t(1) << 25;
    if (bytes.size() < kHeader || std::memcmp(bytes.data(), "DRACO", 5) != 0)
        return "holds data that is not Draco's";
    const int version = bytes[5] * 256 + bytes[6];
    if (version < 0x0202)
        return fmt::format("holds data of Draco version {}.{}, but 2.2 is the first that glTF has",
                           bytes[5], bytes[6]);
    if (bytes[7] != 1) return "holds Draco data that is not a mesh";
    if (bytes[10] & 0x80) return "holds Draco data with metadata, which glTF does not use";
    size_t offset = kHeader;
    if (bytes[8] == 1) ++offset; // edgebreaker: the kind of traversal
    for (int i = 0; i < 2; ++i) {
        uint64_t count = 0;
        if (!readVarint(bytes, offset, count)) return "holds Draco data that is cut short";
        if (count > std::min(kMost, std::max(kSmall, kElementsPerByte * bytes.size())))
            return fmt::format("claims {} elements in {} bytes of Draco data, which cannot be",
                               count, bytes.size());
    }
    return {};
}

} // namespace

Result<void> decodeDraco(GltfFile& file, const gltf::Primitive& primitive,
                         const std::string& pointer, PrimitiveSource& source) {
    const std::string here = pointer + "/extensions/KHR_draco_mesh_compression";
    const auto bytes = file.viewBytes(primitive.draco->view);
    if (!bytes) return bytes.error();
    if (const std::string wrong = wrongHeader(*bytes); !wrong.empty()) return file.at(here, wrong);
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok())
        return file.at(here, fmt::format("holds data that Draco cannot decode: {}",
                                         decoded.status().error_msg_string()));
    const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();
    if (auto fits = file.charge(size_t(mesh->num_points()) + 3 * size_t(mesh->num_faces()), here);
        !fits)
        return fits;

    source.indexed = true;
    source.indices.reserve(3 * size_t(mesh->num_faces()));
    for (uint32_t f = 0; f < mesh->num_faces(); ++f)
        for (const draco::PointIndex& point : mesh->face(draco::FaceIndex(f)))
            source.indices.push_back(point.value());

    for (const auto& [name, id] : primitive.draco->attributes) {
        const draco::PointAttribute* attribute = mesh->GetAttributeByUniqueId(uint32_t(id));
        const auto accessor = primitive.attributes.find(name);
        if (!attribute || accessor == primitive.attributes.end())
            return file.at(
                here + "/attributes/" + name,
                "names an attribute that is not in the compressed data or not in the primitive");
        const gltf::Accessor& described = file.document().accessors[size_t(accessor->second)];
        const int components = componentCount(described.type);
        if (components > 4 || components != int(attribute->num_components()))
            return file.at(here + "/attributes/" + name,
                           fmt::format("has {} components, but the accessor {}",
                                       int(attribute->num_components()), components));
        if (auto fits = file.charge(size_t(mesh->num_points()) * size_t(components), here); !fits)
            return fits;
        if (SharedFloats* place = source.place(name))
            *place = readAttribute(*mesh, *attribute, described);
    }
    return {};
}

} // namespace tyndall
