#include "session.h"

#include <fmt/format.h>

#include "core/log.h"
#include "scene/scene_writer.h"

namespace tyndall::editor {
namespace {

constexpr std::string_view kTechniqueKey = "gi.technique=";

Result<int> findCamera(const Scene& scene, const std::string& name) {
    for (size_t i = 0; i < scene.nodes.size(); ++i)
        if (scene.nodes[i].camera != kNone && scene.nodes[i].name == name) return int(i);
    return Error{fmt::format("--camera {}: the scene has no camera of this name", name)};
}

/// World bounds of a node and what hangs below it; lights and cameras count as points.
Bounds boundsBelow(const Scene& scene, int root) {
    const std::vector<dmat4> world = scene.worldTransforms();
    std::vector<bool> below(scene.nodes.size(), false);
    Bounds bounds;
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        const Node& node = scene.nodes[i];
        below[i] = int(i) == root || (node.parent != kNone && below[size_t(node.parent)]);
        if (!below[i]) continue;
        for (const int mesh : node.meshes) {
            if (node.instances.empty())
                bounds.include(scene.meshes[size_t(mesh)].bounds.transformed(world[i]));
            for (const dmat4& instance : node.instances)
                bounds.include(scene.meshes[size_t(mesh)].bounds.transformed(world[i] * instance));
        }
        if (node.medium != kNone) {
            const dvec3 half = 0.5 * scene.media[size_t(node.medium)].size;
            bounds.include(Bounds{-half, half}.transformed(world[i]));
        }
        if (node.light != kNone || node.camera != kNone) bounds.include(dvec3(world[i][3]));
    }
    return bounds;
}

} // namespace

std::string shellWord(const std::string& text) {
    const bool plain =
        !text.empty() &&
        text.find_first_not_of(
            "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-+=./,:@%") ==
            std::string::npos;
    if (plain) return text;
    std::string word = "'";
    for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return word + "'";
}

Session::Session(Scene& scene, Renderer& renderer, Messages& messages, const EditorOptions& options)
    : scene_(scene), renderer_(renderer), messages_(messages), options_(options),
      sceneFile_(options.render.scene), history_(EditTarget{scene, renderer.settings()}) {
    request.width = options.plan.width;
    request.height = options.plan.height;
    request.terms = options.plan.terms;
    request.time = options.render.time;
    request.seed = options.render.seed;
    request.converge = options.converge;
}

Outcome Session::open(Scene& scene, Renderer& renderer, Messages& messages,
                      const EditorOptions& options, std::unique_ptr<Session>& session) {
    std::unique_ptr<Session> opened(new Session(scene, renderer, messages, options));
    if (Outcome done = opened->applyOptions(); !done.ok()) return done;
    if (const Result<void> set = renderer.setScene(scene); !set.ok())
        return wrongInput(set.message());
    session = std::move(opened);
    return {};
}

Outcome Session::assign(const std::string& assignment, const std::string& origin) {
    if (assignment.starts_with(kTechniqueKey)) {
        request.gi = assignment.substr(kTechniqueKey.size());
        return {};
    }
    const Result<void> done = settings().assign(assignment);
    return done.ok() ? Outcome{} : wrongInput(origin + done.message());
}

Outcome Session::applyOptions() {
    const RenderOptions& render = options_.render;
    for (const std::string& assignment : scene_.settings)
        if (Outcome done = assign(assignment, fmt::format("'{}': /settings: ", render.scene));
            !done.ok())
            return done;
    giOfFile_ = request.gi;
    for (const SettingsGroup& group : settings().groups())
        for (const SettingDesc& field : group.fields)
            settingsOfFile_[field.key] = settingToText(field, group.values);
    if (options_.plan.quality) settings().applyPreset(*options_.plan.quality);
    for (const std::string& assignment : render.assignments)
        if (Outcome done = assign(assignment, "--set: "); !done.ok()) return done;
    if (!render.gi.empty()) request.gi = render.gi;
    const Result<FramePlan> plan =
        makePlan(request.gi, request.terms, renderer_.techniques(), {true, true, true, true});
    if (!plan.ok()) return wrongInput("--gi " + request.gi + ": " + plan.message());

    if (!render.camera.empty()) {
        const Result<int> node = findCamera(scene_, render.camera);
        if (!node.ok()) return wrongInput(node.message());
        request.cameraNode = *node;
    } else if (scene_.activeCamera == kNone) {
        return wrongInput(fmt::format(
            "'{}' has no camera: add a node with a \"camera\" and name it under \"camera\"",
            render.scene));
    }
    if (const std::optional<PoseOption>& pose = options_.plan.pose) {
        dmat4 worldFromCamera = glm::mat4_cast(pose->rotation);
        worldFromCamera[3] = dvec4(pose->position, 1);
        camera_.reset(worldFromCamera, sceneSize());
        yfov_ = pose->yfov;
        free_ = true;
    }
    return {};
}

