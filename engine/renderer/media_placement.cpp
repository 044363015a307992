#include "renderer/media_placement.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

namespace tyndall {
namespace {

constexpr double kEndless =
    1e30; // metres: beyond every scene, and squares of it fit in double precision

Bounds endlessBounds() {
    Bounds bounds;
    bounds.include(dvec3(-kEndless));
    bounds.include(dvec3(kEndless));
    return bounds;
}

Bounds boxOf(const dvec3& halfExtent) {
    Bounds bounds;
    bounds.include(-halfExtent);
    bounds.include(halfExtent);
    return bounds;
}

bool isFinite(const dmat4& m) {
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r)
            if (!std::isfinite(m[c][r])) return false;
    return true;
}

/// False where the transform flattens space: such a medium has no volume.
bool invert(const dmat4& matrix, dmat4& inverse) {
    inverse = glm::inverse(matrix);
    return isFinite(matrix) && isFinite(inverse) && glm::determinant(dmat3(matrix)) != 0.0;
}

/// Local y in metres above the node's origin along its +Y, whatever its scale.
dmat4 heightFromRender(const dmat4& renderFromNode) {
    dvec3 up = glm::normalize(dvec3(renderFromNode[1]));
    if (!std::isfinite(up.x)) up = dvec3(0, 1, 0);
    const dvec3 side =
        glm::normalize(glm::cross(up, std::abs(up.x) < 0.9 ? dvec3(1, 0, 0) : dvec3(0, 0, 1)));
    const dvec3 other = glm::cross(side, up);
    const dvec3 origin(renderFromNode[3]);
    dmat4 m(1.0);
    for (int c = 0; c < 3; ++c) m[c] = dvec4(side[c], up[c], other[c], 0);
    m[3] = dvec4(-glm::dot(side, origin), -glm::dot(up, origin), -glm::dot(other, origin), 1);
    return m;
}

dmat4 renderFromCells(const dmat4& renderFromNode, const BrickGrid& grid) {
    return renderFromNode * grid.worldFromIndex * glm::translate(dmat4(1.0), dvec3(grid.origin));
}

/// False where the grid has no extent.
bool placeGrid(const dmat4& renderFromNode, PlacedMedium& placed) {
    const BrickGrid& grid = *placed.medium->density;
    const dmat4 renderFromCell = renderFromCells(renderFromNode, grid);
    dmat4 inverse;
    if (!invert(renderFromCell, inverse)) return false;
    placed.data.localFromRender = mat4(inverse);
    placed.data.gridBricks = ivec4(grid.brickCount, 0);
    const double edges[3] = {glm::length(dvec3(renderFromCell[0])),
                             glm::length(dvec3(renderFromCell[1])),
                             glm::length(dvec3(renderFromCell[2]))};
    placed.data.voxelSize = float(*std::min_element(edges, edges + 3));
    Bounds cells;
    cells.include(dvec3(0));
    cells.include(dvec3(kBrickCells * grid.brickCount));
    placed.bounds = cells.transformed(renderFromCell);
    const Medium& medium = *placed.medium;
    if (medium.temperatureScale > 0 && medium.temperature && !medium.temperature->bricks.empty()) {
        dmat4 cellFromRender;
        if (!invert(renderFromCells(renderFromNode, *medium.temperature), cellFromRender))
            return true;
        placed.data.temperatureFromRender = mat4(cellFromRender);
        placed.data.temperatureBricks = ivec4(medium.temperature->brickCount, 0);
        placed.data.emission.w = medium.temperatureScale;
    }
    return true;
}

/// False where the medium has no volume.
bool placeShape(const dmat4& renderFromNode, PlacedMedium& placed) {
    const Medium& medium = *placed.medium;
    dmat4 inverse(1.0);
    switch (medium.kind) {
    case MediumKind::Everywhere: placed.bounds = endlessBounds(); break;
    case MediumKind::Height:
        inverse = heightFromRender(renderFromNode);
        placed.bounds = endlessBounds();
        break;
    case MediumKind::Box:
        if (!invert(glm::scale(renderFromNode, medium.size), inverse)) return false;
        placed.bounds = boxOf(0.5 * medium.size).transformed(renderFromNode);
        break;
    case MediumKind::Sphere:
        if (!invert(glm::scale(renderFromNode, 0.5 * medium.size), inverse)) return false;
        placed.bounds = boxOf(0.5 * medium.size).transformed(renderFromNode);
        break;
    case MediumKind::Grid: return placeGrid(renderFromNode, placed);
    }
    placed.data.localFromRender = mat4(inverse);
    return true;
}

bool anyPositive(const vec3& v) { return v.x > 0 || v.y > 0 || v.z > 0; }

bool hasEffect(const Medium& medium) {
    const bool glows =
        anyPositive(medium.emission) || (medium.temperatureScale > 0 && medium.temperature);
    if (!anyPositive(medium.extinction()) && !glows) return false;
    if (medium.kind != MediumKind::Grid) return true;
    return medium.density && medium.density->maximum > 0;
}

/// Planes through the eye instead of the near plane: media count from the eye on.
std::vector<dvec4> mediaFrustum(const gpu::ViewData& view) {
    const mat4 m = glm::transpose(view.clipFromRender);
    const dvec3 forward(view.cameraForward);
    return {dvec4(m[3] + m[0]), dvec4(m[3] - m[0]), dvec4(m[3] + m[1]), dvec4(m[3] - m[1]),
            dvec4(forward, -glm::dot(forward, dvec3(view.cameraPosition)))};
}

bool mayBeSeen(const Bounds& box, const std::vector<dvec4>& planes) {
    if (box.empty()) return false;
    return std::all_of(planes.begin(), planes.end(), [&](const dvec4& plane) {
        // The corner that is farthest inside.
        const dvec3 corner(plane.x > 0 ? box.maximum.x : box.minimum.x,
                           plane.y > 0 ? box.maximum.y : box.minimum.y,
                           plane.z > 0 ? box.maximum.z : box.minimum.z);
        // A millionth of slack for the planes, which come from single precision.
        return glm::dot(dvec3(plane), corner) + plane.w >=
               -1e-6 * (glm::dot(glm::abs(dvec3(plane)), glm::abs(corner)) + std::abs(plane.w));
    });
}

bool overlap(const Bounds& a, const Bounds& b) {
    return glm::all(glm::lessThanEqual(a.minimum, b.maximum)) &&
           glm::all(glm::lessThanEqual(b.minimum, a.maximum));
}

/// Can `medium` meet the box `seen` moved any way against `travel`?
bool upstream(const Bounds& medium, const Bounds& seen, const dvec3& travel) {
    double t0 = 0, t1 = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        const double d = -travel[axis];
        const double low = medium.minimum[axis] - seen.maximum[axis],
                     high = medium.maximum[axis] - seen.minimum[axis];
        if (std::abs(d) < 1e-12) {
            if (low > 0 || high < 0) return false;
            continue;
        }
        t0 = std::max(t0, std::min(low / d, high / d));
        t1 = std::min(t1, std::max(low / d, high / d));
    }
    return t0 <= t1;
}

