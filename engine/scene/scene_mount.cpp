#include "scene/scene_mount.h"

#include <iterator>

namespace tyndall {
namespace {

void shift(int& index, size_t by) {
    if (index != kNone) index += int(by);
}

template <typename T> void moveInto(std::vector<T>& to, std::vector<T>& from) {
    to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

/// Moves meshes, materials … of `part` to the end of those of `scene`, and rewrites what refers to them.
void moveAssets(Scene& scene, Scene& part) {
    for (Texture& texture : part.textures) shift(texture.image, scene.images.size());
    for (Material& material : part.materials)
        for (TextureRef* reference :
             {&material.baseColorTexture, &material.metallicRoughnessTexture,
              &material.normalTexture, &material.occlusionTexture, &material.emissiveTexture})
            shift(reference->texture, scene.textures.size());
    for (Mesh& mesh : part.meshes) shift(mesh.material, scene.materials.size());
    for (Node& node : part.nodes) {
        for (int& mesh : node.meshes) shift(mesh, scene.meshes.size());
        shift(node.light, scene.lights.size());
        shift(node.camera, scene.cameras.size());
    }
    moveInto(scene.images, part.images);
    moveInto(scene.textures, part.textures);
    moveInto(scene.materials, part.materials);
    moveInto(scene.meshes, part.meshes);
    moveInto(scene.lights, part.lights);
    moveInto(scene.cameras, part.cameras);
}

} // namespace

Result<void> GltfMounts::mount(LoadedScene& loaded, int node, const std::filesystem::path& file,
                               const LoadOptions& options) {
    const std::filesystem::path key = file.lexically_normal();
    auto found = mounted_.find(key);
    if (found == mounted_.end()) {
        auto imported = importGltf(file, options);
        if (!imported) return imported.error();
        moveAssets(loaded.scene, imported->scene);
        moveInto(loaded.extensions, imported->extensions);
        moveInto(loaded.notes, imported->notes);
        found = mounted_.emplace(key, Mounted{std::move(imported->scene.nodes)}).first;
    }
    const size_t first = loaded.scene.nodes.size();
    for (Node copy : found->second.nodes) {
        if (copy.parent == kNone)
            copy.parent = node;
        else
            shift(copy.parent, first);
        copy.source = node;
        loaded.scene.nodes.push_back(std::move(copy));
    }
    return {};
}

} // namespace tyndall
