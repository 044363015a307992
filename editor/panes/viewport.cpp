#include <algorithm>
#include <cmath>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include "panes/panes.h"
#include "widgets.h"

namespace tyndall::editor {
namespace {

constexpr int kSmallestSide = 16;    // pixels: a pane can be dragged shut
constexpr double kLongestStep = 0.1; // seconds: after a slow frame the camera does not jump

void drawCameraChoice(Session& session) {
    const Scene& scene = session.scene();
    const int current =
        session.request.cameraNode != kNone ? session.request.cameraNode : scene.activeCamera;
    const std::string shown =
        session.cameraIsFree() ? "free camera" : scene.nodes[size_t(current)].name;
    ImGui::SetNextItemWidth(ImGui::GetFontSize() * 10);
    if (ImGui::BeginCombo("##camera", shown.c_str())) {
        for (size_t i = 0; i < scene.nodes.size(); ++i) {
            if (scene.nodes[i].camera == kNone) continue;
            const std::string label = fmt::format("{}##{}", scene.nodes[i].name, i);
            if (ImGui::Selectable(label.c_str(), !session.cameraIsFree() && int(i) == current))
                session.lookThrough(int(i));
        }
        ImGui::EndCombo();
    }
    tooltip(
        "The camera looked through. Moving in the picture makes it a free one; choosing one here goes back to it (Home).");
}

std::string stateText(Session& session) {
    const LivePicture& picture = session.picture();
    if (!picture.result()) return "";
    const FrameResult& result = *picture.result();
    if (!picture.failure().empty() && !session.panes.rendering)
        return "the last frame failed: drawing stopped";
    if (!session.request.converge)
        return session.panes.rendering ? "rendering" : "still: drawing stopped";
    const std::string frames = fmt::format("{} frame{}", result.accumulatedFrames,
                                           result.accumulatedFrames == 1 ? "" : "s");
    if (result.converged && !session.panes.rendering)
        return fmt::format("converged after {}: drawing stopped", frames);
    if (result.accumulatedFrames < 2 || !std::isfinite(result.estimatedError))
        return "averaging: " + frames;
    return fmt::format("averaging: {}, relmse {:.1e}", frames, result.estimatedError);
}

void drawExposure(Session& session) {
    float ev100 = session.scene().ev100;
    ImGui::SetNextItemWidth(ImGui::GetFontSize() * 6);
    if (dragNumbers(session.panes.typed, &ev100, 1, {0.02f, -20, 30, "EV %.2f"}))
        session.edit(changeExposure(session.scene(), ev100));
    tooltip("Exposure value at ISO 100 (stops); higher is darker.");
}

void drawResolution(Session& session) {
    static constexpr const char* kResolutions[] = {"all pixels", "1/2", "1/4"};
    int index = session.reduction == 1 ? 0 : session.reduction == 2 ? 1 : 2;
    ImGui::SetNextItemWidth(ImGui::GetFontSize() * 6);
    if (ImGui::Combo("##resolution", &index, kResolutions, 3)) session.reduction = 1 << index;
    tooltip(
        "Pixels of the picture along each side, as a part of what the pane has: fewer are faster.");
}

/// At the right end, in a line of its own where there is no room beside the rest.
void drawState(Session& session) {
    const std::string state = fmt::format("{} x {}   {}", session.picture().width(),
                                          session.picture().height(), stateText(session));
    const float width = ImGui::CalcTextSize(state.c_str()).x;
    flow(width);
    ImGui::SetCursorPosX(
        std::max(ImGui::GetCursorPosX(), ImGui::GetWindowContentRegionMax().x - width));
    ImGui::AlignTextToFramePadding();
    const bool done = session.picture().converged() && !session.panes.rendering;
    coloredText(done ? kGood : kGrey, state);
}

void drawToolbar(Session& session) {
    const float em = ImGui::GetFontSize();
    drawCameraChoice(session);
    flow(ImGui::GetFrameHeight() + ImGui::CalcTextSize(" Converge").x);
    ImGui::Checkbox("Converge", &session.request.converge);
    tooltip(
        "Average frames with other samples until edges and noise are gone, then stop; like 'tyndall capture --converge'.");
    if (!session.options().fixedSize) {
        flow(6 * em);
        drawResolution(session);
    }
    flow(6 * em);
    drawExposure(session);
    if (!session.request.inspect.empty()) {
        const std::string showing = "showing " + session.request.inspect;
        const char* back = "back to the picture";
        flow(ImGui::CalcTextSize((showing + back).c_str()).x + 2 * em);
        ImGui::AlignTextToFramePadding();
        coloredText(kWarn, showing);
        ImGui::SameLine();
        if (ImGui::Button(back)) session.request.inspect.clear();
    }
    drawState(session);
}

/// Metres that one pixel spans at the pivot.
double metresPerPixel(const Session& session, const CameraController& camera, float height) {
    const Camera& lens = session.lens();
    const double halfHeight = lens.type == CameraType::Orthographic
                                  ? lens.ymag
                                  : camera.pivotDistance() * std::tan(0.5 * lens.yfov);
    return 2 * halfHeight / double(std::max(height, 1.0f));
}

/// Was the key down since the frame before? One that was released now was.
bool wasDown(int key) { return ImGui::GetIO().KeysDownDurationPrev[key] >= 0; }

void flyByKeys(CameraController& camera) {
    const auto axis = [](int forth, int back) {
        return double(wasDown(forth)) - double(wasDown(back));
    };
    const dvec3 axes(axis(GLFW_KEY_D, GLFW_KEY_A), axis(GLFW_KEY_E, GLFW_KEY_Q),
                     axis(GLFW_KEY_W, GLFW_KEY_S));
    const double faster = ImGui::GetIO().KeyShift ? 4 : 1;
    if (axes != dvec3(0))
        camera.fly(axes, faster * std::min(double(ImGui::GetIO().DeltaTime), kLongestStep));
}

/// The item before is the picture. A button that went down on it keeps the camera until it is released.
void moveCamera(Session& session, float height) {
    const ImGuiIO& io = ImGui::GetIO();
    const bool hovered = ImGui::IsItemHovered(), active = ImGui::IsItemActive();
    const dvec2 moved(double(io.MouseDelta.x), double(io.MouseDelta.y));
    const bool anyMove = moved != dvec2(0);
    if (active && ImGui::IsMouseDown(ImGuiMouseButton_Right)) {
        if (anyMove) session.freeCamera().look(moved);
        if (io.MouseWheel != 0) session.freeCamera().changeSpeed(double(io.MouseWheel));
        for (const int key :
             {GLFW_KEY_W, GLFW_KEY_A, GLFW_KEY_S, GLFW_KEY_D, GLFW_KEY_Q, GLFW_KEY_E})
            if (wasDown(key)) return flyByKeys(session.freeCamera());
        return;
    }
    if (active && ImGui::IsMouseDown(ImGuiMouseButton_Left) && io.KeyAlt && anyMove)
        session.freeCamera().orbit(moved);
    if (active && ImGui::IsMouseDown(ImGuiMouseButton_Middle) && anyMove) {
        CameraController& camera = session.freeCamera();
        camera.pan(moved, metresPerPixel(session, camera, height));
    }
    if (hovered && io.MouseWheel != 0) session.freeCamera().dolly(double(io.MouseWheel));
}

void drawFailure(const std::string& failure, const ImVec2& at, float width) {
    if (failure.empty()) return;
    const float margin = ImGui::GetFontSize() * 0.5f;
    const std::string message = "The last frame failed; this is the one before. " + failure;
    const ImVec2 size = ImGui::CalcTextSize(message.c_str(), nullptr, false, width - 2 * margin);
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddRectFilled(at, {at.x + width, at.y + size.y + 2 * margin}, IM_COL32(90, 20, 18, 230));
    list->AddText(ImGui::GetFont(), ImGui::GetFontSize(), {at.x + margin, at.y + margin},
                  IM_COL32(255, 225, 220, 255), message.c_str(), nullptr, width - 2 * margin);
}

} // namespace

void drawViewport(Session& session) {
    drawToolbar(session);
    const ImVec2 room = ImGui::GetContentRegionAvail(), corner = ImGui::GetCursorScreenPos();
    const ImVec2 pixels = ImGui::GetIO().DisplayFramebufferScale;
    if (!session.options().fixedSize) {
        session.request.width = std::max(int(room.x * pixels.x) / session.reduction, kSmallestSide);
        session.request.height =
            std::max(int(room.y * pixels.y) / session.reduction, kSmallestSide);
    }
    if (room.x < 1 || room.y < 1) return;
    const LivePicture& picture = session.picture();
    ImGui::GetWindowDrawList()->AddRectFilled(corner, {corner.x + room.x, corner.y + room.y},
                                              IM_COL32(14, 14, 15, 255));
    if (picture.textureName() != 0) {
        // As large as fits; pixel for pixel where the picture has the pane's size.
        const float fit =
            std::min(room.x / float(picture.width()), room.y / float(picture.height()));
        const ImVec2 size(float(picture.width()) * fit, float(picture.height()) * fit);
        const ImVec2 at(std::floor(corner.x + 0.5f * (room.x - size.x)),
                        std::floor(corner.y + 0.5f * (room.y - size.y)));
        const auto texture = reinterpret_cast<ImTextureID>(uintptr_t(picture.textureName()));
        ImGui::GetWindowDrawList()->AddImage(texture, at, {at.x + size.x, at.y + size.y}, {0, 1},
                                             {1, 0}); // GL's first row is the lowest
    }
    if (picture.textureName() == 0) {
        ImGui::SetCursorScreenPos(
            {corner.x + ImGui::GetFontSize(), corner.y + ImGui::GetFontSize()});
        coloredText(
            kGrey,
            "Rendering the first picture: shaders are compiled now, which may take a while.");
        ImGui::SetCursorScreenPos(corner);
    }
    ImGui::InvisibleButton("picture", room,
                           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                               ImGuiButtonFlags_MouseButtonMiddle);
    moveCamera(session, room.y);
    drawFailure(picture.failure(), corner, room.x);
}

} // namespace tyndall::editor
