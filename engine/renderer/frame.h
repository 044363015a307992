#pragma once
// The frame as a recipe: frame.cpp reads from top to bottom.

#include "plugin/registry.h"
#include "renderer/blend_pass.h"
#include "renderer/composite_pass.h"
#include "renderer/deferred_lighting_pass.h"
#include "renderer/environment_map.h"
#include "renderer/gbuffer_pass.h"
#include "renderer/gpu_scene.h"
#include "renderer/light_system.h"
#include "renderer/media_system.h"
#include "renderer/medium_march_pass.h"
#include "renderer/tonemap_pass.h"

namespace tyndall {

/// What the renderer keeps from frame to frame.
struct FrameParts {
    GpuScene& surfaces;
    LightSystem& lights;
    MediaSystem& media;
    BlendList& blended;
    EnvironmentMap& environment;
    plugin::PluginRegistry& plugins;
    plugin::SurfaceDrawer& drawer;
    const GBufferSettings& gbufferSettings;
    const SurfaceLightSettings& surfaceLightSettings;
    const PostSettings& postSettings;
};

/// What this frame is to be.
struct FrameOrder {
    ViewResources view;
    const FramePlan* plan = nullptr;
    plugin::SceneState sceneState{};
    const Scene* scene = nullptr;
    dvec3 renderOrigin{0}; // world
    float ev100 = 0;
    uint32_t averagedFrame =
        0;                   // 0: this frame stands alone; else its number in the average, from 1
    uint32_t frameIndex = 0; // as in FrameRequest
    bool separateTerms = false;            // an image a term is wanted
    bool statistics = false;               // numbers about techniques are wanted
    std::span<const Bounds> surfaceBounds; // of everything drawn, render space
};

/// Numbers of one technique: floats, and their names.
struct StatisticsBuffer {
    fg::BufferHandle values;
    std::vector<std::pair<std::string, uint32_t>> elements;
};

/// Handles of what can be read back.
struct FrameImages {
    GBuffer gbuffer;
    fg::TextureHandle transmittance; // of the media before the surfaces; null in vacuum
    TermImages terms;                // averaged where the frame is
    fg::TextureHandle
        beauty; // their sum; averaged where the frame is, alpha then holds squared deviations
    fg::BufferHandle firstInvalid; // see shaders/post/sum.comp
    Display display;
    /// Is a debug view or a post effect in the linear picture? These are given the exposure (plugin::FrameInputs::whiteNits), by which
    /// the LPV's slice and the crosses of virtual lights are made as bright as can be seen.
    bool beautyMayDependOnExposure = false;
    std::vector<StatisticsBuffer> statistics;
};

/// Records the passes of one frame. Everything in `parts` was updated for it.
FrameImages recordFrame(fg::FrameGraph& graph, const FrameParts& parts, const FrameOrder& order);

} // namespace tyndall
