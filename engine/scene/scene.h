#pragma once
// The scene: plain data in flat arrays, indices between them, and a version number on everything that a cache
// could be made from. Import fills it, the editor changes it, the renderer and the reference read it.

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/math.h"
#include "core/version.h"
#include "media/medium.h"

namespace tyndall {

inline constexpr int kNone = -1;
inline constexpr int kMaxUvSets = 4;

enum class Filter : int32_t { Nearest = 0, Linear = 1 };
enum class MipFilter : int32_t { None = 0, Nearest = 1, Linear = 2 };
enum class Wrap : int32_t { Repeat = 0, ClampToEdge = 1, MirroredRepeat = 2 };

struct Sampler {
    Filter magnify = Filter::Linear, minify = Filter::Linear;
    MipFilter mip = MipFilter::Linear;
    Wrap wrapU = Wrap::Repeat, wrapV = Wrap::Repeat;
    bool operator==(const Sampler&) const = default;
};

/// 8-bit RGBA as decoded, top row first. Whether it is sRGB depends on its use, not on the file.
struct ImageData {
    std::string name;
    int width = 0, height = 0;
    std::vector<uint8_t> rgba;
    std::string file; // as written, for saving; empty when embedded
};

struct Texture {
    int image = kNone;
    Sampler sampler;
};

/// KHR_texture_transform included: uv' = offset + R(rotation)·(scale·uv).
struct TextureRef {
    int texture = kNone;
    int uvSet = 0;
    vec2 offset{0}, scale{1};
    float rotation = 0;
};

enum class AlphaMode : int32_t { Opaque = 0, Mask = 1, Blend = 2 };

/// glTF 2.0 metallic-roughness. `emissive` is in nits with KHR_materials_emissive_strength multiplied in.
struct Material {
    std::string name;
    vec4 baseColor{1};
    float metallic = 1, roughness = 1;
    float specular =
        1; // KHR_materials_specular: scales the dielectric F0 of 0.04; 0 is exactly Lambert
    vec3 emissive{0};
    float normalScale = 1, occlusionStrength = 1;
    AlphaMode alphaMode = AlphaMode::Opaque;
    float alphaCutoff = 0.5f;
    bool doubleSided = false;
    bool unlit = false;
    TextureRef baseColorTexture, metallicRoughnessTexture, normalTexture, occlusionTexture,
        emissiveTexture;
    Version version = 0;
};

enum class MeshTopology : int32_t { Triangles = 0, Lines = 1, Points = 2 };

/// One drawable primitive. Strips, fans and loops were turned into lists by the import; there are always
/// indices, normals (triangles) and, where a normal texture needs them, tangents.
struct Mesh {
    std::string name;
    MeshTopology topology = MeshTopology::Triangles;
    int material = kNone; // kNone: the default material
    std::vector<vec3> positions;
    std::vector<vec3>
        normals; // empty for lines and points without normals: drawn unlit, facing the camera
    std::vector<vec4> tangents; // w: handedness; empty without a normal texture
    std::array<std::vector<vec2>, kMaxUvSets> uvs;
    std::vector<vec4> colors; // linear; empty: white
    std::vector<uint32_t> indices;
    Bounds bounds; // of positions
    Version version = 0;
};

enum class LightType : int32_t { Directional = 0, Point = 1, Spot = 2, Rect = 3 };

/// Looks along -Z of its node; a rect's light leaves from its -Z side, in the XY plane, Lambertian.
struct Light {
    std::string name;
    LightType type = LightType::Point;
    vec3 color{1};
    float intensity = 1; // candela (point, spot), lux (directional); unused by rect
    float range = 0;     // metres; 0: unbounded (KHR_lights_punctual's window otherwise)
    float radius =
        0; // sphere radius in metres (point, spot); for directional: angular radius in radians
    float innerConeAngle = 0, outerConeAngle = float(kPi / 4);
    vec2 size{1};     // rect: metres in node space
    vec3 radiance{0}; // rect: nits
    bool castsShadows = true;
    Version version = 0;
};

enum class CameraType : int32_t { Perspective = 0, Orthographic = 1 };

struct Camera {
    std::string name;
    CameraType type = CameraType::Perspective;
    double yfov = 0.8; // radians, full vertical angle
    double ymag = 1;   // orthographic: half the height in metres
    double znear = 0.05;
    Version version = 0;
};

struct Environment {
    vec3 radiance{0};                   // nits; used where there is no image
    std::shared_ptr<const Image> image; // RGB latitude-longitude, linear, top row first
    float intensity = 1;                // multiplies the image
    float rotation = 0;                 // radians, right-handed about +Y
    std::string file;
    Version version = 0;
};

enum class PrimitiveShape : int32_t { Box = 0, Sphere = 1, Plane = 2, Disk = 3, Cylinder = 4 };

/// What a scene file's `primitive` says; the mesh made from it is in the same node's `meshes`.
struct Primitive {
    PrimitiveShape shape = PrimitiveShape::Box;
    dvec3 size{1.0}; // full extents, node space; planes and disks lie in XZ
    bool operator==(const Primitive&) const = default;
};

enum class Interpolation : int32_t { Linear = 0, Step = 1, CubicSpline = 2 };

/// Keyframes of one property of a node, as written (glTF's layout: CubicSpline has three values a key).
struct Animation {
    std::string property; // "translation", "rotation", "scale", "light.intensity", "light.color"
    std::vector<double> times;  // seconds, rising
    std::vector<double> values; // flattened
    Interpolation interpolation = Interpolation::Linear;
    bool operator==(const Animation&) const = default;
};

/// A grid whose `file` holds %04d: frames first to last at `fps`.
struct GridSequence {
    int first = 0, last = 0;
    double fps = 24;
    bool loop = false;
    bool operator==(const GridSequence&) const = default;
};

/// Particles made by rule instead of read from a file.
struct ParticleGenerator {
    std::string kind = "cloud";
    int count = 1024;
    int64_t seed = 1;
    double radius = 1; // metres, node space
    bool operator==(const ParticleGenerator&) const = default;
};

/// A node carries at most one of each. Local transform is translation·rotation·scale or any matrix.
struct Node {
    std::string name;
    int parent = kNone; // always smaller than its own index
    dvec3 translation{0}, scale{1};
    dquat rotation{1, 0, 0, 0};
    std::optional<dmat4> matrix; // when given, replaces the three above
    bool visible = true;
    std::vector<int> meshes;      // drawn with this node's transform
    std::vector<dmat4> instances; // EXT_mesh_gpu_instancing, node space; empty: one, identity
    int light = kNone, camera = kNone, medium = kNone;
    int source =
        kNone; // index of the scene-file node that brought it in; kNone for those nodes themselves

