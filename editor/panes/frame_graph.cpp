#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "framegraph/access.h"
#include "panes/panes.h"
#include "widgets.h"

namespace tyndall::editor {
namespace {

std::string describe(const fg::CompiledResource& resource) {
    if (resource.isBuffer) return "buffer";
    const fg::TextureDesc& desc = resource.texture;
    std::string result =
        fmt::format("{} {} x {}", fg::formatName(desc.format), desc.width, desc.height);
    if (desc.kind != fg::TextureKind::Tex2D) result += fmt::format(" x {}", desc.depth);
    return desc.mips > 1 ? fmt::format("{}, {} levels", result, desc.mips) : result;
}

void drawResource(Session& session, const fg::CompiledGraph& graph, size_t index) {
    const fg::CompiledResource& resource = graph.resources[index];
    const std::string name(resource.name);
    const bool showable =
        !resource.isBuffer && resource.used && !fg::isIntegerFormat(resource.texture.format);
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::PushID(int(index));
    if (!showable) ImGui::PushStyleColor(ImGuiCol_Text, kGrey);
    const bool shown = !name.empty() && session.request.inspect == name;
    if (ImGui::Selectable(name.c_str(), shown, ImGuiSelectableFlags_SpanAllColumns) && showable)
        session.request.inspect = shown ? "" : name;
    tooltip(showable ? shown ? "Click to see the picture again" : "Click to see it in the viewport"
            : resource.isBuffer ? "A buffer is not a picture"
            : resource.used     ? "Integers are not shown as a picture"
                                : "No pass of this frame used it");
    ImGui::TableNextColumn();
    text(describe(resource));
    ImGui::TableNextColumn();
    text(byteText(resource.bytes));
    ImGui::TableNextColumn();
    text(fg::originName(resource.origin));
    if (!showable) ImGui::PopStyleColor();
    ImGui::PopID();
}

/// How the resource is shown: the settings whose keys begin with "inspect.".
void drawInspectSettings(Session& session) {
    bool first = true;
    const float width = ImGui::GetFontSize() * 5;
    for (const SettingsGroup& group : session.settings().groups())
        for (const SettingDesc& field : group.fields) {
            if (!std::string_view(field.key).starts_with("inspect.")) continue;
            if (!first) flow(ImGui::CalcTextSize(field.name).x + ImGui::GetFontSize() + width);
            first = false;
            ImGui::PushID(field.key);
            ImGui::AlignTextToFramePadding();
            text(field.name);
            tooltip(field.help);
            ImGui::SameLine();
            std::string changed;
            if (settingWidget(session.panes.typed, field, group.values, width, changed))
                session.edit(changeSettings(session.settings(), fmt::format("set {}", field.key),
                                            {{field.key, changed}}));
            tooltip(field.help);
            ImGui::PopID();
        }
}

void drawResources(Session& session) {
    std::string& filter = session.panes.resourceFilter;
    const fg::CompiledGraph& graph = session.renderer().graph();
    if (session.request.inspect.empty()) {
        ImGui::SetNextItemWidth(-1);
        ImGui::InputTextWithHint(
            "##filter", "find a resource; click a texture to see it in the viewport", &filter);
    } else {
        drawInspectSettings(session);
    }
    const ImGuiTableFlags flags =
        ImGuiTableFlags_ScrollY | ImGuiTableFlags_RowBg | ImGuiTableFlags_Resizable;
    if (!ImGui::BeginTable("resources", 4, flags)) return;
    ImGui::TableSetupScrollFreeze(0, 1);
    ImGui::TableSetupColumn("resource", ImGuiTableColumnFlags_WidthStretch, 3);
    ImGui::TableSetupColumn("kind", ImGuiTableColumnFlags_WidthStretch, 3);
    ImGui::TableSetupColumn("memory", ImGuiTableColumnFlags_WidthStretch, 1);
    ImGui::TableSetupColumn("lives", ImGuiTableColumnFlags_WidthStretch, 2);
    ImGui::TableHeadersRow();
    for (size_t i = 1; i < graph.resources.size(); ++i) // 0 is the null resource
        if (contains(std::string(graph.resources[i].name), filter)) drawResource(session, graph, i);
    ImGui::EndTable();
}

void drawUses(const fg::CompiledGraph& graph, const fg::CompiledPass& pass) {
    for (const fg::ResourceUse& use : graph.usesOf(pass)) {
        const std::string name(graph.resources[use.resource].name);
        ImGui::BulletText("%s %s", fg::isWrite(use.access) ? "writes" : "reads", name.c_str());
        ImGui::SameLine();
        coloredText(kGrey, fg::accessName(use.access));
    }
}

void drawPasses(Session& session) {
    const fg::CompiledGraph& graph = session.renderer().graph();
    coloredText(kGrey, fmt::format("{} of transient resources in {} slots, {} if none were shared",
                                   byteText(graph.pooledBytes()), graph.slots.size(),
                                   byteText(graph.unpooledBytes())));
    ImGui::BeginChild("passes");
    for (size_t i = 0; i < graph.passes.size(); ++i) {
        const fg::CompiledPass& pass = graph.passes[i];
        const bool ran = pass.status == fg::PassStatus::Ran;
        std::string label(pass.name);
        if (!ran) label += fmt::format("   {}: {}", fg::statusName(pass.status), pass.reason);
        ImGui::PushID(int(i));
        if (!ran) ImGui::PushStyleColor(ImGuiCol_Text, kGrey);
        const bool open =
            ImGui::TreeNodeEx("##pass", ImGuiTreeNodeFlags_SpanAvailWidth, "%s", label.c_str());
        if (!ran) ImGui::PopStyleColor();
        if (open) {
            drawUses(graph, pass);
            ImGui::TreePop();
        }
        ImGui::PopID();
    }
    ImGui::EndChild();
}

} // namespace

void drawFrameGraph(Session& session) {
    if (!ImGui::BeginTabBar("graph")) return;
    if (ImGui::BeginTabItem("Resources")) {
        drawResources(session);
        ImGui::EndTabItem();
    }
    if (ImGui::BeginTabItem("Passes")) {
        drawPasses(session);
        ImGui::EndTabItem();
    }
    ImGui::EndTabBar();
}

} // namespace tyndall::editor
