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
    case Term::LSSE: return "Light that two surfaces reflect, one after the other";
    case Term::LVSE: return "Light scattered by a medium onto a surface";
    case Term::LSVE: return "Light reflected by a surface, then scattered by a medium";
    case Term::LVVE: return "Light scattered twice by media";
    case Term::LXSSE: return "Light scattered three times or more, at last by two surfaces";
    case Term::LXVSE:
        return "Light scattered three times or more, at last by a medium, then by a surface";
    case Term::LXSVE:
        return "Light scattered three times or more, at last by a surface, then by a medium";
    case Term::LXVVE: return "Light scattered three times or more, at last by media twice";
    }
    return "";
}

void useTechnique(Session& session, const std::string& name) {
    session.edit(changeSettings(session.settings(), "use the technique " + name,
                                {{kTechniqueSetting, name}}));
}

/// "not rendered; lpv or vpl could", where a click on a name uses that technique.
void drawCandidates(Session& session, const FramePlan& plan, Term term) {
    const auto techniques = session.renderer().techniques();
    const std::vector<int> able = techniquesFor(term, plan, techniques);
    const auto word = [](const char* value) {
        flow(ImGui::CalcTextSize(value).x);
        text(value);
    };
    text("not rendered;");
    if (able.empty()) return word("no technique here can");
    for (size_t i = 0; i < able.size(); ++i) {
        const std::string& name = techniques[size_t(able[i])].name;
        if (i > 0) word(i + 1 < able.size() ? "," : "or");
        flow(ImGui::CalcTextSize(name.c_str()).x + 2 * ImGui::GetStyle().FramePadding.x);
        if (ImGui::SmallButton(name.c_str())) useTechnique(session, name);
        tooltip("Use " + name + ": it computes " +
                termNames(techniques[size_t(able[i])].claims & plan.possible) + ".");
    }
    word("could");
}

void drawTechniqueChoice(Session& session) {
    ImGui::SetNextItemWidth(-1);
    const std::string chosen = session.technique();
    if (!ImGui::BeginCombo("##technique", chosen.c_str())) return;
    const auto offer = [&](const std::string& name, const std::string& help) {
        if (ImGui::Selectable(name.c_str(), chosen == name) && chosen != name)
            useTechnique(session, name);
        tooltip(help);
    };
    offer("auto", "Each term by whoever computes it best.");
    offer("none", "Direct light only.");
    for (const Technique& technique : session.renderer().techniques())
        offer(technique.name, technique.title + ". " + technique.help + " Computes " +
                                  termNames(technique.claims) + ".");
    ImGui::EndCombo();
}

/// What is left out, in plain words, and who could compute it.
void drawMissing(Session& session, const FramePlan& plan, Term term) {
    ImGui::PushID(int(term));
    ImGui::PushTextWrapPos(0);
    coloredText(kGrey, meaning(term));
    ImGui::PopTextWrapPos();
    drawCandidates(session, plan, term);
    ImGui::PopID();
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
        return drawMissing(session, plan, term);
    else if (plan.missing & one)
        coloredText(kGrey, names + "; not rendered in " + mediaNames(plan.missingIn(term)));
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
