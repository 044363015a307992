#include "scene/scene_reach.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tyndall {
namespace {

constexpr double kWidestGap = 4;     // times the longest side of a cluster
constexpr size_t kMostClusters = 64; // more would cost more than they save
constexpr double kSpeck = 0.01;      // size over distance
constexpr double kSpread = 12;       // diffusion lengths: exp(-12) = 6e-6
constexpr double kVisible = 4;       // mean free paths: exp(-4) = 0.018
constexpr double kManyTimes = 4;     // a medium is wide that is so many times as long as light goes to both sides
constexpr double kMargin = 0.1;      // radians around the view that count as seen: what is there soon will be

double longest(const Bounds& b) {
    if (b.empty()) return 0;
    const dvec3 extent = b.extent();
    return std::max({extent.x, extent.y, extent.z});
}

double gap(const Bounds& a, const Bounds& b) {
    return glm::length(
        glm::max(glm::max(a.minimum - b.maximum, b.minimum - a.maximum), dvec3(0)));
}

Bounds inflated(const Bounds& b, double by) {
    return b.empty() ? b : Bounds{b.minimum - by, b.maximum + by};
}

/// How far light goes in a homogeneous medium, of the channel in which it goes farthest.
WideMedium reachInside(const Medium& medium) {
    WideMedium wide;
    for (int c = 0; c < 3; ++c) {
        const double absorption = double(medium.absorption[c]),
                     scattering =
                         double(medium.scattering[c]) * (1 - double(medium.anisotropy)),
                     extinction = absorption + scattering;
        if (!(extinction > 0)) return {{}, kInfinity, kInfinity};
        wide.visible = std::max(wide.visible, kVisible / extinction);
        // The diffusion length; never less than the mean free path, which it is where light is hardly scattered.
        const double length =
            std::max(1 / std::sqrt(3 * absorption * extinction), 1 / extinction);
        wide.spread = std::max(wide.spread, kSpread * length);
    }
    return wide;
}

bool isWide(const Medium& medium, const Bounds& box, WideMedium& wide) {
    if (medium.kind != MediumKind::Box && medium.kind != MediumKind::Sphere) return false;
    wide = reachInside(medium);
    wide.box = box;
    return longest(box) > kManyTimes * 2 * std::min(wide.visible, wide.spread);
}

/// Takes out of `boxes` what belongs with the largest of them.
SceneCluster takeCluster(std::vector<Bounds>& boxes) {
    SceneCluster cluster;
    cluster.things = *std::max_element(boxes.begin(), boxes.end(), [](auto& a, auto& b) {
        return longest(a) < longest(b);
    });
    std::vector<Bounds> taken;
    for (bool grown = true; grown;) {
        // What is far smaller has to be nearer: a house at the foot of a mountain stands for itself.
        const double size = longest(cluster.things);
        const auto first = std::partition(boxes.begin(), boxes.end(), [&](const Bounds& box) {
            return gap(box, cluster.things) > kWidestGap * std::sqrt(size * longest(box));
        });
        grown = first != boxes.end();
        for (auto box = first; box != boxes.end(); ++box) cluster.things.include(*box);
        taken.insert(taken.end(), first, boxes.end());
        boxes.erase(first, boxes.end());
    }
    cluster.content = contentOf(std::move(taken));
    cluster.withLamps = cluster.things;
    return cluster;
}

/// To the cluster that it is nearest to, if it is near; else it stands for itself.
void addLamp(std::vector<SceneCluster>& clusters, const dvec3& place) {
    const Bounds lamp{place, place};
    SceneCluster* nearest = nullptr;
    for (SceneCluster& cluster : clusters)
        if (!nearest || gap(lamp, cluster.things) < gap(lamp, nearest->things)) nearest = &cluster;
    if (nearest && gap(lamp, nearest->things) <= kWidestGap * longest(nearest->things))
        nearest->withLamps.include(place);
    else if (clusters.size() < kMostClusters)
        clusters.push_back({{}, {}, lamp});
}

bool isSeen(const Bounds& box, const Viewer& viewer) {
    if (box.empty()) return false;
    const dvec3 way = box.centre() - viewer.eye;
    const double distance = glm::length(way), radius = 0.5 * glm::length(box.extent());
    if (distance <= radius) return true;
    const double angle =
        std::acos(std::clamp(glm::dot(way, viewer.forward) / distance, -1.0, 1.0));
    return angle - std::asin(std::min(radius / distance, 1.0)) < viewer.halfAngle + kMargin;
}

/// Size over distance; infinite from within.
double apparentSize(const Bounds& box, const dvec3& eye) {
    return longest(box) / std::max(gap(box, {eye, eye}), 1e-300);
}

/// What of a wide medium lies within `far` of `others` and of the eye.
Bounds partOf(const WideMedium& wide, Bounds others, const dvec3& eye, double far) {
    if (!std::isfinite(far)) return wide.box;
    // In whole steps: a lattice that lies around it stays where it is while somebody walks.
    const double step = 0.5 * far;
    others.include(glm::round(eye / step) * step);
    return intersection(wide.box, inflated(others, far));
}

} // namespace

