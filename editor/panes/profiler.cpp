#include <algorithm>

#include <fmt/format.h>

#include "panes/panes.h"
#include "widgets.h"

namespace tyndall::editor {
namespace {

std::string milliseconds(double value) { return value < 0 ? "-" : fmt::format("{:.3f}", value); }

void drawPass(const fg::PassReport& pass, double largest) {
    ImGui::TableNextRow();
    const bool ran = pass.status == fg::PassStatus::Ran;
    if (!ran) ImGui::PushStyleColor(ImGuiCol_Text, kGrey);
    ImGui::TableNextColumn();
    text(std::string(pass.name));
    ImGui::TableNextColumn();
    if (ran) {
        const float share = pass.gpuMs > 0 && largest > 0 ? float(pass.gpuMs / largest) : 0;
        ImGui::PushStyleColor(ImGuiCol_PlotHistogram, ImVec4(0.29f, 0.45f, 0.62f, 1));
        ImGui::ProgressBar(share, {-1, ImGui::GetTextLineHeight()},
                           milliseconds(pass.gpuMs).c_str());
        ImGui::PopStyleColor();
    }
    ImGui::TableNextColumn();
    if (ran) text(milliseconds(pass.cpuMs));
    ImGui::TableNextColumn();
    if (!ran) {
        const std::string saved =
            pass.savedMs >= 0 ? fmt::format(" (saves {:.2f} ms)", pass.savedMs) : "";
        text(fmt::format("{}: {}{}", fg::statusName(pass.status), pass.reason, saved));
        tooltip(std::string(pass.reason));
    }
    if (!ran) ImGui::PopStyleColor();
}

} // namespace

void drawProfiler(Session& session) {
    const fg::FrameReport& report = session.renderer().report();
    const bool measured = report.gpuMs >= 0;
    text(fmt::format("GPU {} ms   CPU {:.2f} ms   {} on the GPU   {} barriers",
                     measured ? fmt::format("{:.2f}", report.gpuMs) : "-", report.cpuMs,
                     byteText(report.gpuBytes), report.barriers));
    double largest = 0;
    for (const fg::PassReport& pass : report.passes)
        if (pass.status == fg::PassStatus::Ran) largest = std::max(largest, pass.gpuMs);
    const ImGuiTableFlags flags = ImGuiTableFlags_ScrollY | ImGuiTableFlags_RowBg |
                                  ImGuiTableFlags_Resizable | ImGuiTableFlags_BordersInnerV;
    if (!ImGui::BeginTable("passes", 4, flags)) return;
    ImGui::TableSetupScrollFreeze(0, 1);
    ImGui::TableSetupColumn("pass", ImGuiTableColumnFlags_WidthStretch, 3);
    ImGui::TableSetupColumn("GPU ms", ImGuiTableColumnFlags_WidthStretch, 3);
    ImGui::TableSetupColumn("CPU ms", ImGuiTableColumnFlags_WidthStretch, 1);
    ImGui::TableSetupColumn("why it did not run", ImGuiTableColumnFlags_WidthStretch, 5);
    ImGui::TableHeadersRow();
    for (const fg::PassReport& pass : report.passes) drawPass(pass, largest);
    ImGui::EndTable();
}

} // namespace tyndall::editor
