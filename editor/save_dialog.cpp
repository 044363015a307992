#include "save_dialog.h"

#include <imgui.h>
#include <imgui_stdlib.h>

#include "widgets.h"

namespace tyndall::editor {
namespace fs = std::filesystem;
namespace {

constexpr const char* kName = "Save a copy";
constexpr const char* kReplace = "Replace the file?";
constexpr const char* kQuit = "Quit?";

bool beginDialog(const char* name) {
    return ImGui::BeginPopupModal(name, nullptr, ImGuiWindowFlags_AlwaysAutoResize);
}

} // namespace

void SaveDialog::ask(bool quitAfterwards) {
    asked_ = true;
    quitAfterwards_ = quitAfterwards;
    failure_.clear();
}

fs::path SaveDialog::fullPath() const {
    std::error_code error;
    const fs::path path = fs::absolute(path_, error);
    return error ? fs::path(path_) : path.lexically_normal();
}

/// True when the file is there.
bool SaveDialog::write(const Save& save) {
    const Result<void> written = save(path_);
    failure_ = written.ok() ? "" : written.message();
    quits_ |= written.ok() && quitAfterwards_;
    return written.ok();
}

void SaveDialog::draw(bool unsavedEdits, const Save& save) {
    drawQuit(unsavedEdits);
    if (asked_) ImGui::OpenPopup(kName);
    asked_ = false;
    drawName(save);
}

void SaveDialog::drawName(const Save& save) {
    if (!beginDialog(kName)) return;
    ImGui::SetNextItemWidth(ImGui::GetFontSize() * 28);
    if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
    const bool entered = ImGui::InputText("##path", &path_, ImGuiInputTextFlags_EnterReturnsTrue);
    const bool escaped = ImGui::IsItemDeactivated() &&
                         ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape), false);
    ImGui::PushTextWrapPos(ImGui::GetFontSize() * 28);
    if (!failure_.empty()) coloredText(kBad, failure_);
    ImGui::PopTextWrapPos();
    const bool wanted = ImGui::Button("Save") || entered;
    std::error_code error;
    if (wanted && !path_.empty() && fs::exists(path_, error))
        ImGui::OpenPopup(kReplace);
    else if (wanted && !path_.empty() && write(save))
        ImGui::CloseCurrentPopup();
    ImGui::SameLine();
    if (ImGui::Button("Cancel") || escaped) ImGui::CloseCurrentPopup();
    drawReplace(save);
    ImGui::EndPopup();
}

/// Inside the dialog for the name: both are closed once the file is written.
void SaveDialog::drawReplace(const Save& save) {
    bool written = false;
    if (beginDialog(kReplace)) {
        text(fullPath().string());
        text("is there already. What it holds now will be lost.");
        if (ImGui::Button("Replace")) {
            written = write(save);
            ImGui::CloseCurrentPopup();
        }
        ImGui::SameLine();
        if (ImGui::Button("Cancel")) ImGui::CloseCurrentPopup();
        ImGui::EndPopup();
    }
    if (written) ImGui::CloseCurrentPopup();
}

void SaveDialog::drawQuit(bool unsavedEdits) {
    quits_ |= quitAsked_ && !unsavedEdits;
    if (quitAsked_ && !quits_) ImGui::OpenPopup(kQuit);
    quitAsked_ = false;
    if (!beginDialog(kQuit)) return;
    text("The scene has edits that are in no file.");
    if (ImGui::Button("Save a copy and quit...")) {
        ask(true);
        ImGui::CloseCurrentPopup();
    }
    ImGui::SameLine();
    if (ImGui::Button("Quit without them")) quits_ = true;
    ImGui::SameLine();
    if (ImGui::Button("Stay")) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
}

} // namespace tyndall::editor
