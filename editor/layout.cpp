#include "layout.h"

#include <algorithm>
#include <cstdio>

#include <imgui.h>
#include <imgui_internal.h> // settings handlers are not in the public header of this version

#include "panes/panes.h"

namespace tyndall::editor {
namespace {

constexpr float kSmallest = 0.06f, kLargest = 0.94f; // shares that a bar can be dragged to

/// A bar to drag. `share` grows to the right or down, or the other way for `sign` -1; `extent`: pixels of the whole.
void splitter(const char* name, bool vertical, float& share, float extent, float sign,
              float length) {
    const float thickness = std::max(4.0f, ImGui::GetFontSize() * 0.3f);
    ImGui::InvisibleButton(name, vertical ? ImVec2(thickness, length) : ImVec2(length, thickness));
    if (ImGui::IsItemHovered() || ImGui::IsItemActive())
        ImGui::SetMouseCursor(vertical ? ImGuiMouseCursor_ResizeEW : ImGuiMouseCursor_ResizeNS);
    if (ImGui::IsItemActive()) {
        const float moved = vertical ? ImGui::GetIO().MouseDelta.x : ImGui::GetIO().MouseDelta.y;
        share = std::clamp(share + sign * moved / std::max(extent, 1.0f), kSmallest,
                           0.45f + (vertical ? 0.0f : 0.49f));
        ImGui::MarkIniSettingsDirty();
    }
    const ImU32 color =
        ImGui::GetColorU32(ImGui::IsItemActive() || ImGui::IsItemHovered() ? ImGuiCol_ButtonHovered
                                                                           : ImGuiCol_WindowBg);
    ImGui::GetWindowDrawList()->AddRectFilled(ImGui::GetItemRectMin(), ImGui::GetItemRectMax(),
                                              color);
}

using Draw = void (*)(Session&);
struct Tab {
    const char* title;
    Draw draw;
};

/// A child window whose panes are tabs.
void drawTabs(const char* name, const ImVec2& size, const ImVec2& spacing, Session& session,
              std::initializer_list<Tab> tabs) {
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, spacing);
    ImGui::BeginChild(name, size, true);
    if (ImGui::BeginTabBar("tabs")) {
        for (const Tab& tab : tabs) {
            if (!ImGui::BeginTabItem(tab.title)) continue;
            ImGui::BeginChild(tab.title);
            tab.draw(session);
            ImGui::EndChild();
            ImGui::EndTabItem();
        }
        ImGui::EndTabBar();
    }
    ImGui::EndChild();
    ImGui::PopStyleVar();
}

} // namespace

void Layout::drawLeft(Session& session, const Room& room, float width) {
    ImGui::BeginGroup();
    const float upper = room.height * shares_.leftUpper;
    drawTabs("scene", {width, upper}, paneSpacing_, session, {{"Scene", drawSceneTree}});
    splitter("##leftBar", false, shares_.leftUpper, room.height, 1, width);
    drawTabs("inspector", {width, room.height - upper - room.bar}, paneSpacing_, session,
             {{"Inspector", drawInspector}});
    ImGui::EndGroup();
}

void Layout::drawMiddle(Session& session, const Room& room, float width) {
    ImGui::BeginGroup();
    const float lower = room.height * shares_.bottom;
    ImGui::BeginChild("viewport", {width, room.height - lower - room.bar}, true,
                      ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, paneSpacing_);
    drawViewport(session);
    ImGui::PopStyleVar();
    ImGui::EndChild();
    splitter("##middleBar", false, shares_.bottom, room.height, -1, width);
    drawTabs("reports", {width, lower}, paneSpacing_, session,
             {{"Profiler", drawProfiler}, {"Frame graph", drawFrameGraph}, {"Log", drawLog}});
    ImGui::EndGroup();
}

void Layout::drawRight(Session& session, const Room& room, float width) {
    ImGui::BeginGroup();
    const float upper = room.height * shares_.rightUpper;
    drawTabs("techniques", {width, upper}, paneSpacing_, session, {{"Techniques", drawTechniques}});
    splitter("##rightBar", false, shares_.rightUpper, room.height, 1, width);
    drawTabs("settings", {width, room.height - upper - room.bar}, paneSpacing_, session,
             {{"Settings", drawSettings}});
    ImGui::EndGroup();
}

void Layout::read(const char* line) {
    Shares read = shares_;
    if (std::sscanf(line, "Shares=%f,%f,%f,%f,%f", &read.left, &read.right, &read.bottom,
                    &read.leftUpper, &read.rightUpper) != 5)
        return;
    for (const float share : {read.left, read.right, read.bottom, read.leftUpper, read.rightUpper})
        if (!(share >= kSmallest && share <= kLargest)) return; // edited by hand, or damaged
    if (read.left + read.right < kLargest) shares_ = read;
}

void Layout::write(const char* section, ImGuiTextBuffer& text) const {
    text.appendf("[%s][Panes]\nShares=%.4f,%.4f,%.4f,%.4f,%.4f\n\n", section, double(shares_.left),
                 double(shares_.right), double(shares_.bottom), double(shares_.leftUpper),
                 double(shares_.rightUpper));
}

void Layout::remember() {
    ImGuiSettingsHandler handler;
    handler.TypeName = "Tyndall";
    handler.TypeHash = ImHashStr("Tyndall");
    handler.UserData = this;
    handler.ReadOpenFn = [](ImGuiContext*, ImGuiSettingsHandler* section, const char*) {
        return section->UserData;
    };
    handler.ReadLineFn = [](ImGuiContext*, ImGuiSettingsHandler*, void* layout, const char* line) {
        static_cast<Layout*>(layout)->read(line);
    };
    handler.WriteAllFn = [](ImGuiContext*, ImGuiSettingsHandler* section, ImGuiTextBuffer* text) {
        static_cast<const Layout*>(section->UserData)->write(section->TypeName, *text);
    };
    ImGui::GetCurrentContext()->SettingsHandlers.push_back(handler);
}

void Layout::reset() {
    shares_ = {};
    ImGui::MarkIniSettingsDirty();
}

void Layout::draw(Session& session) {
    const ImVec2 all = ImGui::GetContentRegionAvail();
    const Room room{all.x, all.y, std::max(4.0f, ImGui::GetFontSize() * 0.3f)};
    const float left = room.width * shares_.left, right = room.width * shares_.right;
    // Bars are what lies between panes: no other room.
    paneSpacing_ = ImGui::GetStyle().ItemSpacing;
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(0, 0));
    drawLeft(session, room, left);
    ImGui::SameLine(0, 0);
    splitter("##left", true, shares_.left, room.width, 1, room.height);
    ImGui::SameLine(0, 0);
    drawMiddle(session, room, room.width - left - right - 2 * room.bar);
    ImGui::SameLine(0, 0);
    splitter("##right", true, shares_.right, room.width, -1, room.height);
    ImGui::SameLine(0, 0);
    drawRight(session, room, right);
    ImGui::PopStyleVar();
}

} // namespace tyndall::editor