bool onPathOf(const gpu::LightData& light, const Bounds& medium, const Bounds& seen) {
    const vec4 sample = light.samplePoint;
    if (light.type == gpu::kLightDirectional)
        return upstream(medium, seen, dvec3(light.direction)) ||
               (sample.w > 0 && upstream(medium, seen, dvec3(sample)));
    const dvec3 centre(light.position);
    dvec3 extent = glm::abs(dvec3(light.axisX)) + glm::abs(dvec3(light.axisY));
    if (light.type != gpu::kLightRect) extent = dvec3(double(light.direction.w));
    Bounds lamp;
    lamp.include(centre - extent);
    lamp.include(centre + extent);
    if (light.position.w > 0) {
        Bounds reach;
        reach.include(centre - extent - double(light.position.w));
        reach.include(centre + extent + double(light.position.w));
        if (!overlap(medium, reach)) return false;
    }
    Bounds hull = seen;
    hull.include(lamp);
    return overlap(medium, hull);
}

} // namespace

MediaSet mediaSetOf(const Medium& medium) {
    switch (medium.kind) {
    case MediumKind::Everywhere:
    case MediumKind::Box:
    case MediumKind::Sphere: return kShapeMedia;
    case MediumKind::Height: return kHeightMedia;
    case MediumKind::Grid: return medium.particles ? kParticleMedia : kGridMedia;
    }
    return 0;
}

