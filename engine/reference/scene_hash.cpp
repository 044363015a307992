// One number for everything in a scene that a picture depends on, whatever file or order of loading it came from.

#include <bit>
#include <cstring>

#include "reference/render.h"
#include "tracing/sampler.h"

namespace tyndall::reference {
namespace {

class Hash {
public:
    void bytes(const void* data, size_t size) {
        add(size);
        const auto* p = static_cast<const unsigned char*>(data);
        for (; size >= 8; p += 8, size -= 8) {
            uint64_t word;
            std::memcpy(&word, p, 8);
            add(word);
        }
        uint64_t rest = 0;
        std::memcpy(&rest, p, size);
        add(rest);
    }
    void add(uint64_t word) { state_ = mixBits(state_ ^ word) + 0x9e3779b97f4a7c15ull; }
    void add(int value) { add(uint64_t(int64_t(value))); }
    void add(bool value) { add(uint64_t(value)); }
    void add(double value) { add(std::bit_cast<uint64_t>(value == 0 ? 0.0 : value)); }
    void add(float value) { add(double(value)); }
    template <glm::length_t N, typename T> void add(const glm::vec<N, T>& v) {
        for (glm::length_t i = 0; i < N; ++i) add(v[i]);
    }
    void add(const dmat4& m) {
        for (int i = 0; i < 4; ++i) add(m[i]);
    }
    template <typename... T> void each(const T&... values) { (add(values), ...); }
    template <typename T> void all(const std::vector<T>& values) {
        bytes(values.data(), values.size() * sizeof(T));
    }
    [[nodiscard]] uint64_t value() const { return mixBits(state_); }

private:
    uint64_t state_ = 0x243f6a8885a308d3ull;
};

void addTexture(Hash& hash, const Scene& scene, const TextureRef& ref) {
    hash.add(ref.texture != kNone);
    if (ref.texture == kNone) return;
    const Texture& texture = scene.textures[size_t(ref.texture)];
    hash.each(ref.uvSet, ref.offset, ref.scale, ref.rotation, int(texture.sampler.magnify),
              int(texture.sampler.wrapU), int(texture.sampler.wrapV));
    if (texture.image == kNone) return;
    const ImageData& image = scene.images[size_t(texture.image)];
    hash.add(image.width);
    hash.add(image.height);
    hash.all(image.rgba);
}

void addMaterial(Hash& hash, const Scene& scene, const Material& m) {
    hash.each(m.baseColor, m.metallic, m.roughness, m.specular, m.emissive, m.normalScale,
              int(m.alphaMode), m.alphaCutoff, m.doubleSided, m.unlit);
    for (const TextureRef* ref :
         {&m.baseColorTexture, &m.metallicRoughnessTexture, &m.normalTexture, &m.emissiveTexture})
        addTexture(hash, scene, *ref);
}

void addMesh(Hash& hash, const Scene& scene, const Mesh& mesh) {
    hash.add(int(mesh.topology));
    hash.all(mesh.positions);
    hash.all(mesh.normals);
    hash.all(mesh.tangents);
    for (const auto& set : mesh.uvs) hash.all(set);
    hash.all(mesh.colors);
    hash.all(mesh.indices);
    addMaterial(hash, scene, scene.materialOf(mesh));
}

void addGrid(Hash& hash, const BrickGrid* grid) {
    hash.add(grid != nullptr);
    if (!grid) return;
    hash.each(grid->origin, grid->brickCount, grid->worldFromIndex);
    for (const Brick& brick : grid->bricks) {
        hash.add(brick.minimum);
        hash.add(brick.maximum);
        hash.add(uint64_t(brick.slot));
    }
    hash.all(grid->samples);
}

void addMedium(Hash& hash, const Medium& m) {
    hash.each(int(m.kind), m.size, m.scaleHeight, m.scattering, m.absorption, m.anisotropy,
              int(m.phase), m.emission, m.temperatureScale);
    addGrid(hash, m.density.get());
    addGrid(hash, m.temperature.get());
}

void addLight(Hash& hash, const Light& l) {
    hash.each(int(l.type), l.color, l.intensity, l.range, l.radius, l.innerConeAngle,
              l.outerConeAngle, l.size, l.radiance, l.castsShadows);
}

} // namespace

uint64_t sceneHash(const Scene& scene, int cameraNode) {
    Hash hash;
    const std::vector<dmat4> world = scene.worldTransforms();
    const std::vector<bool> visible = scene.worldVisibility();
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        const Node& node = scene.nodes[i];
        if (!visible[i]) continue;
        if (node.meshes.empty() && node.light == kNone && node.medium == kNone) continue;
        hash.add(world[i]);
        for (const int mesh : node.meshes) addMesh(hash, scene, scene.meshes[size_t(mesh)]);
        for (const dmat4& instance : node.instances) hash.add(instance);
        if (node.light != kNone) addLight(hash, scene.lights[size_t(node.light)]);
        if (node.medium != kNone) addMedium(hash, scene.media[size_t(node.medium)]);
    }
    const Environment& e = scene.environment;
    hash.each(e.radiance, e.intensity, e.rotation);
    if (e.image) {
        hash.add(e.image->width);
        hash.add(e.image->height);
        hash.all(e.image->pixels);
    }
    const Camera& camera = scene.cameras[size_t(scene.nodes[size_t(cameraNode)].camera)];
    hash.each(world[size_t(cameraNode)], int(camera.type), camera.yfov, camera.ymag, camera.znear);
    return hash.value();
}

} // namespace tyndall::reference
