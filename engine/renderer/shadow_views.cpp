#include "renderer/shadow_views.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/low_discrepancy.h"
#include "framegraph/hash.h"

namespace tyndall {
namespace {

constexpr int kBorder = 4;       // texels around a map that only filters see
constexpr int kSmallestMap = 16; // texels
constexpr double kNearPart =
    1e-5; // near distance of perspective maps, of the radius of what is near; reversed depth bears it
constexpr double kWidestSpot = kPi / 3; // half angle; wider ones are drawn as six faces

struct Frustum {
    dmat4 clipFromRender{1.0};
    double texelSize = 0; // metres, at distance 1 (perspective) or anywhere
    double range = 0;     // near distance or depth range
    bool perspective = false;
    bool empty = false; // nothing in it can be lit
};

/// One light's maps before they have a place in the atlas.
struct PlannedLight {
    uint32_t light = 0;
    int side = 0;
    int count = 0;
};

int powerOfTwo(int value) { return int(std::bit_floor(unsigned(std::max(value, kSmallestMap)))); }

void perpendiculars(const dvec3& forward, dvec3& right, dvec3& up) {
    const dvec3 pole = std::abs(forward.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(0, 0, 1);
    right = glm::normalize(glm::cross(forward, pole));
    up = glm::cross(right, forward);
}

/// From rows of an affine or perspective map.
dmat4 fromRows(const dvec4& x, const dvec4& y, const dvec4& z, const dvec4& w) {
    return glm::transpose(dmat4(x, y, z, w));
}

/// `tangent`: of half the angle that the map must show. Reversed depth near/distance, far plane at infinity.
Frustum perspectiveFrustum(const dvec3& from, const dvec3& right, const dvec3& up,
                           const dvec3& forward, double tangent, double nearDistance, int side,
                           const dvec2& jitter) {
    const double t = tangent * side / double(side - 2 * kBorder);
    const dvec4 w(forward, -glm::dot(forward, from));
    const dvec4 x = dvec4(right, -glm::dot(right, from)) / t + w * (2.0 * jitter.x / side);
    const dvec4 y = dvec4(up, -glm::dot(up, from)) / t + w * (2.0 * jitter.y / side);
    Frustum frustum;
    frustum.clipFromRender = fromRows(x, y, dvec4(0, 0, 0, nearDistance), w);
    frustum.texelSize = 2.0 * t / side;
    frustum.range = nearDistance;
    frustum.perspective = true;
    return frustum;
}

/// An interval of the light's own coordinates: along right and up, metres.
struct Window {
    dvec2 centre{0}, halfSize{0};
};

/// What light from infinity falls on, and what may stand in its way.
struct Casters {
    Bounds near; // of those that are near: what the maps must show
    std::vector<Bounds> beyond;
    const ViewResources* view = nullptr;
};

Casters castersOf(const ShadowRequest& request) {
    Casters casters;
    casters.view = request.view;
    Bounds all;
    for (const Bounds& caster : request.casters) all.include(caster);
    casters.near = {glm::max(all.minimum, request.surroundings.minimum),
                    glm::min(all.maximum, request.surroundings.maximum)};
    if (casters.near.empty()) casters.near = all;
    for (const Bounds& caster : request.casters)
        if (!casters.near.contains(caster.minimum) || !casters.near.contains(caster.maximum))
            casters.beyond.push_back(caster);
    return casters;
}

/// Directional light: what surrounds its maps.
struct LightSpace {
    dvec3 right, up, forward;
    double nearest = 0, range = 0; // along forward, from the first caster to the end of what is near
    Window near;
};

/// Casters that stand before what is near are in its maps, however far away.
LightSpace lightSpaceOf(const dvec3& forward, const Casters& casters) {
    LightSpace space;
    space.forward = forward;
    perpendiculars(forward, space.right, space.up);
    dvec3 low(kInfinity),
        high(-kInfinity);
    for (int i = 0; i < 8; ++i) {
        const dvec3 corner((i & 1) ? casters.near.maximum.x : casters.near.minimum.x,
                           (i & 2) ? casters.near.maximum.y : casters.near.minimum.y,
                           (i & 4) ? casters.near.maximum.z : casters.near.minimum.z);
        const dvec3 p(glm::dot(space.right, corner), glm::dot(space.up, corner),
                      glm::dot(forward, corner));
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    // A little room, so that nothing lies on the edge and a flat scene has depth.
    const double room = 1e-3 * glm::length(high - low);
    space.near.centre = 0.5 * dvec2(low + high);
    space.near.halfSize = 0.5 * dvec2(high - low) + room;
    // Depth is reversed: it is precise at the end of what is near, wherever the first caster stands.
    double first = low.z;
    for (const Bounds& caster : casters.beyond) {
        const dvec3 centre = caster.centre(), half = 0.5 * caster.extent();
        const auto along = [&](const dvec3& axis) {
            return dvec2(glm::dot(axis, centre), glm::dot(glm::abs(axis), half));
        };
        const dvec2 x = along(space.right), y = along(space.up), z = along(forward);
        if (std::abs(x[0] - space.near.centre.x) <= space.near.halfSize.x + x[1] &&
            std::abs(y[0] - space.near.centre.y) <= space.near.halfSize.y + y[1])
            first = std::min(first, z[0] - z[1]);
    }
    space.nearest = first - room;
    space.range = std::max(high.z - first + 2.0 * room, 1e-30);
    return space;
}

Frustum parallelFrustum(const LightSpace& space, const Window& window, int side,
                        const dvec2& jitter) {
    const dvec2 half = window.halfSize * (double(side) / double(side - 2 * kBorder));
    const dvec4 x(space.right / half.x, -window.centre.x / half.x + 2.0 * jitter.x / side);
    const dvec4 y(space.up / half.y, -window.centre.y / half.y + 2.0 * jitter.y / side);
    const dvec4 z(-space.forward / space.range, 1.0 + space.nearest / space.range);
    Frustum frustum;
    frustum.clipFromRender = fromRows(x, y, z, dvec4(0, 0, 0, 1));
    frustum.texelSize = 2.0 * std::max(half.x, half.y) / side;
    frustum.range = space.range;
    return frustum;
}

/// Balls around the slices of the view's frustum, nearest first, all but the last slice (that one is the whole scene). They
/// depend on the camera's lens and on the distances alone, so that a turning camera changes no size.
struct Slice {
    dvec3 centre;
    double radius;
};
std::vector<Slice> viewSlices(const gpu::ViewData& view, const Bounds& near,
                              const ShadowSettings& settings) {
    std::vector<Slice> slices;
    if ((view.flags & gpu::kViewOrthographic) != 0 || settings.cascades < 2) return slices;
    const dvec3 eye(view.cameraPosition), forward(view.cameraForward);
    double farthest = 0;
    for (int i = 0; i < 8; ++i)
        farthest =
            std::max(farthest, glm::length(dvec3((i & 1) ? near.maximum.x : near.minimum.x,
                                                 (i & 2) ? near.maximum.y : near.minimum.y,
                                                 (i & 4) ? near.maximum.z : near.minimum.z) -
                                           eye));
    // In steps of a quarter octave of the scene's size, so that small moves change nothing; between the steps lies the centre
    // of the scene, a place where cameras like to be.
    const double diagonal = glm::length(near.extent());
    if (!(diagonal > 0)) return slices;
    farthest =
        diagonal * std::exp2((std::ceil(4.0 * std::log2(farthest / diagonal) + 0.5) - 0.5) / 4.0);
    const double nearDistance = std::max(double(view.cameraPosition.w), 1e-3 * farthest);
    if (!(farthest > 2.0 * nearDistance)) return slices;
    // Half the diagonal of the view at distance 1, from the unjittered scale of the matrix: |clip row| = 1/tan.
    const dmat4 clip(view.clipFromRender);
    const dvec4 w(clip[0][3], clip[1][3], clip[2][3], clip[3][3]);
    const auto tangent = [&](int row) {
        dvec3 r(clip[0][row], clip[1][row], clip[2][row]);
        r -= forward * glm::dot(r, forward);
        return 1.0 / std::max(glm::length(r), 1e-12);
    };
    // Rounded up: the matrix is in single precision and its noise turns with the camera.
    const double tanX = tangent(0), tanY = tangent(1),
                 diagonal2 = (std::round((tanX * tanX + tanY * tanY) * 4096.0) + 1.0) / 4096.0;
    double begin = 0;
    for (int i = 1; i < settings.cascades; ++i) {
        const double part = double(i) / settings.cascades;
        const double even = nearDistance + (farthest - nearDistance) * part;
        const double ratio = nearDistance * std::pow(farthest / nearDistance, part);
        const double end = std::lerp(even, ratio, double(settings.cascadeSplit));
        // Smallest ball around the slice, centre on the axis.
        double middle = std::min(0.5 * (begin + end) * (1.0 + diagonal2), end);
        const double radius =
            std::sqrt(std::max((end - middle) * (end - middle) + end * end * diagonal2,
                               (begin - middle) * (begin - middle) + begin * begin * diagonal2));
        slices.push_back({eye + forward * middle, radius});
        begin = end;
    }
    return slices;
}

/// Centres snap to whole texels: the map's grid is fixed in the scene and edges do not swim.
Window snappedWindow(const LightSpace& space, const Slice& slice, int side) {
    const double texel = 2.0 * slice.radius / double(side - 2 * kBorder - 2);
    const dvec2 centre(glm::dot(space.right, slice.centre), glm::dot(space.up, slice.centre));
    return {glm::round(centre / texel) * texel, dvec2(0.5 * texel * double(side - 2 * kBorder))};
}

std::vector<Frustum> directionalViews(const gpu::LightData& light, const Casters& casters,
                                      const ShadowSettings& settings, int side,
                                      const dvec2& jitter) {
    const dvec3 forward =
        glm::normalize(dvec3(light.samplePoint.w > 0 ? light.samplePoint : light.direction));
    const LightSpace space = lightSpaceOf(forward, casters);
    std::vector<Frustum> views;
    if ((light.flags & gpu::kLightFromEnvironment) == 0)
        for (const Slice& slice : viewSlices(casters.view->data, casters.near, settings)) {
            if (slice.radius >= std::max(space.near.halfSize.x, space.near.halfSize.y)) break;
            views.push_back(
                parallelFrustum(space, snappedWindow(space, slice, side), side, jitter));
        }
    views.push_back(parallelFrustum(space, space.near, side, jitter));
    return views;
}

std::vector<Frustum> localViews(const gpu::LightData& light, double nearDistance, int side,
                                const dvec2& jitter) {
    const bool inBall = light.samplePoint.w > 0;
    const dvec3 from(inBall ? light.samplePoint : light.position);
    // Light leaves a ball at its surface: what is inside, or the lamp's own glass, casts no shadow. (Seen from its middle; ballAround
    // does the same for a point elsewhere in it.)
    if (!inBall && light.type != gpu::kLightRect)
        nearDistance = std::max(nearDistance, 1.001 * double(light.direction.w));
    std::vector<Frustum> views;
    if (light.type == gpu::kLightSpot && double(light.axisY.w) >= std::cos(kWidestSpot)) {
        const dvec3 forward = glm::normalize(dvec3(light.direction));
        dvec3 right, up;
        perpendiculars(forward, right, up);
        const double cosine = std::min(double(light.axisY.w), std::cos(1e-3));
        views.push_back(perspectiveFrustum(from, right, up, forward,
                                           std::sqrt(1.0 - cosine * cosine) / cosine, nearDistance,
                                           side, jitter));
        return views;
    }
    for (int face = 0; face < 6; ++face) {
        dvec3 forward(0), right(0);
        forward[face / 2] = (face & 1) ? -1.0 : 1.0;
        right[(face / 2 + 1) % 3] = 1.0;
        const dvec3 up = glm::cross(right, forward);
        Frustum view =
            perspectiveFrustum(from, right, up, forward, 1.0, nearDistance, side, jitter);
        if (light.type != gpu::kLightPoint) {
            // A spot's cone and a rect's light stay on one side of a plane: does any corner of the face reach there?
            double most = -1;
            for (int corner = 0; corner < 4; ++corner)
                most = std::max(most, glm::dot(dvec3(light.direction),
                                               forward + ((corner & 1) ? right : -right) +
                                                   ((corner & 2) ? up : -up)));
            view.empty = most <= 1e-6;
        }
        views.push_back(view);
    }
    return views;
}

int sideOf(const gpu::LightData& light, const ShadowSettings& settings, int shrunk) {
    int wanted = settings.resolution;
    if (light.type == gpu::kLightDirectional) {
        if ((light.flags & gpu::kLightFromEnvironment) != 0)
            wanted = settings.environmentResolution;
    } else if (light.type != gpu::kLightSpot || double(light.axisY.w) < std::cos(kWidestSpot)) {
        wanted = settings.localResolution;
    }
    return std::max(std::min(powerOfTwo(wanted), powerOfTwo(settings.atlasSize)) >> shrunk,
                    kSmallestMap);
}

uint64_t hashView(const Frustum& frustum, const gpu::ShadowView& view, uint64_t salt) {
    uint64_t hash = fg::mixHash(salt, uint64_t(view.layer) << 32 | uint64_t(view.atlas.x));
    hash = fg::mixHash(hash, uint64_t(view.atlas.y) << 32 | uint64_t(view.atlas.z));
    const mat4 clip(frustum.clipFromRender);
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; r += 2)
            hash = fg::mixHash(hash, uint64_t(std::bit_cast<uint32_t>(clip[c][r])) << 32 |
                                         std::bit_cast<uint32_t>(clip[c][r + 1]));
    return hash;
}

/// Squares of powers of two, largest first, along a Z-curve through the layers: each lies on a multiple of its own size.
class Atlas {
public:
    Atlas(int size, int layers) : cells_(size / kSmallestMap), layers_(layers) {}
    /// Cells that squares of this side take.
    static uint64_t cellsOf(int side) {
        return uint64_t(side / kSmallestMap) * uint64_t(side / kSmallestMap);
    }
    void place(gpu::ShadowView& view, int side) {
        const uint64_t perLayer = uint64_t(cells_) * uint64_t(cells_);
        uint32_t x = 0, y = 0;
        const uint64_t within = next_ % perLayer;
        for (int bit = 0; bit < 31; ++bit) {
            x |= uint32_t(within >> (2 * bit) & 1u) << bit;
            y |= uint32_t(within >> (2 * bit + 1) & 1u) << bit;
        }
        view.atlas = vec4(float(x * kSmallestMap), float(y * kSmallestMap), float(side),
                          float(cells_ * kSmallestMap));
        view.layer = int(next_ / perLayer);
        CHECK(view.layer < layers_, "shadow maps outgrew the atlas that was sized for them");
        next_ += cellsOf(side);
    }

private:
    int cells_, layers_;
    uint64_t next_ = 0;
};

/// This frame's offset of a light's texel grid, -½..½ texels.
dvec2 jitterOf(const gpu::ViewData& view, uint32_t light) {
    if ((view.flags & gpu::kViewConverge) == 0) return dvec2(0);
    return lowDiscrepancyPoint(view.frameIndex, fg::mixHash(uint64_t(view.seed) + 77, light)) - 0.5;
}

gpu::ShadowView describe(const Frustum& frustum, int count, bool soft,
                         const ShadowSettings& settings) {
    gpu::ShadowView view{};
    const dmat4 shadowFromClip =
        fromRows({0.5, 0, 0, 0.5}, {0, 0.5, 0, 0.5}, {0, 0, 1, 0}, {0, 0, 0, 1});
    view.shadowFromRender = mat4(shadowFromClip * frustum.clipFromRender);
    view.bias = vec4(float(frustum.texelSize), frustum.perspective ? 1.0f : 0.0f,
                     float(frustum.range), float(kBorder - 1));
    view.count = count;
    view.taps = settings.taps;
    view.searchTaps = soft ? settings.searchTaps : 0;
    return view;
}

/// How many maps the light gets; the same for every size of them.
int viewCount(const gpu::LightData& light, const Casters& casters,
              const ShadowSettings& settings) {
    if (light.type == gpu::kLightDirectional)
        return int(directionalViews(light, casters, settings, 256, dvec2(0)).size());
    return int(localViews(light, 1.0, 256, dvec2(0)).size());
}

uint64_t cellsWanted(std::span<const gpu::LightData> lights, std::span<const PlannedLight> planned,
                     const ShadowSettings& settings, int shrunk) {
    uint64_t cells = 0;
    for (const PlannedLight& p : planned)
        cells += uint64_t(p.count) * Atlas::cellsOf(sideOf(lights[p.light], settings, shrunk));
    return cells;
}

/// Halves the maps until all fit, then gives up lights from the end; sizes the atlas to what is left.
void fitAtlas(std::span<const gpu::LightData> lights, std::vector<PlannedLight>& planned,
              const ShadowSettings& settings, ShadowPlan& plan) {
    const int fullSize = powerOfTwo(settings.atlasSize);
    const uint64_t capacity =
        Atlas::cellsOf(fullSize) * uint64_t(std::max(settings.atlasLayers, 1));
    while (cellsWanted(lights, planned, settings, plan.shrunk) > capacity &&
           (fullSize >> plan.shrunk) > kSmallestMap)
        ++plan.shrunk;
    while (cellsWanted(lights, planned, settings, plan.shrunk) > capacity) {
        planned.pop_back();
        ++plan.lightsDropped;
    }
    const uint64_t cells = cellsWanted(lights, planned, settings, plan.shrunk);
    plan.atlasSize = fullSize;
    int largest = kSmallestMap;
    for (PlannedLight& p : planned) {
        p.side = sideOf(lights[p.light], settings, plan.shrunk);
        largest = std::max(largest, p.side);
    }
    while (plan.atlasSize > largest && Atlas::cellsOf(plan.atlasSize / 2) >= cells)
        plan.atlasSize /= 2;
    const uint64_t perLayer = Atlas::cellsOf(plan.atlasSize);
    plan.layers = int((cells + perLayer - 1) / perLayer);
}

/// The ball of light that its maps look out of in averaged frames, a little larger, for its own glass lies on it; radius 0: none.
vec4 ballAround(const gpu::LightData& light) {
    const bool inBall = light.samplePoint.w > 0 &&
                        (light.type == gpu::kLightPoint || light.type == gpu::kLightSpot);
    return inBall ? vec4(vec3(light.position), 1.001f * light.direction.w) : vec4(0);
}

} // namespace

ShadowPlan planShadows(std::span<gpu::LightData> lights, std::span<const uint32_t> chosen,
                       const ShadowRequest& request, const ShadowSettings& settings) {
    ShadowPlan plan;
    for (gpu::LightData& light : lights) light.shadowIndex = -1;
    if (request.casters.empty() || chosen.empty() || !settings.enabled) return plan;
    CHECK(request.view, "shadows are planned for a view");

    const Casters casters = castersOf(request);
    std::vector<PlannedLight> planned;
    for (const uint32_t light : chosen)
        planned.push_back({light, 0, viewCount(lights[light], casters, settings)});
    fitAtlas(lights, planned, settings, plan);
    if (planned.empty()) return plan;
    // Not by importance: places in the atlas, and with them kept maps, stay while importances change.
    std::sort(planned.begin(), planned.end(), [](const PlannedLight& a, const PlannedLight& b) {
        return a.side != b.side ? a.side > b.side : a.light < b.light;
    });

    const gpu::ViewData& view = request.view->data;
    const bool converge = (view.flags & gpu::kViewConverge) != 0;
    // The longest way that light may take here: distances below a part of it cannot be told from zero.
    const double radius = 0.5 * glm::length(casters.near.extent());
    Atlas atlas(plan.atlasSize, plan.layers);
    for (const PlannedLight& p : planned) {
        gpu::LightData& light = lights[p.light];
        const dvec2 jitter = jitterOf(view, p.light);
        const std::vector<Frustum> frusta =
            light.type == gpu::kLightDirectional
                ? directionalViews(light, casters, settings, p.side, jitter)
                : localViews(light, std::max(kNearPart * radius, 1e-30), p.side, jitter);
        CHECK(int(frusta.size()) <= p.count, "a light has more shadow maps than were counted");
        const bool soft = !converge && (light.type == gpu::kLightRect || light.direction.w > 0);
        light.shadowIndex = int(plan.views.size());
        const vec4 ball = ballAround(light);
        for (const Frustum& frustum : frusta) {
            gpu::ShadowView entry = describe(frustum, int(frusta.size()), soft, settings);
            // Many of them overlap: that blurs their edges more than a filter does.
            if ((light.flags & gpu::kLightFromEnvironment) != 0)
                entry.taps = (settings.taps + 3) / 4;
            atlas.place(entry, p.side);
            uint64_t key = hashView(frustum, entry, converge ? 1 : 0);
            for (int i = 0; i < 4; ++i) key = fg::mixHash(key, std::bit_cast<uint32_t>(ball[i]));
            if (frustum.empty) entry.atlas.z = 0;
            plan.views.push_back(entry);
            plan.clipFromRender.push_back(mat4(frustum.clipFromRender));
            plan.balls.push_back(ball);
            plan.keys.push_back(key);
        }
    }
    return plan;
}

} // namespace tyndall
