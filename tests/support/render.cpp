#include "support/render.h"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>

#include "plugin/builtin_plugins.h"
#include "support/content.h"

namespace tyndall::test {
namespace {

void expectValid(const Image& image, const std::string& name) {
    size_t nonFinite = 0, negative = 0;
    for (float value : image.pixels) {
        nonFinite += !std::isfinite(value);
        negative += value < 0;
    }
    EXPECT_EQ(nonFinite, 0u) << "non-finite values in " << name;
    EXPECT_EQ(negative, 0u) << "negative values in " << name;
}

gl::Context createContext(gl::Backend backend) {
    gl::ContextOptions options;
    options.backend = backend;
    options.debug = gl::DebugMode::Synchronous;
    Result<gl::Context> context = gl::Context::create(options);
    if (!context) throw std::runtime_error(context.message());
    return std::move(context).value();
}

} // namespace

TestRenderer::TestRenderer(gl::Backend backend, const RendererOptions& options)
    : context_(createContext(backend)) {
    RendererOptions withPlugins = options;
    withPlugins.builtinPlugins = plugin::builtinPlugins();
    if (const char* file = std::getenv("TYNDALL_TEST_PLUGIN"))
        withPlugins.pluginFiles.emplace_back(file);
    Result<std::unique_ptr<Renderer>> renderer = Renderer::create(context_, withPlugins);
    if (!renderer) throw std::runtime_error(renderer.message());
    renderer_ = std::move(renderer).value();
}

TestRenderer::~TestRenderer() {
    context_.makeCurrent();
    renderer_.reset();
}

Rendered TestRenderer::render(const Scene& scene, const RenderOptions& options) {
    context_.makeCurrent();
    renderer_->settings().resetAll();
    if (options.quality) {
        renderer_->settings().applyPreset(*options.quality);
    } else {
        renderer_->settings().applyPreset(Quality::High);
        CHECK(renderer_->settings().assign("lights.cutoff=0").ok(), "a setting of the renderer");
    }
    if (Result<void> done = renderer_->settings().set("gi.technique", options.gi); !done)
        throw std::runtime_error(done.message());
    for (const std::string& setting : options.settings)
        if (Result<void> done = renderer_->settings().assign(setting); !done)
            throw std::runtime_error(done.message());
    if (Result<void> done = renderer_->setScene(scene); !done)
        throw std::runtime_error(done.message());

    Rendered rendered;
    FrameRequest request;
    request.width = options.width;
    request.height = options.height;
    request.terms = options.terms;
    request.seed = options.seed;
    request.converge = options.converge || options.frames > 1;
    request.separateTerms = options.separateTerms;
    request.statistics = options.statistics;
    for (int frame = 0; frame < options.frames; ++frame) {
        request.frameIndex = uint32_t(frame);
        request.restart = frame == 0;
        Result<FrameResult> result = renderer_->renderFrame(request);
        if (!result) throw std::runtime_error(result.message());
        rendered.frame = *result;
    }
    rendered.beauty = renderer_->readBeauty();
    expectValid(rendered.beauty, "beauty");
    if (options.separateTerms)
        for (TermImage& term : renderer_->readTerms()) {
            expectValid(term.image, term.name);
            rendered.terms[term.name] = std::move(term.image);
        }
    rendered.statistics = renderer_->readStatistics();
    rendered.display = renderer_->readDisplay();
    for (const fg::PassReport& pass : renderer_->report().passes)
        rendered.passes[std::string(pass.name)] =
            std::string(fg::statusName(pass.status)) +
            (pass.reason.empty() ? "" : ": " + std::string(pass.reason));
    EXPECT_EQ(context_.debugLog().count(gl::Severity::High), 0u) << "OpenGL reported an error";
    return rendered;
}

TestRenderer& sharedRenderer() {
    static TestRenderer renderer;
    return renderer;
}

vec3 Rendered::pixel(int x, int y, const std::string& term) const {
    const Image& image = term == "beauty" ? beauty : terms.at(term);
    const float* p = image.at(x, y);
    return {p[0], p[1], p[2]};
}

vec3 Rendered::centre(const std::string& term, int radius) const {
    vec3 sum(0);
    int count = 0;
    for (int y = beauty.height / 2 - radius; y <= beauty.height / 2 + radius; ++y)
        for (int x = beauty.width / 2 - radius; x <= beauty.width / 2 + radius; ++x, ++count)
            sum += pixel(x, y, term);
    return sum / float(count);
}

double meanOf(const Image& image) {
    double sum = 0;
    for (const float v : image.pixels) sum += double(v);
    return sum / double(image.pixels.size());
}

Scene sceneFromJson(const std::string& json) {
    std::string text = json;
    const auto content = sharedContent("");
    for (size_t at; content && (at = text.find("{CONTENT}")) != std::string::npos;)
        text.replace(at, 9, content->string());
    static const std::filesystem::path folder = scratchDir("scenes");
    static int count = 0;
    const std::filesystem::path path = folder / ("scene" + std::to_string(count++) + ".scene.json");
    std::ofstream(path) << text;
    Result<LoadedScene> loaded = loadScene(path);
    if (!loaded) throw std::runtime_error(loaded.message());
    return std::move(loaded->scene);
}

} // namespace tyndall::test
