#pragma once
// The surfaces of a scene for rays: triangles in Embree, and the material at a hit point.
//
// Surfaces with holes (MASK) or of partial coverage (BLEND) let a ray pass at random, decided by the ray's own random
// number. Only camera rays pass one-sided surfaces from behind. Lines and points have no area: no ray hits them.

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "core/result.h"
#include "tracing/bsdf.h"
#include "tracing/material_eval.h"

struct RTCDeviceTy;
struct RTCSceneTy;

namespace tyndall::tracing {

/// One mesh at one place. Vertices are rounded to single precision in the space of rays.
struct MeshInstance {
    const Mesh* mesh = nullptr;
    const Material* material = nullptr;
    mat3 normalFromMesh{1}; // inverse transpose; sign of the determinant left in
    mat3 rayFromMesh{1};    // of vectors: tangents
    bool mirrored = false;
    dmat4 place{1};             // ray space from the mesh's
    uint32_t firstTriangle = 0; // number of its first triangle among all
    std::vector<vec3> positions;
    uint32_t firstEmitter =
        0; // number of its first triangle among all that emit; kNoEmitter: it does not
    static constexpr uint32_t kNoEmitter = 0xffffffffu;
};

struct RayHit {
    double distance = kInfinity;
    uint32_t instance = 0, triangle = 0;
    double u = 0, v = 0; // barycentric, of corners 1 and 2
    [[nodiscard]] bool found() const { return distance < kInfinity; }
};

/// A point of a surface, for the path that hit it.
struct SurfacePoint {
    dvec3 position{0};
    Surface surface;
    dvec3 emission{0}; // nits towards where the path came from
    bool unlit = false;
    uint32_t emitter = MeshInstance::kNoEmitter; // its triangle's number among those that emit
    double margin = 0; // metres by which rays from here start off the surface
};

/// A triangle's pieces: each of its edges in eight parts. Piece (i, j, upper) has barycentric u in [i, i+1]/8, v in [j, j+1]/8, and is the upper half of that.
inline constexpr int kPiecesAlongEdge = 8;
[[nodiscard]] constexpr int pieceNumber(int i, int j, bool upper) {
    return j * (2 * kPiecesAlongEdge - j) + 2 * i + int(upper);
}

struct SceneTriangle {
    std::array<dvec3, 3> corners{}; // ray space
    uint64_t covers = ~0ull;        // a bit for each of its pieces: rays pass the others
    [[nodiscard]] bool opaque() const { return covers == ~0ull; }
};

enum class RayKind { Camera = 0, Path = 1 };

class SurfaceScene {
public:
    /// `origin`: the world's point that becomes the origin of ray space. `scene` must outlive this.
    /// Errors: more triangles than 32-bit numbers can name, or than Embree gets memory for.
    static Result<std::unique_ptr<SurfaceScene>> build(const Scene& scene, const dvec3& origin,
                                                       int threads);
    ~SurfaceScene();
    /// Moves meshes to where their nodes are now: trees are refitted, not built again. `moved`: numbers of the instances that were.
    /// False, and nothing is changed, if the visible meshes are other ones than before, or one is or was flat.
    bool move(const Scene& scene, const dvec3& origin, std::vector<uint32_t>& moved);
    SurfaceScene(const SurfaceScene&) = delete;
    SurfaceScene& operator=(const SurfaceScene&) = delete;

    /// The first surface between `nearest` and `farthest` along the ray. `chance` decides at surfaces of partial coverage.
    [[nodiscard]] RayHit intersect(const Ray& ray, double nearest, double farthest, RayKind kind,
                                   uint64_t chance) const;
    /// Does a surface lie between the two ends of the ray? `farthest` may be infinite.
    [[nodiscard]] bool occluded(const Ray& ray, double farthest, uint64_t chance) const;
    [[nodiscard]] SurfacePoint pointAt(const Ray& ray, const RayHit& hit) const;

    [[nodiscard]] const std::vector<MeshInstance>& instances() const { return instances_; }
    [[nodiscard]] std::vector<MeshInstance>& mutableInstances() { return instances_; }
    [[nodiscard]] const MaterialReader& materials() const { return materials_; }
    [[nodiscard]] size_t triangleCount() const { return triangleCount_; }
    /// All of them, instance by instance. A random decision, the same each time, fills pieces of partial coverage, so that coverage is right on average.
    [[nodiscard]] std::vector<SceneTriangle> triangles() const;
    [[nodiscard]] std::array<dvec3, 3> corners(uint32_t instance, uint32_t triangle) const;
    /// The instance that a triangle belongs to; `triangle`: its number among all.
    [[nodiscard]] uint32_t instanceOf(uint32_t triangle) const;
    /// Of all triangles, in ray space; empty without any.
    [[nodiscard]] const Bounds& bounds() const { return bounds_; }
    /// Messages about what is left out.
    [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }
    /// Coverage at a point of a triangle: for Embree's filter.
    [[nodiscard]] double coverageAt(uint32_t instance, uint32_t triangle, double u, double v) const;

private:
    explicit SurfaceScene(const Scene& scene) : materials_(scene) {}
    [[nodiscard]] uint64_t coveredPieces(uint32_t instance, uint32_t triangle) const;
    void addMesh(const Scene& scene, const Mesh& mesh, const dmat4& rayFromMesh);
    void updateBounds();
    Result<void> buildTree(int threads);
    [[nodiscard]] VertexValues vertexValues(const RayHit& hit) const;

    RTCDeviceTy* device_ = nullptr;
    RTCSceneTy* tree_ = nullptr;
    bool moves_ = false; // the tree is of a kind that can be refitted
    std::vector<MeshInstance> instances_;
    MaterialReader materials_;
    size_t triangleCount_ = 0;
    Bounds bounds_;
    std::vector<std::string> notes_;
};

/// Start of a ray that leaves a surface in this direction: off the surface by its margin.
inline Ray rayFrom(const SurfacePoint& point, const dvec3& direction) {
    const dvec3& n = point.surface.geometricNormal;
    const double side = glm::dot(n, direction) >= 0 ? point.margin : -point.margin;
    return {point.position + side * n, direction};
}

} // namespace tyndall::tracing
