// A camera inside of an interior. Rays from one point are tested against all triangles in one pass, so that no tree is needed.
#include <algorithm>
#include <cmath>

#include "scene/zero_config.h"

namespace tyndall {
namespace {

constexpr double kFieldOfView = 1.05; // radians, vertical: rooms are looked at with a wide lens
constexpr int kRays = 96;
constexpr double kFrontFaces = 0.85; // of the rays that hit
constexpr double kClosed =
    0.88; // of all rays hit: a courtyard has a sky, but a box that lacks a side hides only 0.83
constexpr double kEyeHeight = 1.6;    // metres
constexpr double kEyeOfHeight = 0.13; // 1.6 m in a hall of 12 m, whatever unit the hall was made in

struct Hit {
    double distance = kInfinity;
    bool front =
        false; // by the order of the corners (glTF 2.0 section 3.7.2.1), whether the material is two-sided or not
};

/// Calls function(a, b, c) for every visible triangle, in world space, counter-clockwise where it shows its front.
template <typename Function> void forEachTriangle(const Scene& scene, Function&& function) {
    const std::vector<dmat4> world = scene.worldTransforms();
    const std::vector<bool> visible = scene.worldVisibility();
    const auto draw = [&](const Mesh& mesh, const dmat4& worldFromLocal) {
        std::vector<dvec3> positions;
        positions.reserve(mesh.positions.size());
        for (const vec3& position : mesh.positions)
            positions.emplace_back(worldFromLocal * dvec4(dvec3(position), 1));
        const bool mirrored = glm::determinant(dmat3(worldFromLocal)) < 0;
        for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
            function(positions[mesh.indices[i]], positions[mesh.indices[i + (mirrored ? 2 : 1)]],
                     positions[mesh.indices[i + (mirrored ? 1 : 2)]]);
    };
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        const Node& node = scene.nodes[i];
        for (const int index : node.meshes) {
            const Mesh& mesh = scene.meshes[size_t(index)];
            if (!visible[i] || mesh.topology != MeshTopology::Triangles) continue;
            if (node.instances.empty()) draw(mesh, world[i]);
            for (const dmat4& instance : node.instances) draw(mesh, world[i] * instance);
        }
    }
}

/// The nearest hit of each ray from `origin`.
std::vector<Hit> cast(const Scene& scene, const dvec3& origin,
                      const std::vector<dvec3>& directions) {
    std::vector<Hit> hits(directions.size());
    forEachTriangle(scene, [&](const dvec3& cornerA, const dvec3& cornerB, const dvec3& cornerC) {
        const dvec3 a = cornerA - origin, b = cornerB - origin, c = cornerC - origin;
        // A ray from the origin passes on one side of all three planes through it and an edge.
        const dvec3 ab = glm::cross(a, b), bc = glm::cross(b, c), ca = glm::cross(c, a);
        const dvec3 normal = ab + bc + ca; // = (b - a) × (c - a)
        const double volume = glm::dot(normal, a);
        for (size_t i = 0; i < directions.size(); ++i) {
            const dvec3& d = directions[i];
            const double u = glm::dot(d, ab), v = glm::dot(d, bc), w = glm::dot(d, ca);
            const bool back = u >= 0 && v >= 0 && w >= 0, front = u <= 0 && v <= 0 && w <= 0;
            if (back == front) continue; // missed, or seen edge-on
            const double distance = volume / glm::dot(normal, d);
            if (distance > 0 && distance < hits[i].distance) hits[i] = {distance, front};
        }
    });
    return hits;
}

/// Evenly over the sphere: a Fibonacci lattice.
std::vector<dvec3> allAround() {
    std::vector<dvec3> directions;
    for (int i = 0; i < kRays; ++i) {
        const double y = 1 - (2 * i + 1.0) / kRays, angle = i * kPi * (3 - std::sqrt(5.0));
        const double radius = std::sqrt(1 - y * y);
        directions.emplace_back(radius * std::cos(angle), y, radius * std::sin(angle));
    }
    return directions;
}

/// Horizontally; opposite directions are kRays / 2 apart.
std::vector<dvec3> toAllSides() {
    std::vector<dvec3> directions;
    for (int i = 0; i < kRays; ++i)
        directions.emplace_back(std::cos(2 * kPi * i / kRays), 0, std::sin(2 * kPi * i / kRays));
    return directions;
}

/// Nearly all that is seen from an interior shows its front; from inside of a solid model one sees backs.
bool isInside(const std::vector<Hit>& hits) {
    double hit = 0, front = 0;
    for (const Hit& one : hits) {
        hit += std::isfinite(one.distance) ? 1 : 0;
        front += one.front ? 1 : 0;
    }
    return hit >= kClosed * double(hits.size()) && front >= kFrontFaces * hit;
}

/// Of what is hit.
double meanDistance(const std::vector<Hit>& hits) {
    double sum = 0, count = 0;
    for (const Hit& hit : hits)
        if (std::isfinite(hit.distance)) {
            sum += hit.distance;
            ++count;
        }
    return sum / count;
}

double missed(const std::vector<Hit>& hits) {
    const auto free = std::count_if(hits.begin(), hits.end(),
                                    [](const Hit& hit) { return !std::isfinite(hit.distance); });
    return double(free) / double(hits.size());
}

/// The mean over the view: at the mean cosine of a surface that faces the lamp's side, ½.
double seenByLamp(const Scene& scene, const Interior& interior, const dvec3& eye,
                  const dvec3& ahead) {
    const dquat rotation = rotationLookingAlong(ahead);
    const double halfHeight = std::tan(0.5 * kFieldOfView), halfWidth = halfHeight * 16 / 9;
    std::vector<dvec3> directions;
    for (int i = 0; i < kRays; ++i) {
        const double x = (i + 0.5) / kRays, y = i * 0.61803399 - std::floor(i * 0.61803399);
        directions.push_back(glm::normalize(
            rotation * dvec3((2 * x - 1) * halfWidth, (2 * y - 1) * halfHeight, -1)));
    }
    const std::vector<Hit> hits = cast(scene, eye, directions);
    double sum = 0, count = 0;
    for (size_t i = 0; i < hits.size(); ++i) {
        if (!std::isfinite(hits[i].distance)) continue;
        const double distance =
            glm::length(eye + hits[i].distance * directions[i] - interior.middle);
        const double ratio = interior.reach / std::max(distance, 0.5 * interior.reach);
        sum += 0.5 * ratio * ratio;
        ++count;
    }
    return count > 0 ? sum / count : 0.5;
}

} // namespace

