#include "scene/gltf_workrounds.h"

#include <nlohmann/json.hpp>

namespace tyndall::gltf {
namespace {

template <typename Function> void forEach(Json& gltf, const char* name, Function&& function) {
    if (const auto found = gltf.find(name); found != gltf.end())
        for (Json& element : *found) function(element);
}

/// tinygltf wants a URI of every buffer outside of a GLB, files of exactly byteLength bytes and data URIs of seven media types, turns '+' of
/// a name into a space, and keeps a copy of the bytes for each buffer that names a file.
void withholdBuffers(Json& gltf, Withheld& withheld) {
    forEach(gltf, "buffers", [&](Json& json) {
        Buffer buffer;
        buffer.byteLength = json.at("byteLength").get<uint64_t>();
        if (const auto uri = json.find("uri"); uri != json.end())
            buffer.uri = std::move(uri->get_ref<std::string&>());
        withheld.buffers.push_back(std::move(buffer));
    });
    gltf.erase("buffers");
}

/// tinygltf takes the address of a picture's bytes without looking whether its buffer view has them, refuses the model for one picture
/// that it cannot find, and unpacks data URIs whether a material uses them or not.
void withholdImages(Json& gltf, Withheld& withheld) {
    forEach(gltf, "images", [&](Json& json) {
        Image image;
        image.name = json.value("name", std::string());
        if (const auto uri = json.find("uri"); uri != json.end())
            image.uri = std::move(uri->get_ref<std::string&>());
        image.view = json.value("bufferView", kNone);
        withheld.images.push_back(std::move(image));
    });
    gltf.erase("images");
}

/// tinygltf refuses strides that are no multiple of four or 256; drivers never see them, since accessors are unpacked.
void withholdStrides(Json& gltf, Withheld& withheld) {
    forEach(gltf, "bufferViews", [&](Json& view) {
        withheld.strides.push_back(view.value("byteStride", uint64_t(0)));
        view.erase("byteStride");
    });
}

/// tinygltf refuses indices without a buffer view, which Draco's have (and which otherwise are zeros).
void withholdIndices(Json& gltf, Withheld& withheld) {
    forEach(gltf, "meshes", [&](Json& mesh) {
        withheld.indices.emplace_back();
        for (Json& primitive : mesh.at("primitives")) {
            withheld.indices.back().push_back(primitive.value("indices", kNone));
            primitive.erase("indices");
        }
    });
}

/// tinygltf refuses orthographic cameras without what only other projections than ours need, and spots that leave all to the defaults.
void completeCamerasAndLights(Json& gltf) {
    forEach(gltf, "cameras", [](Json& camera) {
        if (camera.at("type") == "orthographic")
            for (const char* unused : {"xmag", "zfar"}) camera.at("orthographic")[unused] = 1.0;
    });
    const Json::json_pointer lights("/extensions/KHR_lights_punctual/lights");
    if (!gltf.contains(lights)) return;
    for (Json& light : gltf.at(lights))
        if (light.at("type") == "spot" && !light.contains("spot")) light["spot"] = Json::object();
}

/// tinygltf keeps integers of extensions in 32 bits; as other numbers they are doubles.
void widenPackedViews(Json& gltf) {
    const Json::json_pointer place("/extensions/EXT_meshopt_compression");
    forEach(gltf, "bufferViews", [&](Json& view) {
        if (!view.contains(place)) return;
        for (Json& member : view.at(place))
            if (member.is_number()) member = member.get<double>();
    });
}

} // namespace

Withheld withhold(Json& gltf) {
    Withheld withheld;
    withholdBuffers(gltf, withheld);
    withholdImages(gltf, withheld);
    withholdStrides(gltf, withheld);
    withholdIndices(gltf, withheld);
    completeCamerasAndLights(gltf);
    widenPackedViews(gltf);
    return withheld;
}

} // namespace tyndall::gltf
