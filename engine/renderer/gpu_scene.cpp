#include "renderer/gpu_scene.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/check.h"
#include "core/log.h"
#include "gl/buffer.h"

namespace tyndall {
namespace {

/// uv' = offset + R·(scale·uv). Rotation is counter-clockwise as the picture is seen, that is with v pointing down: the
/// reading of KHR_texture_transform that its first example and the sample viewer agree on.
gpu::MaterialTexture materialTexture(const TextureRef& ref, bool present) {
    const double c = std::cos(double(ref.rotation)), s = std::sin(double(ref.rotation));
    gpu::MaterialTexture use;
    use.linear = vec4(float(c * double(ref.scale.x)), float(s * double(ref.scale.y)),
                      float(-s * double(ref.scale.x)), float(c * double(ref.scale.y)));
    use.offset =
        vec4(ref.offset, float(std::clamp(ref.uvSet, 0, kMaxUvSets - 1)), present ? 1.0f : 0.0f);
    return use;
}

bool hasImage(const Scene& scene, const TextureRef& ref) {
    if (ref.texture == kNone || size_t(ref.texture) >= scene.textures.size()) return false;
    const int image = scene.textures[size_t(ref.texture)].image;
    return image != kNone && size_t(image) < scene.images.size() &&
           !scene.images[size_t(image)].rgba.empty();
}

gpu::MaterialData packMaterial(const Scene& scene, const Material& material) {
    gpu::MaterialData data{};
    data.baseColor = material.baseColor;
    data.emissive = vec4(material.emissive, material.alphaCutoff);
    data.metallic = material.metallic;
    data.roughness = material.roughness;
    data.specular = material.specular;
    data.normalScale = material.normalScale;
    data.occlusionStrength = material.occlusionStrength;
    data.flags = (material.doubleSided ? gpu::kMaterialDoubleSided : 0u) |
                 (material.unlit ? gpu::kMaterialUnlit : 0u) |
                 (material.alphaMode == AlphaMode::Mask ? gpu::kMaterialMask : 0u) |
                 (material.alphaMode == AlphaMode::Blend ? gpu::kMaterialBlend : 0u);
    data.baseColorTexture =
        materialTexture(material.baseColorTexture, hasImage(scene, material.baseColorTexture));
    data.metallicRoughnessTexture = materialTexture(
        material.metallicRoughnessTexture, hasImage(scene, material.metallicRoughnessTexture));
    data.normalTexture =
        materialTexture(material.normalTexture, hasImage(scene, material.normalTexture));
    data.occlusionTexture =
        materialTexture(material.occlusionTexture, hasImage(scene, material.occlusionTexture));
    data.emissiveTexture =
        materialTexture(material.emissiveTexture, hasImage(scene, material.emissiveTexture));

    std::array<float, 16> cutoffs;
    cutoffs.fill(material.alphaCutoff);
    if (material.alphaMode == AlphaMode::Mask && hasImage(scene, material.baseColorTexture) &&
        material.baseColor.w > 0) {
        const Texture& texture = scene.textures[size_t(material.baseColorTexture.texture)];
        cutoffs = alphaCutoffs(scene.images[size_t(texture.image)],
                               material.alphaCutoff / material.baseColor.w);
        for (float& cutoff : cutoffs) cutoff *= material.baseColor.w;
    }
    for (int i = 0; i < 16; ++i) data.alphaCutoffs[i / 4][i % 4] = cutoffs[size_t(i)];
    return data;
}

bool isFinite(const dmat4& m) {
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r)
            if (!std::isfinite(m[c][r])) return false;
    return true;
}

gpu::ObjectData packObject(const dmat4& renderFromLocal, const Mesh& mesh, uint32_t material) {
    gpu::ObjectData data{};
    data.renderFromLocal = mat4(renderFromLocal);
    const dmat3 m(renderFromLocal);
    const double determinant = glm::determinant(m);
    // The cofactor matrix is the inverse transpose times the determinant: it exists for flattened objects too.
    dmat3 normals(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
    double largest = 0;
    for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r) largest = std::max(largest, std::abs(normals[c][r]));
    if (largest > 0)
        normals *= (determinant < 0 ? -1.0 : 1.0) /
                   largest; // so that tiny objects keep their digits in floats
    data.normalX = vec4(vec3(normals[0]), 0);
    data.normalY = vec4(vec3(normals[1]), 0);
    data.normalZ = vec4(vec3(normals[2]), 0);
    data.material = material;
    data.flags = (determinant < 0 ? gpu::kObjectMirrored : 0u) |
                 (mesh.normals.empty() ? 0u : gpu::kObjectHasNormals) |
                 (mesh.tangents.empty() ? 0u : gpu::kObjectHasTangents) |
                 (mesh.colors.empty() ? 0u : gpu::kObjectHasColors);
    return data;
}

fg::Topology topologyOf(const Mesh& mesh) {
    switch (mesh.topology) {
    case MeshTopology::Lines: return fg::Topology::Lines;
    case MeshTopology::Points: return fg::Topology::Points;
    case MeshTopology::Triangles: break;
    }
    return fg::Topology::Triangles;
}

/// Writes `values` into the registered buffer, which is made again where the size is another.
template <typename T>
Result<void> uploadArray(fg::Executor& executor, fg::StaticBuffer& buffer, const char* name,
                         const std::vector<T>& values) {
    const uint64_t bytes =
        std::max<uint64_t>(values.size(), 1) * sizeof(T); // a storage block needs some storage
    if (buffer.id && executor.buffer(buffer).bytes() != bytes) {
        executor.release(buffer);
        buffer = {};
    }
    if (!buffer.id) {
        Result<gl::Buffer> made = gl::Buffer::create(name, bytes, gl::BufferAccess::CpuUpdates);
        if (!made) return made.error();
        buffer = executor.registerBuffer(name, std::move(*made));
    }
    if (!values.empty()) executor.buffer(buffer).write(0, values.data(), bytes);
    return {};
}

} // namespace

