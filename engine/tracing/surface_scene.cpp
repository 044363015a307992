#include "tracing/surface_scene.h"

#include <algorithm>
#include <cmath>

#include <embree3/rtcore.h>
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "tracing/sampler.h"

namespace tyndall::tracing {
namespace {

/// Rays start this part of the largest coordinate involved off a surface: some roundings of single precision.
constexpr double kMarginPart = 4e-6;

struct Context {
    RTCIntersectContext embree; // first: Embree hands back a pointer to it
    const SurfaceScene* scene;
    uint64_t chance;
};

/// Embree calls this at every surface that may have holes: does the ray hit it?
void filterCoverage(const RTCFilterFunctionNArguments* arguments) {
    const Context& context = *reinterpret_cast<const Context*>(arguments->context);
    for (unsigned i = 0; i < arguments->N; ++i) {
        if (arguments->valid[i] == 0) continue;
        const uint32_t instance = RTCHitN_geomID(arguments->hit, arguments->N, i),
                       triangle = RTCHitN_primID(arguments->hit, arguments->N, i);
        const double coverage = context.scene->coverageAt(
            instance, triangle, double(RTCHitN_u(arguments->hit, arguments->N, i)),
            double(RTCHitN_v(arguments->hit, arguments->N, i)));
        // The same answer each time that the tree offers the same triangle to the same ray.
        const uint64_t bits =
            mixBits(context.chance ^ mixBits((uint64_t(instance) << 32) | triangle));
        if (!(double(bits >> 11) * 0x1p-53 < coverage)) arguments->valid[i] = 0;
    }
}

void setRay(RTCRay& out, const Ray& ray, double nearest, double farthest) {
    out.org_x = float(ray.origin.x);
    out.org_y = float(ray.origin.y);
    out.org_z = float(ray.origin.z);
    out.dir_x = float(ray.direction.x);
    out.dir_y = float(ray.direction.y);
    out.dir_z = float(ray.direction.z);
    out.tnear = float(std::max(0.0, nearest));
    out.tfar = farthest < 1e30 ? float(farthest) : std::numeric_limits<float>::infinity();
    out.time = 0;
    out.mask = 0xffffffffu;
    out.id = 0;
    out.flags = 0;
}

template <typename T> auto mixCorners(const T& a, const T& b, const T& c, double u, double v) {
    return (1 - u - v) * a + u * b + v * c;
}

/// Not unit; outwards as the file's winding has it, which a mirrored transform turns round.
dvec3 facetOf(const MeshInstance& instance, uint32_t triangle) {
    const uint32_t* corner = &instance.mesh->indices[3 * size_t(triangle)];
    const dvec3 a(instance.positions[corner[0]]), b(instance.positions[corner[1]]),
        c(instance.positions[corner[2]]);
    const dvec3 facet = glm::cross(b - a, c - a);
    return instance.mirrored ? -facet : facet;
}

dvec3 unitOr(const dvec3& v, const dvec3& otherwise) {
    const double squared = glm::dot(v, v);
    return squared > 0 && std::isfinite(squared) ? v / std::sqrt(squared) : otherwise;
}

/// Calls `use(mesh, rayFromMesh)` for every visible mesh with triangles; returns how many meshes have no area.
template <typename Use> size_t forEachMesh(const Scene& scene, const dvec3& origin, Use&& use) {
    const std::vector<dmat4> world = scene.worldTransforms();
    const std::vector<bool> visible = scene.worldVisibility();
    size_t withoutArea = 0;
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        if (!visible[i]) continue;
        const Node& node = scene.nodes[i];
        for (const int index : node.meshes) {
            const Mesh& mesh = scene.meshes[size_t(index)];
            if (mesh.topology != MeshTopology::Triangles) {
                ++withoutArea;
                continue;
            }
            if (mesh.indices.size() < 3) continue;
            const auto place = [&](const dmat4& worldFromMesh) {
                dmat4 rayFromMesh = worldFromMesh;
                rayFromMesh[3] -= dvec4(origin, 0);
                use(mesh, rayFromMesh);
            };
            if (node.instances.empty()) place(world[i]);
            for (const dmat4& instance : node.instances) place(world[i] * instance);
        }
    }
    return withoutArea;
}

void putAt(MeshInstance& instance, const dmat4& rayFromMesh) {
    const dmat3 linear(rayFromMesh);
    const double determinant = glm::determinant(linear);
    instance.place = rayFromMesh;
    instance.mirrored = determinant < 0;
    instance.rayFromMesh = mat3(linear);
    // The cofactor matrix is the inverse transpose times the determinant: it exists for flat transforms, too.
    instance.normalFromMesh =
        mat3(dmat3(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                   glm::cross(linear[0], linear[1])) *
             (determinant < 0 ? -1.0 : 1.0));
    const std::vector<vec3>& from = instance.mesh->positions;
    for (size_t i = 0; i < from.size(); ++i)
        instance.positions[i] = vec3(dvec3(rayFromMesh * dvec4(dvec3(from[i]), 1)));
}

bool flat(const dmat4& place) { return glm::determinant(dmat3(place)) == 0; }

} // namespace

