#pragma once
// The plan of a frame: which technique computes each term of light transport, once only, and why.

#include <array>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "transport/media_kinds.h"
#include "transport/scene_class.h"
#include "transport/terms.h"

namespace tyndall {

/// A technique as a plugin registered it.
struct Technique {
    std::string name; // "octaves"
    std::string title, help;
    std::string plugin; // the plugin that registered it
    TermSet claims = 0;
    bool automatic = true; // `auto` may choose it; else only on request
    /// The sets of terms that it takes: a technique that mixes several terms computes them together or not at all.
    /// Empty: any part of its claims.
    std::vector<TermSet> sets;
    MediaSet media = kAllMedia; // kinds of media in which it computes its terms in media
    bool separatesMedia = true; // it can leave out some of these kinds
    std::array<Expectation, kSceneClassCount> expected{}; // what `auto` chooses by

    /// Can it compute exactly these terms, of those that are `possible` at all?
    [[nodiscard]] bool accepts(TermSet terms, TermSet possible) const;
};

/// What about the scene decides whether a term can be other than zero.
struct SceneTraits {
    bool surfaces = false;        // anything that reflects
    bool media = false;           // any medium with extinction or emission that matters
    bool scatteringMedia = false; // any medium that scatters
    bool lights = false;          // lights, emitters or an environment
    MediaSet kinds = kAllMedia;   // of the media that scatter
    double opticalDepth = 0;      // mean of the scattering media, across them; 0 without

    [[nodiscard]] SceneClass sceneClass() const;
};

inline constexpr int kNobody = -1;
inline constexpr int kDirectPasses = -2;

/// Who computes a term, and in which kinds of media. The kinds matter to terms in media (kIndirectInMedia, LVE) alone.
struct TermShare {
    int owner = kNobody; // kDirectPasses, or an index into the techniques
    MediaSet media = 0;
};

struct FramePlan {
    /// By term and kind of medium: kDirectPasses, kNobody, or an index into the techniques. A term on surfaces has one owner.
    std::array<std::array<int, kMediaKindCount>, kTermCount> owner{};
    TermSet wanted = 0;    // asked for
    TermSet possible = 0;  // can be other than zero in this scene
    MediaSet kinds = 0;    // of media that scatter in this scene
    TermSet rendered = 0;  // wanted, and somebody computes it, at least in some media
    TermSet missing = 0;   // wanted and possible, but nobody computes it, at least in some media
    std::string technique; // "none", a name, or the assignments
    std::string why;       // one sentence

    /// The terms that technique `index` computes (kDirectPasses for the engine's own).
    [[nodiscard]] TermSet termsOf(int index) const;
    /// The kinds of media in which it computes its terms in media.
    [[nodiscard]] MediaSet mediaOf(int index) const;
    /// Who computes a term: none, or one, or one for each of several kinds of media.
    [[nodiscard]] std::vector<TermShare> sharesOf(Term term) const;
    /// The scene's kinds of media in which nobody computes the term.
    [[nodiscard]] MediaSet missingIn(Term term) const;
};

/// Terms that these traits allow to be other than zero.
TermSet possibleTerms(const SceneTraits& traits);

/// Techniques, by index, that could compute a term that `plan` leaves out, if they were chosen by name instead: they claim it, in a kind of medium in which
/// it is missing, and can be given what else they claim of the terms that are wanted.
std::vector<int> techniquesFor(Term term, const FramePlan& plan,
                               std::span<const Technique> techniques);

/// `gi` is auto, none, a technique's name, or a list TERM=TECHNIQUE,… of indirect terms: those that it does not name are not rendered.
/// TERM:MEDIA=TECHNIQUE gives a term in one kind of medium (shapes, height, grids, particles): LVVE:particles=network,LVVE=lpv.
/// Direct terms stay with the engine's own passes (`direct`), unless the list gives one to a technique that claims it.
/// Errors name the unknown word and list what there is, or say which terms a technique claims, or computes only together.
Result<FramePlan> makePlan(std::string_view gi, TermSet wanted,
                           std::span<const Technique> techniques, const SceneTraits& traits);

} // namespace tyndall
