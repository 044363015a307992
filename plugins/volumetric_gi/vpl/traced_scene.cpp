#include "volumetric_gi/vpl/traced_scene.h"

#include "framegraph/hash.h"

namespace tyndall::volumetric_gi {

Result<void> TracedScene::update(const plugin::FrameInputs& inputs) {
    const Scene& scene = *inputs.whole;
    const SceneVersions& now = scene.versions;
    const dvec3 origin(inputs.origin[0], inputs.origin[1], inputs.origin[2]);
    uint64_t surfaces = fg::kHashStart;
    for (const uint64_t version :
         {now.structure, now.transforms, now.meshes, now.materials, now.textures})
        surfaces = fg::mixHash(surfaces, version);
    for (const double coordinate : inputs.origin)
        surfaces = fg::mixHash(surfaces, std::bit_cast<uint64_t>(coordinate));
    uint64_t key = surfaces;
    for (const uint64_t version : {now.lights, now.media, now.environment})
        key = fg::mixHash(key, version);
    if (whole_ == &scene && key == key_) return {};

    emission_.reset();
    scene_.lights.reset();
    if (whole_ != &scene || surfaces != surfacesKey_) {
        scene_.surfaces.reset();
        auto built = reference::SurfaceScene::build(scene, origin, 0);
        if (!built.ok()) {
            whole_ = nullptr;
            return built.error();
        }
        scene_.surfaces = std::move(*built);
    }
    scene_.media = std::make_unique<reference::MediaField>(scene, origin);
    scene_.lights =
        std::make_unique<reference::Lights>(scene, origin, *scene_.surfaces, *scene_.media);
    Bounds content = scene.contentBounds();
    if (!content.empty()) {
        content.minimum -= origin;
        content.maximum -= origin;
    }
    emission_ = std::make_unique<reference::LightEmission>(scene_, content);
    whole_ = &scene;
    key_ = key;
    surfacesKey_ = surfaces;
    return {};
}

} // namespace tyndall::volumetric_gi
