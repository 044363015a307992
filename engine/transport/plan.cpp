#include "transport/plan.h"

#include <vector>

#include "core/settings.h"

namespace tyndall {
namespace {

constexpr std::string_view kDirectName = "direct";

/// kDirectPasses, an index, or kNobody when there is none of this name.
int findTechnique(std::string_view name, std::span<const Technique> techniques) {
    if (name == kDirectName) return kDirectPasses;
    for (size_t i = 0; i < techniques.size(); ++i)
        if (techniques[i].name == name) return int(i);
    return kNobody;
}

Error unknownTechnique(std::string_view name, std::span<const Technique> techniques) {
    std::string list = "auto, none";
    std::vector<std::string_view> names = {"auto", "none"};
    for (const Technique& technique : techniques) {
        list += ", " + technique.name;
        names.emplace_back(technique.name);
    }
    const std::string nearest = nearestName(name, names);
    return Error{"technique '" + std::string(name) + "' is not available: " +
                 (nearest.empty() ? "" : "did you mean '" + nearest + "'? ") + "there are " + list};
}

TermSet claimsOf(int owner, std::span<const Technique> techniques) {
    return owner == kDirectPasses ? kDirectTerms : techniques[size_t(owner)].claims;
}

void give(FramePlan& plan, TermSet terms, int owner) {
    for (uint32_t i = 0; i < kTermCount; ++i)
        if (terms & bit(Term(i))) plan.owner[i] = owner;
}

/// "LSVE=surfels,LVVE=lpv": exactly these terms.
Result<void> assign(FramePlan& plan, std::string_view list, std::span<const Technique> techniques) {
    while (!list.empty()) {
        const size_t comma = std::min(list.find(','), list.size());
        const std::string_view item = list.substr(0, comma);
        list.remove_prefix(std::min(comma + 1, list.size()));
        const size_t equals = item.find('=');
        if (equals == std::string_view::npos)
            return Error{"'" + std::string(item) +
                         "' is not an assignment: write TERM=TECHNIQUE, as in LVVE=octaves"};
        const Result<TermSet> term = parseTerms(item.substr(0, equals));
        if (!term) return term.error();
        const std::string_view name = item.substr(equals + 1);
        const int owner = findTechnique(name, techniques);
        if (owner == kNobody) return unknownTechnique(name, techniques);
        const TermSet claims = claimsOf(owner, techniques);
        if (*term & ~claims)
            return Error{"technique '" + std::string(name) + "' does not compute " +
                         termNames(*term & ~claims) + ": it claims " + termNames(claims)};
        for (uint32_t i = 0; i < kTermCount; ++i)
            if ((*term & bit(Term(i))) && plan.owner[i] != kNobody)
                return Error{"term " + std::string(termName(Term(i))) +
                             " is given to two techniques: each term is computed once"};
        give(plan, *term, owner);
    }
    return {};
}

/// The technique that claims most of what can be seen beyond the direct terms.
int chooseAutomatically(TermSet indirect, std::span<const Technique> techniques) {
    int best = kNobody;
    int most = 0;
    for (size_t i = 0; i < techniques.size(); ++i) {
        const int count = __builtin_popcount(techniques[i].claims & indirect);
        if (techniques[i].automatic && count > most) {
            most = count;
            best = int(i);
        }
    }
    return best;
}

std::string chooseAndExplain(FramePlan& plan, std::span<const Technique> techniques) {
    const TermSet indirect = plan.possible & plan.wanted & ~kDirectTerms;
    const int choice = chooseAutomatically(indirect, techniques);
    if (choice == kNobody) {
        plan.technique = "none";
        return indirect == 0 ? "auto: the scene has direct light alone"
                             : "auto: no technique here computes " + termNames(indirect);
    }
    const Technique& chosen = techniques[size_t(choice)];
    give(plan, chosen.claims & plan.wanted, choice);
    plan.technique = chosen.name;
    return "auto: '" + chosen.name + "' claims " + termNames(chosen.claims & indirect) +
           " of the indirect terms that this scene has";
}

} // namespace

TermSet FramePlan::termsOf(int index) const {
    TermSet set = 0;
    for (uint32_t i = 0; i < kTermCount; ++i)
        if (owner[i] == index) set |= bit(Term(i));
    return set & wanted;
}

TermSet possibleTerms(const SceneTraits& traits) {
    if (!traits.lights) return 0;
    TermSet set = bit(Term::LE);
    if (traits.surfaces) set |= terms(Term::LSE, Term::LSSE, Term::LXSSE);
    if (traits.scatteringMedia) set |= terms(Term::LVE, Term::LVVE, Term::LXVVE);
    if (traits.surfaces && traits.scatteringMedia)
        set |= terms(Term::LVSE, Term::LSVE, Term::LXVSE, Term::LXSVE);
    return set;
}

Result<FramePlan> makePlan(std::string_view gi, TermSet wanted,
                           std::span<const Technique> techniques, const SceneTraits& traits) {
    FramePlan plan;
    plan.owner.fill(kNobody);
    plan.wanted = wanted;
    plan.possible = possibleTerms(traits);
    if (gi.find('=') != std::string_view::npos) {
        if (Result<void> done = assign(plan, gi, techniques); !done) return done.error();
        plan.technique = std::string(gi);
        plan.why = "assigned on the command line";
    } else {
        give(plan, kDirectTerms, kDirectPasses);
        if (gi == "none") {
            plan.technique = "none";
            plan.why = "direct terms only, as asked for";
        } else if (gi == "auto") {
            plan.why = chooseAndExplain(plan, techniques);
        } else {
            const int owner = findTechnique(gi, techniques);
            if (owner == kNobody || owner == kDirectPasses) return unknownTechnique(gi, techniques);
            give(plan, techniques[size_t(owner)].claims & ~kDirectTerms, owner);
            plan.technique = std::string(gi);
            plan.why = "asked for";
        }
    }
    for (uint32_t i = 0; i < kTermCount; ++i)
        if (plan.owner[i] != kNobody && (wanted & bit(Term(i)))) plan.rendered |= bit(Term(i));
    plan.missing = plan.wanted & plan.possible & ~plan.rendered;
    return plan;
}

} // namespace tyndall