    // As written in the scene file, for saving and for the clock.
    std::string gltf; // the file mounted here
    std::optional<Primitive> primitive;
    std::vector<Animation> animations;
    std::optional<GridSequence> sequence;
    std::optional<ParticleGenerator> particles;
    [[nodiscard]] dmat4 localTransform() const;
};

/// What changed last, per kind: caches and skips build on these.
struct SceneVersions {
    Version structure = 0; // nodes or meshes added, removed, reparented
    Version transforms = 0;
    Version meshes = 0, materials = 0, textures = 0, lights = 0, media = 0, cameras = 0,
            environment = 0;
};

struct Scene {
    std::string name;
    std::filesystem::path path; // the file it was loaded from

    std::vector<Node> nodes;
    std::vector<Mesh> meshes;
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<ImageData> images;
    std::vector<Light> lights;
    std::vector<Camera> cameras;
    std::vector<Medium> media;
    Environment environment;

    int activeCamera = kNone; // a node with a camera
    float ev100 = 0;
    std::vector<std::string> settings; // "KEY=VALUE" from the file, in order

    SceneVersions versions;

    [[nodiscard]] const Material& materialOf(const Mesh& mesh) const; // the default one for kNone
    /// world-from-local of every node; parents first. Invisible nodes are included.
    [[nodiscard]] std::vector<dmat4> worldTransforms() const;
    /// Is the node and are all its ancestors visible?
    [[nodiscard]] std::vector<bool> worldVisibility() const;
    /// Of all visible meshes and bounded media.
    [[nodiscard]] Bounds worldBounds() const;
    /// worldBounds() without the landscape: without what is flat and many times longer than all that is smaller, in scenes that are
    /// flat themselves.
    [[nodiscard]] Bounds contentBounds(bool withMedia = true) const;

private:
    [[nodiscard]] std::vector<Bounds> worldBoxes(bool withMedia) const;
};

} // namespace tyndall
