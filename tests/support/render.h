#pragma once
// Pictures in tests: a scene as JSON text or a Scene, rendered headless by the engine that the programs use.

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gl/context.h"
#include "renderer/renderer.h"
#include "scene/scene_file.h"

namespace tyndall::test {

struct RenderOptions {
    int width = 32, height = 32;
    int frames = 1;                    // averaged when above 1 (converge mode)
    bool converge = false;             // even for one frame
    std::optional<Quality> quality;    // a preset, before the settings; none: high, with every light everywhere
    std::vector<std::string> settings; // KEY=VALUE
    std::string gi = "none";
    TermSet terms = kAllTerms;
    uint32_t seed = 0;
    bool separateTerms = true;
    bool statistics = false;
};

struct Rendered {
    Image beauty;
    std::map<std::string, Image> terms; // "LE", "LSE", "LVE", …
    std::vector<uint8_t> display;
    std::map<std::string, std::string> passes; // name → "ran", "skipped: no medium in the scene", …
    std::map<std::string, double> statistics; // where options ask for them
    FrameResult frame;

    /// Mean over a square of 2·radius+1 pixels around the picture's centre, or around (x, y) from the top left.
    [[nodiscard]] vec3 centre(const std::string& term = "beauty", int radius = 0) const;
    [[nodiscard]] vec3 pixel(int x, int y, const std::string& term = "beauty") const;
};

/// One GL context of a back end and one renderer in it, made when first asked for and kept for the process.
/// Fails the test on high-severity GL messages and on invalid pixels. Loads the plugin that $TYNDALL_TEST_PLUGIN names, if it names one.
class TestRenderer {
public:
    explicit TestRenderer(gl::Backend backend = gl::Backend::Egl,
                          const RendererOptions& options = {});
    ~TestRenderer();
    Rendered render(const Scene& scene, const RenderOptions& options = {});
    /// Settings keep their values between calls of render() only through RenderOptions: each call starts from the defaults.
    [[nodiscard]] Renderer& renderer() { return *renderer_; }
    [[nodiscard]] gl::Context& context() { return context_; }

private:
    gl::Context context_;
    std::unique_ptr<Renderer> renderer_;
};

/// The EGL renderer that tests of one executable share.
TestRenderer& sharedRenderer();

/// Over pixels and channels.
double meanOf(const Image& image);

/// A scene from the JSON of a scene file; `{CONTENT}` in it becomes the shared content's folder. Throws on refusal.
Scene sceneFromJson(const std::string& json);

} // namespace tyndall::test
