#pragma once
// Puts the content of a glTF file below a node of a scene.

#include <filesystem>
#include <map>

#include "core/result.h"
#include "scene/gltf_import.h"

namespace tyndall {

/// Files mounted so far: a file that several nodes mount is read once, and its meshes, materials and textures are shared.
class GltfMounts {
public:
    /// Imports `file` (or takes it from the earlier mount) and appends its nodes below `node`, with `source` = node.
    Result<void> mount(LoadedScene& loaded, int node, const std::filesystem::path& file,
                       const LoadOptions& options);

private:
    struct Mounted {
        std::vector<Node>
            nodes; // indices to meshes, lights and cameras already those of the scene; parents are not
    };
    std::map<std::filesystem::path, Mounted> mounted_;
};

} // namespace tyndall
