#include "session.h"

#include <fmt/format.h>

#include "app/program.h"
#include "core/log.h"
#include "scene/scene_writer.h"
#include "setting_options.h"

namespace tyndall::editor {
namespace {

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

Session::Session(RenderSession& rendering, Messages& messages, const EditorOptions& options)
    : request(rendering.request()), rendering_(rendering), scene_(rendering.scene()),
      renderer_(rendering.renderer()), messages_(messages), options_(options),
      sceneFile_(options.render.scene), history_(EditTarget{scene_, renderer_.settings()}) {
    request.converge = options.converge;
    if (const std::optional<PoseOption>& pose = rendering.plan().pose) {
        dmat4 worldFromCamera = glm::mat4_cast(pose->rotation);
        worldFromCamera[3] = dvec4(pose->position, 1);
        camera_.reset(worldFromCamera, sceneSize());
        yfov_ = pose->yfov;
        free_ = true;
    }
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
    Bounds bounds = selected_ != kNone ? boundsBelow(scene_, selected_) : scene_.worldBounds();
    if (bounds.empty()) return;
    if (glm::length(bounds.extent()) == 0) { // a light: some room around it
        const dvec3 room(0.05 * sceneSize());
        bounds = Bounds{bounds.centre() - room, bounds.centre() + room};
    }
    freeCamera().frame(bounds, yfov_.value_or(lens().yfov), double(request.width) / request.height);
}

void Session::placeCamera() {
    request.pose.reset();
    if (free_) {
        request.pose = CameraPose{lens(), camera_.worldFromCamera()};
        if (yfov_) request.pose->camera.yfov = *yfov_;
    }
}

bool Session::pictureIsDue() {
    placeCamera();
    return picture_.isDue(renderer_, scene_, request);
}

bool Session::update() {
    placeCamera();
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
                 {{"tyndall.command", captureLine()}, {"tyndall.version", programVersion()}});
    written.ok() ? log::info("wrote " + path) : log::error(written.message());
}

Result<void> Session::saveScene(const std::string& path) {
    Result<void> written = writeSceneFile(scene_, path);
    if (!written.ok()) {
        log::error(written.message());
        return written;
    }
    sceneFile_ = path;
    history_.markSaved();
    log::info("wrote " + path);
    return {};
}

std::string Session::captureLine() const {
    std::string line = "tyndall capture " + shellWord(sceneFile_);
    // A scene that was saved has the grid in its file.
    if (!options_.render.grid.empty() && sceneFile_ == options_.render.scene)
        line += " --grid " + shellWord(options_.render.grid);
    line += fmt::format(" --size {}x{}", request.width, request.height);
    if (request.cameraNode != kNone)
        line += " --camera " + shellWord(scene_.nodes[size_t(request.cameraNode)].name);
    // With '=', since a number may begin with a minus.
    if (free_) line += " --pose=" + poseText({camera_.position(), camera_.rotation(), yfov_});
    if (request.terms != kAllTerms) line += " --terms " + termNames(request.terms);
    for (const std::string& plugin : options_.render.plugins)
        line += " --plugin " + shellWord(plugin);
    for (const std::string& option :
         settingOptions(renderer_.settings(), rendering_.settingsOfScene(), kTechniqueSetting))
        line += " " + option;
    if (request.time != 0) line += fmt::format(" --time {}", request.time);
    if (request.seed != 0) line += fmt::format(" --seed {}", request.seed);
    if (request.converge) line += " --converge";
    return line + " -o picture.png";
}

} // namespace tyndall::editor