bool SceneReach::operator==(const SceneReach& other) const {
    const auto same = [](const Bounds& a, const Bounds& b) {
        return a.minimum == b.minimum && a.maximum == b.maximum;
    };
    return same(surroundings, other.surroundings) && same(content, other.content) &&
           same(withLamps, other.withLamps) && same(seen, other.seen);
}

SceneClusters findClusters(const Scene& scene, bool withoutMedia) {
    SceneClusters found;
    std::vector<Bounds> boxes;
    scene.forEachBox([&](int node, bool isMedium, const Bounds& box) {
        if (isMedium && withoutMedia) return;
        WideMedium wide;
        if (isMedium && isWide(scene.media[size_t(scene.nodes[size_t(node)].medium)], box, wide))
            found.wide.push_back(wide);
        else
            boxes.push_back(box);
    });
    while (!boxes.empty() && found.clusters.size() + 1 < kMostClusters)
        found.clusters.push_back(takeCluster(boxes));
    if (!boxes.empty()) {
        SceneCluster rest;
        for (const Bounds& box : boxes) rest.things.include(box);
        rest.content = rest.withLamps = rest.things;
        found.clusters.push_back(rest);
    }
    const std::vector<dmat4> world = scene.worldTransforms();
    const std::vector<bool> visible = scene.worldVisibility();
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        const int light = scene.nodes[i].light;
        if (visible[i] && light != kNone &&
            scene.lights[size_t(light)].type != LightType::Directional)
            addLamp(found.clusters, dvec3(world[i][3]));
    }
    return found;
}

SceneReach reachOf(const SceneClusters& scene, const Viewer& viewer) {
    SceneReach reach;
    const SceneCluster* widest = nullptr;
    const auto size = [&](const SceneCluster& c) { return apparentSize(c.withLamps, viewer.eye); };
    for (const SceneCluster& cluster : scene.clusters) {
        if (!widest || size(cluster) > size(*widest)) widest = &cluster;
        const bool seen = isSeen(cluster.withLamps, viewer);
        if (seen) reach.seen.include(cluster.things);
        if (size(cluster) < kSpeck) continue;
        reach.surroundings.include(cluster.things);
        reach.withLamps.include(cluster.withLamps);
        if (seen) reach.content.include(cluster.content);
    }
    if (widest && reach.withLamps.empty()) {
        reach.surroundings = widest->things;
        reach.withLamps = widest->withLamps;
    }
    if (widest && reach.content.empty()) reach.content = widest->content;
    const SceneReach others = reach;
    for (const WideMedium& wide : scene.wide) {
        const bool inside = wide.box.contains(viewer.eye);
        const double seen = std::min(wide.visible, wide.spread);
        const Bounds surroundings =
            inside ? partOf(wide, others.withLamps, viewer.eye, wide.spread) : wide.box;
        reach.surroundings.include(surroundings);
        reach.withLamps.include(surroundings);
        Bounds content = others.content;
        content.include(others.withLamps);
        reach.content.include(inside ? partOf(wide, content, viewer.eye, seen) : wide.box);
    }
    return reach;
}

SceneReach reachOfLargest(const SceneClusters& scene) {
    SceneReach reach;
    if (!scene.clusters.empty()) {
        const SceneCluster& largest = scene.clusters.front();
        reach = {largest.things, largest.content, largest.withLamps, {}};
    }
    // Fog alone is what there is to see.
    if (reach.surroundings.empty())
        for (const WideMedium& wide : scene.wide) {
            reach.surroundings.include(wide.box);
            reach.content.include(wide.box);
            reach.withLamps.include(wide.box);
        }
    return reach;
}

} // namespace tyndall
