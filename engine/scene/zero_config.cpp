#include "scene/zero_config.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "media/grid_import.h"
#include "scene/scene_reach.h"

namespace tyndall {
namespace {

constexpr double kFieldOfView = 0.8; // radians, vertical
constexpr double kSunLux = 10;
constexpr double kSkyNits = 0.5;
constexpr double kOpticalDepth = 4;
constexpr double kAlbedo = 0.99;

bool emits(const Scene& scene) {
    if (scene.environment.image || scene.environment.radiance != vec3(0)) return true;
    for (const Mesh& mesh : scene.meshes)
        if (scene.materialOf(mesh).emissive != vec3(0)) return true;
    for (const Medium& medium : scene.media)
        if (medium.emission != vec3(0) || medium.temperatureScale > 0) return true;
    return std::any_of(scene.nodes.begin(), scene.nodes.end(),
                       [](const Node& node) { return node.light != kNone; });
}

double luminance(const vec3& color) {
    return 0.2126 * double(color.x) + 0.7152 * double(color.y) + 0.0722 * double(color.z);
}

/// The lux that the light would put on a facing surface in the middle of the scene, in vacuum, unshadowed.
double illuminance(const Light& light, double distance) {
    const double squared = distance * distance;
    if (light.type == LightType::Directional)
        return luminance(light.color) * double(light.intensity);
    if (light.type == LightType::Rect)
        return luminance(light.radiance) * double(light.size.x) * double(light.size.y) / squared;
    return luminance(light.color) * double(light.intensity) / squared;
}

} // namespace

dquat rotationLookingAlong(const dvec3& forward) {
    const dvec3 upHint = std::abs(forward.y) > 0.999 ? dvec3(0, 0, 1) : dvec3(0, 1, 0);
    const dvec3 right = glm::normalize(glm::cross(forward, upHint));
    return glm::normalize(glm::quat_cast(dmat3(right, glm::cross(right, forward), -forward)));
}

void supplyCamera(LoadedScene& loaded) {
    Scene& scene = loaded.scene;
    if (scene.activeCamera != kNone) return;
    Bounds bounds = reachOfLargest(findClusters(scene)).surroundings;
    if (bounds.empty()) bounds.include(dvec3(0));
    const double radius =
        std::max(0.5 * glm::length(bounds.extent()), 1e-6 * (1 + glm::length(bounds.centre())));
    const dvec3 forward = glm::normalize(dvec3(-0.45, -0.3, -1));
    // The ball around the bounds fits between the upper and the lower edge of the picture.
    const double distance = 1.02 * radius / std::sin(0.5 * kFieldOfView);
    Camera camera;
    camera.name = "supplied camera";
    camera.yfov = kFieldOfView;
    camera.znear = 1e-3 * radius;
    Node node;
    node.name = camera.name;
    node.translation = bounds.centre() - distance * forward;
    node.rotation = rotationLookingAlong(forward);
    node.camera = int(scene.cameras.size());
    scene.cameras.push_back(std::move(camera));
    scene.activeCamera = int(scene.nodes.size());
    scene.nodes.push_back(std::move(node));
    const bool all = bounds.contains(scene.worldBounds().minimum) &&
                     bounds.contains(scene.worldBounds().maximum);
    loaded.supplied.push_back(all || scene.worldBounds().empty()
                                  ? "a camera that frames the scene"
                                  : "a camera that frames what stands together; other things "
                                    "are far away from it");
}

bool supplyLight(LoadedScene& loaded, const std::optional<Interior>& interior) {
    Scene& scene = loaded.scene;
    if (emits(scene)) return false;
    Light sun;
    sun.name = "supplied sun";
    sun.type = LightType::Directional;
    sun.intensity = float(kSunLux);
    Node node;
    node.name = sun.name;
    node.rotation = rotationLookingAlong(glm::normalize(dvec3(0.5, -1, -0.6)));
    node.light = int(scene.lights.size());
    scene.lights.push_back(std::move(sun));
    scene.nodes.push_back(std::move(node));
    scene.environment.radiance = vec3(float(kSkyNits));
    loaded.supplied.push_back(
        fmt::format("a sun of {} lux and a sky of {} nits", kSunLux, kSkyNits));
    if (!interior) return false;
    Light inside; // as bright on what is around it as the sun is outside
    inside.name = "supplied lamp";
    inside.intensity = float(std::min(kSunLux * interior->reach * interior->reach, 1e30));
    Node holder;
    holder.name = inside.name;
    holder.translation = interior->middle;
    holder.light = int(scene.lights.size());
    loaded.supplied.push_back(
        fmt::format("a lamp of {:.3g} candela in the middle", double(inside.intensity)));
    scene.lights.push_back(std::move(inside));
    scene.nodes.push_back(std::move(holder));
    return true;
}

void supplyExposure(LoadedScene& loaded, const std::optional<Interior>& interior) {
    Scene& scene = loaded.scene;
    const Bounds bounds = reachOfLargest(findClusters(scene)).surroundings;
    const dvec3 centre = bounds.empty() ? dvec3(0) : bounds.centre();
    const double radius = bounds.empty() ? 1 : std::max(0.5 * glm::length(bounds.extent()), 1e-9);
    const std::vector<dmat4> world = scene.worldTransforms();
    double lux = scene.environment.image ? kPi * double(scene.environment.intensity) * 0.5
                                         : kPi * luminance(scene.environment.radiance);
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        if (scene.nodes[i].light == kNone) continue;
        // A light inside the scene lights what is near it; half the scene's size away is typical.
        const double distance = std::max(glm::length(dvec3(world[i][3]) - centre), 0.5 * radius);
        lux += illuminance(scene.lights[size_t(scene.nodes[i].light)], distance);
    }
    double brightest = 0;
    for (const Mesh& mesh : scene.meshes)
        brightest = std::max(brightest, luminance(scene.materialOf(mesh).emissive));
    lux += 0.1 * kPi * brightest; // an emitter that fills a tenth of the view
    if (interior) // the sun and the sky come in by the openings
        lux = kSunLux * interior->seenByLamp +
              interior->open * (kSunLux + kPi * luminance(scene.environment.radiance));
    if (!(lux > 0) || !std::isfinite(lux)) return;
    scene.ev100 = float(std::round(2 * std::clamp(std::log2(lux / 2.5), -20.0, 40.0)) / 2);
    loaded.supplied.push_back(fmt::format("an exposure of EV100 {} for the {:.3g} lux that arrive",
                                          double(scene.ev100), lux));
}