double Session::sceneSize() const {
    const Bounds bounds = scene_.worldBounds();
    return bounds.empty() ? 10 : glm::length(bounds.extent());
}

void Session::lookThrough(int node) {
    request.cameraNode = node == scene_.activeCamera ? kNone : node;
    free_ = false;
    yfov_.reset();
}

CameraController& Session::freeCamera() {
    if (!free_) camera_.reset(scene_.worldTransforms().at(size_t(cameraNode())), sceneSize());
    free_ = true;
    return camera_;
}

const Camera& Session::lens() const {
    return scene_.cameras.at(size_t(scene_.nodes.at(size_t(cameraNode())).camera));
}

void Session::frameSelection() {
    Bounds bounds = selected != kNone ? boundsBelow(scene_, selected) : scene_.worldBounds();
    if (bounds.empty()) return;
    if (glm::length(bounds.extent()) == 0) { // a light: some room around it
        const dvec3 room(0.05 * sceneSize());
        bounds = Bounds{bounds.centre() - room, bounds.centre() + room};
    }
    freeCamera().frame(bounds, yfov_.value_or(lens().yfov), double(request.width) / request.height);
}

bool Session::update() {
    request.pose.reset();
    if (free_) {
        request.pose = CameraPose{lens(), camera_.worldFromCamera()};
        if (yfov_) request.pose->camera.yfov = *yfov_;
    }
    return picture_.update(renderer_, scene_, request);
}

void Session::saveScreenshot(const std::string& path) {
    const std::vector<uint8_t> bytes = picture_.read();
    if (bytes.empty()) return log::error("there is no picture to write yet");
    const Result<void> written = writePng(path, picture_.width(), picture_.height(), 3, bytes);
    written.ok() ? log::info("wrote " + path) : log::error(written.message());
}

void Session::saveExr(const std::string& path) {
    if (!picture_.result() || !picture_.failure().empty())
        return log::error("the last frame failed, so there are no linear values to write");
    const Image beauty = renderer_.readBeauty();
    const ImageLayer layer{"", beauty};
    const Result<void> written =
        writeExr(path, std::span(&layer, 1),
                 {{"tyndall.command", captureLine()}, {"tyndall.version", TYNDALL_VERSION}});
    written.ok() ? log::info("wrote " + path) : log::error(written.message());
}

void Session::saveScene(const std::string& path) {
    const Result<void> written = writeSceneFile(scene_, path);
    if (!written.ok()) return log::error(written.message());
    sceneFile_ = path;
    history_.markSaved();
    log::info("wrote " + path);
}

std::string Session::captureLine() const {
    std::string line = "tyndall capture " + shellWord(sceneFile_);
    line += fmt::format(" --size {}x{}", request.width, request.height);
    if (request.cameraNode != kNone)
        line += " --camera " + shellWord(scene_.nodes[size_t(request.cameraNode)].name);
    // With '=', since a number may begin with a minus.
    if (free_) line += " --pose=" + poseText({camera_.position(), camera_.rotation(), yfov_});
    if (request.gi != giOfFile_) line += " --gi " + shellWord(request.gi);
    if (request.terms != kAllTerms) line += " --terms " + termNames(request.terms);
    for (const std::string& plugin : options_.render.plugins)
        line += " --plugin " + shellWord(plugin);
    for (const SettingsGroup& group : renderer_.settings().groups())
        for (const SettingDesc& field : group.fields) {
            const std::string key = field.key, text = settingToText(field, group.values);
            const auto before = settingsOfFile_.find(key);
            if (!key.starts_with("inspect.") && before != settingsOfFile_.end() &&
                before->second != text)
                line += " --set " + shellWord(key + "=" + text);
        }
    if (request.time != 0) line += fmt::format(" --time {}", request.time);
    if (request.seed != 0) line += fmt::format(" --seed {}", request.seed);
    if (request.converge) line += " --converge";
    return line + " -o picture.png";
}

} // namespace tyndall::editor
