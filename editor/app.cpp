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
    0.25;                        // how often changed shaders are looked for while nothing happens
constexpr int kSettleFrames = 3; // of the interface, after an event

/// The window's user pointer is a flag that any event sets.
void wake(GLFWwindow* window) { *static_cast<bool*>(glfwGetWindowUserPointer(window)) = true; }

/// Before ImGui's, which calls these on.
void listen(GLFWwindow* window, bool* flag) {
    glfwSetWindowUserPointer(window, flag);
    glfwSetCursorPosCallback(window, [](GLFWwindow* w, double, double) { wake(w); });
    glfwSetCursorEnterCallback(window, [](GLFWwindow* w, int) { wake(w); });
    glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int, int, int) { wake(w); });
    glfwSetScrollCallback(window, [](GLFWwindow* w, double, double) { wake(w); });
    glfwSetKeyCallback(window, [](GLFWwindow* w, int, int, int, int) { wake(w); });
    glfwSetCharCallback(window, [](GLFWwindow* w, unsigned) { wake(w); });
    glfwSetWindowFocusCallback(window, [](GLFWwindow* w, int) { wake(w); });
    glfwSetFramebufferSizeCallback(window, [](GLFWwindow* w, int, int) { wake(w); });
    glfwSetWindowRefreshCallback(window, [](GLFWwindow* w) { wake(w); });
    glfwSetWindowCloseCallback(window, [](GLFWwindow* w) { wake(w); });
}

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

    listen(window_.handle(), &eventArrived_);
    interface_ = std::make_unique<UserInterface>(window_, layout_, !options_.hidden);
    savePath_ = fs::path(options_.render.scene)
                    .filename()
                    .replace_extension("")
                    .replace_extension("")
                    .string() +
                "-edited.scene.json";
    return {};
}

bool App::done() const {
    if (quit_) return true;
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
            askToQuit_ = true;
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
    const bool busy = !session_->picture().atRest() || interfaceFrames_ > 0 || options_.frames > 0;
    if (busy) {
        gl::Window::pollEvents();
    } else if (
        !timingsKnown_) { // the last frames' times come some frames late; none follow, so they are waited for
        rendering_->renderer().waitForTimings();
        timingsKnown_ = true;
        interfaceFrames_ = 1;
        gl::Window::pollEvents();
    } else {
        glfwWaitEventsTimeout(kIdleSeconds);
    }
    const bool held =
        ImGui::IsAnyMouseDown() ||
        ImGui::GetIO().WantTextInput; // keys that are held move the camera; a cursor blinks
    if (eventArrived_ || held) interfaceFrames_ = kSettleFrames;
    eventArrived_ = false;
}

void App::drawInterface() {
    const ivec2 size = window_.framebufferSize();
    if (interfaceFrames_ == 0 || size.x < 1 || size.y < 1) return;
    --interfaceFrames_;
    interface_->beginFrame();
    if (!ImGui::IsAnyItemActive()) session_->history().seal(); // one drag, one step
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
    drawSaveDialog();
    interface_->endFrame(size);
    window_.swapBuffers();
    updateTitle();
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
    if (ImGui::MenuItem("Save a copy as...", "Ctrl+S")) openSaveDialog_ = true;
    ImGui::Separator();
    if (ImGui::MenuItem("Screenshot as displayed (PNG)", "F12")) screenshot("png");
    if (ImGui::MenuItem("Linear picture (EXR)")) screenshot("exr");
    if (ImGui::MenuItem("Copy as command line", "Ctrl+L")) copyCommandLine();
    ImGui::Separator();
    if (ImGui::MenuItem("Quit", "Ctrl+Q")) askToQuit_ = true;
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
            "  Esc                          clear the selection, show the picture\n\n"
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

void App::drawSaveDialog() {
    if (openSaveDialog_) ImGui::OpenPopup("Save a copy");
    openSaveDialog_ = false;
    if (ImGui::BeginPopupModal("Save a copy", nullptr, ImGuiWindowFlags_AlwaysAutoResize)) {
        char path[1024] = {};
        savePath_.copy(path, sizeof path - 1);
        ImGui::SetNextItemWidth(ImGui::GetFontSize() * 28);
        if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
        const bool entered =
            ImGui::InputText("##path", path, sizeof path, ImGuiInputTextFlags_EnterReturnsTrue);
        savePath_ = path;
        if (ImGui::Button("Save") || entered) {
            session_->saveScene(savePath_);
            ImGui::CloseCurrentPopup();
        }
        ImGui::SameLine();
        if (ImGui::Button("Cancel")) ImGui::CloseCurrentPopup();
        ImGui::EndPopup();
    }
    if (askToQuit_ && !session_->history().hasUnsavedEdits()) quit_ = true;
    if (askToQuit_ && !quit_) ImGui::OpenPopup("Quit?");
    askToQuit_ = false;
    if (!ImGui::BeginPopupModal("Quit?", nullptr, ImGuiWindowFlags_AlwaysAutoResize)) return;
    ImGui::TextUnformatted("The scene has edits that are in no file.");
    if (ImGui::Button("Save a copy...")) {
        openSaveDialog_ = true;
        ImGui::CloseCurrentPopup();
    }
    ImGui::SameLine();
    if (ImGui::Button("Quit without them")) quit_ = true;
    ImGui::SameLine();
    if (ImGui::Button("Stay")) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
}

void App::handleKeys() {
    const ImGuiIO& io = ImGui::GetIO();
    if (io.WantTextInput) return;
    const auto pressed = [](int key) { return ImGui::IsKeyPressed(key, false); };
    History& history = session_->history();
    if (io.KeyCtrl) {
        if (pressed(GLFW_KEY_Z)) io.KeyShift ? history.redo() : history.undo();
        if (pressed(GLFW_KEY_Y)) history.redo();
        if (pressed(GLFW_KEY_S)) openSaveDialog_ = true;
        if (pressed(GLFW_KEY_Q)) askToQuit_ = true;
        if (pressed(GLFW_KEY_L)) copyCommandLine();
        return;
    }
    if (ImGui::IsMouseDown(ImGuiMouseButton_Right)) return; // keys fly
    if (pressed(GLFW_KEY_F)) session_->frameSelection();
    if (pressed(GLFW_KEY_HOME)) session_->lookThrough(session_->scene().activeCamera);
    if (pressed(GLFW_KEY_C)) session_->request.converge = !session_->request.converge;
    if (pressed(GLFW_KEY_F12)) screenshot("png");
    if (pressed(GLFW_KEY_ESCAPE)) {
        session_->selected = kNone;
        session_->request.inspect.clear();
    }
}

} // namespace tyndall::editor
