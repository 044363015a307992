#pragma once
// All that a plugin includes. Pure-virtual interfaces with plain data across them: no GL names, no ImGui, no exceptions
// and no standard containers cross the boundary. The exceptions are named where they occur: `const Scene*`, and the frame graph, whose inline
// functions a plugin compiles. The handshake covers all of it: PluginDescriptor has the sizes of all types that cross, and a hash of the text of their
// headers. A plugin is linked statically (from a list that CMake makes) or loaded as
// a shared library by its C entry point; both use this header unchanged.

#include <cstdint>

#include "core/settings.h"
#include "framegraph/frame_graph.h"
#include "plugin/abi_hash.h"
#include "plugin/frame_resources.h"
#include "shared/march.h"
#include "transport/media_kinds.h"
#include "transport/scene_class.h"
#include "transport/terms.h"

namespace tyndall {
struct Scene;
}

namespace tyndall::plugin {

/// Raised by one whenever anything that crosses the boundary changes its meaning.
inline constexpr uint32_t kAbiVersion = 6;

/// Description of a technique: the name that `--gi` takes, what it computes, and the figures that `auto` chooses by.
struct TechniqueInfo {
    const char* name;  // "octaves"
    const char* title; // "Octaves of multiple scattering"
    const char* help;  // one sentence
    TermSet claims;    // what it can compute, on surfaces (kIndirectOnSurfaces) and in media (the rest)
    /// The sets of terms that the frame's plan may give it. A technique that mixes several terms computes them together or not at all.
    /// Null: any part of its claims.
    const TermSet* sets;
    uint32_t setCount;
    MediaSet media;         // kinds of media in which it computes its terms in media: kAllMedia, or some
    uint32_t separatesMedia; // 1: it leaves out the kinds that are not in FrameInputs::kinds
    uint32_t automatic;      // 1: `auto` may choose it; 0: only on request
    Expectation expected[kSceneClassCount]; // measured on software GL: docs/measured/auto.md
};

struct PluginInfo {
    const char* name;    // "volumetric_gi"
    const char* version; // "0.1.0"
    const char* help;
};

/// Services of the host for a plugin, valid from setup() to destruction.
class Host {
public:
    /// Adds a shader source under `path` ("gi/octaves/march.comp"); `text` is copied. A plugin's shaders may include the engine's.
    virtual void addShader(const char* path, const char* text) = 0;
    virtual void log(const char* message) = 0;

protected:
    ~Host() = default;
};

/// The scene of this frame: version numbers of its parts (core/version.h), and how far it reaches.
struct SceneState {
    uint64_t geometry, materials, lights, media, environment;
    uint32_t lightCount, mediumCount;
    // Of surfaces and of media with an end, render space; minimum > maximum: nothing.
    float boundsMinimum[4], boundsMaximum[4];
    // The same without the landscape around them (Scene::contentBounds).
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
    fg::StaticBuffer vertices; // floats; a vertex begins with its position
    fg::StaticBuffer indices;  // three a triangle
    // Of its material; white where that has none.
    fg::StaticTexture baseColor, metallicRoughness;
    uint32_t strideFloats, triangleCount;
    // Floats from a vertex's beginning to its UV sets and its colour; 0: it has none.
    uint32_t uvFloats[4], colorFloats;
    uint32_t object; // of `Objects` (shared/object.h), which names the material
    uint32_t mesh;   // of FrameInputs::whole
    mat4 renderFromLocal;
};

/// The scene's surfaces from any view, for reflective shadow maps and voxels. Good until the frame has been executed.
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

/// This frame, for a technique.
struct FrameInputs {
    ViewResources view;
    GBuffer gbuffer;
    LightResources lights;
    MediaResources media;
    fg::TextureHandle
        transmittance; // view-sized, of the media on the way to each pixel's surface; null: there are none
    gpu::MarchParams march; // how rays through media are upsampled: media.march.*
    SceneState scene;
    const gpu::LightData*
        lightData; // `lights.lightCount` of them, as on the GPU; until the frame is recorded
    SurfaceDrawer* surfaces;
    /// The scene on the processor, for tracing rays; until the frame is recorded. Not plain data: scene/scene.h is one of the headers that
    /// the handshake's hash covers.
    const Scene* whole;
    double origin[3]; // the world's point that is render space's origin
    TermSet terms;    // that the plan gives to this technique: one of its sets
    MediaSet kinds;   // of media in which it computes its terms in media
    bool statistics;  // FrameOutputs::statistics are wanted
    float whiteNits;  // luminance that the picture's exposure makes white, before the tone curve
    bool mediaOff;    // media.enabled: those of `whole` are not there
};

/// A number about a frame: "iterations.gi.lpv", "residual.gi.lpv", "energy.gi.lpv.injected". The part before the first dot names its kind.
struct Statistic {
    const char* name;
    uint32_t element; // of FrameOutputs::statistics
};

/// Images by receiver. Null handles: not produced. All view-sized.
struct FrameOutputs {
    fg::TextureHandle
        onSurfaces; // RGBA32F nits leaving surfaces towards the eye (before media), for the granted terms on surfaces
    fg::TextureHandle
        inMedia; // RGBA32F nits reaching the eye from media, for the granted terms in media
    fg::BufferHandle statistics;          // floats; only where inputs.statistics is set
    const Statistic* statistic = nullptr; // what they are, until the next addPasses()
    uint32_t statisticCount = 0;
};

/// A table of settings, and where their values are. Keys start with the technique's or the plugin's name.
struct SettingsTable {
    const SettingDesc* fields = nullptr;
    uint32_t count = 0;
    void* values = nullptr; // lives as long as the plugin
    const PresetEntry* presets = nullptr;
    uint32_t presetCount = 0;
};

/// One way to compute terms of light transport. Belongs to its plugin.
class Technique {
public:
    virtual const TechniqueInfo& info() const = 0;
    virtual SettingsTable settings() { return {}; }
    /// Adds this frame's passes, for `inputs.terms`. Called in frames in which the plan gives it terms.
    virtual FrameOutputs addPasses(fg::FrameGraph& graph, const FrameInputs& inputs) = 0;
    /// Draws its debug views into the finished linear picture (`color`, view-sized RGBA32F nits), if its settings select one; returns
    /// the new picture, or `color`. Called after addPasses() in the same frames.
    virtual fg::TextureHandle addDebugView(fg::FrameGraph&, const FrameInputs&,
                                           fg::TextureHandle color) {
        return color;
    }

protected:
    ~Technique() = default;
};

class Plugin {
public:
    virtual const PluginInfo& info() const = 0;
    /// Settings of the plugin itself.
    virtual SettingsTable settings() { return {}; }
    /// Once, before the first frame. Returns false and writes a sentence into `message` if it cannot run here:
    /// the renderer then goes on without it.
    virtual bool setup(Host& host, char* message, uint32_t messageBytes) = 0;
    virtual uint32_t techniqueCount() const { return 0; }
    virtual Technique* technique(uint32_t) { return nullptr; }
    /// Adds passes that change the finished linear picture (`color`, view-sized RGBA32F nits); returns the new one, or `color`.
    virtual fg::TextureHandle addPostPasses(fg::FrameGraph&, const FrameInputs&,
                                            fg::TextureHandle color) {
        return color;
    }
    /// Frees the plugin with the allocator that made it.
    virtual void destroy() = 0;

protected:
    ~Plugin() = default;
};

/// Sizes of what crosses the boundary by value or by address. A compiler or a flag that lays something out in another way shows here.
struct AbiSizes {
    uint32_t settingDesc = sizeof(SettingDesc), techniqueInfo = sizeof(TechniqueInfo),
             frameInputs = sizeof(FrameInputs), frameOutputs = sizeof(FrameOutputs),
             surfaceTriangles = sizeof(SurfaceTriangles), lightData = sizeof(gpu::LightData),
             frameGraph = sizeof(fg::FrameGraph), settingsTable = sizeof(SettingsTable);
    bool operator==(const AbiSizes&) const = default;
};

/// Returned by the entry point. The first two fields never change place.
struct PluginDescriptor {
    uint32_t structSize = sizeof(PluginDescriptor);
    uint32_t abiVersion = kAbiVersion;
    const char* name = nullptr;
    Plugin* (*create)() = nullptr;
    uint64_t headers = kHeadersHash; // of the text of every header that crosses
    AbiSizes sizes{};
};

/// The symbol that a shared library exports with C linkage: `const PluginDescriptor* tyndall_plugin()`.
using EntryPoint = const PluginDescriptor* (*)();
inline constexpr const char* kEntryPointName = "tyndall_plugin";

} // namespace tyndall::plugin

/// Defines the entry point. As part of a program the symbol carries the plugin's name, so that several can be linked.
#ifdef TYNDALL_PLUGIN_SHARED
#define TYNDALL_PLUGIN_ENTRY(NAME) tyndall_plugin
#define TYNDALL_PLUGIN_EXPORT __attribute__((visibility("default")))
#else
#define TYNDALL_PLUGIN_ENTRY(NAME) tyndall_plugin_##NAME
#define TYNDALL_PLUGIN_EXPORT
#endif
#define TYNDALL_PLUGIN(NAME, CREATE)                                                               \
    extern "C" TYNDALL_PLUGIN_EXPORT const ::tyndall::plugin::PluginDescriptor*                    \
    TYNDALL_PLUGIN_ENTRY(NAME)() {                                                                 \
        static const ::tyndall::plugin::PluginDescriptor descriptor{                               \
            .name = #NAME, .create = CREATE};                                                      \
        return &descriptor;                                                                        \
    }
