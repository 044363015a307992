#include "transport/terms.h"

#include <array>
#include <vector>

#include "core/settings.h"
#include "transport/media_kinds.h"

namespace tyndall {
namespace {
constexpr std::array<std::string_view, kTermCount> kNames = {
    "LE", "LSE", "LVE", "LSSE", "LVSE", "LSVE", "LVVE", "LXSSE", "LXVSE", "LXSVE", "LXVVE"};
constexpr std::array<std::string_view, kMediaKindCount> kMediaNames = {"shapes", "height", "grids",
                                                                       "particles"};
}

std::string mediaNames(MediaSet media) {
    std::string names;
    for (uint32_t i = 0; i < kMediaKindCount; ++i)
        if (media & (1u << i)) names += (names.empty() ? "" : ",") + std::string(kMediaNames[i]);
    return names;
}

MediaSet mediaNamed(std::string_view name) {
    for (uint32_t i = 0; i < kMediaKindCount; ++i)
        if (kMediaNames[i] == name) return 1u << i;
    return 0;
}

std::string_view termName(Term term) { return kNames[uint32_t(term)]; }

std::string termNames(TermSet set) {
    std::string names;
    for (uint32_t i = 0; i < kTermCount; ++i)
        if (set & bit(Term(i))) names += (names.empty() ? "" : ",") + std::string(kNames[i]);
    return names;
}

Result<TermSet> parseTerms(std::string_view list) {
    TermSet set = 0;
    while (!list.empty()) {
        const size_t comma = std::min(list.find(','), list.size());
        const std::string_view word = list.substr(0, comma);
        list.remove_prefix(std::min(comma + 1, list.size()));
        if (word == "all") {
            set |= kAllTerms;
            continue;
        }
        if (word == "direct") {
            set |= kDirectTerms;
            continue;
        }
        uint32_t index = 0;
        while (index < kTermCount && kNames[index] != word) ++index;
        if (index == kTermCount) {
            const std::string nearest = nearestName(word, kNames);
            return Error{"transport term '" + std::string(word) + "' is unknown: " +
                         (nearest.empty() ? "the terms are " + termNames(kAllTerms)
                                          : "did you mean '" + nearest + "'?")};
        }
        set |= bit(Term(index));
    }
    return set;
}

} // namespace tyndall