Result<void> supplyMedium(LoadedScene& loaded, const std::filesystem::path& file,
                          const std::string& grid) {
    GridRequest request;
    request.density = grid;
    auto grids = importGrid(file, request);
    if (!grids) return grids.error();
    Medium medium;
    medium.name = file.stem().string();
    medium.kind = MediumKind::Grid;
    medium.file = file.filename().string();
    medium.gridName = grids->densityName;
    medium.density = grids->density;
    const dvec3 extent =
        medium.density->indexBounds().transformed(medium.density->worldFromIndex).extent();
    const double largest = std::max({extent.x, extent.y, extent.z}),
                 mean = medium.density->meanOfPositive;
    if (largest > 0 && mean > 0 && std::isfinite(largest)) {
        const double extinction = std::clamp(kOpticalDepth / (largest * mean), 1e-30, 1e30);
        medium.scattering = vec3(float(kAlbedo * extinction));
        medium.absorption = vec3(float((1 - kAlbedo) * extinction));
        loaded.supplied.push_back(fmt::format(
            "a medium for grid '{}': extinction {:.3g} per metre and unit of density, albedo {}",
            grids->densityName, extinction, kAlbedo));
    }
    for (std::string& note : grids->notes) loaded.notes.push_back(std::move(note));
    Node node;
    node.name = medium.name;
    node.medium = int(loaded.scene.media.size());
    loaded.scene.media.push_back(std::move(medium));
    loaded.scene.nodes.push_back(std::move(node));
    return {};
}

} // namespace tyndall
