#include <fmt/format.h>

#include "panes/panes.h"
#include "widgets.h"

namespace tyndall::editor {
namespace {

const ImVec4& colorOf(log::Level level) {
    switch (level) {
    case log::Level::Error: return kBad;
    case log::Level::Warning: return kWarn;
    case log::Level::Info: return ImGui::GetStyle().Colors[ImGuiCol_Text];
    case log::Level::Debug: break;
    }
    return kGrey;
}

} // namespace

void drawLog(Session& session) {
    Messages& messages = session.messages();
    const std::vector<Messages::Entry> entries = messages.entries();
    if (ImGui::SmallButton("Clear")) messages.clear();
    ImGui::SameLine();
    if (ImGui::SmallButton("Copy")) {
        std::string all;
        for (const Messages::Entry& entry : entries) all += entry.text + "\n";
        ImGui::SetClipboardText(all.c_str());
    }
    ImGui::BeginChild("messages");
    ImGui::PushTextWrapPos(0);
    for (const Messages::Entry& entry : entries)
        coloredText(colorOf(entry.level),
                    entry.count > 1 ? fmt::format("{} ({} times)", entry.text, entry.count)
                                    : entry.text);
    ImGui::PopTextWrapPos();
    size_t& seen = session.panes.messagesSeen;
    if (messages.total() != seen) ImGui::SetScrollHereY(1); // follow new messages
    seen = messages.total();
    ImGui::EndChild();
}

} // namespace tyndall::editor
