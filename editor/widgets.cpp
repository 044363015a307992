#include "widgets.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

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

bool integer(const SettingDesc& field, const void* values, std::string& changed) {
    int value = valueOf<int32_t>(field, values);
    const int least = int(field.minimum), most = int(field.maximum);
    const std::string format = fmt::format("%d {}", field.unit);
    const float speed = std::max(0.05f, float(most - least) / 2000);
    if (!ImGui::DragInt("##value", &value, speed, least, most, format.c_str(),
                        ImGuiSliderFlags_AlwaysClamp))
        return false;
    changed = std::to_string(value);
    return true;
}

bool real(const SettingDesc& field, const void* values, std::string& changed) {
    float value = valueOf<float>(field, values);
    const auto least = float(field.minimum), most = float(field.maximum);
    // Ranges that span decades are dragged by ratio.
    const bool wide = field.minimum >= 0 && field.maximum > 100 * std::max(field.minimum, 1e-30);
    const float speed = std::max(std::abs(value), wide ? 1e-4f : 0.01f) / 100;
    const std::string format =
        fmt::format("%.4g {}", std::strcmp(field.unit, "%") == 0 ? "%%" : field.unit);
    if (!ImGui::DragFloat("##value", &value, speed, least, most, format.c_str(),
                          ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoRoundToFormat))
        return false;
    changed = fmt::format("{}", value);
    return true;
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

bool settingWidget(const SettingDesc& field, const void* values, float width,
                   std::string& changed) {
    ImGui::SetNextItemWidth(width);
    switch (field.type) {
    case SettingType::Bool: return checkbox(field, values, changed);
    case SettingType::Int: return integer(field, values, changed);
    case SettingType::Float: return real(field, values, changed);
    case SettingType::Enum: return choice(field, values, changed);
    case SettingType::Text: return words(field, values, changed);
    }
    return false;
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
