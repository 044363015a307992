#include "app.h"

#include <algorithm>
#include <filesystem>

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include "app/load_scene.h"
#include "core/log.h"
#include "core/progress.h"

namespace tyndall::editor {
namespace fs = std::filesystem;
namespace {

constexpr double kIdleSeconds =
    0.25; // how often changed shaders are looked for while nothing happens
constexpr double kHeldSeconds = 1.0 / 60; // what is held down with the mouse may go on by itself
constexpr int kSettleFrames = 3;          // of the interface, after an event

} // namespace

Outcome App::run() {
    Scene scene;
    if (Outcome opened = openScene(scene); !opened.ok()) return opened;
    if (Outcome opened = openWindow(); !opened.ok()) return opened;
    if (Outcome opened = openSession(std::move(scene)); !opened.ok()) return opened;
    return loop();
}

Outcome App::openScene(Scene& scene) {
    Progress shown("loading " + options_.render.scene, detectProgressStyle());
    JobControl job([&shown](const JobProgress& progress) {
        shown.update(progress.fraction, progress.sentence);
    });
    return loadScene(options_.render, job, scene);
}

Outcome App::openWindow() {
    gl::WindowOptions windowOptions;
    windowOptions.title = "Tyndall";
    windowOptions.size = {options_.windowWidth, options_.windowHeight};
    windowOptions.visibility =
        options_.hidden ? gl::WindowVisibility::Hidden : gl::WindowVisibility::Shown;
    windowOptions.swapInterval =
        options_.frames > 0 ? gl::SwapInterval::Immediate : gl::SwapInterval::Display;
    Result<gl::Window> window = gl::Window::create(windowOptions);
    if (!window.ok())
        return failed(window.message() + "; 'tyndall capture' renders without a display");
    window_ = std::move(*window);
    return {};
}

Outcome App::openSession(Scene scene) {
    if (Outcome opened = RenderSession::openIn(window_.context(), std::move(scene), options_.render,
                                               nullptr, rendering_);
        !opened.ok())
        return opened;
    session_ = std::make_unique<Session>(*rendering_, messages_, options_);
    // A processor that draws is slow: moving about matters more than pixels. A screenshot of so many frames has them all.
    if (options_.frames == 0 && window_.context().capabilities().isSoftware())
        session_->reduction = 2;

    input_.listen(window_.handle());
    interface_ = std::make_unique<UserInterface>(window_, layout_, !options_.hidden);
    saveDialog_.setPath(fs::path(options_.render.scene)
                            .filename()
                            .replace_extension("")
                            .replace_extension("")
                            .string() +
                        "-edited.scene.json");
    return {};
}

bool App::done() const {
    if (saveDialog_.quits()) return true;
    const LivePicture& picture = session_->picture();
    return options_.frames > 0 && picture.frames() >= uint64_t(options_.frames);
}

Outcome App::loop() {
    bool first = true;
    while (!done()) {
        waitForEvents();
        if (rendering_->renderer().reloadShaders()) session_->picture().invalidate();
        if (options_.frames > 0) session_->picture().invalidate(); // so many frames were asked for
        drawInterface();
        if (beforeFirstPicture_ > 0 && --beforeFirstPicture_ > 0)
            continue; // the pane's size is only known once the interface has settled
        announceRendering();
        if (session_->update()) {
            interfaceFrames_ =
                std::max(interfaceFrames_, 1); // the new picture is shown by the next
            timingsKnown_ = false;
        }
        if (first && session_->picture().result()) {
            log::info(session_->picture().result()->plan.why);
            for (const std::string& note : rendering_->renderer().notes())
                log::info("note: " + note);
            first = false;
        }
        if (window_.shouldClose()) {
            glfwSetWindowShouldClose(window_.handle(), GLFW_FALSE);
            saveDialog_.askToQuit();
            interfaceFrames_ = kSettleFrames;
        }
    }
    if (!session_->picture().failure().empty() && options_.frames > 0)
        return failed(session_->picture().failure());
    if (options_.screenshot.empty()) return {};
    const std::vector<uint8_t> bytes = session_->picture().read();
    return outcomeOf(writePng(options_.screenshot, session_->picture().width(),
                              session_->picture().height(), 3, bytes),
                     ExitStatus::Failed);
}

void App::waitForEvents() {
    const bool busy = !session_->picture().atRest() || interfaceFrames_ > 0 ||
                      options_.frames > 0 || !input_.queue().empty();
    if (busy) {
        gl::Window::pollEvents();
    } else if (
        !timingsKnown_) { // the last frames' times come some frames late; none follow, so they are waited for
        rendering_->renderer().waitForTimings();
        timingsKnown_ = true;
        interfaceFrames_ = 1;
        gl::Window::pollEvents();
    } else {
        glfwWaitEventsTimeout(ImGui::IsAnyMouseDown() ? kHeldSeconds : kIdleSeconds);
    }
    if (input_.takeArrived()) interfaceFrames_ = kSettleFrames;
    // Keys that are held move the camera. A text cursor does not blink, so nothing moves beside it.
    if (ImGui::IsAnyMouseDown() && glfwGetTime() - lastDrawn_ >= kHeldSeconds)
        interfaceFrames_ = std::max(interfaceFrames_, 1);
}

void App::announceRendering() {
    if (session_->pictureIsDue() == session_->panes.rendering) return;
    session_->panes.rendering = !session_->panes.rendering;
    interfaceFrames_ = std::max(interfaceFrames_, 1);
    drawInterface();
}

void App::drawInterface() {
    if (interfaceFrames_ == 0 && input_.queue().empty()) return;
    interfaceFrames_ = std::max(interfaceFrames_ - 1, 0);
    const ivec2 size = window_.framebufferSize();
    do {
        interfaceFrame(size);
    } while (!input_.queue().empty());
    updateTitle();
}

void App::interfaceFrame(ivec2 size) {
    interface_->beginFrame(input_.queue());
    session_->beginPanes();
    if (!ImGui::IsAnyItemActive()) session_->history().seal(); // one drag, one step
    if (size.x > 0 && size.y > 0) drawPanes();                 // else it is minimised
    if (size.x < 1 || size.y < 1 || !input_.queue().empty()) return interface_->endFrameUnseen();
    interface_->endFrame(size);
    window_.swapBuffers();
    lastDrawn_ = glfwGetTime();
}

void App::drawPanes() {
    drawMenu();
    const ImGuiViewport* viewport = ImGui::GetMainViewport();
    ImGui::SetNextWindowPos(viewport->WorkPos);
    ImGui::SetNextWindowSize(viewport->WorkSize);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0f);
    ImGui::Begin("Tyndall", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus |
                     ImGuiWindowFlags_NoScrollWithMouse);
    ImGui::PopStyleVar(2);
    layout_.draw(*session_);
    ImGui::End();
    handleKeys();
    saveDialog_.draw(session_->history().hasUnsavedEdits(),
                     [this](const std::string& path) { return session_->saveScene(path); });
}

