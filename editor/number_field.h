#pragma once
// Fields for numbers: what is dragged takes effect at once, what is typed when it is entered or the field is left; Esc takes it back.

#include <cstdint>

#include <imgui.h>

namespace tyndall::editor {

/// The number that is being typed, of whichever field. One for all fields; belongs to who draws them.
struct TypedNumber {
    ImGuiID field = 0;
    double value = 0;
};

/// Right after a number's widget, which says whether it changed `value` from `before`. True when `value` is to be taken; else it is `before` again.
template <typename T> bool takeNumber(TypedNumber& typed, bool changed, T before, T& value);

/// Where a number is shown with so many decimals, one that would be shown as "-0.00" is 0.
double withoutNegativeZero(double value, int decimals);

/// How numbers are dragged and shown.
struct NumberStyle {
    float speed = 1;  // of a pixel's drag
    double least = 0; // both 0: no limits
    double most = 0;
    const char* format = "%.3g";
    ImGuiSliderFlags flags = 0;
};

/// `count` numbers beside each other, together as wide as the next item. True when one of them changed.
bool dragNumbers(TypedNumber& typed, double* values, int count, const NumberStyle& style);
bool dragNumbers(TypedNumber& typed, float* values, int count, const NumberStyle& style);
bool dragNumbers(TypedNumber& typed, int32_t* values, int count, const NumberStyle& style);

} // namespace tyndall::editor