bool mayBeInside(const Bounds& box, std::span<const vec4> planes) {
    if (box.empty()) return false;
    for (const vec4& plane : planes) {
        const dvec3 normal(plane);
        const dvec3 farthest(normal.x >= 0 ? box.maximum.x : box.minimum.x,
                             normal.y >= 0 ? box.maximum.y : box.minimum.y,
                             normal.z >= 0 ? box.maximum.z : box.minimum.z);
        const double distance = glm::dot(normal, farthest) + double(plane.w);
        // Planes are floats: what lies within their rounding counts as inside.
        const double rounding =
            1e-5 * (glm::dot(glm::abs(normal), glm::abs(farthest)) + std::abs(double(plane.w)));
        if (distance < -rounding) return false;
    }
    return true;
}

GpuScene::GpuScene(fg::Executor& executor)
    : executor_(executor), meshes_(executor), textures_(executor) {}

GpuScene::~GpuScene() {
    if (objects_.id) executor_.release(objects_);
    if (materials_.id) executor_.release(materials_);
}

std::span<const DrawItem> GpuScene::items(AlphaMode mode) const {
    const auto first = std::partition_point(
        items_.begin(), items_.end(), [&](const DrawItem& item) { return item.alphaMode < mode; });
    const auto last = std::partition_point(
        first, items_.end(), [&](const DrawItem& item) { return item.alphaMode == mode; });
    return {first, last};
}

const Scene& GpuScene::scene() const {
    CHECK(scene_ != nullptr, "GpuScene::update was never called");
    return *scene_;
}

Result<void> GpuScene::update(const Scene& scene, const dvec3& renderOrigin) {
    const bool first = scene_ != &scene;
    const SceneVersions& now = scene.versions;
    const bool textures =
        first || now.textures != seen_.textures || seenAnisotropy_ != textures_.anisotropy();
    const bool materials = textures || now.materials != seen_.materials;
    const bool items = first || materials || now.structure != seen_.structure ||
                       now.transforms != seen_.transforms || now.meshes != seen_.meshes ||
                       renderOrigin != renderOrigin_;
    if (!items) return {};
    scene_ = &scene;
    renderOrigin_ = renderOrigin;
    version_ = nextVersion();
    // A failed update must be tried again in full.
    seen_ = {};
    seenAnisotropy_ = 0;
    if (textures) textures_.forget();
    if (materials)
        if (Result<void> done = updateMaterials(scene); !done) return done;
    if (Result<void> done = updateItems(scene); !done) return done;
    seen_ = now;
    seenAnisotropy_ = textures_.anisotropy();
    return {};
}

