#include "widgets.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>

#include <fmt/format.h>
#include <imgui_internal.h> // closing popups is not in the public header

namespace tyndall::editor {
namespace {

template <typename T> T valueOf(const SettingDesc& field, const void* values) {
    T value;
    std::memcpy(&value, static_cast<const char*>(values) + field.offset, sizeof value);
    return value;
}

bool checkbox(const SettingDesc& field, const void* values, std::string& changed) {
    bool value = valueOf<bool>(field, values);
    if (!ImGui::Checkbox("##value", &value)) return false;
    changed = value ? "true" : "false";
    return true;
}

bool choice(const SettingDesc& field, const void* values, std::string& changed) {
    int value = valueOf<int32_t>(field, values);
    if (!ImGui::Combo("##value", &value, field.enumNames, int(field.enumCount))) return false;
    changed = field.enumNames[value];
    return true;
}

bool integer(TypedNumber& typed, const SettingDesc& field, const void* values,
             std::string& changed) {
    int32_t value = valueOf<int32_t>(field, values);
    const std::string format = fmt::format("%d {}", field.unit);
    const float speed = std::max(0.05f, float(field.maximum - field.minimum) / 2000);
    if (!dragNumbers(
            typed, &value, 1,
            {speed, field.minimum, field.maximum, format.c_str(), ImGuiSliderFlags_AlwaysClamp}))
        return false;
    changed = std::to_string(value);
    return true;
}

bool real(TypedNumber& typed, const SettingDesc& field, const void* values, std::string& changed) {
    float value = valueOf<float>(field, values);
    // Ranges that span decades are dragged by ratio.
    const bool wide = field.minimum >= 0 && field.maximum > 100 * std::max(field.minimum, 1e-30);
    const float speed = std::max(std::abs(value), wide ? 1e-4f : 0.01f) / 100;
    const std::string format =
        fmt::format("%.4g {}", std::strcmp(field.unit, "%") == 0 ? "%%" : field.unit);
    if (!dragNumbers(typed, &value, 1,
                     {speed, field.minimum, field.maximum, format.c_str(),
                      ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoRoundToFormat}))
        return false;
    changed = fmt::format("{}", value);
    return true;
}

std::string helpText(const SettingDesc& field) {
    std::string help = fmt::format("{}\n{}", field.help, field.key);
    if (field.type == SettingType::Int || field.type == SettingType::Float)
        help += fmt::format("\n{:g} to {:g}{}{}", field.minimum, field.maximum,
                            *field.unit ? " " : "", field.unit);
    return help + "\nDefault: " + settingDefaultText(field);
}

/// Takes effect when it is entered: half a word is seldom a value.
bool words(const SettingDesc& field, const void* values, std::string& changed) {
    auto value = valueOf<SettingText>(field, values);
    if (!ImGui::InputText("##value", value.bytes, sizeof value.bytes,
                          ImGuiInputTextFlags_EnterReturnsTrue))
        return false;
    changed = value.view();
    return true;
}

} // namespace

void text(const std::string& value) {
    ImGui::TextUnformatted(value.data(), value.data() + value.size());
}

void coloredText(const ImVec4& color, const std::string& value) {
    ImGui::PushStyleColor(ImGuiCol_Text, color);
    text(value);
    ImGui::PopStyleColor();
}

void tooltip(const std::string& value) {
    if (!ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(ImGui::GetFontSize() * 28);
    text(value);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

bool settingWidget(TypedNumber& typed, const SettingDesc& field, const void* values, float width,
                   std::string& changed) {
    ImGui::SetNextItemWidth(width);
    switch (field.type) {
    case SettingType::Bool: return checkbox(field, values, changed);
    case SettingType::Int: return integer(typed, field, values, changed);
    case SettingType::Float: return real(typed, field, values, changed);
    case SettingType::Enum: return choice(field, values, changed);
    case SettingType::Text: return words(field, values, changed);
    }
    return false;
}

bool beginSettingRows(const char* id) {
    if (!ImGui::BeginTable(id, 3, ImGuiTableFlags_SizingStretchSame)) return false;
    ImGui::TableSetupColumn("reset", ImGuiTableColumnFlags_WidthFixed, ImGui::GetFrameHeight());
    ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthStretch);
    ImGui::TableSetupColumn("value", ImGuiTableColumnFlags_WidthStretch);
    return true;
}

std::optional<SettingEdit> settingRow(TypedNumber& typed, const SettingDesc& field,
                                      const void* values) {
    std::optional<SettingEdit> edit;
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::PushID(field.key);
    const std::string now = settingToText(field, values), standard = settingDefaultText(field);
    const bool differs = now != standard;
    ImGui::BeginDisabled(!differs);
    if (ImGui::Button("\u2190##reset", {ImGui::GetFrameHeight(), 0})) edit = {standard, true};
    ImGui::EndDisabled();
    tooltip((differs ? "Back to its default: " : "It has its default: ") + standard);
    ImGui::TableNextColumn();
    ImGui::AlignTextToFramePadding();
    differs ? coloredText(kWarn, field.name) : text(field.name);
    tooltip(helpText(field));
    ImGui::TableNextColumn();
    std::string changed;
    if (settingWidget(typed, field, values, -1, changed) && changed != now) edit = {changed, false};
    tooltip(helpText(field));
    ImGui::PopID();
    return edit;
}

bool closeInnermostPopup() {
    const int open = ImGui::GetCurrentContext()->OpenPopupStack.Size;
    if (open > 0) ImGui::ClosePopupToLevel(open - 1, true);
    return open > 0;
}

void flow(float width) {
    const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
    const float spacing = ImGui::GetStyle().ItemSpacing.x;
    if (ImGui::GetItemRectMax().x + spacing + width <= right) ImGui::SameLine();
}

std::string byteText(uint64_t bytes) {
    if (bytes < 1024) return fmt::format("{} B", bytes);
    if (bytes < 1024 * 1024) return fmt::format("{:.1f} KiB", double(bytes) / 1024);
    return fmt::format("{:.1f} MiB", double(bytes) / (1024 * 1024));
}

bool contains(const std::string& text, const std::string& needle) {
    const auto same = [](char a, char b) {
        return std::tolower(static_cast<unsigned char>(a)) ==
               std::tolower(static_cast<unsigned char>(b));
    };
    return std::search(text.begin(), text.end(), needle.begin(), needle.end(), same) != text.end();
}

} // namespace tyndall::editor
