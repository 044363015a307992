#include <algorithm>
#include <cctype>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "panes/panes.h"
#include "widgets.h"

namespace tyndall::editor {
namespace {

/// Settings whose keys begin with the same word, whoever registered them.
struct Room {
    std::string title; // "Media" of "media.march.steps"
    std::vector<std::pair<const SettingDesc*, const void*>> fields;
};

/// In the order in which their first settings were registered.
std::vector<Room> roomsOf(const SettingsRegistry& settings, const std::string& filter) {
    std::vector<Room> rooms;
    for (const SettingsGroup& group : settings.groups())
        for (const SettingDesc& field : group.fields) {
            if (!contains(field.key, filter) && !contains(field.name, filter)) continue;
            std::string title(
                std::string_view(field.key).substr(0, std::string_view(field.key).find('.')));
            title[0] = char(std::toupper(static_cast<unsigned char>(title[0])));
            auto room = std::find_if(rooms.begin(), rooms.end(),
                                     [&](const Room& known) { return known.title == title; });
            if (room == rooms.end()) room = rooms.insert(room, {title, {}});
            room->fields.emplace_back(&field, group.values);
        }
    return rooms;
}

void drawSetting(Session& session, const SettingDesc& field, const void* values) {
    const std::optional<SettingEdit> edit = settingRow(session.panes.typed, field, values);
    if (edit)
        session.edit(changeSettings(session.settings(),
                                    fmt::format("{} {}", edit->reset ? "reset" : "set", field.key),
                                    {{field.key, edit->text}}));
}

void drawPresets(Session& session) {
    ImGui::AlignTextToFramePadding();
    text("Preset");
    for (const Quality quality : {Quality::Low, Quality::Medium, Quality::High, Quality::Ultra}) {
        ImGui::SameLine();
        const std::string name(qualityName(quality));
        if (ImGui::SmallButton(name.c_str())) {
            std::vector<std::pair<std::string, std::string>> assignments;
            for (const PresetEntry& entry : session.settings().presets())
                if (entry.quality == quality) assignments.emplace_back(entry.key, entry.value);
            session.edit(
                changeSettings(session.settings(), "apply the preset " + name, assignments));
        }
        if (!ImGui::IsItemHovered()) continue;
        std::string entries = "Sets";
        for (const PresetEntry& entry : session.settings().presets())
            if (entry.quality == quality) entries += fmt::format("\n{}={}", entry.key, entry.value);
        tooltip(entries);
    }
}

} // namespace

void drawSettings(Session& session) {
    std::string& filter = session.panes.settingFilter;
    drawPresets(session);
    ImGui::SetNextItemWidth(-1);
    ImGui::InputTextWithHint("##filter", "find a setting", &filter);
    for (const Room& room : roomsOf(session.settings(), filter)) {
        if (!filter.empty()) ImGui::SetNextItemOpen(true);
        if (!ImGui::CollapsingHeader(room.title.c_str(), ImGuiTreeNodeFlags_DefaultOpen)) continue;
        if (!beginSettingRows(room.title.c_str())) continue;
        for (const auto& [field, values] : room.fields) drawSetting(session, *field, values);
        ImGui::EndTable();
    }
}

} // namespace tyndall::editor
