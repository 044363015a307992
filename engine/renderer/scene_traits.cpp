#include "renderer/scene_traits.h"

#include <algorithm>
#include <cmath>

#include "renderer/media_placement.h"

namespace tyndall {
namespace {

/// The mean chord of a cube as large as the box: 4V/S = 2/3 of its edge.
double meanChord(const Bounds& box) {
    const dvec3 extent = box.extent();
    return 2.0 / 3.0 * std::cbrt(extent.x * extent.y * extent.z);
}

/// Optical depth of a medium along a typical way through it, of the channel in the middle. `surfaces`: of a medium without an end what lies around
/// these counts.
double opticalDepthAcross(const Medium& medium, const Bounds& box, const Bounds& surfaces) {
    const vec3 extinction = medium.extinction();
    const double perMetre = double(extinction.y) * (medium.density ? medium.density->meanOfPositive : 1);
    if (!box.empty()) return perMetre * meanChord(box);
    if (surfaces.empty()) return perMetre * (medium.kind == MediumKind::Height ? double(medium.scaleHeight) : 1);
    return perMetre * meanChord(surfaces);
}

} // namespace

SceneTraits sceneTraits(const Scene& scene, bool mediaEnabled) {
    SceneTraits traits;
    traits.lights = maximumOf(scene.environment.radiance) > 0 || scene.environment.image;
    const std::vector<bool> visible = scene.worldVisibility();
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        traits.surfaces |= visible[i] && !scene.nodes[i].meshes.empty();
        traits.lights |= visible[i] && scene.nodes[i].light != kNone;
    }
    for (const Material& material : scene.materials)
        traits.lights |= maximumOf(material.emissive) > 0;
    if (!mediaEnabled) return traits;
    traits.kinds = 0;
    for (const Medium& medium : scene.media) {
        if (maximumOf(medium.scattering) > 0) traits.kinds |= mediaSetOf(medium);
        traits.media |= maximumOf(medium.extinction()) > 0 || maximumOf(medium.emission) > 0;
        traits.scatteringMedia |= maximumOf(medium.scattering) > 0;
        traits.lights |=
            maximumOf(medium.emission) > 0 || (medium.temperature && medium.temperatureScale > 0);
    }
    Bounds surfaces;
    std::vector<Bounds> media(scene.nodes.size());
    scene.forEachBox([&](int node, bool isMedium, const Bounds& box) {
        (isMedium ? media[size_t(node)] : surfaces).include(box);
    });
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        const int medium = scene.nodes[i].medium;
        if (medium == kNone || !visible[i] || maximumOf(scene.media[size_t(medium)].scattering) <= 0)
            continue;
        traits.opticalDepth = std::max(
            traits.opticalDepth, opticalDepthAcross(scene.media[size_t(medium)], media[i], surfaces));
    }
    return traits;
}

} // namespace tyndall
