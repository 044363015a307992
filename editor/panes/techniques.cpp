#include <fmt/format.h>

#include "panes/panes.h"
#include "widgets.h"

namespace tyndall::editor {
namespace {

/// What a term's letters say.
const char* meaning(Term term) {
    switch (term) {
    case Term::LE: return "Emitters, media that glow and the environment, seen directly";
    case Term::LSE: return "Light that one surface reflects to the eye";
    case Term::LVE: return "Light that a medium scatters once to the eye";
    case Term::LSSE: return "Light from surface to surface to the eye";
    case Term::LVSE: return "Light scattered by a medium onto a surface";
    case Term::LSVE: return "Light reflected by a surface, then scattered by a medium";
    case Term::LVVE: return "Light scattered twice by media";
    case Term::LXSSE: return "The same as LSSE after one or more scatterings before";
    case Term::LXVSE: return "The same as LVSE after one or more scatterings before";
    case Term::LXSVE: return "The same as LSVE after one or more scatterings before";
    case Term::LXVVE: return "The same as LVVE after one or more scatterings before";
    }
    return "";
}

void drawTechniqueChoice(Session& session) {
    ImGui::SetNextItemWidth(-1);
    const std::string chosen = session.technique();
    if (!ImGui::BeginCombo("##technique", chosen.c_str())) return;
    const auto offer = [&](const std::string& name, const std::string& help) {
        if (ImGui::Selectable(name.c_str(), chosen == name) && chosen != name)
            session.edit(changeSettings(session.settings(), "use the technique " + name,
                                        {{kTechniqueSetting, name}}));
        tooltip(help);
    };
    offer("auto", "Each term by whoever computes it best.");
    offer("none", "Direct light only.");
    for (const Technique& technique : session.renderer().techniques())
        offer(technique.name, technique.title + ". " + technique.help + " Computes " +
                                  termNames(technique.claims) + ".");
    ImGui::EndCombo();
}

void drawClaim(Session& session, const FramePlan& plan, Term term) {
    const TermSet one = bit(term);
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    bool wanted = session.request.terms & one;
    ImGui::PushID(int(term));
    if (ImGui::Checkbox(std::string(termName(term)).c_str(), &wanted)) session.request.terms ^= one;
    ImGui::PopID();
    tooltip(meaning(term));
    ImGui::TableNextColumn();
    ImGui::AlignTextToFramePadding();
    const auto techniques = session.renderer().techniques();
    const auto nameOf = [&](const TermShare& share) {
        const std::string name =
            share.owner == kDirectPasses ? "the engine" : techniques[size_t(share.owner)].name;
        return share.media == kAllMedia ? name : name + " in " + mediaNames(share.media);
    };
    std::string names;
    for (const TermShare& share : plan.sharesOf(term))
        names += (names.empty() ? "" : ", ") + nameOf(share);
    if (!(plan.wanted & one))
        coloredText(kGrey, "not asked for");
    else if (!(plan.possible & one))
        coloredText(kGrey, "dark in this scene");
    else if (names.empty())
        coloredText(kBad, "missing: nobody computes it");
    else if (plan.missing & one)
        coloredText(kBad, names + "; missing in " + mediaNames(plan.missingIn(term)));
    else
        coloredText(kGood, names);
    tooltip(meaning(term));
}

} // namespace

void drawTechniques(Session& session) {
    text("Technique for indirect light");
    drawTechniqueChoice(session);
    if (!session.picture().result()) return;
    const FramePlan& plan = session.picture().result()->plan;
    ImGui::PushTextWrapPos(0);
    coloredText(kGrey, plan.why);
    ImGui::PopTextWrapPos();
    if (!ImGui::BeginTable("claims", 2, ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersInnerV))
        return;
    ImGui::TableSetupColumn("term", ImGuiTableColumnFlags_WidthFixed,
                            ImGui::GetFrameHeight() + ImGui::CalcTextSize("LXSSE  ").x);
    ImGui::TableSetupColumn("computed by", ImGuiTableColumnFlags_WidthStretch);
    ImGui::TableHeadersRow();
    for (uint32_t term = 0; term < kTermCount; ++term) drawClaim(session, plan, Term(term));
    ImGui::EndTable();
}

} // namespace tyndall::editor
