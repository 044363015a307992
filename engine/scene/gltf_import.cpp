#include "scene/gltf_import.h"

#include "scene/gltf_model.h"

namespace tyndall {

Result<GltfScene> importGltf(const std::filesystem::path& path, const LoadOptions& options) {
    auto file = GltfFile::open(path, options);
    if (!file) return file.error();
    GltfScene result;
    if (auto built = GltfModel(*file, result.scene).build(); !built) return built.error();
    result.extensions = file->document().extensions;
    result.notes = std::move(file->notes);
    return result;
}

} // namespace tyndall
