#pragma once
// Who computes which term of light transport in this frame, once only, and why.

#include <array>
#include <span>
#include <string>

#include "core/result.h"
#include "transport/terms.h"

namespace tyndall {

/// A technique as a plugin registered it.
struct Technique {
    std::string name; // "octaves"
    std::string title, help;
    std::string plugin; // who brings it
    TermSet claims = 0;
    bool automatic = true; // `auto` may choose it; else it is there for who asks for it
};

/// What about the scene decides whether a term can be other than zero.
struct SceneTraits {
    bool surfaces = false;        // anything that reflects
    bool media = false;           // any medium with extinction or emission that matters
    bool scatteringMedia = false; // any medium that scatters
    bool lights = false;          // lights, emitters or an environment
};

inline constexpr int kNobody = -1;
inline constexpr int kDirectPasses = -2;

struct FramePlan {
    /// Per term: kDirectPasses, kNobody, or an index into the techniques.
    std::array<int, kTermCount> owner{};
    TermSet wanted = 0;    // asked for
    TermSet possible = 0;  // can be other than zero in this scene
    TermSet rendered = 0;  // wanted, and somebody computes it
    TermSet missing = 0;   // wanted and possible, but nobody claims it
    std::string technique; // "none", a name, or the assignments
    std::string why;       // one sentence

    /// The terms that technique `index` computes (kDirectPasses for the engine's own).
    [[nodiscard]] TermSet termsOf(int index) const;
};

/// Terms that these traits allow to be other than zero.
TermSet possibleTerms(const SceneTraits& traits);

/// `gi` is auto, none, a technique's name, or a list TERM=TECHNIQUE,… (terms not named are then not rendered; `direct` names
/// the engine's own passes). Errors name the unknown word and list what there is, or say which terms a technique claims.
Result<FramePlan> makePlan(std::string_view gi, TermSet wanted,
                           std::span<const Technique> techniques, const SceneTraits& traits);

} // namespace tyndall