Result<void> GpuScene::updateMaterials(const Scene& scene) {
    materialData_.clear();
    materialTextures_.clear();
    const Material defaultMaterial;
    for (size_t i = 0; i <= scene.materials.size(); ++i) {
        const Material& material =
            i < scene.materials.size() ? scene.materials[i] : defaultMaterial;
        materialData_.push_back(packMaterial(scene, material));
        MaterialTextures set;
        const auto obtain = [&](fg::StaticTexture& slot, const TextureRef& ref,
                                ColorSpace space) -> Result<void> {
            Result<fg::StaticTexture> texture = textures_.obtain(scene, ref.texture, space);
            if (!texture) return texture.error();
            slot = *texture;
            return {};
        };
        if (Result<void> done = obtain(set.baseColor, material.baseColorTexture, ColorSpace::Srgb);
            !done)
            return done;
        if (Result<void> done = obtain(set.metallicRoughness, material.metallicRoughnessTexture,
                                       ColorSpace::Linear);
            !done)
            return done;
        if (Result<void> done = obtain(set.normal, material.normalTexture, ColorSpace::Linear);
            !done)
            return done;
        if (Result<void> done =
                obtain(set.occlusion, material.occlusionTexture, ColorSpace::Linear);
            !done)
            return done;
        if (Result<void> done = obtain(set.emissive, material.emissiveTexture, ColorSpace::Srgb);
            !done)
            return done;
        materialTextures_.push_back(set);
    }
    return uploadArray(executor_, materials_, "Materials", materialData_);
}

void GpuScene::addItems(const Scene& scene, int node, const dmat4& worldFromNode) {
    const Node& source = scene.nodes[size_t(node)];
    const size_t instances = source.instances.empty() ? 1 : source.instances.size();
    for (size_t instance = 0; instance < instances; ++instance) {
        dmat4 renderFromLocal =
            source.instances.empty() ? worldFromNode : worldFromNode * source.instances[instance];
        renderFromLocal[3] -= dvec4(renderOrigin_, 0);
        if (!isFinite(renderFromLocal)) {
            log::warningOnce("transform " + source.name,
                             "node '" + source.name +
                                 "' has a transform that is not finite and is not drawn");
            continue;
        }
        for (const int meshIndex : source.meshes) {
            const Mesh& mesh = scene.meshes[size_t(meshIndex)];
            const Material& material = scene.materialOf(mesh);
            DrawItem item;
            item.indexCount = uint32_t(mesh.indices.size());
            item.material =
                mesh.material == kNone ? uint32_t(scene.materials.size()) : uint32_t(mesh.material);
            item.topology = topologyOf(mesh);
            item.alphaMode = material.alphaMode;
            item.doubleSided = material.doubleSided || mesh.topology != MeshTopology::Triangles;
            item.bounds = mesh.bounds.transformed(renderFromLocal);
            item.mesh = meshIndex;
            item.node = node;
            item.instance = int32_t(instance);
            item.object = uint32_t(objectData_.size());
            objectData_.push_back(packObject(renderFromLocal, mesh, item.material));
            item.mirrored = (objectData_.back().flags & gpu::kObjectMirrored) != 0;
            items_.push_back(item);
        }
    }
}

void GpuScene::sortItems() {
    const auto key = [](const DrawItem& i) {
        return std::tuple(int(i.alphaMode), uint32_t(i.topology), i.doubleSided, i.mirrored,
                          i.material, i.mesh, i.node, i.instance);
    };
    std::sort(items_.begin(), items_.end(),
              [&](const DrawItem& a, const DrawItem& b) { return key(a) < key(b); });
    std::vector<gpu::ObjectData> ordered(objectData_.size());
    for (size_t i = 0; i < items_.size(); ++i) {
        ordered[i] = objectData_[items_[i].object];
        items_[i].object = uint32_t(i);
    }
    objectData_ = std::move(ordered);
}

Result<void> GpuScene::updateItems(const Scene& scene) {
    items_.clear();
    objectData_.clear();
    bounds_ = {};
    meshes_.trim(scene.meshes.size());
    const std::vector<dmat4> world = scene.worldTransforms();
    const std::vector<bool> visible = scene.worldVisibility();
    for (size_t node = 0; node < scene.nodes.size(); ++node)
        if (visible[node] && !scene.nodes[node].meshes.empty())
            addItems(scene, int(node), world[node]);
    sortItems();
    for (DrawItem& item : items_) {
        Result<fg::StaticGeometry> geometry = meshes_.obtain(scene, item.mesh);
        if (!geometry) return geometry.error();
        item.geometry = *geometry;
        bounds_.include(item.bounds);
    }
    // Meshes without vertices keep their object, so that objects and items stay in step, but nothing is to be drawn.
    std::erase_if(items_, [](const DrawItem& item) { return item.geometry.id == 0; });
    return uploadArray(executor_, objects_, "Objects", objectData_);
}

} // namespace tyndall
