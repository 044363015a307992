#pragma once
// Resources that passes hand to each other: handles grouped by meaning, and how a command binds each group.
// Plugins see exactly this.

#include <cstdint>

#include "framegraph/frame_graph.h"
#include "shared/light.h"
#include "shared/medium.h"
#include "shared/view.h"

namespace tyndall {

/// Deferred surfaces, view-sized. Depth is reversed: 0 where no surface is.
struct GBuffer {
    fg::TextureHandle depth; // Depth32F
    fg::TextureHandle
        normal; // RG16Snorm ×2 packed as RGBA16: shading and geometric normal, octahedral
    fg::TextureHandle base;     // RGBA16: base colour, metallic
    fg::TextureHandle material; // RGBA16: roughness, specular, occlusion, flags
    fg::TextureHandle emissive; // RGBA32F: nits
};

/// Lights, their clusters and shadow maps.
struct LightResources {
    fg::BufferHandle lights; // LightData[]
    fg::BufferHandle
        clusters; // offsets and counts, then light indices (shaders/lighting/clusters.glsl)
    fg::BufferHandle shadowViews;  // ShadowView[]
    fg::TextureHandle shadowAtlas; // Depth32F array
    uint32_t lightCount = 0;      // with environment samples
    uint32_t sceneLightCount = 0; // without them
    bool softShadows =
        true; // the define SOFT_SHADOWS: a shadow of this frame has a penumbra
};

struct MediaResources {
    fg::BufferHandle media;             // MediaHeader, then MediumData[]
    fg::BufferHandle bricks;            // BrickData[] of all grids
    fg::BufferHandle blackbody;         // radiance by temperature
    fg::StaticTexture atlas;            // R32F 3D: brick samples of density and temperature grids
    fg::BufferHandle opticalDepthViews; // OpticalDepthView[], by light
    fg::TextureHandle
        opticalDepth; // light-space optical depth of the grids; null where no light has a volume
    fg::StaticTexture noOpticalDepth; // bound in its place then
    uint32_t count =
        0; // media in view or between a light and the view; 0: bind nothing, include nothing
    uint32_t kinds = 0; // the define MEDIA_KINDS: kMediaShapes and so on in shared/medium.h
    uint32_t phaseGroups =
        1; // the define PHASE_GROUPS: 1 where one phase function is enough, else 8
    // How much a ray meets at most, for plugin/shader_rounds.h; grids in steps, not cell by cell.
    uint32_t bricksOnRay = 0;  // of all grids
    uint32_t stepsInBrick = 0; // of one
    uint32_t stepsOnRay = 0;   // through all media
    uint32_t lightsAtOnce = 0; // that a point of a march gathers straight, with the environment's
};

/// The define MEDIA_KINDS for a shader; `towardsLights`: it needs optical depth towards lights. Some combinations share
/// a variant, so that there are not too many.
inline int32_t mediaKinds(const MediaResources& media, bool towardsLights) {
    uint32_t kinds = media.kinds;
    if (!towardsLights || (kinds & gpu::kMediaExactGrids) != 0) kinds &= ~gpu::kMediaLightVolumes;
    if (media.phaseGroups > 1 && (kinds & gpu::kMediaGrids) != 0) kinds |= gpu::kMediaShapes;
    return int32_t(kinds);
}

/// The define MEDIA_KINDS for light on surfaces: fewer variants than a march has, for it asks for optical depth once a light.
inline int32_t surfaceMediaKinds(const MediaResources& media) {
    if (media.count == 0) return 0;
    const uint32_t kinds = uint32_t(mediaKinds(media, true)) & ~gpu::kMediaSingle;
    return int32_t((kinds & gpu::kMediaGrids) != 0 ? kinds | gpu::kMediaShapes : kinds);
}

struct ViewResources {
    gpu::ViewData data;
    int32_t width = 0, height = 0;
};

template <typename Command> Command& bindView(Command& command, const ViewResources& view) {
    return command.params(view.data, "View");
}

/// Declares that a pass reads the surfaces without their emission, for shaders that include shaders/common/receiver.glsl. The result is what
/// bindGBuffer() takes.
inline GBuffer readGBuffer(fg::Builder& builder, const GBuffer& gbuffer) {
    return {builder.read(gbuffer.depth),
            builder.read(gbuffer.normal),
            builder.read(gbuffer.base),
            builder.read(gbuffer.material),
            {}};
}

template <typename Command> Command& bindGBuffer(Command& command, const GBuffer& gbuffer) {
    return command.bind("gbufferDepth", gbuffer.depth)
        .bind("gbufferNormal", gbuffer.normal)
        .bind("gbufferBase", gbuffer.base)
        .bind("gbufferMaterial", gbuffer.material);
}

/// Declares that a pass reads the media, for shaders that include shaders/media/density.glsl, optical_depth.glsl or march.glsl. Only
/// if `media.count` > 0. Keep the result in the pass's data, for bindMedia().
inline MediaResources readMedia(fg::Builder& builder, const MediaResources& media) {
    MediaResources read = media;
    read.media = builder.read(media.media);
    read.bricks = builder.read(media.bricks);
    read.blackbody = builder.read(media.blackbody);
    read.opticalDepthViews = builder.read(media.opticalDepthViews);
    if (media.opticalDepth) read.opticalDepth = builder.read(media.opticalDepth);
    return read;
}

/// Binds everything that media shaders use. `media` comes from readMedia(). Names that a shader does not use are ignored.
template <typename Command> Command& bindMedia(Command& command, const MediaResources& media) {
    command.bind("Media", media.media)
        .bind("Bricks", media.bricks)
        .bind("Blackbody", media.blackbody)
        .bind("OpticalDepthViews", media.opticalDepthViews)
        .bind("mediumAtlas", media.atlas);
    if (media.opticalDepth) return command.bind("lightOpticalDepth", media.opticalDepth);
    return command.bind("lightOpticalDepth", media.noOpticalDepth);
}

/// Declares that the pass reads the lights, their lists and their shadows; the result is what bindLights() takes.
inline LightResources readLights(fg::Builder& builder, const LightResources& lights) {
    LightResources read = lights;
    read.lights = builder.read(lights.lights);
    if (lights.clusters) read.clusters = builder.read(lights.clusters);
    if (lights.shadowViews) read.shadowViews = builder.read(lights.shadowViews);
    if (lights.shadowAtlas) read.shadowAtlas = builder.read(lights.shadowAtlas);
    return read;
}

/// For shaders that include lighting/clusters.glsl, beside bindLights().
template <typename Command>
Command& bindLightLists(Command& command, const LightResources& lights) {
    return lights.clusters ? command.bind("Clusters", lights.clusters) : command;
}

/// For shaders that include lighting/light.glsl and lighting/shadow.glsl; `lights` from readLights(). Light-space optical depth
/// is bound separately.
template <typename Command> Command& bindLights(Command& command, const LightResources& lights) {
    command.bind("Lights", lights.lights);
    if (lights.shadowViews) command.bind("ShadowViews", lights.shadowViews);
    if (lights.shadowAtlas) command.bind("shadowAtlas", lights.shadowAtlas);
    return command;
}

} // namespace tyndall
