#include "transport/plan.h"

#include <algorithm>
#include <cstdio>

#include "core/settings.h"

namespace tyndall {
namespace {

constexpr std::string_view kDirectName = "direct";
constexpr TermSet kTermsInMedia = kIndirectInMedia | bit(Term::LVE);

/// kDirectPasses, an index, or kNobody if there is none of this name.
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

/// Gives terms to `owner`, those in media in these kinds alone.
void give(FramePlan& plan, TermSet terms, int owner, MediaSet media = kAllMedia) {
    for (uint32_t i = 0; i < kTermCount; ++i) {
        if (!(terms & bit(Term(i)))) continue;
        const MediaSet in = kTermsInMedia & bit(Term(i)) ? media : kAllMedia;
        for (uint32_t kind = 0; kind < kMediaKindCount; ++kind)
            if (in & (1u << kind)) plan.owner[i][kind] = owner;
    }
}

/// Kinds of media in which a technique already computes the term.
MediaSet takenIn(const FramePlan& plan, Term term) {
    MediaSet taken = 0;
    for (uint32_t kind = 0; kind < kMediaKindCount; ++kind)
        if (plan.owner[size_t(term)][kind] >= 0) taken |= 1u << kind;
    return taken;
}

/// Kinds of media in which `owner` computes the term.
MediaSet ownedIn(const FramePlan& plan, Term term, int owner) {
    MediaSet media = 0;
    for (uint32_t kind = 0; kind < kMediaKindCount; ++kind)
        if (plan.owner[size_t(term)][kind] == owner) media |= 1u << kind;
    return media;
}

/// One item of a list of assignments.
struct Assignment {
    TermSet terms;
    int owner;
    MediaSet media = kAllMedia;
};

Result<Assignment> parseAssignment(std::string_view item, std::span<const Technique> techniques) {
    const size_t equals = item.find('=');
    if (equals == std::string_view::npos)
        return Error{"'" + std::string(item) +
                     "' is not an assignment: write TERM=TECHNIQUE, as in LVVE=octaves"};
    const size_t colon = std::min(item.find(':'), equals);
    const Result<TermSet> terms = parseTerms(item.substr(0, colon));
    if (!terms) return terms.error();
    MediaSet media = kAllMedia;
    if (colon < equals) media = mediaNamed(item.substr(colon + 1, equals - colon - 1));
    if (media == 0)
        return Error{"'" + std::string(item) + "' names no kind of medium: there are " +
                     mediaNames(kAllMedia)};
    const std::string_view name = item.substr(equals + 1);
    const int owner = findTechnique(name, techniques);
    if (owner == kNobody) return unknownTechnique(name, techniques);
    const TermSet claims = owner == kDirectPasses ? kDirectTerms : techniques[size_t(owner)].claims;
    if (*terms & ~claims)
        return Error{"technique '" + std::string(name) + "' does not compute " +
                     termNames(*terms & ~claims) + ": it claims " + termNames(claims)};
    if (media != kAllMedia && (*terms & ~kTermsInMedia))
        return Error{"'" + std::string(item) + "': " + termNames(*terms & ~kTermsInMedia) +
                     " is seen on surfaces, not in a kind of medium"};
    return Assignment{*terms, owner, media};
}

/// Gives the terms of one item to its technique, in the kinds of media that no other has.
Result<void> take(FramePlan& plan, const Assignment& item, std::span<const Technique> techniques) {
    if (item.owner == kDirectPasses) return {}; // they own them unless a technique takes them
    const Technique& technique = techniques[size_t(item.owner)];
    for (uint32_t i = 0; i < kTermCount; ++i) {
        const Term term = Term(i);
        if (!(item.terms & bit(term))) continue;
        const MediaSet taken = takenIn(plan, term), rest = technique.media & item.media & ~taken;
        const bool shares = (bit(term) & kTermsInMedia) != 0 && technique.separatesMedia;
        if ((bit(term) & kTermsInMedia) != 0 && (technique.media & item.media) == 0)
            return Error{"technique '" + technique.name + "' computes nothing in " +
                         mediaNames(item.media) + ": it has " + mediaNames(technique.media)};
        if (taken == 0 && rest != technique.media && !technique.separatesMedia)
            return Error{"technique '" + technique.name + "' cannot leave out a kind of medium"};
        if (taken != 0 && (!shares || rest == 0))
            return Error{"term " + std::string(termName(term)) +
                         " is given to two techniques: each term is computed once"};
        give(plan, bit(term), item.owner, rest);
    }
    return {};
}

/// "LSVE=surfels,LVVE=lpv": of the indirect terms exactly these.
Result<void> assign(FramePlan& plan, std::string_view list, std::span<const Technique> techniques) {
    std::vector<Assignment> items;
    while (!list.empty()) {
        const size_t comma = std::min(list.find(','), list.size());
        const Result<Assignment> item = parseAssignment(list.substr(0, comma), techniques);
        if (!item) return item.error();
        items.push_back(*item);
        list.remove_prefix(std::min(comma + 1, list.size()));
    }
    // An item for few kinds of media comes before one that takes the rest.
    const auto kinds = [&](const Assignment& item) {
        if (item.owner < 0) return 0;
        return __builtin_popcount(item.media & techniques[size_t(item.owner)].media);
    };
    std::stable_sort(items.begin(), items.end(),
                     [&](const auto& a, const auto& b) { return kinds(a) < kinds(b); });
    for (const Assignment& item : items)
        if (Result<void> taken = take(plan, item, techniques); !taken.ok()) return taken;
    return {};
}

/// The smallest set that a technique can be given and that has all of `terms` in it.
TermSet smallestWith(const Technique& technique, TermSet terms) {
    TermSet best = technique.claims;
    for (const TermSet set : technique.sets)
        if ((terms & ~set) == 0 && __builtin_popcount(set) < __builtin_popcount(best)) best = set;
    return best;
}

/// A technique that mixes terms must get one of its sets: light of other terms would be counted wrongly.
Result<void> checkSets(const FramePlan& plan, std::span<const Technique> techniques) {
    for (size_t i = 0; i < techniques.size(); ++i) {
        const TermSet given = plan.termsOf(int(i)) & plan.possible;
        if (given == 0 || techniques[i].accepts(given, plan.possible)) continue;
        const TermSet together = smallestWith(techniques[i], given) & plan.possible;
        return Error{"technique '" + techniques[i].name + "' computes " + termNames(together) +
                     " together: it cannot leave out " + termNames(together & ~given)};
    }
    return {};
}

/// A technique has one set of kinds of media for all its terms in media.
Result<void> checkKinds(const FramePlan& plan, std::span<const Technique> techniques) {
    for (size_t i = 0; i < techniques.size(); ++i) {
        const MediaSet all = plan.mediaOf(int(i));
        for (uint32_t t = 0; t < kTermCount; ++t) {
            if (!(plan.wanted & bit(Term(t)) & kTermsInMedia)) continue;
            const MediaSet here = ownedIn(plan, Term(t), int(i));
            if (here != 0 && here != all)
                return Error{"technique '" + techniques[i].name +
                             "' computes all its terms in the same kinds of media: " +
                             std::string(termName(Term(t))) + " is left to it in " +
                             mediaNames(here) + ", others in " + mediaNames(all)};
        }
    }
    return {};
}

/// A technique is not chosen by itself where a frame takes more than so many times one with direct light alone.
constexpr float kMostCost = 10;

/// What `auto` knows when it chooses for surfaces or for media.
struct Choice {
    TermSet terms, possible;
    SceneClass scene;
    bool inMedia;
};

float errorOf(const Technique& technique, const Choice& choice) {
    const Expectation& expected = technique.expected[size_t(choice.scene)];
    return choice.inMedia ? expected.errorInMedia : expected.errorOnSurfaces;
}

/// Of the techniques that `auto` may choose, are quick enough and compute most of the terms, the one with the least error.
int bestFor(const Choice& choice, std::span<const Technique> techniques) {
    int best = kNobody, most = 0;
    for (size_t i = 0; i < techniques.size(); ++i) {
        const Technique& technique = techniques[i];
        const TermSet share = technique.claims & choice.terms;
        const int count = __builtin_popcount(share);
        if (!technique.automatic || count == 0 || !technique.accepts(share, choice.possible) ||
            technique.expected[size_t(choice.scene)].cost > kMostCost)
            continue;
        if (count < most || (count == most && !(errorOf(technique, choice) <
                                                errorOf(techniques[size_t(best)], choice))))
            continue;
        best = int(i);
        most = count;
    }
    return best;
}

/// "0.02", "0.4".
std::string shortNumber(float value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.1g", double(value));
    return text;
}

/// Surfaces may have their indirect light from one technique, and media from another.
void chooseAndExplain(FramePlan& plan, std::span<const Technique> techniques, SceneClass scene) {
    const TermSet indirect = plan.possible & plan.wanted & ~kDirectTerms;
    const TermSet receivers[] = {kIndirectOnSurfaces & indirect, kIndirectInMedia & indirect};
    std::string chosen;
    for (const bool inMedia : {false, true}) {
        const Choice choice{receivers[inMedia], plan.possible, scene, inMedia};
        const int best = bestFor(choice, techniques);
        if (best == kNobody) continue;
        const Technique& technique = techniques[size_t(best)];
        const TermSet receiver = inMedia ? kIndirectInMedia : kIndirectOnSurfaces;
        give(plan, technique.claims & plan.wanted & receiver, best, technique.media);
        if (plan.technique.empty())
            plan.technique = technique.name;
        else if (plan.technique != technique.name)
            plan.technique += "+" + technique.name;
        chosen += (chosen.empty() ? "" : "; ") + technique.name +
                  (inMedia ? " in media (relmse about " : " on surfaces (relmse about ") +
                  shortNumber(errorOf(technique, choice)) + ")";
    }
    if (plan.technique.empty()) plan.technique = "none";
    plan.why = !chosen.empty()
                   ? "auto: " + chosen + "; of the techniques that take at most " +
                         std::to_string(int(kMostCost)) +
                         " times direct light, least measured error for " + sceneClassText(scene)
               : indirect == 0 ? "auto: the scene has direct light alone"
                               : "auto: no technique here computes " + termNames(indirect);
}

Result<void> decide(FramePlan& plan, std::string_view gi, std::span<const Technique> techniques,
                    SceneClass scene) {
    give(plan, kDirectTerms, kDirectPasses);
    if (gi.find('=') != std::string_view::npos) {
        plan.technique = std::string(gi);
        plan.why = "techniques by term, as asked for";
        return assign(plan, gi, techniques);
    }
    if (gi == "none") {
        plan.technique = "none";
        plan.why = "direct terms only, as asked for";
        return {};
    }
    if (gi == "auto") {
        chooseAndExplain(plan, techniques, scene);
        return {};
    }
    const int owner = findTechnique(gi, techniques);
    if (owner == kNobody || owner == kDirectPasses) return unknownTechnique(gi, techniques);
    const Technique& technique = techniques[size_t(owner)];
    give(plan, technique.claims & ~kDirectTerms, owner, technique.media);
    plan.technique = std::string(gi);
    plan.why = "technique " + plan.technique + ", as asked for";
    return {};
}

} // namespace

bool Technique::accepts(TermSet terms, TermSet possible) const {
    if (sets.empty()) return (terms & ~claims) == 0;
    return std::any_of(sets.begin(), sets.end(),
                       [&](TermSet set) { return (set & possible) == (terms & possible); });
}

TermSet FramePlan::termsOf(int index) const {
    TermSet set = 0;
    for (uint32_t i = 0; i < kTermCount; ++i)
        for (const int who : owner[i])
            if (who == index) set |= bit(Term(i));
    return set & wanted;
}

MediaSet FramePlan::mediaOf(int index) const {
    MediaSet media = 0;
    for (uint32_t i = 0; i < kTermCount; ++i)
        for (uint32_t kind = 0; kind < kMediaKindCount; ++kind)
            if (owner[i][kind] == index && (bit(Term(i)) & kTermsInMedia & wanted))
                media |= 1u << kind;
    return media;
}

std::vector<TermShare> FramePlan::sharesOf(Term term) const {
    std::vector<TermShare> shares;
    for (uint32_t kind = 0; kind < kMediaKindCount; ++kind) {
        const int who = owner[size_t(term)][kind];
        if (who == kNobody || !(bit(term) & wanted)) continue;
        const auto known = std::find_if(shares.begin(), shares.end(),
                                        [&](const TermShare& share) { return share.owner == who; });
        if (known == shares.end())
            shares.push_back({who, 1u << kind});
        else
            known->media |= 1u << kind;
    }
    return shares;
}

MediaSet FramePlan::missingIn(Term term) const {
    if (!(bit(term) & wanted & possible)) return 0;
    MediaSet missingKinds = 0;
    for (uint32_t kind = 0; kind < kMediaKindCount; ++kind)
        if (owner[size_t(term)][kind] == kNobody) missingKinds |= 1u << kind;
    return bit(term) & kTermsInMedia ? missingKinds & kinds : missingKinds;
}

SceneClass SceneTraits::sceneClass() const {
    if (!scatteringMedia) return SceneClass::Surfaces;
    if (!surfaces) return SceneClass::MediaAlone;
    return opticalDepth > kDenseFrom ? SceneClass::Dense : SceneClass::Thin;
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

std::vector<int> techniquesFor(Term term, const FramePlan& plan,
                               std::span<const Technique> techniques) {
    std::vector<int> result;
    const MediaSet missing = plan.missingIn(term);
    for (size_t i = 0; i < techniques.size(); ++i) {
        const Technique& technique = techniques[i];
        const TermSet given = technique.claims & ~kDirectTerms & plan.wanted & plan.possible;
        const bool here = !(bit(term) & kTermsInMedia) || (technique.media & missing) != 0;
        if (missing != 0 && (given & bit(term)) && here && technique.accepts(given, plan.possible))
            result.push_back(int(i));
    }
    return result;
}

Result<FramePlan> makePlan(std::string_view gi, TermSet wanted,
                           std::span<const Technique> techniques, const SceneTraits& traits) {
    FramePlan plan;
    for (auto& kinds : plan.owner) kinds.fill(kNobody);
    plan.wanted = wanted;
    plan.possible = possibleTerms(traits);
    plan.kinds = traits.scatteringMedia ? traits.kinds : 0;
    if (Result<void> done = decide(plan, gi, techniques, traits.sceneClass()); !done.ok())
        return done.error();
    if (Result<void> fits = checkSets(plan, techniques); !fits.ok()) return fits.error();
    if (Result<void> fits = checkKinds(plan, techniques); !fits.ok()) return fits.error();
    for (uint32_t i = 0; i < kTermCount; ++i) {
        const auto& owners = plan.owner[i];
        const bool owned =
            std::any_of(owners.begin(), owners.end(), [](int who) { return who != kNobody; });
        if (owned) plan.rendered |= wanted & bit(Term(i));
        if (plan.missingIn(Term(i)) != 0) plan.missing |= bit(Term(i));
    }
    return plan;
}

} // namespace tyndall