Result<std::unique_ptr<SurfaceScene>> SurfaceScene::build(const Scene& scene, const dvec3& origin,
                                                          int threads) {
    std::unique_ptr<SurfaceScene> result(new SurfaceScene(scene));
    const size_t withoutArea =
        forEachMesh(scene, origin, [&](const Mesh& mesh, const dmat4& rayFromMesh) {
            result->addMesh(scene, mesh, rayFromMesh);
        });
    result->updateBounds();
    if (withoutArea > 0)
        result->notes_.push_back(fmt::format(
            "{} meshes of lines or points are left out: they have no area for rays", withoutArea));
    if (result->triangleCount_ >= 0xfffffff0u)
        return Error{
            fmt::format("the scene has {} triangles; the reference takes 4 thousand million",
                        result->triangleCount_)};
    if (Result<void> built = result->buildTree(threads); !built.ok()) return built.error();
    return result;
}

void SurfaceScene::addMesh(const Scene& scene, const Mesh& mesh, const dmat4& rayFromMesh) {
    MeshInstance instance;
    instance.mesh = &mesh;
    instance.material = &scene.materialOf(mesh);
    instance.firstEmitter = MeshInstance::kNoEmitter;
    instance.positions.resize(mesh.positions.size() +
                              1); // Embree reads 16 bytes at the last vertex
    putAt(instance, rayFromMesh);
    instance.firstTriangle = uint32_t(triangleCount_);
    triangleCount_ += mesh.indices.size() / 3;
    instances_.push_back(std::move(instance));
}

void SurfaceScene::updateBounds() {
    bounds_ = {};
    for (const MeshInstance& instance : instances_)
        for (size_t i = 0; i < instance.mesh->positions.size(); ++i)
            bounds_.include(dvec3(instance.positions[i]));
}

bool SurfaceScene::move(const Scene& scene, const dvec3& origin, std::vector<uint32_t>& moved) {
    std::vector<std::pair<const Mesh*, dmat4>> places;
    forEachMesh(scene, origin, [&](const Mesh& mesh, const dmat4& rayFromMesh) {
        places.emplace_back(&mesh, rayFromMesh);
    });
    moved.clear();
    if (places.size() != instances_.size()) return false;
    for (uint32_t i = 0; i < places.size(); ++i) {
        if (places[i].first != instances_[i].mesh) return false;
        if (places[i].second == instances_[i].place) continue;
        if (flat(places[i].second) || flat(instances_[i].place)) return false;
        moved.push_back(i);
    }
    if (moved.empty()) return true;
    if (!moves_) { // once; rays through such a tree take somewhat longer
        rtcSetSceneFlags(tree_, RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_DYNAMIC);
        rtcSetSceneBuildQuality(tree_, RTC_BUILD_QUALITY_MEDIUM);
        moves_ = true;
    }
    for (const uint32_t i : moved) {
        putAt(instances_[i], places[i].second);
        RTCGeometry geometry = rtcGetGeometry(tree_, i);
        rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_REFIT);
        rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
        rtcCommitGeometry(geometry);
    }
    rtcCommitScene(tree_);
    updateBounds();
    return rtcGetDeviceError(device_) == RTC_ERROR_NONE;
}