void App::updateTitle() {
    const std::string title = fmt::format(
        "{}{} - Tyndall", session_->history().hasUnsavedEdits() ? "*" : "", options_.render.scene);
    if (title == title_) return;
    glfwSetWindowTitle(window_.handle(), title.c_str());
    title_ = title;
}

void App::screenshot(const char* ending) {
    const std::string stem = fs::path(options_.render.scene)
                                 .filename()
                                 .replace_extension("")
                                 .replace_extension("")
                                 .string();
    for (int number = 1;; ++number) { // never over an older one
        const std::string path = fmt::format("{}-{:03}.{}", stem, number, ending);
        if (fs::exists(path)) continue;
        return std::string_view(ending) == "png" ? session_->saveScreenshot(path)
                                                 : session_->saveExr(path);
    }
}

void App::copyCommandLine() {
    const std::string line = session_->captureLine();
    ImGui::SetClipboardText(line.c_str());
    log::info("copied: " + line);
    if (session_->history().hasUnsavedEdits())
        log::warning(
            "the scene has edits that its file does not have: save a copy first, and the line will show them");
}

void App::drawFileMenu() {
    if (ImGui::MenuItem("Save a copy as...", "Ctrl+S")) saveDialog_.ask(false);
    ImGui::Separator();
    if (ImGui::MenuItem("Screenshot as displayed (PNG)", "F12")) screenshot("png");
    if (ImGui::MenuItem("Linear picture (EXR)")) screenshot("exr");
    if (ImGui::MenuItem("Copy as command line", "Ctrl+L")) copyCommandLine();
    ImGui::Separator();
    if (ImGui::MenuItem("Quit", "Ctrl+Q")) saveDialog_.askToQuit();
}

