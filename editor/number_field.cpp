#include "number_field.h"

#include <cmath>

#include <imgui_internal.h> // which field is being typed into is not in the public header

namespace tyndall::editor {
namespace {

constexpr ImGuiDataType typeOf(double) { return ImGuiDataType_Double; }
constexpr ImGuiDataType typeOf(float) { return ImGuiDataType_Float; }
constexpr ImGuiDataType typeOf(int32_t) { return ImGuiDataType_S32; }

template <typename T>
bool dragEach(TypedNumber& typed, T* values, int count, const NumberStyle& style) {
    const T least = T(style.least), most = T(style.most);
    const bool limited = least < most;
    bool any = false;
    ImGui::BeginGroup();
    ImGui::PushMultiItemsWidths(count, ImGui::CalcItemWidth());
    for (int i = 0; i < count; ++i) {
        if (i > 0) ImGui::SameLine(0, ImGui::GetStyle().ItemInnerSpacing.x);
        ImGui::PushID(i);
        T value = values[i];
        const bool changed = ImGui::DragScalar(
            "##value", typeOf(value), &value, style.speed, limited ? &least : nullptr,
            limited ? &most : nullptr, style.format, style.flags);
        if (takeNumber(typed, changed, values[i], value)) {
            values[i] = value;
            any = true;
        }
        ImGui::PopID();
        ImGui::PopItemWidth();
    }
    ImGui::EndGroup();
    return any;
}

} // namespace

template <typename T> bool takeNumber(TypedNumber& typed, bool changed, T before, T& value) {
    const ImGuiContext& context = *ImGui::GetCurrentContext();
    const ImGuiID field = ImGui::GetItemID();
    if (context.TempInputId != field) { // nobody types: it was dragged, if anything
        if (!changed) value = before;
        return changed;
    }
    if (changed) typed = {field, double(value)};
    value = before;
    if (context.ActiveId == field || typed.field != field)
        return false; // still typing, or nothing was typed
    const bool taken = !ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape));
    if (taken) value = T(typed.value);
    typed = {};
    return taken && value != before;
}

template bool takeNumber(TypedNumber&, bool, double, double&);
template bool takeNumber(TypedNumber&, bool, float, float&);
template bool takeNumber(TypedNumber&, bool, int32_t, int32_t&);

double withoutNegativeZero(double value, int decimals) {
    return std::abs(value) < 0.5 * std::pow(10.0, -decimals) ? 0 : value;
}

bool dragNumbers(TypedNumber& typed, double* values, int count, const NumberStyle& style) {
    return dragEach(typed, values, count, style);
}
bool dragNumbers(TypedNumber& typed, float* values, int count, const NumberStyle& style) {
    return dragEach(typed, values, count, style);
}
bool dragNumbers(TypedNumber& typed, int32_t* values, int count, const NumberStyle& style) {
    return dragEach(typed, values, count, style);
}

} // namespace tyndall::editor
