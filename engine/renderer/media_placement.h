#pragma once
// Media placed in render space, and which of them a frame needs. No GL here.

#include <span>
#include <string>
#include <vector>

#include "plugin/frame_resources.h"
#include "scene/scene.h"
#include "shared/light.h"
#include "shared/medium.h"
#include "transport/media_kinds.h"

namespace tyndall {

/// One medium of one node, as shaders will see it. Brick tables and phase groups are filled in later.
struct PlacedMedium {
    gpu::MediumData data{};
    Bounds bounds; // render space; without end for Everywhere and Height
    const Medium* medium = nullptr;
};

/// The kind of a medium as techniques tell them apart: one bit.
[[nodiscard]] MediaSet mediaSetOf(const Medium& medium);

/// Every visible medium that absorbs, scatters or emits, those with grids last. Transforms are computed in double precision.
/// Media that cannot be rendered are left out, with a sentence each in `notes`.
std::vector<PlacedMedium> placeMedia(const Scene& scene, const dvec3& renderOrigin,
                                     std::vector<std::string>& notes);

/// What decides whether a medium matters. Everything in render space.
struct MediaView {
    const gpu::ViewData* view = nullptr;
    std::span<const Bounds> surfaces; // of everything drawn
    std::span<const gpu::LightData> lights;
};

enum class MediumUse { Dropped, OnLightPath, InView };

/// Conservative: a medium is dropped only where no ray from the eye and no path from a light to anything in view can meet it.
std::vector<MediumUse> classifyMedia(std::span<const PlacedMedium> media, const MediaView& view);

/// Gives each medium its group of equal phase functions and writes the groups; returns their number (at least 1). Beyond
/// kMaxPhaseGroups a medium joins the most alike group, with a sentence in `notes`.
uint32_t assignPhaseGroups(std::span<PlacedMedium> media, gpu::MediaHeader& header,
                           std::vector<std::string>& notes);

/// How much a ray meets at most: bricksOnRay and so on. Brick tables are filled in. `lightCount`: with the environment's.
void countOnRays(std::span<const PlacedMedium> media, const gpu::MediaHeader& header,
                 uint32_t lightCount, MediaResources& resources);

} // namespace tyndall
