#include "renderer/light_system.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/low_discrepancy.h"
#include "plugin/cache_key.h"
#include "plugin/cached_upload.h"
#include "renderer/emissive_lights.h"
#include "renderer/gpu_scene.h"

namespace tyndall {
namespace {

constexpr double kNearestPart = 1e-5; // of the radius of what is near: no inverse square below it
constexpr size_t kManyLights = 64;    // up to so many, the cutoff drops nothing
constexpr float kWidestDisc = 1.5f;   // radians: a sun's angular radius stays below a half-space

bool finite(const dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

uint32_t shaderType(LightType type) {
    switch (type) {
    case LightType::Directional: return gpu::kLightDirectional;
    case LightType::Point: return gpu::kLightPoint;
    case LightType::Spot: return gpu::kLightSpot;
    case LightType::Rect: return gpu::kLightRect;
    }
    return gpu::kLightPoint;
}

/// Where on the light this frame samples it; every light has its own sequence.
struct FrameSequence {
    uint32_t frame;
    uint64_t key;
};

/// A point in the unit ball whose density goes with 1/√(1 - r²). Seen along any line, as much of it lies in front as behind any other: point
/// lights so spread shine as a Lambertian ball does, evenly over its disc, and each gives a receiver nearly what all give together, where
/// points on the ball's surface would go with their cosine. The first three coordinates of a unit vector in four dimensions are so spread;
/// its uniform distribution is Shoemake's (1992, "Uniform random rotations").
dvec3 pointInBall(const FrameSequence& sequence) {
    const dvec2 a = lowDiscrepancyPoint(sequence.frame, sequence.key),
                b = lowDiscrepancyPoint(sequence.frame, fg::mixHash(sequence.key, 1));
    const double s = std::sqrt(1.0 - a.x), c = std::sqrt(a.x), p = 2.0 * kPi * a.y,
                 q = 2.0 * kPi * b.x;
    return {s * std::sin(p), s * std::cos(p), c * std::sin(q)};
}

/// A direction in which a sun with a disc travels, uniform by solid angle.
dvec3 sunDirection(const gpu::LightData& light, const FrameSequence& sequence) {
    const dvec2 u = lowDiscrepancyPoint(sequence.frame, sequence.key);
    const double z = 1.0 - u.x * (1.0 - std::cos(double(light.direction.w))),
                 s = std::sqrt(std::max(0.0, 1.0 - z * z)), azimuth = 2.0 * kPi * u.y;
    const dvec3 axis(light.direction);
    const dvec3 x =
        glm::normalize(glm::cross(axis, std::abs(axis.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0)));
    const dvec3 y = glm::cross(axis, x);
    return glm::normalize(x * (s * std::cos(azimuth)) + y * (s * std::sin(azimuth)) + axis * z);
}

/// A point on the light that stands for all of it in this frame; see light.glsl for the weights.
void setSamplePoint(gpu::LightData& light, const FrameSequence& sequence) {
    const double radius = double(light.direction.w);
    if (light.type == gpu::kLightRect) {
        const dvec2 u = lowDiscrepancyPoint(sequence.frame, sequence.key);
        const dvec3 point = dvec3(light.position) + (2.0 * u.x - 1.0) * dvec3(light.axisX) +
                            (2.0 * u.y - 1.0) * dvec3(light.axisY);
        light.samplePoint = vec4(vec3(point), 1.0f);
    } else if (radius > 0 && light.type == gpu::kLightDirectional) {
        light.samplePoint = vec4(vec3(sunDirection(light, sequence)), 1.0f);
        // A disc of constant radiance gives E on a surface that faces its centre: its mean is 2E/(1 + cos) by solid angle.
        light.intensity *= vec4(vec3(float(2.0 / (1.0 + std::cos(radius)))), 1.0f);
    } else if (radius > 0) {
        light.samplePoint =
            vec4(vec3(dvec3(light.position) + radius * pointInBall(sequence)), 1.0f);
    }
}

} // namespace

void LightSystem::registerSettings(SettingsRegistry& registry) {
    registry.add({lightSettingsTable(), &lightSettings_});
    registry.add({shadowSettingsTable(), &shadowSettings_});
    registry.addPreset(lightPresets());
}

void LightSystem::collectLight(const Light& light, const dmat4& worldFromNode, int node,
                               const dvec3& origin) {
    const auto leaveOut = [&](const char* why) {
        sceneNotes_.push_back(fmt::format("light '{}' is left out: {}", light.name, why));
    };
    Collected c;
    c.node = node;
    c.castsShadows = light.castsShadows;
    const bool rect = light.type == LightType::Rect;
    const dvec3 power = rect ? dvec3(light.radiance) : dvec3(light.color) * double(light.intensity);
    const dvec3 position = dvec3(worldFromNode[3]) - origin;
    if (!finite(power) || !finite(position)) return leaveOut("its numbers are not finite");
    if (std::min({power.x, power.y, power.z}) < 0) return leaveOut("its power is negative");
    if (std::max({power.x, power.y, power.z}) == 0) return leaveOut("its power is zero");

    dvec3 forward = -dvec3(worldFromNode[2]);
    gpu::LightData& data = c.data;
    data.type = shaderType(light.type);
    data.shadowIndex = -1;
    data.position = vec4(vec3(position), std::max(light.range, 0.0f));
    data.intensity = vec4(vec3(power), 0);
    c.strength = std::max({power.x, power.y, power.z});
    if (rect) {
        const dvec3 x = 0.5 * double(light.size.x) * dvec3(worldFromNode[0]),
                    y = 0.5 * double(light.size.y) * dvec3(worldFromNode[1]);
        const dvec3 normal = glm::cross(x, y);
        const double quarter = glm::length(normal);
        if (!(quarter > 0) || !std::isfinite(quarter)) return leaveOut("its area is zero");
        // Across the plane, also where the node is sheared, and out of the side that -Z points to.
        forward = glm::dot(normal, forward) < 0 ? -normal : normal;
        data.axisX = vec4(vec3(x), 0);
        data.axisY = vec4(vec3(y), 0);
        data.intensity.w = float(4.0 * quarter);
        data.position.w = 0;
        c.strength *= 4.0 * quarter;
    }
    const double length = glm::length(forward);
    const bool needsDirection = light.type != LightType::Point;
    if (needsDirection && !(length > 0 && std::isfinite(length)))
        return leaveOut("its node's scale leaves it no direction");
    data.direction =
        vec4(length > 0 && std::isfinite(length) ? vec3(forward / length) : vec3(0, 0, -1),
             rect ? 0 : std::max(light.radius, 0.0f));
    if (light.type == LightType::Directional)
        data.direction.w = std::min(data.direction.w, kWidestDisc);
    if (light.type == LightType::Spot) {
        const double outer = std::clamp(double(light.outerConeAngle), 0.0, kPi / 2);
        if (!(outer > 0)) return leaveOut("its cone is closed");
        data.axisX.w = float(std::cos(std::clamp(double(light.innerConeAngle), 0.0, outer)));
        data.axisY.w = float(std::cos(outer));
    }
    if (data.type == gpu::kLightPoint || data.type == gpu::kLightSpot) c.reach = data.position.w;
    collected_.push_back(c);
}

void LightSystem::collect(const LightFrame& frame) {
    const Scene& scene = *frame.scene;
    const SceneVersions& now = scene.versions;
    if (scene_ != &scene || seen_.structure != now.structure ||
        seen_.transforms != now.transforms || seen_.lights != now.lights ||
        seen_.meshes != now.meshes || seen_.materials != now.materials ||
        seen_.media != now.media || seenOrigin_ != frame.renderOrigin) {
        seen_ = now;
        seenOrigin_ = frame.renderOrigin;
        collected_.clear();
        sceneNotes_.clear();
        const std::vector<dmat4> transforms = scene.worldTransforms();
        const std::vector<bool> visible = scene.worldVisibility();
        for (int node = 0; node < int(scene.nodes.size()); ++node) {
            const int light = scene.nodes[size_t(node)].light;
            if (light == kNone || !visible[size_t(node)]) continue;
            collectLight(scene.lights.at(size_t(light)), transforms[size_t(node)], node,
                         frame.renderOrigin);
        }
        EmissiveLights emissive = findEmissiveLights(scene, transforms, visible);
        for (const EmissiveLight& found : emissive.lights)
            collectLight(found.light, found.worldFromLight, found.node, frame.renderOrigin);
        std::move(emissive.notes.begin(), emissive.notes.end(), std::back_inserter(sceneNotes_));
    }
    if (scene_ != &scene || seenEnvironment_ != scene.environment.version) {
        seenEnvironment_ = scene.environment.version;
        environment_ = EnvironmentSampler(scene.environment);
    }
    collectMedia(frame);
    setScale(frame);
    scene_ = &scene;
}

void LightSystem::setScale(const LightFrame& frame) {
    reachRadius_ = frame.withLamps.empty() ? 0.0 : 0.5 * glm::length(frame.withLamps.extent());
    if (!(reachRadius_ > 0) || !std::isfinite(reachRadius_))
        reachRadius_ = std::max(double(frame.view->data.cameraForward.w), 1e-6);
    for (Collected& c : collected_)
        if (c.data.type == gpu::kLightPoint || c.data.type == gpu::kLightSpot)
            c.data.intensity.w = float(kNearestPart * reachRadius_);
}

/// A grid's light is summed up voxel by voxel: only when a medium has changed.
void LightSystem::collectMedia(const LightFrame& frame) {
    const Scene& scene = *frame.scene;
    if (scene_ == &scene && seenMedia_ == scene.versions.media &&
        seenMediaTransforms_ == scene.versions.transforms &&
        seenMediaStructure_ == scene.versions.structure &&
        mediaParts_ == lightSettings_.mediumLights)
        return;
    seenMedia_ = scene.versions.media;
    seenMediaTransforms_ = scene.versions.transforms;
    seenMediaStructure_ = scene.versions.structure;
    mediaParts_ = lightSettings_.mediumLights;
    media_ =
        findMediumEmitters(scene, scene.worldTransforms(), scene.worldVisibility(), mediaParts_);
}

void LightSystem::addEnvironment(const LightFrame& frame, std::vector<Collected>& all) {
    if (environment_.black()) return;
    const gpu::ViewData& view = frame.view->data;
    const bool converge = (view.flags & gpu::kViewConverge) != 0;
    for (const EnvironmentLight& light :
         converge
             ? environment_.sample(lightSettings_.environmentLights, view.frameIndex, view.seed)
             : environment_.lights(lightSettings_.environmentLights)) {
        Collected c;
        c.data.type = gpu::kLightDirectional;
        c.data.flags = gpu::kLightFromEnvironment;
        c.data.direction = vec4(vec3(-light.toLight), 0);
        c.data.intensity = vec4(vec3(light.illuminance), 0);
        c.data.shadowIndex = -1;
        c.strength = std::max({light.illuminance.x, light.illuminance.y, light.illuminance.z});
        all.push_back(c);
    }
}

void LightSystem::addMedia(const LightFrame& frame, std::vector<Collected>& all) {
    const gpu::ViewData& view = frame.view->data;
    const bool converge = (view.flags & gpu::kViewConverge) != 0;
    for (size_t i = 0; i < media_.emitters.size() && !frame.mediaOff; ++i) {
        const MediumEmitter& emitter = media_.emitters[i];
        const uint64_t key = fg::mixHash(uint64_t(view.seed) + 67, uint64_t(media_.nodes[i]));
        for (const MediumLight& light :
             converge ? emitter.sample(view.frameIndex, key) : emitter.lights()) {
            Collected c;
            c.node = media_.nodes[i];
            c.strength = std::max({light.intensity.x, light.intensity.y, light.intensity.z});
            if (!(c.strength > 0)) continue;
            c.data.type = gpu::kLightPoint;
            c.data.position = vec4(vec3(light.position - frame.renderOrigin), 0);
            c.data.direction = vec4(0, 0, -1, float(light.radius));
            // In averaged frames the rest comes from shaders/media/near_glow.glsl.
            const double nearest = kNearestPart * reachRadius_;
            c.data.intensity =
                vec4(vec3(light.intensity),
                     float(converge ? std::max(nearest, media_.nearDistance) : nearest));
            c.data.flags = gpu::kLightFromMedium;
            c.data.shadowIndex = -1;
            all.push_back(c);
        }
    }
}

/// Lights without a range of their own get one where there are many: all that is dropped together stays below `cutoff` of the
/// illuminance that all of them would give from a scene's radius away.
void LightSystem::setReach(std::vector<Collected>& all, bool converge) const {
    size_t local = 0;
    double strength = 0;
    for (const Collected& c : all)
        if (c.data.type != gpu::kLightDirectional) ++local, strength += c.strength;
    if (converge || !(lightSettings_.cutoff > 0) || local <= kManyLights) return;
    const double least =
        double(lightSettings_.cutoff) * strength / (reachRadius_ * reachRadius_) / double(local);
    for (Collected& c : all) {
        if (c.data.type == gpu::kLightDirectional) continue;
        const double size =
            c.data.type == gpu::kLightRect
                ? double(glm::length(vec3(c.data.axisX)) + glm::length(vec3(c.data.axisY)))
                : double(c.data.direction.w);
        const double reach = std::sqrt(c.strength / least) + size;
        if (c.reach <= 0 || reach < double(c.reach)) c.reach = float(reach);
    }
}

void LightSystem::chooseShadows(const LightFrame& frame, const std::vector<Collected>& all) {
    struct Candidate {
        uint32_t light;
        double score;
    };
    std::vector<Candidate> candidates;
    std::vector<uint32_t> chosen;
    const dvec3 eye(frame.view->data.cameraPosition);
    for (uint32_t i = 0; i < all.size(); ++i) {
        if (!all[i].castsShadows || (lights_[i].flags & gpu::kLightFromEnvironment) != 0) continue;
        const double distance =
            std::max(glm::length(dvec3(lights_[i].position) - eye), 1e-2 * reachRadius_);
        const bool directional = lights_[i].type == gpu::kLightDirectional;
        candidates.push_back(
            {i, directional ? all[i].strength : all[i].strength / (distance * distance)});
    }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
    const size_t most = size_t(std::max(shadowSettings_.maxLights, 0));
    if (shadowSettings_.enabled && !frame.casters.empty() && candidates.size() > most)
        notes_.push_back(fmt::format("{} of {} lights cast no shadows: shadows.maxLights is {}",
                                     candidates.size() - most, candidates.size(), most));
    for (size_t i = 0; i < std::min(candidates.size(), most); ++i)
        chosen.push_back(candidates[i].light);
    for (uint32_t i = 0; i < all.size(); ++i)
        if ((lights_[i].flags & gpu::kLightFromEnvironment) != 0) chosen.push_back(i);
    plan_ = planShadows(lights_, chosen, {frame.casters, frame.surroundings, frame.view}, shadowSettings_);
    if (plan_.lightsDropped > 0)
        notes_.push_back(fmt::format(
            "{} lights cast no shadows: their maps do not fit into shadows.atlasLayers = {} layers",
            plan_.lightsDropped, shadowSettings_.atlasLayers));
    else if (plan_.shrunk > 0)
        notes_.push_back(fmt::format(
            "shadow maps are {} times smaller than set, to fit into shadows.atlasLayers = {} layers",
            1 << plan_.shrunk, shadowSettings_.atlasLayers));
}

void LightSystem::update(const LightFrame& frame) {
    CHECK(frame.scene && frame.view, "lights are made from a scene for a view");
    collect(frame);
    notes_ = sceneNotes_;
    notes_.insert(notes_.end(), media_.notes.begin(), media_.notes.end());
    if (environment_.brokenPixels() > 0)
        notes_.push_back(fmt::format(
            "{} pixels of the environment are negative or not finite, and count as black",
            environment_.brokenPixels()));
    const bool converge = (frame.view->data.flags & gpu::kViewConverge) != 0;
    std::vector<Collected> all = collected_;
    addMedia(frame, all);
    addEnvironment(frame, all);
    setReach(all, converge);
    std::stable_partition(all.begin(), all.end(), [](const Collected& c) { return c.reach <= 0; });

    lights_.clear();
    balls_.clear();
    nodes_.clear();
    globalCount_ = 0;
    for (const Collected& c : all) {
        gpu::LightData data = c.data;
        // Numbered by node, so that a light keeps its sequence when others come and go.
        if (converge)
            setSamplePoint(data, {frame.view->data.frameIndex,
                                  fg::mixHash(uint64_t(frame.view->data.seed) + 31,
                                              uint64_t(uint32_t(c.node)))});
        lights_.push_back(data);
        nodes_.push_back(c.node);
        if (c.reach <= 0)
            ++globalCount_;
        else
            balls_.push_back(vec4(vec3(data.position), c.reach + data.direction.w));
    }
    chooseShadows(frame, all);
}

LightResources LightSystem::addPasses(fg::FrameGraph& graph, const GpuScene& scene,
                                      const ViewResources& view, bool shadows) {
    LightResources resources;
    resources.lightCount = uint32_t(lights_.size());
    resources.sceneLightCount =
        uint32_t(std::count_if(lights_.begin(), lights_.end(), [](const gpu::LightData& light) {
            return (light.flags & gpu::kLightFromEnvironment) == 0;
        }));
    resources.softShadows =
        (view.data.flags & gpu::kViewConverge) == 0 &&
        std::any_of(plan_.views.begin(), plan_.views.end(),
                    [](const gpu::ShadowView& shadow) { return shadow.searchTaps > 0; });
    resources.lights =
        addCachedUpload(graph, "lights.upload", "lights", lights_.data(),
                        lights_.size() * sizeof(gpu::LightData),
                        cacheKey(std::as_bytes(std::span(lights_))));
    const ShadowResources maps = shadows_.addPasses(graph, scene, plan_, view, shadows);
    resources.shadowAtlas = maps.atlas;
    resources.shadowViews = maps.views;
    resources.clusters = addLightClusterPass(graph, view, balls_, globalCount_, lightSettings_);
    return resources;
}

} // namespace tyndall
