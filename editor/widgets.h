#pragma once
// Small things that several panes draw.

#include <optional>
#include <string>

#include <imgui.h>

#include "core/settings.h"
#include "number_field.h"

namespace tyndall::editor {

inline const ImVec4 kGrey{0.55f, 0.55f, 0.57f, 1};
inline const ImVec4 kGood{0.55f, 0.8f, 0.55f, 1};
inline const ImVec4 kWarn{0.95f, 0.75f, 0.35f, 1};
inline const ImVec4 kBad{0.95f, 0.45f, 0.4f, 1};

void text(const std::string& value);
void coloredText(const ImVec4& color, const std::string& value);
/// Shown while the mouse rests on the last item.
void tooltip(const std::string& value);
/// The widget of one setting at the cursor, as wide as `width`. True when the user changed it; `changed` is then the new text.
bool settingWidget(TypedNumber& typed, const SettingDesc& field, const void* values, float width,
                   std::string& changed);
/// What the user did in a row of a setting.
struct SettingEdit {
    std::string text; // the new value
    bool reset;       // to the default
};
/// A table for settingRow().
bool beginSettingRows(const char* id);
/// A button that resets, name and widget of one setting: a row of a table that beginSettingRows() began. The button comes first, so that it is seen however
/// narrow the pane is; it is enabled where the value is not the default.
std::optional<SettingEdit> settingRow(TypedNumber& typed, const SettingDesc& field,
                                      const void* values);
/// Closes the innermost menu, list or dialog that is open. False: there is none.
bool closeInnermostPopup();
/// The next item, so many pixels wide, comes beside the last one, or in a new line where there is no room for it.
void flow(float width);
/// "12.3 MB".
std::string byteText(uint64_t bytes);
/// Is `needle` in `text`, whatever the case? An empty needle is everywhere.
bool contains(const std::string& text, const std::string& needle);

} // namespace tyndall::editor
