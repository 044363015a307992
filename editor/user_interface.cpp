#include "user_interface.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include "gl/screen.h"

namespace tyndall::editor {
namespace fs = std::filesystem;
namespace {

constexpr double kMoment = 1.0 / 60; // seconds
constexpr float kFontPixels = 15;
constexpr const char* kFont = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
// Latin, Greek and what formulas and units use; pairs of first and last, ended by zero.
constexpr ImWchar kLetters[] = {0x20,   0xff,   0x391,  0x3c9,  0x2010, 0x2026, 0x2070, 0x2089,
                                0x2190, 0x2193, 0x2212, 0x2212, 0x2248, 0x2265, 0};

void setColors(ImGuiStyle& style) {
    ImGui::StyleColorsDark(&style);
    const auto grey = [](float value, float alpha = 1) {
        return ImVec4(value, value, value + 0.006f, alpha);
    };
    const ImVec4 accent(0.29f, 0.45f, 0.62f, 1), bright(0.36f, 0.55f, 0.75f, 1);
    ImVec4* colors = style.Colors;
    colors[ImGuiCol_Text] = grey(0.88f);
    colors[ImGuiCol_WindowBg] = grey(0.105f);
    colors[ImGuiCol_ChildBg] = grey(0.135f);
    colors[ImGuiCol_PopupBg] = grey(0.16f, 0.98f);
    colors[ImGuiCol_MenuBarBg] = grey(0.16f);
    colors[ImGuiCol_Border] = grey(0.22f);
    colors[ImGuiCol_FrameBg] = grey(0.2f);
    colors[ImGuiCol_FrameBgHovered] = grey(0.25f);
    colors[ImGuiCol_FrameBgActive] = grey(0.3f);
    colors[ImGuiCol_Button] = grey(0.24f);
    colors[ImGuiCol_ButtonHovered] = accent;
    colors[ImGuiCol_ButtonActive] = bright;
    colors[ImGuiCol_Header] = ImVec4(0.24f, 0.33f, 0.43f, 1);
    colors[ImGuiCol_HeaderHovered] = ImVec4(0.27f, 0.38f, 0.5f, 1);
    colors[ImGuiCol_HeaderActive] = accent;
    colors[ImGuiCol_Tab] = grey(0.16f);
    colors[ImGuiCol_TabHovered] = accent;
    colors[ImGuiCol_TabActive] = ImVec4(0.24f, 0.33f, 0.43f, 1);
    colors[ImGuiCol_CheckMark] = bright;
    colors[ImGuiCol_TableHeaderBg] = grey(0.18f);
    colors[ImGuiCol_TableRowBg] = ImVec4(0, 0, 0, 0);
    colors[ImGuiCol_TableRowBgAlt] = ImVec4(1, 1, 1, 0.018f);
    colors[ImGuiCol_Separator] = grey(0.22f);
}

void setStyle(float scale) {
    ImGuiStyle style;
    setColors(style);
    style.WindowRounding = style.ChildRounding = 0;
    style.FrameRounding = style.TabRounding = style.GrabRounding = 2;
    style.WindowPadding = {8, 6};
    style.FramePadding = {6, 3};
    style.ItemSpacing = {7, 4};
    style.IndentSpacing = 14;
    style.ScrollbarSize = 12;
    style.ScaleAllSizes(scale);
    ImGui::GetStyle() = style;
}

} // namespace

std::string layoutFile() {
    const char* config = std::getenv("XDG_CONFIG_HOME");
    const char* home = std::getenv("HOME");
    fs::path folder;
    if (config && *config)
        folder = config;
    else if (home && *home)
        folder = fs::path(home) / ".config";
    else
        return {};
    folder /= "tyndall";
    std::error_code error;
    fs::create_directories(folder, error);
    return error ? std::string() : (folder / "imgui.ini").string();
}

UserInterface::UserInterface(gl::Window& window, Layout& layout, bool keepLayout)
    : layoutFile_(keepLayout ? layoutFile() : std::string()) {
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = layoutFile_.empty() ? nullptr : layoutFile_.c_str();
    io.ConfigInputTextCursorBlink =
        false; // or the window could not rest while the cursor stands in a field
    layout.remember();
    float scale = 1, vertical = 1;
    glfwGetWindowContentScale(window.handle(), &scale, &vertical);
    scale = std::clamp(scale, 1.0f, 4.0f);
    setStyle(scale);
    std::error_code error;
    if (fs::exists(kFont, error)) {
        io.Fonts->AddFontFromFileTTF(kFont, kFontPixels * scale, nullptr, kLetters);
    } else {
        ImFontConfig config;
        config.SizePixels = 13 * scale; // of the font inside ImGui, which has Latin letters only
        io.Fonts->AddFontDefault(&config);
    }
    ImGui_ImplGlfw_InitForOpenGL(window.handle(), false); // events come from the queue
    ImGui_ImplOpenGL3_Init("#version 450 core");
}

UserInterface::~UserInterface() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

void UserInterface::beginFrame(InputQueue& queue) {
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    const std::vector<InputEvent> events = queue.takeFrame();
    const double now = glfwGetTime();
    // GLFW does not say when an event was made. Of several that waited each takes a moment, so that a key moves the camera however short it was.
    const bool together = moreWaited_ || !queue.empty();
    const double passed = std::max(now - lastFrame_, together ? kMoment : 0);
    moreWaited_ = !queue.empty();
    lastFrame_ = now;
    feed_.apply(events, passed);
    ImGui::NewFrame();
}

void UserInterface::endFrameUnseen() { ImGui::EndFrame(); }

void UserInterface::endFrame(ivec2 framebufferSize) {
    ImGui::Render();
    gl::beginWindowFrame(framebufferSize.x, framebufferSize.y, 0.105f, 0.105f, 0.11f);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

} // namespace tyndall::editor