Result<void> SurfaceScene::buildTree(int threads) {
    device_ = rtcNewDevice(threads > 0 ? fmt::format("threads={}", threads).c_str() : nullptr);
    if (!device_)
        return Error{
            fmt::format("Embree does not start: error {}", int(rtcGetDeviceError(nullptr)))};
    tree_ = rtcNewScene(device_);
    rtcSetSceneBuildQuality(tree_, RTC_BUILD_QUALITY_HIGH);
    rtcSetSceneFlags(tree_, RTC_SCENE_FLAG_ROBUST); // no ray slips between two triangles
    for (MeshInstance& instance : instances_) {
        RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        const size_t vertices = instance.mesh->positions.size();
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                   instance.positions.data(), 0, sizeof(vec3), vertices);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                   instance.mesh->indices.data(), 0, 3 * sizeof(uint32_t),
                                   instance.mesh->indices.size() / 3);
        if (instance.material->alphaMode != AlphaMode::Opaque) {
            rtcSetGeometryIntersectFilterFunction(geometry, filterCoverage);
            rtcSetGeometryOccludedFilterFunction(geometry, filterCoverage);
        }
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(tree_, geometry); // numbered in order
        rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(tree_);
    if (const RTCError error = rtcGetDeviceError(device_); error != RTC_ERROR_NONE)
        return Error{
            fmt::format("Embree cannot build its tree over {} triangles: {}", triangleCount_,
                        error == RTC_ERROR_OUT_OF_MEMORY ? std::string("there is not enough memory")
                                                         : fmt::format("error {}", int(error)))};
    return {};
}

SurfaceScene::~SurfaceScene() {
    if (tree_) rtcReleaseScene(tree_);
    if (device_) rtcReleaseDevice(device_);
}

RayHit SurfaceScene::intersect(const Ray& ray, double nearest, double farthest, RayKind kind,
                               uint64_t chance) const {
    RayHit result;
    if (instances_.empty()) return result;
    Context context;
    rtcInitIntersectContext(&context.embree);
    context.scene = this;
    context.chance = chance;
    for (;;) {
        RTCRayHit hit;
        setRay(hit.ray, ray, nearest, farthest);
        hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(tree_, &context.embree, &hit);
        if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return result;
        if (kind == RayKind::Camera) {
            const MeshInstance& instance = instances_[hit.hit.geomID];
            const dvec3 facet = facetOf(instance, hit.hit.primID);
            if (!instance.material->doubleSided && glm::dot(facet, ray.direction) > 0) {
                nearest = double(std::nextafter(hit.ray.tfar, std::numeric_limits<float>::max()));
                continue;
            }
        }
        result.distance = double(hit.ray.tfar);
        result.instance = hit.hit.geomID;
        result.triangle = hit.hit.primID;
        result.u = double(hit.hit.u);
        result.v = double(hit.hit.v);
        return result;
    }
}

bool SurfaceScene::occluded(const Ray& ray, double farthest, uint64_t chance) const {
    if (instances_.empty()) return false;
    Context context;
    rtcInitIntersectContext(&context.embree);
    context.scene = this;
    context.chance = chance;
    RTCRay shadow;
    setRay(shadow, ray, 0, farthest);
    rtcOccluded1(tree_, &context.embree, &shadow);
    return shadow.tfar < 0;
}

std::array<dvec3, 3> SurfaceScene::corners(uint32_t instance, uint32_t triangle) const {
    const uint32_t* corner = &instances_[instance].mesh->indices[3 * size_t(triangle)];
    const std::vector<vec3>& positions = instances_[instance].positions;
    return {dvec3(positions[corner[0]]), dvec3(positions[corner[1]]), dvec3(positions[corner[2]])};
}

uint32_t SurfaceScene::instanceOf(uint32_t triangle) const {
    const auto after = std::upper_bound(
        instances_.begin(), instances_.end(), triangle,
        [](uint32_t t, const MeshInstance& instance) { return t < instance.firstTriangle; });
    return uint32_t(after - instances_.begin() - 1);
}

uint64_t SurfaceScene::coveredPieces(uint32_t instance, uint32_t triangle) const {
    uint64_t covers = 0;
    for (int j = 0; j < kPiecesAlongEdge; ++j)
        for (int i = 0; i + j < kPiecesAlongEdge; ++i)
            for (int upper = 0; upper < (i + j + 1 < kPiecesAlongEdge ? 2 : 1); ++upper) {
                const int piece = pieceNumber(i, j, upper != 0);
                Sampler sampler((uint64_t(instance) << 32) | triangle, uint64_t(piece), 0);
                // A point of the piece, folded into it.
                dvec2 at(sampler.random(), sampler.random());
                if (at.x + at.y > 1) at = 1.0 - at;
                if (upper) at = 1.0 - at;
                at = (dvec2(i, j) + at) / double(kPiecesAlongEdge);
                if (sampler.random() < coverageAt(instance, triangle, at.x, at.y))
                    covers |= 1ull << piece;
            }
    return covers;
}

