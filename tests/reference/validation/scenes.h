#pragma once
// Scenes in which quantities are measured, made in code: bodies of matter, black walls, lights from given directions.

#include "tracing/ray.h"
#include "scene/scene.h"

namespace tyndall::validation {

/// Extinction 1 per metre: a metre is a mean free path. Scattering and absorption add up to exactly 1 in single precision.
Medium matter(MediumKind kind, double albedo, double anisotropy);

class SceneMaker {
public:
    int addNode(const dmat4& worldFromNode = dmat4(1.0));
    void addMedium(const Medium& medium, const dmat4& worldFromNode = dmat4(1.0));
    void addMedium(const Medium& medium, const dvec3& at);
    /// Its mesh at this place; the material's factors alone count.
    void addPrimitive(PrimitiveShape shape, const dvec3& size, const Material& material,
                      const dmat4& worldFromNode = dmat4(1.0));
    /// Black, from both sides, at this height, and without an end for all that matters.
    void addBlackPlane(double height);
    void addPointLight(const dvec3& at, double candela, double radius = 0);
    /// Light that travels along `direction`.
    void addSun(const dvec3& direction, double lux);
    void addLight(const Light& light, const dmat4& worldFromNode);
    /// Sees `to` in the middle of its picture; gives the node.
    int addCamera(const dvec3& from, const dvec3& to, double yfov = 0.8);
    /// Radiance 1 from everywhere.
    void addWhiteEnvironment() { scene_.environment.radiance = vec3(1); }
    [[nodiscard]] Scene& scene() { return scene_; }
    [[nodiscard]] Scene take() { return std::move(scene_); }

private:
    Scene scene_;
};

/// A lamp over a block of matt stuff; with fog around both.
void addLampOverABlock(SceneMaker& maker, bool fog);

/// A slab of matter between y = -tau (m) and y = 0.
void addSlab(SceneMaker& maker, double albedo, double anisotropy, double tau);

/// Lambert's surface, seen from both sides.
Material matt(const vec3& colour);

/// The node's -Z axis along `direction`.
dmat4 lookAlong(const dvec3& direction, const dvec3& at = dvec3(0));

/// A grid of density `field` of node space, sampled at `first` + [0,size) times `spacing`, that is 0 outside.
template <typename Field>
std::shared_ptr<const BrickGrid> sampledGrid(ivec3 first, ivec3 size, const dvec3& spacing,
                                             const Field& field) {
    std::vector<float> voxels;
    voxels.reserve(size_t(size.x) * size_t(size.y) * size_t(size.z));
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x)
                voxels.push_back(float(field(dvec3(first + ivec3(x, y, z)) * spacing)));
    dmat4 worldFromIndex(1.0);
    for (int axis = 0; axis < 3; ++axis) worldFromIndex[axis][axis] = spacing[axis];
    return std::make_shared<BrickGrid>(makeBrickGrid(voxels, first, size, worldFromIndex));
}

/// Uneven density between 0 and `densest` around the origin, out to ±0.5·`extent`, the same on every machine.
std::shared_ptr<const BrickGrid> lumpyGrid(double extent, double densest, uint64_t seed);

} // namespace tyndall::validation
