#pragma once
// glTF 2.0 (.gltf, .glb) to scene data.
//
// Understood extensions: KHR_materials_unlit, KHR_materials_emissive_strength, KHR_materials_specular (factor), KHR_texture_transform,
// KHR_mesh_quantization, KHR_lights_punctual, EXT_mesh_gpu_instancing, KHR_draco_mesh_compression,
// EXT_meshopt_compression, EXT_texture_webp. Any other one in `extensionsRequired` is refused by name; in
// `extensionsUsed` it is noted. Skins, morph targets and animations are noted and stay in their rest pose.
//
// Our rules judge the JSON (gltf_rules.h), tinygltf parses the model (gltf_document.h), and accessors check every read (gltf_file.h).

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"
#include "scene/scene_file.h"

namespace tyndall {

/// The default scene of a file (its first one, where none is named; every root node, where there is no scene at all).
/// Nodes come parents first; roots have no parent; activeCamera is the first node with a camera.
struct GltfScene {
    Scene scene;
    std::vector<std::string> extensions; // that the file uses
    std::vector<std::string> notes;      // each names the file
};

/// The file is checked in full before any of it is used: types, ranges, references, cycles, sizes. Errors name the file
/// and the JSON pointer.
Result<GltfScene> importGltf(const std::filesystem::path& path, const LoadOptions& options = {});

} // namespace tyndall