std::optional<Interior> supplyCameraInside(LoadedScene& loaded) {
    Scene& scene = loaded.scene;
    const Bounds bounds = scene.worldBounds();
    if (scene.activeCamera != kNone || bounds.empty()) return {};
    dvec3 eye = bounds.centre();
    const std::vector<Hit> fromMiddle = cast(scene, eye, allAround());
    if (!isInside(fromMiddle)) return {};
    Interior interior{eye, meanDistance(fromMiddle), missed(fromMiddle), 0};

    const std::vector<Hit> vertical = cast(scene, eye, {dvec3(0, -1, 0), dvec3(0, 1, 0)});
    const double floor = std::max(eye.y - vertical[0].distance, bounds.minimum.y);
    const double ceiling = std::min(eye.y + vertical[1].distance, bounds.maximum.y);
    const double height = ceiling - floor;
    eye.y = floor + std::min(0.5 * height, std::max(kEyeHeight, kEyeOfHeight * height));

    const std::vector<dvec3> sides = toAllSides();
    const std::vector<Hit> around = cast(scene, eye, sides);
    const auto free = [&](size_t i) {
        return std::min(around[i % sides.size()].distance, glm::length(bounds.extent()));
    };
    size_t ahead = 0;
    for (size_t i = 1; i < sides.size(); ++i)
        if (free(i) > free(ahead)) ahead = i;
    // From further back more of the room is in the picture.
    eye -= 0.7 * free(ahead + sides.size() / 2) * sides[ahead];
    double nearest = kInfinity;
    for (const Hit& hit : cast(scene, eye, allAround())) nearest = std::min(nearest, hit.distance);

    Camera camera;
    camera.name = "supplied camera";
    camera.yfov = kFieldOfView;
    camera.znear = 0.05 * std::min(nearest, height); // rays miss what is thin and nearer
    Node node;
    node.name = camera.name;
    node.translation = eye;
    node.rotation = rotationLookingAlong(sides[ahead]);
    node.camera = int(scene.cameras.size());
    scene.cameras.push_back(std::move(camera));
    scene.activeCamera = int(scene.nodes.size());
    scene.nodes.push_back(std::move(node));
    loaded.supplied.push_back("a camera inside the scene, which is closed around its middle");
    interior.seenByLamp = seenByLamp(scene, interior, eye, sides[ahead]);
    return interior;
}

} // namespace tyndall