std::vector<SceneTriangle> SurfaceScene::triangles() const {
    std::vector<SceneTriangle> all(triangleCount_);
    for (uint32_t number = 0; number < instances_.size(); ++number) {
        const MeshInstance& instance = instances_[number];
        const std::vector<uint32_t>& indices = instance.mesh->indices;
        const bool opaque = instance.material->alphaMode == AlphaMode::Opaque;
        tbb::parallel_for(uint32_t(0), uint32_t(indices.size() / 3), [&](uint32_t i) {
            SceneTriangle& triangle = all[instance.firstTriangle + i];
            triangle.corners = corners(number, i);
            if (!opaque) triangle.covers = coveredPieces(number, i);
        });
    }
    return all;
}

VertexValues SurfaceScene::vertexValues(const RayHit& hit) const {
    const Mesh& mesh = *instances_[hit.instance].mesh;
    const uint32_t* corner = &mesh.indices[3 * size_t(hit.triangle)];
    VertexValues values;
    for (size_t set = 0; set < kMaxUvSets; ++set)
        if (!mesh.uvs[set].empty())
            values.uvs[set] =
                mixCorners(dvec2(mesh.uvs[set][corner[0]]), dvec2(mesh.uvs[set][corner[1]]),
                           dvec2(mesh.uvs[set][corner[2]]), hit.u, hit.v);
    if (!mesh.colors.empty())
        values.color = mixCorners(dvec4(mesh.colors[corner[0]]), dvec4(mesh.colors[corner[1]]),
                                  dvec4(mesh.colors[corner[2]]), hit.u, hit.v);
    return values;
}

double SurfaceScene::coverageAt(uint32_t instance, uint32_t triangle, double u, double v) const {
    RayHit hit;
    hit.instance = instance;
    hit.triangle = triangle;
    hit.u = u;
    hit.v = v;
    return materials_.coverage(*instances_[instance].material, vertexValues(hit));
}

SurfacePoint SurfaceScene::pointAt(const Ray& ray, const RayHit& hit) const {
    const MeshInstance& instance = instances_[hit.instance];
    const Mesh& mesh = *instance.mesh;
    const uint32_t* corner = &mesh.indices[3 * size_t(hit.triangle)];
    const dvec3 a(instance.positions[corner[0]]), b(instance.positions[corner[1]]),
        c(instance.positions[corner[2]]);
    SurfacePoint point;
    point.position = mixCorners(a, b, c, hit.u, hit.v);
    const dvec3 largest = glm::max(glm::max(glm::abs(a), glm::abs(b)), glm::abs(c));
    point.margin = kMarginPart * maximumOf(largest);

    const dvec3 toEye = -ray.direction;
    const dvec3 facet = unitOr(facetOf(instance, hit.triangle), toEye);
    const bool front = glm::dot(facet, toEye) >= 0;
    point.surface.geometricNormal = front ? facet : -facet;

    dvec3 interpolated(0);
    if (!mesh.normals.empty())
        interpolated = dmat3(instance.normalFromMesh) *
                       mixCorners(dvec3(mesh.normals[corner[0]]), dvec3(mesh.normals[corner[1]]),
                                  dvec3(mesh.normals[corner[2]]), hit.u, hit.v);
    dvec3 normal = unitOr(interpolated, facet);
    const MaterialValues values = materials_.evaluate(*instance.material, vertexValues(hit));
    if (values.hasNormalTexel && !mesh.tangents.empty()) {
        const dvec4 tangent =
            mixCorners(dvec4(mesh.tangents[corner[0]]), dvec4(mesh.tangents[corner[1]]),
                       dvec4(mesh.tangents[corner[2]]), hit.u, hit.v);
        const dvec3 n = normal, t = unitOr(dmat3(instance.rayFromMesh) * dvec3(tangent), dvec3(0));
        const dvec3 bitangent = glm::cross(n, t) * (mesh.tangents[corner[0]].w < 0 ? -1.0 : 1.0) *
                                (instance.mirrored ? -1.0 : 1.0);
        normal = unitOr(t * values.normalTexel.x + bitangent * values.normalTexel.y +
                            n * values.normalTexel.z,
                        normal);
    }
    point.surface.normal = front ? normal : -normal;
    point.surface.baseColor = values.baseColor;
    point.surface.metallic = values.metallic;
    point.surface.roughness = values.roughness;
    point.surface.specular = values.specular;
    point.unlit = instance.material->unlit || mesh.normals.empty();
    // A one-sided surface glows on its outside alone.
    if (front || instance.material->doubleSided)
        point.emission = point.unlit ? values.baseColor : values.emissive;
    if (instance.firstEmitter != MeshInstance::kNoEmitter)
        point.emitter = instance.firstEmitter + hit.triangle;
    return point;
}

} // namespace tyndall::tracing