std::vector<PlacedMedium> placeMedia(const Scene& scene, const dvec3& renderOrigin,
                                     std::vector<std::string>& notes) {
    std::vector<PlacedMedium> placed;
    const std::vector<dmat4> world = scene.worldTransforms();
    const std::vector<bool> visible = scene.worldVisibility();
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        if (scene.nodes[i].medium == kNone || !visible[i]) continue;
        const Medium& medium = scene.media.at(size_t(scene.nodes[i].medium));
        if (!hasEffect(medium)) continue;
        PlacedMedium entry;
        entry.medium = &medium;
        entry.data.kind = uint32_t(medium.kind);
        entry.data.set = mediaSetOf(medium);
        entry.data.phase = uint32_t(medium.phase);
        entry.data.scattering = vec4(medium.scattering, medium.anisotropy);
        entry.data.extinction = vec4(medium.extinction(), float(medium.scaleHeight));
        entry.data.emission = vec4(medium.emission, 0);
        const dmat4 renderFromNode = glm::translate(dmat4(1.0), -renderOrigin) * world[i];
        if (placeShape(renderFromNode, entry))
            placed.push_back(entry);
        else
            notes.push_back("medium '" + medium.name +
                            "' has no volume: its size or a scale above it is 0");
    }
    std::stable_partition(placed.begin(), placed.end(),
                          [](const PlacedMedium& m) { return m.data.kind != gpu::kMediumGrid; });
    return placed;
}

std::vector<MediumUse> classifyMedia(std::span<const PlacedMedium> media, const MediaView& view) {
    std::vector<MediumUse> uses(media.size(), MediumUse::Dropped);
    const std::vector<dvec4> planes = mediaFrustum(*view.view);
    Bounds seen;
    for (const Bounds& surface : view.surfaces)
        if (mayBeSeen(surface, planes)) seen.include(surface);
    for (size_t i = 0; i < media.size(); ++i) {
        if (!mayBeSeen(media[i].bounds, planes)) continue;
        uses[i] = MediumUse::InView;
        seen.include(media[i].bounds);
    }
    if (seen.empty()) return uses;
    for (size_t i = 0; i < media.size(); ++i) {
        if (uses[i] != MediumUse::Dropped) continue;
        for (const gpu::LightData& light : view.lights)
            if (onPathOf(light, media[i].bounds, seen)) {
                uses[i] = MediumUse::OnLightPath;
                break;
            }
    }
    return uses;
}

uint32_t assignPhaseGroups(std::span<PlacedMedium> media, gpu::MediaHeader& header,
                           std::vector<std::string>& notes) {
    uint32_t count = 0;
    for (PlacedMedium& medium : media) {
        if (!anyPositive(medium.medium->scattering)) continue; // any group will do
        // Rayleigh's function has no parameter.
        const vec2 wanted(float(medium.data.phase), medium.data.phase == gpu::kPhaseRayleigh
                                                        ? 0.0f
                                                        : medium.data.scattering.w);
        uint32_t group = 0;
        while (group < count && vec2(header.phases[group]) != wanted) ++group;
        if (group == gpu::kMaxPhaseGroups) {
            const auto difference = [&](const vec4& other) {
                return std::abs(other.y - wanted.y) + (other.x != wanted.x ? 1.0f : 0.0f);
            };
            group = uint32_t(std::min_element(header.phases, header.phases + count,
                                              [&](const vec4& a, const vec4& b) {
                                                  return difference(a) < difference(b);
                                              }) -
                             header.phases);
            notes.push_back("medium '" + medium.medium->name +
                            "' scatters with the phase function of another: a frame has room for " +
                            std::to_string(gpu::kMaxPhaseGroups) + " different ones");
        } else if (group == count) {
            header.phases[count++] = vec4(wanted, 0, 0);
        }
        medium.data.phaseGroup = group;
    }
    return std::max(count, 1u);
}

void countOnRays(std::span<const PlacedMedium> media, const gpu::MediaHeader& header,
                 uint32_t lightCount, MediaResources& resources) {
    const auto steps = [&](double cells) {
        return uint32_t(std::ceil(cells / double(header.stepVoxels)));
    };
    for (const PlacedMedium& medium : media) {
        if (medium.data.kind != gpu::kMediumGrid) {
            resources.stepsOnRay += header.analyticSteps + 2;
            continue;
        }
        const ivec3 bricks(medium.data.gridBricks);
        const auto crossed = uint32_t(bricks.x + bricks.y + bricks.z);
        resources.bricksOnRay += crossed;
        resources.stepsOnRay += crossed + steps(kBrickCells * glm::length(dvec3(bricks)));
    }
    resources.stepsInBrick = std::min(steps(kBrickCells * std::sqrt(3.0)), gpu::kMostBrickSteps);
    const uint32_t stride = std::max(header.environmentStride, 1u);
    resources.lightsAtOnce = lightCount - header.environmentLights +
                             (header.environmentLights + stride - 1) / stride;
}

} // namespace tyndall
