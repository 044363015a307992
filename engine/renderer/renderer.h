#pragma once
// The renderer as programs and the editor use it: a scene goes in, frames come out. One object a GL context.

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/settings.h"
#include "framegraph/gl/executor.h"
#include "gl/context.h"
#include "plugin/plugin_api.h"
#include "renderer/scene_traits.h"
#include "scene/scene.h"
#include "transport/plan.h"

namespace tyndall {

struct RendererOptions {
    /// Plugins linked into the program: plugin::builtinPlugins().
    std::span<const plugin::EntryPoint> builtinPlugins;
    /// Shared-library plugins to load; one that carries the name of a built-in plugin replaces it. A refusal is an error here.
    std::vector<std::filesystem::path> pluginFiles;
    /// Every created or skipped resource starts as NaN: nothing that is shown may depend on it.
    bool poison = false;
    /// Counts non-finite and negative texels that each pass writes (FrameReport::passes[i]); slow.
    bool checkTexels = false;
};

/// A camera that is not in the scene: the editor's.
struct CameraPose {
    Camera camera;
    dmat4 worldFromCamera{1.0};
};

struct FrameRequest {
    int width = 1280, height = 720;
    int cameraNode = kNone;         // kNone: the scene's active camera
    std::optional<CameraPose> pose; // replaces cameraNode
    TermSet terms = kAllTerms;      // terms not in here are not rendered
    double time = 0;                // seconds of the scene's clock
    uint32_t frameIndex = 0;        // counts frames; drives jitter and low-discrepancy sequences
    uint32_t seed = 0;
    bool converge =
        false;            // average this frame with those since the last change of request or scene
    bool restart = false; // forget the average
    bool separateTerms = false; // keep an image a term for readTerms(), averaged too
    bool statistics = false;    // keep numbers about techniques for readStatistics()
    std::string
        inspect; // name of a resource to show instead of the picture ("shadow.atlas"), see InspectSettings
};

struct FrameResult {
    uint32_t accumulatedFrames = 1; // in the average, this one included
    /// relmse of the average that its own variance accounts for; 0 where nothing varies, infinity before the second frame.
    /// Only measured every so often in converge mode (it needs a read-back); the last measurement is kept.
    double estimatedError = 0;
    bool converged = false; // estimatedError is below the setting `converge.relmse`
    FramePlan plan;
};

/// One image of the frame: a term, or a union of terms that a technique computes jointly ("LVVE+LXVVE").
struct TermImage {
    TermSet terms = 0;
    std::string name;
    Image image;
};

/// A term image that held a value that is not finite: whose, and in which frame first (counted from 1; in the average, where frames are averaged).
struct InvalidTerms {
    TermSet terms = 0;
    int owner = kDirectPasses; // or an index into Renderer::techniques()
    uint32_t firstFrame = 0;
};

class Renderer {
public:
    /// Shaders are found, plugins loaded and set up. `context` must be current and outlive the renderer.
    static Result<std::unique_ptr<Renderer>> create(gl::Context& context,
                                                    const RendererOptions& options = {});
    ~Renderer();

    /// Every setting of the engine and of the plugins.
    [[nodiscard]] SettingsRegistry& settings();
    /// Names, claims and help of what the setting `gi.technique` accepts beside auto and none.
    [[nodiscard]] std::span<const Technique> techniques() const;

    /// Keeps a pointer: `scene` must outlive the renderer or the next call. Changes are found by version numbers.
    Result<void> setScene(const Scene& scene);

    /// Records and runs one frame. Errors: no camera, sizes out of range, unknown technique, a shader that never compiled.
    /// The driver has no room for a picture of this size.
    Result<FrameResult> renderFrame(const FrameRequest& request);

    /// Shows the last frame with the exposure (Scene::ev100) and the settings post.* of now. The tone-mapping pass alone runs, over the linear
    /// picture that is kept, so the display image is the one that a whole frame would give, to the last bit. False, and nothing
    /// was done, where it takes a whole frame: none was rendered yet, the last one failed, or a debug view or a plugin's post
    /// effect, which may depend on the exposure, is in the picture. Errors: a shader that never compiled.
    Result<bool> toneMapAgain();

    // Read-backs of the last frame; each waits for the GPU. Linear and unexposed, top row first.
    [[nodiscard]] Image readBeauty();
    [[nodiscard]] std::vector<TermImage> readTerms();
    /// Since the first frame, or since the average began; the earliest first. Empty although the picture is not finite: what was done
    /// to the sum of the terms made it so (plugins' post effects).
    [[nodiscard]] std::vector<InvalidTerms> readInvalidTerms();
    /// Numbers about the frame's techniques by name (plugin::Statistic); none unless the request asked for them.
    [[nodiscard]] std::map<std::string, double> readStatistics();
    /// `depth` (metres along the ray, Y), `normal` (world, RGB), `albedo` (RGB), `transmittance` (RGB).
    Result<Image> readAov(std::string_view name);
    /// Exposed, tone-mapped, dithered RGB bytes, top row first.
    [[nodiscard]] std::vector<uint8_t> readDisplay();
    /// GL texture of the display image for a viewport; row 0 at the bottom.
    [[nodiscard]] uint32_t displayTexture() const;

    [[nodiscard]] const fg::FrameReport& report() const;
    /// Waits for the GPU times of the frames so far and brings report() up to date with them.
    void waitForTimings();
    /// The frame graph of the last frame as text, dot or JSON (see framegraph/dump.h).
    [[nodiscard]] const fg::CompiledGraph& graph() const;
    /// Sentences about this scene that a person should read once: lights without shadows, media that swallow the sun …
    [[nodiscard]] std::vector<std::string> notes() const;
    /// Reads changed shader files again; true when anything was reloaded.
    bool reloadShaders();

private:
    struct Impl;
    explicit Renderer(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

} // namespace tyndall
