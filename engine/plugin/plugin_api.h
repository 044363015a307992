#pragma once
// All that a plugin includes. One pure-virtual interface with plain data across it: no GL names, no ImGui, no exceptions
// and no standard containers cross the boundary. A plugin is linked statically (from a list that CMake makes) or loaded as
// a shared library by its C entry point; both use this header unchanged.

#include <cstdint>

#include "core/settings.h"
#include "framegraph/frame_graph.h"
#include "plugin/frame_resources.h"
#include "shared/march.h"
#include "transport/terms.h"

namespace tyndall {
struct Scene;
}

namespace tyndall::plugin {

/// Raised by one whenever anything that crosses the boundary changes its meaning or layout.
inline constexpr uint32_t kAbiVersion = 5;

/// One technique that a plugin offers: the name that `--gi` takes, and the terms that it computes.
struct TechniqueInfo {
    const char* name;   // "octaves"
    const char* title;  // "Octaves of multiple scattering"
    const char* help;   // one sentence
    TermSet claims;     // what it can compute; the frame's plan gives it all or some
    uint32_t automatic; // 1: `auto` may choose it; 0: only who asks for it gets it
};

struct PluginInfo {
    const char* name;    // "volumetric_gi"
    const char* version; // "0.1.0"
    const char* help;
    const TechniqueInfo* techniques;
    uint32_t techniqueCount;
};

/// The host's side: what a plugin may ask for, valid from setup() to destruction.
class Host {
public:
    /// Adds a shader source under `path` ("gi/octaves/march.comp"); `text` is copied. A plugin's shaders may include the engine's.
    virtual void addShader(const char* path, const char* text) = 0;
    virtual void log(const char* message) = 0;

protected:
    ~Host() = default;
};

/// What changed since the last frame, as version numbers (core/version.h).
struct SceneChange {
    uint64_t geometry, materials, lights, media, environment;
    uint32_t lightCount, mediumCount;
    // Of surfaces and of media with an end, render space; minimum > maximum: nothing.
    float boundsMinimum[4], boundsMaximum[4];
    // The same without the landscape that all else stands in (Scene::contentBounds).
    float contentMinimum[4], contentMaximum[4];
};

/// A square picture of the surfaces from a point or, where `yfov` is 0, along parallel rays. It looks along -Z of `renderFromView`,
/// which has no scale.
struct SurfaceView {
    mat4 renderFromView;
    float yfov;       // radians
    float halfHeight; // metres, parallel
    float nearest;    // metres before which nothing is drawn; perspective
    float depthRange; // metres, parallel
    int32_t side;     // pixels
};

/// The triangles of one object, in its own space: what compute shaders read.
struct SurfaceTriangles {
    fg::StaticBuffer vertices;   // floats; a vertex begins with its position
    fg::StaticBuffer indices;    // three a triangle
    fg::StaticTexture baseColor; // of its material; white where that has none
    uint32_t strideFloats, triangleCount;
    uint32_t object; // of `Objects` (shared/object.h), which names the material
};

/// The scene's surfaces from anywhere: what reflective shadow maps and voxels are made of. Good until the frame has been executed.
class SurfaceDrawer {
public:
    /// Of all opaque and alpha-tested surfaces.
    virtual uint32_t triangleSetCount() const = 0;
    virtual SurfaceTriangles triangles(uint32_t set) const = 0;
    virtual fg::StaticBuffer objects() const = 0;   // ObjectData[]
    virtual fg::StaticBuffer materials() const = 0; // MaterialData[]

