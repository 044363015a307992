#include <vector>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "panes/panes.h"
#include "widgets.h"

namespace tyndall::editor {
namespace {

const char* kindOf(const Node& node) {
    if (node.light != kNone) return "light";
    if (node.medium != kNone) return "medium";
    if (node.camera != kNone) return "camera";
    if (!node.gltf.empty()) return "file";
    return node.meshes.empty() ? "group" : "mesh";
}

class Tree {
public:
    explicit Tree(Session& session, const std::string& filter)
        : session_(session), filter_(filter), children_(session.scene().nodes.size()) {
        const std::vector<Node>& nodes = session.scene().nodes;
        for (size_t i = 0; i < nodes.size(); ++i)
            nodes[i].parent == kNone ? roots_.push_back(int(i))
                                     : children_[size_t(nodes[i].parent)].push_back(int(i));
    }
    void draw() {
        // A filter shows what matches as a flat list.
        if (filter_.empty())
            for (const int root : roots_) drawNode(root);
        else
            for (size_t i = 0; i < children_.size(); ++i)
                if (contains(session_.scene().nodes[i].name, filter_) ||
                    contains(kindOf(session_.scene().nodes[i]), filter_))
                    drawRow(int(i), true);
    }

private:
    void drawNode(int node) {
        const bool leaf = children_[size_t(node)].empty();
        if (!drawRow(node, leaf) || leaf) return;
        for (const int child : children_[size_t(node)]) drawNode(child);
        ImGui::TreePop();
    }
    bool drawRow(int index, bool leaf) {
        const Node& node = session_.scene().nodes[size_t(index)];
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::PushID(index);
        bool visible = node.visible;
        if (ImGui::Checkbox("##visible", &visible))
            session_.edit(changeVisibility(session_.scene(), index, visible));
        tooltip(visible ? "Shown; click to hide it and what is below it"
                        : "Hidden; click to show it");
        ImGui::TableNextColumn();
        ImGuiTreeNodeFlags flags =
            ImGuiTreeNodeFlags_OpenOnArrow | ImGuiTreeNodeFlags_SpanAvailWidth;
        if (leaf) flags |= ImGuiTreeNodeFlags_Leaf | ImGuiTreeNodeFlags_NoTreePushOnOpen;
        if (session_.selected() == index) flags |= ImGuiTreeNodeFlags_Selected;
        if (!node.visible) ImGui::PushStyleColor(ImGuiCol_Text, kGrey);
        const bool open = ImGui::TreeNodeEx("##node", flags, "%s",
                                            node.name.empty() ? "(no name)" : node.name.c_str());
        if (!node.visible) ImGui::PopStyleColor();
        if (ImGui::IsItemClicked() && !ImGui::IsItemToggledOpen()) session_.select(index);
        ImGui::TableNextColumn();
        coloredText(kGrey, kindOf(node));
        ImGui::PopID();
        return open;
    }

    Session& session_;
    const std::string& filter_;
    std::vector<std::vector<int>> children_;
    std::vector<int> roots_;
};

} // namespace

void drawSceneTree(Session& session) {
    std::string& filter = session.panes.nodeFilter;
    ImGui::SetNextItemWidth(-1);
    ImGui::InputTextWithHint("##filter", "find by name or kind", &filter);
    if (!ImGui::BeginTable("nodes", 3, ImGuiTableFlags_ScrollY | ImGuiTableFlags_RowBg)) return;
    ImGui::TableSetupColumn("visible", ImGuiTableColumnFlags_WidthFixed, ImGui::GetFrameHeight());
    ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthStretch);
    ImGui::TableSetupColumn("kind", ImGuiTableColumnFlags_WidthFixed,
                            ImGui::CalcTextSize("medium").x);
    Tree(session, filter).draw();
    ImGui::EndTable();
}

} // namespace tyndall::editor
