#include "tracing/light_emission.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scene/light_flux.h"

namespace tyndall::tracing {
namespace {

dvec3 uniformDirection(const dvec2& u) { return directionAround(1 - 2 * u.x, u.y); }

/// Part of light from infinity that is sampled towards the content, where that is smaller than the whole; the rest goes to boxes around it, each this many times as wide.
constexpr double kToContent = 0.7;
constexpr double kWider = 4;
constexpr size_t kMostBoxes = 16;

/// The last box is around everything: rays per area fall off with the squared distance from the content, like the contribution of light there.
std::vector<Bounds> boxesAround(const Bounds& content, const Bounds& whole) {
    if (whole.empty()) return {};
    std::vector<Bounds> boxes;
    const double least = 1e-6 * glm::length(whole.extent());
    dvec3 half = glm::max(0.5 * content.extent(), dvec3(least));
    const dvec3 centre = glm::clamp(content.centre(), whole.minimum, whole.maximum);
    for (Bounds box = content; !(box.contains(whole.minimum) && box.contains(whole.maximum)) &&
                               boxes.size() < kMostBoxes;) {
        boxes.push_back(box);
        half *= kWider;
        box = {glm::max(centre - half, whole.minimum), glm::min(centre + half, whole.maximum)};
    }
    boxes.push_back(whole);
    return boxes;
}

/// As wide along each axis as the ball around it.
Bounds cubeAround(const Bounds& box) {
    if (box.empty()) return box;
    const dvec3 half(0.5 * glm::length(box.extent()));
    return {box.centre() - half, box.centre() + half};
}

/// Uniform on the shadow that a box casts along a direction: a point of a face by which the direction enters.
dvec3 pointOnShadow(const Bounds& box, const dvec3& direction, const dvec2& u) {
    const dvec3 shadow = projectedFaces(box, direction);
    double target = u.x * (shadow.x + shadow.y + shadow.z);
    int face = 0;
    while (face < 2 && !(target < shadow[face])) target -= shadow[face++];
    while (face > 0 && !(shadow[face] > 0)) --face; // never one that is seen from its edge
    const int one = (face + 1) % 3, other = (face + 2) % 3;
    const double part = shadow[face] > 0 ? std::min(target / shadow[face], 1.0) : 0.5;
    dvec3 point = box.minimum;
    point[face] = direction[face] > 0 ? box.minimum[face] : box.maximum[face];
    point[one] += part * box.extent()[one];
    point[other] += u.y * box.extent()[other];
    return point;
}

/// Does the line through a point meet the box?
bool onShadow(const Bounds& box, const dvec3& point, const dvec3& direction) {
    if (box.empty()) return false;
    double enter = -kInfinity, leave = kInfinity;
    for (int axis = 0; axis < 3; ++axis) {
        double low = box.minimum[axis] - point[axis], high = box.maximum[axis] - point[axis];
        if (direction[axis] == 0) {
            if (low > 0 || high < 0) return false;
            continue;
        }
        low /= direction[axis];
        high /= direction[axis];
        enter = std::max(enter, std::min(low, high));
        leave = std::min(leave, std::max(low, high));
    }
    return enter <= leave;
}

} // namespace

LightEmission::LightEmission(const TracerScene& scene, const Bounds& content,
                             const Bounds& surroundings)
    : scene_(scene) {
    whole_ = scene.surfaces->bounds();
    bool endless = false;
    for (const MediumSource& medium : scene.media->media()) {
        whole_.include(medium.bounds());
        endless |= medium.endless();
    }
    content_ = content.empty() ? whole_ : content;
    near_ = {glm::max(whole_.minimum, surroundings.minimum),
             glm::min(whole_.maximum, surroundings.maximum)};
    if (surroundings.empty() || near_.empty()) near_ = whole_;
    if (endless) {
        whole_ = cubeAround(whole_);
        near_ = cubeAround(near_);
    }
    boxes_ = boxesAround(content_, near_);
    reachesBeyond_ = glm::length(whole_.extent()) > 2 * glm::length(near_.extent());
    const Lights& lights = *scene.lights;
    const auto add = [this](double power) { sums_.push_back(sums_.back() + std::max(0.0, power)); };
    const double area = meanProjectedArea(content_);
    for (const LightSource& lamp : lights.lamps()) add(lamp.power(area));
    add(lights.emittedPower());
    add(lights.environment().black()
            ? 0
            : parallelFlux(pointFlux(lights.environment().meanLuminance()), area));
    add(lights.glow().black() ? 0 : pointFlux(lights.glow().intensity()));
}

/// From outside of the ball around what is near, for single precision has nothing to spare for ways from far away; but where something far away is in the
/// way, from before that.
Ray LightEmission::fromInfinity(const dvec3& direction, double choice, const dvec2& u,
                                double& area) const {
    area = 0;
    if (near_.empty()) return {dvec3(0), direction};
    // Boxes that a direction sees from their edges have no shadow; all of them, where there is more than one.
    const auto shadowOf = [&](size_t box) { return projectedArea(boxes_[box], direction); };
    const size_t last = boxes_.size() - 1;
    const double toContent = last > 0 && shadowOf(0) > 0 ? kToContent : 0.0,
                 toOther = last > 0 ? (1 - toContent) / double(last) : 1.0;
    size_t target = last;
    if (choice < toContent) {
        target = 0;
    } else if (last > 0) {
        target = 1 + std::min(size_t((choice - toContent) / toOther), last - 1);
    }
    dvec3 position = pointOnShadow(boxes_[target], direction, u);
    double density = 0;
    for (size_t box = 0; box <= last; ++box) {
        const double part = box == 0 && last > 0 ? toContent : toOther, shadow = shadowOf(box);
        // A point of a box's face is on that box's shadow, however it was rounded.
        if (part > 0 && shadow > 0 && (box == target || onShadow(boxes_[box], position, direction)))
            density += part / shadow;
    }
    area = density > 0 ? 1 / density : 0;
    const auto outside = [&](const Bounds& box) {
        const double radius = 0.5 * glm::length(box.extent());
        return position - (glm::dot(position - box.centre(), direction) + radius) * direction;
    };
    const dvec3 start = outside(near_);
    if (!reachesBeyond_ || !scene_.surfaces->occluded({start, -direction}, kInfinity, 0))
        return {start, direction};
    return {outside(whole_), direction};
}

EmittedRay LightEmission::sample(Sampler& sampler) const {
    EmittedRay out;
    if (black()) return out;
    const dvec2 choice = sampler.next2(), where = sampler.next2(), way = sampler.next2();
    const double target = choice.x * sums_.back();
    size_t light = size_t(std::upper_bound(sums_.begin(), sums_.end(), target) - sums_.begin());
    light = std::clamp<size_t>(light, 1, sums_.size() - 1) - 1;
    while (light > 0 && !(sums_[light + 1] > sums_[light])) --light; // never one without power
    const double chance = (sums_[light + 1] - sums_[light]) / sums_.back();

    const Lights& lights = *scene_.lights;
    double area = 0;
    if (light < lights.lamps().size()) {
        const LightSource& lamp = lights.lamps()[light];
        if (lamp.local()) {
            out = lamp.emit(where, way);
        } else {
            const LampSample sun = lamp.sample(whole_.empty() ? dvec3(0) : whole_.centre(), way);
            out.ray = fromInfinity(-sun.direction, choice.y, where, area);
            if (sun.density > 0) out.power = sun.radiance * (area / sun.density);
            out.distant = true;
        }
    } else if (light == lights.trianglesIndex()) {
        out = lights.emitFromTriangle(choice.y, where, way);
    } else if (light == lights.environmentIndex()) {
        const DirectionSample sky = lights.environment().sample(way);
        out.ray = fromInfinity(-sky.direction, choice.y, where, area);
        if (sky.density > 0) out.power = sky.radiance * (area / sky.density);
        out.distant = true;
    } else {
        const GlowSample glow = lights.glow().sample(choice.y, where);
        out.ray = {glow.position, uniformDirection(way)};
        if (glow.density > 0) out.power = glow.emission * (4 * kPi / glow.density);
    }
    out.power /= chance;
    if (out.distant && out.power != dvec3(0)) {
        const Ray back{out.ray.origin, -out.ray.direction};
        out.power *=
            transmittance(*scene_.media, back, kInfinity, TransmittanceMode::Exact, sampler);
    }
    return out;
}

} // namespace tyndall::tracing