    /// Adds a pass of this name (a literal). Both sides of all surfaces are drawn. `view`: for bindView(), to get back from pixels to rays.
    virtual GBuffer addGBuffer(fg::FrameGraph& graph, const char* name, const SurfaceView& from,
                               ViewResources& view) = 0;

protected:
    ~SurfaceDrawer() = default;
};

/// This frame, as far as a technique sees it.
struct FrameInputs {
    ViewResources view;
    GBuffer gbuffer;
    LightResources lights;
    MediaResources media;
    fg::TextureHandle
        transmittance; // view-sized, of the media on the way to each pixel's surface; null: there are none
    gpu::MarchParams march; // how rays through media are upsampled: media.march.*
    SceneChange scene;
    const gpu::LightData*
        lightData; // `lights.lightCount` of them, as on the GPU; until the frame is recorded
    SurfaceDrawer* surfaces;
    const Scene*
        whole; // as it is on the processor, for who traces rays there; until the frame is recorded
    double origin[3]; // the world's point that is render space's origin
    TermSet terms;    // that the plan gives to this plugin
    bool statistics;  // somebody asks for FrameOutputs::statistics
    float whiteNits;  // luminance that the picture's exposure makes white, before the tone curve
};

/// A number about a frame: "iterations.gi.lpv", "residual.gi.lpv", "energy.gi.lpv.injected". The part before the first dot names its kind.
struct Statistic {
    const char* name;
    uint32_t element; // of FrameOutputs::statistics
};

/// Null handles: not produced. All view-sized.
struct FrameOutputs {
    fg::TextureHandle
        inScatter; // RGBA32F nits reaching the eye from media, for the granted terms in media
    fg::TextureHandle
        surfaceRadiance; // RGBA32F nits leaving surfaces towards the eye (before media), for the granted terms on surfaces
    fg::BufferHandle statistics;          // floats; only where inputs.statistics is set
    const Statistic* statistic = nullptr; // what they are, until the next addPasses()
    uint32_t statisticCount = 0;
};

class Plugin {
public:
    virtual const PluginInfo& info() const = 0;
    /// The plugin's settings; the values live as long as the plugin. The table's keys start with the technique's name.
    virtual uint32_t settingsGroupCount() const = 0;
    virtual void settingsGroup(uint32_t index, const SettingDesc** fields, uint32_t* count,
                               void** values) = 0;
    virtual void presets(const PresetEntry** entries, uint32_t* count) const = 0;
    /// Once, before the first frame. Returns false and writes a sentence into `message` if it cannot run here:
    /// the renderer then goes on without it.
    virtual bool setup(Host& host, char* message, uint32_t messageBytes) = 0;
    virtual void sceneChanged(const SceneChange& change) = 0;
    /// Adds this frame's passes for `technique` (an index into info().techniques).
    virtual FrameOutputs addPasses(fg::FrameGraph& graph, uint32_t technique,
                                   const FrameInputs& inputs) = 0;
    /// Adds passes that change the finished linear picture (`color`, view-sized RGBA32F nits); returns the new one, or `color`.
    virtual fg::TextureHandle addPostPasses(fg::FrameGraph& graph, const FrameInputs& inputs,
                                            fg::TextureHandle color) = 0;
    /// Frees the plugin with the allocator that made it.
    virtual void destroy() = 0;

protected:
    ~Plugin() = default;
};

/// Returned by the entry point. The first two fields never change place.
struct PluginDescriptor {
    uint32_t structSize; // sizeof(PluginDescriptor)
    uint32_t abiVersion; // kAbiVersion
    const char* name;
    Plugin* (*create)();
};

/// The symbol that a shared library exports with C linkage: `const PluginDescriptor* tyndall_plugin()`.
using EntryPoint = const PluginDescriptor* (*)();
inline constexpr const char* kEntryPointName = "tyndall_plugin";

} // namespace tyndall::plugin

/// Defines the entry point. As part of a program the symbol carries the plugin's name, so that several can be linked.
#ifdef TYNDALL_PLUGIN_SHARED
#define TYNDALL_PLUGIN(NAME, CREATE)                                                               \
    extern "C" __attribute__((visibility("default"))) const ::tyndall::plugin::PluginDescriptor*   \
    tyndall_plugin() {                                                                             \
        static constexpr ::tyndall::plugin::PluginDescriptor descriptor{                           \
            sizeof(::tyndall::plugin::PluginDescriptor), ::tyndall::plugin::kAbiVersion, #NAME,    \
            CREATE};                                                                               \
        return &descriptor;                                                                        \
    }
#else
#define TYNDALL_PLUGIN(NAME, CREATE)                                                               \
    extern "C" const ::tyndall::plugin::PluginDescriptor* tyndall_plugin_##NAME() {                \
        static constexpr ::tyndall::plugin::PluginDescriptor descriptor{                           \
            sizeof(::tyndall::plugin::PluginDescriptor), ::tyndall::plugin::kAbiVersion, #NAME,    \
            CREATE};                                                                               \
        return &descriptor;                                                                        \
    }
#endif
