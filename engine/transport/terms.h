#pragma once
// The terms of light transport: every path from a light to the eye is in exactly one.
// Letters from light to eye: L light, S surface, V medium, X one or more earlier scatterings, E eye.

#include <cstdint>
#include <string>
#include <string_view>

#include "core/result.h"

namespace tyndall {

enum class Term : uint32_t {
    LE = 0,
    LSE = 1,
    LVE = 2,
    LSSE = 3,
    LVSE = 4,
    LSVE = 5,
    LVVE = 6,
    LXSSE = 7,
    LXVSE = 8,
    LXSVE = 9,
    LXVVE = 10,
};
inline constexpr uint32_t kTermCount = 11;

/// A set of terms as bits 1 << Term: plain data, crosses the plugin boundary.
using TermSet = uint32_t;
constexpr TermSet bit(Term term) { return TermSet(1) << uint32_t(term); }
template <typename... T> constexpr TermSet terms(T... term) {
    return (TermSet(0) | ... | bit(term));
}

inline constexpr TermSet kDirectTerms = terms(Term::LE, Term::LSE, Term::LVE);
inline constexpr TermSet kIndirectOnSurfaces =
    terms(Term::LSSE, Term::LVSE, Term::LXSSE, Term::LXVSE);
inline constexpr TermSet kIndirectInMedia = terms(Term::LSVE, Term::LVVE, Term::LXSVE, Term::LXVVE);
inline constexpr TermSet kAllTerms = kDirectTerms | kIndirectOnSurfaces | kIndirectInMedia;

std::string_view termName(Term term);
/// "LE,LSE": in order, comma-separated; "" for none.
std::string termNames(TermSet set);
/// The inverse; also "all", "direct". Errors name the unknown term.
Result<TermSet> parseTerms(std::string_view list);

} // namespace tyndall
