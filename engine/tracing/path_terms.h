#pragma once
// The term of light transport of a path, from its scatterings in the order of the path tracer: eye first.

#include "transport/terms.h"

namespace tyndall::tracing {

enum class Scattering : uint8_t { Surface = 0, Medium = 1 };

/// The scatterings of a path so far.
class PathHistory {
public:
    void add(Scattering kind) {
        if (count_ < 2) kinds_[count_] = kind;
        ++count_;
    }
    [[nodiscard]] int count() const { return count_; }
    /// Of light that joins the path after its last scattering.
    [[nodiscard]] Term term() const { return termOf(count_, kinds_[0], kinds_[1]); }
    /// Of light that is scattered once more, by `kind`, before it joins.
    [[nodiscard]] Term termAfter(Scattering kind) const {
        PathHistory longer = *this;
        longer.add(kind);
        return longer.term();
    }

private:
    static Term termOf(int count, Scattering first, Scattering second) {
        const bool inMedium = first == Scattering::Medium,
                   fromMedium = second == Scattering::Medium;
        if (count == 0) return Term::LE;
        if (count == 1) return inMedium ? Term::LVE : Term::LSE;
        if (count == 2)
            return inMedium ? (fromMedium ? Term::LVVE : Term::LSVE)
                            : (fromMedium ? Term::LVSE : Term::LSSE);
        return inMedium ? (fromMedium ? Term::LXVVE : Term::LXSVE)
                        : (fromMedium ? Term::LXVSE : Term::LXSSE);
    }
    int count_ = 0;
    Scattering kinds_[2] = {};
};

/// The most scatterings that a path of these terms can have; -1: any number.
inline int longestPath(TermSet terms) {
    if (terms & ~(kDirectTerms | tyndall::terms(Term::LSSE, Term::LVSE, Term::LSVE, Term::LVVE)))
        return -1;
    if (terms & ~kDirectTerms) return 2;
    return terms & ~bit(Term::LE) ? 1 : 0;
}

} // namespace tyndall::tracing