void App::drawEditMenu() {
    History& history = session_->history();
    const std::string undo = history.undoName(), redo = history.redoName();
    if (ImGui::MenuItem(("Undo " + undo).c_str(), "Ctrl+Z", false, !undo.empty())) history.undo();
    if (ImGui::MenuItem(("Redo " + redo).c_str(), "Ctrl+Shift+Z", false, !redo.empty()))
        history.redo();
}

void App::drawMenu() {
    if (!ImGui::BeginMainMenuBar()) return;
    if (ImGui::BeginMenu("File")) {
        drawFileMenu();
        ImGui::EndMenu();
    }
    if (ImGui::BeginMenu("Edit")) {
        drawEditMenu();
        ImGui::EndMenu();
    }
    if (ImGui::BeginMenu("View")) {
        if (ImGui::MenuItem("Frame the selection, or the scene", "F")) session_->frameSelection();
        if (ImGui::MenuItem("Back to the scene's camera", "Home"))
            session_->lookThrough(session_->scene().activeCamera);
        ImGui::MenuItem("Converge", "C", &session_->request.converge);
        if (ImGui::MenuItem("Panes as at first")) layout_.reset();
        ImGui::EndMenu();
    }
    if (ImGui::BeginMenu("Help")) {
        ImGui::TextUnformatted(
            "In the picture:\n"
            "  right button + W A S D Q E   fly (Shift: faster; wheel: speed)\n"
            "  Alt + left button            orbit\n"
            "  middle button                pan\n"
            "  wheel                        nearer, farther\n"
            "  F                            frame the selection, or the scene\n"
            "  Home                         the scene's camera\n"
            "  Esc                          close what is open, else clear the selection\n\n"
            "Everything that can be dragged can be typed: Ctrl + click.");
        ImGui::EndMenu();
    }
    const std::string scene = fmt::format("{}{}", options_.render.scene,
                                          session_->history().hasUnsavedEdits() ? " (edited)" : "");
    ImGui::SameLine(ImGui::GetWindowWidth() - ImGui::CalcTextSize(scene.c_str()).x -
                    ImGui::GetFontSize());
    ImGui::TextDisabled("%s", scene.c_str());
    ImGui::EndMainMenuBar();
}

void App::handleKeys() {
    const ImGuiIO& io = ImGui::GetIO();
    if (io.WantTextInput) return;
    const auto pressed = [](int key) { return ImGui::IsKeyPressed(key, false); };
    if (pressed(GLFW_KEY_ESCAPE) && closeInnermostPopup()) return;
    if (ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopup)) return; // keys are its own
    History& history = session_->history();
    if (io.KeyCtrl) {
        if (pressed(GLFW_KEY_Z)) io.KeyShift ? history.redo() : history.undo();
        if (pressed(GLFW_KEY_Y)) history.redo();
        if (pressed(GLFW_KEY_S)) saveDialog_.ask(false);
        if (pressed(GLFW_KEY_Q)) saveDialog_.askToQuit();
        if (pressed(GLFW_KEY_L)) copyCommandLine();
        return;
    }
    if (ImGui::IsMouseDown(ImGuiMouseButton_Right)) return; // keys fly
    if (pressed(GLFW_KEY_F)) session_->frameSelection();
    if (pressed(GLFW_KEY_HOME)) session_->lookThrough(session_->scene().activeCamera);
    if (pressed(GLFW_KEY_C)) session_->request.converge = !session_->request.converge;
    if (pressed(GLFW_KEY_F12)) screenshot("png");
    if (pressed(GLFW_KEY_ESCAPE)) {
        session_->select(kNone);
        session_->request.inspect.clear();
    }
}

} // namespace tyndall::editor
