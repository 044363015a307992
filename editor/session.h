#pragma once
// One open scene and everything that the panes show and change.

#include <string>

#include "app/render_session.h"
#include "camera_controller.h"
#include "command.h"
#include "live_picture.h"
#include "messages.h"
#include "options.h"
#include "rotation_angles.h"
#include "widgets.h"

namespace tyndall::editor {

class Session {
public:
    /// Both outlive the session.
    Session(RenderSession& rendering, Messages& messages, const EditorOptions& options);

    [[nodiscard]] Scene& scene() { return scene_; }
    [[nodiscard]] Renderer& renderer() { return renderer_; }
    [[nodiscard]] SettingsRegistry& settings() { return renderer_.settings(); }
    /// What gi.technique says.
    [[nodiscard]] std::string technique() { return settings().get(kTechniqueSetting).value(); }
    [[nodiscard]] Messages& messages() { return messages_; }
    [[nodiscard]] const EditorOptions& options() const { return options_; }
    [[nodiscard]] History& history() { return history_; }
    [[nodiscard]] LivePicture& picture() { return picture_; }
    /// Performs an edit.
    void edit(CommandPtr command) { history_.perform(std::move(command)); }

    // --- what is looked at ---
    [[nodiscard]] int selected() const { return selected_; } // node
    /// From the next frame of the interface on: a field that is left by this click still belongs to the node selected now.
    void select(int node) { nextSelected_ = node; }
    FrameRequest request; // size, terms, resource shown; the pose is filled in by update()
    int reduction = 1;    // the picture has this part of the pane's pixels along each side
    /// Looks through a camera of the scene again.
    void lookThrough(int cameraNode);
    /// The free camera, which starts where the picture is seen from now.
    CameraController& freeCamera();
    [[nodiscard]] bool cameraIsFree() const { return free_; }
    /// The lens in use.
    [[nodiscard]] const Camera& lens() const;
    /// Brings the selection, or else the scene, into the picture.
    void frameSelection();

    /// Before the panes of a frame of the interface are drawn.
    void beginPanes() { selected_ = nextSelected_; }
    /// Is a frame to be rendered?
    [[nodiscard]] bool pictureIsDue();
    /// Renders if something changed; true when there is a new picture.
    bool update();

    /// What panes keep between frames: nothing of the scene.
    struct PaneState {
        std::string nodeFilter, resourceFilter, settingFilter;
        size_t messagesSeen = 0;
        TypedNumber typed;
        RotationAngles angles;
        bool rendering = false; // said in the toolbar: a frame is being made
    } panes;

    // --- what leaves the editor; each says in the log what it did ---
    void saveScreenshot(const std::string& path);
    void saveExr(const std::string& path);
    Result<void> saveScene(const std::string& path);
    /// The `tyndall capture` line that makes the same picture.
    [[nodiscard]] std::string captureLine() const;

private:
    [[nodiscard]] int cameraNode() const {
        return request.cameraNode != kNone ? request.cameraNode : scene_.activeCamera;
    }
    [[nodiscard]] double sceneSize() const;
    void placeCamera();

    RenderSession& rendering_;
    Scene& scene_;       // of rendering_
    Renderer& renderer_; // of rendering_
    Messages& messages_;
    EditorOptions options_;
    std::string sceneFile_;
    History history_;
    LivePicture picture_;
    CameraController camera_;
    bool free_ = false;
    int selected_ = kNone, nextSelected_ = kNone;
    std::optional<double> yfov_; // of --pose
};

} // namespace tyndall::editor
