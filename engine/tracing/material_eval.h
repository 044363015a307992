#pragma once
// A material at a point of a surface: glTF's factors times its textures, at their finest level.

#include <array>
#include <vector>

#include "tracing/ray.h"
#include "scene/scene.h"

namespace tyndall::tracing {

/// Attributes of a triangle at a point, interpolated from its corners.
struct VertexValues {
    std::array<dvec2, kMaxUvSets> uvs{};
    dvec4 color{1};
};

struct MaterialValues {
    dvec3 baseColor{1}; // 0..1; unlit: nits
    double alpha = 1;   // 0..1
    double metallic = 0, roughness = 1, specular = 1;
    dvec3 emissive{0};          // nits
    dvec3 normalTexel{0, 0, 1}; // tangent space, not unit
    bool hasNormalTexel = false;
};

/// Reads the materials of one scene, which must outlive it.
class MaterialReader {
public:
    explicit MaterialReader(const Scene& scene);

    [[nodiscard]] MaterialValues evaluate(const Material& material,
                                          const VertexValues& vertex) const;
    /// 0..1, of the base colour alone; a MASK's is 0 or 1.
    [[nodiscard]] double coverage(const Material& material, const VertexValues& vertex) const;
    /// The largest luminance that the emissive texture times factor has anywhere, nits.
    [[nodiscard]] double brightestEmission(const Material& material) const;

private:
    [[nodiscard]] dvec4 sample(const TextureRef& ref, const VertexValues& vertex, bool srgb) const;
    const Scene& scene_;
    std::array<double, 256> linear_; // of an sRGB byte
};

} // namespace tyndall::tracing
