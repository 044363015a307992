#include <algorithm>
#include <cctype>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "panes/panes.h"
#include "widgets.h"

namespace tyndall::editor {
namespace {

std::string defaultText(const SettingDesc& field) {
    switch (field.type) {
    case SettingType::Bool: return field.defaultValue != 0 ? "true" : "false";
    case SettingType::Int: return std::to_string(int(field.defaultValue));
    case SettingType::Float: return fmt::format("{}", float(field.defaultValue));
    case SettingType::Enum: return field.enumNames[size_t(field.defaultValue)];
    }
    return {};
}

std::string helpText(const SettingDesc& field) {
    std::string help = fmt::format("{}\n{}", field.help, field.key);
    if (field.type == SettingType::Int || field.type == SettingType::Float)
        help += fmt::format("\n{:g} to {:g}{}{}", field.minimum, field.maximum, *field.unit ? " " : "", field.unit);
    return help + "\nDefault: " + defaultText(field);
}

/// "media" of "media.march.steps".
std::string roomOf(const SettingDesc& field) {
    const std::string key = field.key;
    return key.substr(0, key.find('.'));
}

void drawSetting(Session& session, const SettingDesc& field, const void* values) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::PushID(field.key);
    ImGui::AlignTextToFramePadding();
    const std::string now = settingToText(field, values), standard = defaultText(field);
    const bool changedBefore = now != standard;
    changedBefore ? coloredText(kWarn, field.name) : text(field.name);
    tooltip(helpText(field));
    ImGui::TableNextColumn();
    const float button = ImGui::GetFrameHeight() + ImGui::GetStyle().ItemInnerSpacing.x;
    std::string changed;
    if (settingWidget(field, values, ImGui::GetContentRegionAvail().x - button, changed) && changed != now)
        session.edit(changeSettings(session.settings(), fmt::format("set {}", field.key), {{field.key, changed}}));
    tooltip(helpText(field));
    if (changedBefore) {
        ImGui::SameLine(ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x - ImGui::GetFrameHeight());
        if (ImGui::Button("x", {ImGui::GetFrameHeight(), 0}))
            session.edit(changeSettings(session.settings(), fmt::format("reset {}", field.key), {{field.key, standard}}));
        tooltip("Back to its default: " + standard);
    }
    ImGui::PopID();
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
            session.edit(changeSettings(session.settings(), "apply the preset " + name, assignments));
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
    static std::string filter;
    drawPresets(session);
    ImGui::SetNextItemWidth(-1);
    ImGui::InputTextWithHint("##filter", "find a setting", &filter);
    std::string room;
    bool open = false;
    const auto close = [&open] {
        if (open) ImGui::EndTable();
        open = false;
    };
    for (const SettingsGroup& group : session.settings().groups())
        for (const SettingDesc& field : group.fields) {
            if (!contains(field.key, filter) && !contains(field.name, filter)) continue;
            if (roomOf(field) != room) {
                close();
                room = roomOf(field);
                std::string title = room;
                std::replace(title.begin(), title.begin() + 1, title[0], char(std::toupper(static_cast<unsigned char>(title[0]))));
                ImGui::PushID(field.key);
                if (!filter.empty()) ImGui::SetNextItemOpen(true);
                if (ImGui::CollapsingHeader(title.c_str(), ImGuiTreeNodeFlags_DefaultOpen))
                    open = ImGui::BeginTable("fields", 2, ImGuiTableFlags_SizingStretchSame);
                ImGui::PopID();
            }
            if (open) drawSetting(session, field, group.values);
        }
    close();
}

} // namespace tyndall::editor
