#include "renderer/emissive_lights.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

namespace tyndall {
namespace {

/// The light starts this part of its size off the surface, which must not shadow it.
constexpr double kOffSurface = 1e-3;

bool glows(const Material& material) { return material.emissive != vec3(0) && !material.unlit; }

/// A plane's light, out of its front (+Y) or, for `side` -1, out of its back.
EmissiveLight planeLight(const Primitive& plane, const Material& material, const dmat4& world,
                         double side) {
    EmissiveLight result;
    result.light.type = LightType::Rect;
    result.light.size = vec2(plane.size.x, plane.size.z);
    result.light.radiance = material.emissive;
    // -Z of the light is ±Y of the plane, its X the plane's, its Y the plane's Z.
    const dmat4 planeFromLight(dvec4(1, 0, 0, 0), dvec4(0, 0, 1, 0), dvec4(0, -side, 0, 0),
                               dvec4(0, 0, 0, 1));
    result.worldFromLight = world * planeFromLight;
    const dvec3 x = dvec3(world[0]) * plane.size.x, z = dvec3(world[2]) * plane.size.z;
    const dvec3 normal = glm::cross(z, x);
    const double length = glm::length(normal);
    if (length > 0) {
        const double outwards = glm::dot(normal, dvec3(world[1])) < 0 ? -1 : 1;
        result.worldFromLight[3] +=
            dvec4(side * outwards * kOffSurface * std::min(glm::length(x), glm::length(z)) *
                      (normal / length),
                  0);
    }
    return result;
}

/// Empty where the transform makes no ball of it.
std::optional<EmissiveLight> ballLight(const Primitive& ball, const Material& material,
                                       const dmat4& world) {
    const dvec3 radii(0.5 * ball.size.x * glm::length(dvec3(world[0])),
                      0.5 * ball.size.y * glm::length(dvec3(world[1])),
                      0.5 * ball.size.z * glm::length(dvec3(world[2])));
    const double radius = (radii.x + radii.y + radii.z) / 3;
    if (!(radius > 0) || glm::length(radii - dvec3(radius)) > 1e-3 * radius) return {};
    EmissiveLight result;
    result.light.type = LightType::Point;
    result.light.radius = float(radius);
    // A Lambertian ball of radiance L has the intensity πr²·L.
    result.light.color = material.emissive;
    result.light.intensity = float(kPi * radius * radius);
    result.worldFromLight = dmat4(1.0);
    result.worldFromLight[3] = world[3];
    return result;
}

} // namespace

EmissiveLights findEmissiveLights(const Scene& scene, const std::vector<dmat4>& world,
                                  const std::vector<bool>& visible) {
    EmissiveLights result;
    const auto add = [&result](EmissiveLight light, int node, const std::string& name) {
        light.node = node;
        light.light.name = name;
        result.lights.push_back(std::move(light));
    };
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        const Node& node = scene.nodes[i];
        if (!visible[i]) continue;
        const auto glowing = std::find_if(node.meshes.begin(), node.meshes.end(), [&](int mesh) {
            return glows(scene.materialOf(scene.meshes[size_t(mesh)]));
        });
        if (glowing == node.meshes.end()) continue;
        const Material& material = scene.materialOf(scene.meshes[size_t(*glowing)]);
        const bool even = material.emissiveTexture.texture == kNone &&
                          material.alphaMode == AlphaMode::Opaque && node.instances.empty();
        if (even && node.primitive && node.primitive->shape == PrimitiveShape::Plane) {
            add(planeLight(*node.primitive, material, world[i], 1), int(i), node.name);
            if (material.doubleSided)
                add(planeLight(*node.primitive, material, world[i], -1), int(i), node.name);
            continue;
        }
        if (even && node.primitive && node.primitive->shape == PrimitiveShape::Sphere)
            if (auto ball = ballLight(*node.primitive, material, world[i])) {
                add(*ball, int(i), node.name);
                continue;
            }
        result.notes.push_back(fmt::format(
            "'{}' glows, but direct light is only had from evenly glowing planes and balls: it lights nothing",
            node.name));
    }
    return result;
}

} // namespace tyndall
