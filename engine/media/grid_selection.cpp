#include "media/grid_selection.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

namespace tyndall {

namespace {

constexpr const char* kDensityNames[] = {"density", "smoke", "soot", "fog",
                                         "cloud",   "dust",  "fume"};
constexpr const char* kTemperatureNames[] = {"temperature", "temp", "heat",
                                             "flame",       "fire", "fuel"};

bool sameIgnoringCase(std::string_view a, std::string_view b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](unsigned char x, unsigned char y) {
        return std::tolower(x) == std::tolower(y);
    });
}

std::string describe(const GridInfo& grid) {
    return fmt::format("'{}' ({}, {})", grid.name, grid.type, grid.gridClass);
}

/// Why the grid cannot be a density or temperature; empty where it can.
std::string whyNot(const GridInfo& grid) {
    if (grid.gridClass == "level set") return "is a level set: distances to a surface";
    if (grid.gridClass == "points") return "holds points";
    if (grid.type == "unreadable") return "is of a type that cannot be read";
    if (!grid.importable) return fmt::format("is {} of class {}", grid.type, grid.gridClass);
    if (!grid.affine) return "has a frustum transform, which is not affine";
    return {};
}

std::optional<size_t> findNamed(std::span<const GridInfo> grids, std::string_view name) {
    for (size_t i = 0; i < grids.size(); ++i)
        if (grids[i].name == name) return i;
    return std::nullopt;
}

/// The first usable grid with one of the names, in the order of the names.
std::optional<size_t> findSynonym(std::span<const GridInfo> grids,
                                  std::span<const char* const> names) {
    for (const char* name : names)
        for (size_t i = 0; i < grids.size(); ++i)
            if (sameIgnoringCase(grids[i].name, name) && whyNot(grids[i]).empty()) return i;
    return std::nullopt;
}

Result<size_t> requireNamed(std::span<const GridInfo> grids, const std::string& name,
                            const char* use, const std::string& file) {
    const std::optional<size_t> found = findNamed(grids, name);
    if (!found)
        return Error{
            fmt::format("'{}' has no grid '{}'; it has {}", file, name, describeGrids(grids))};
    if (const std::string reason = whyNot(grids[*found]); !reason.empty())
        return Error{fmt::format(
            "'{}': grid '{}' cannot be {}, because it {}; a scalar fog volume is needed", file,
            name, use, reason)};
    return *found;
}

/// The only fog volume; or the only grid that could be one, when no grid has a class.
std::optional<size_t> findOnly(std::span<const GridInfo> grids) {
    for (const char* gridClass : {"fog volume", "unknown"}) {
        std::optional<size_t> only;
        size_t count = 0;
        for (size_t i = 0; i < grids.size(); ++i)
            if (grids[i].gridClass == gridClass && whyNot(grids[i]).empty()) {
                only = i;
                ++count;
            }
        if (count == 1) return only;
        if (count > 1) return std::nullopt;
    }
    return std::nullopt;
}

/// "'a', 'b' or 'c'": what could be density; "" where nothing could.
std::string nameCandidates(std::span<const GridInfo> grids) {
    std::vector<std::string> names;
    for (const GridInfo& grid : grids)
        if (whyNot(grid).empty()) names.push_back("'" + grid.name + "'");
    constexpr size_t kShown = 12;
    std::string text;
    for (size_t i = 0; i < std::min(names.size(), kShown); ++i)
        text += (i == 0 ? "" : i + 1 == names.size() ? " or " : ", ") + names[i];
    return names.size() > kShown ? fmt::format("{} and {} more", text, names.size() - kShown)
                                 : text;
}

Result<size_t> selectDensity(std::span<const GridInfo> grids, const GridRequest& request,
                             const std::string& file, GridSelection& selection) {
    if (!request.density.empty()) return requireNamed(grids, request.density, "density", file);
    if (const std::optional<size_t> found = findSynonym(grids, kDensityNames)) {
        if (!sameIgnoringCase(grids[*found].name, kDensityNames[0]))
            selection.notes.push_back(
                fmt::format("'{}': grid '{}' is taken as density", file, grids[*found].name));
        return *found;
    }
    if (const std::optional<size_t> found = findOnly(grids)) {
        selection.notes.push_back(
            fmt::format("'{}': grid '{}' is taken as density, being the only one that can be", file,
                        grids[*found].name));
        return *found;
    }
    if (grids.size() == 1)
        return Error{fmt::format(
            "'{}': its only grid '{}' cannot be density, because it {}; a scalar fog volume is needed",
            file, grids[0].name, whyNot(grids[0]))};
    if (grids.empty())
        return Error{fmt::format("'{}' has no grids; a scalar fog volume is needed", file)};
    const std::string candidates = nameCandidates(grids);
    if (candidates.empty())
        return Error{
            fmt::format("'{}' has {}; none of them is a scalar fog volume that could be density",
                        file, describeGrids(grids))};
    return Error{fmt::format(
        "'{}' has several grids that could be density, {}; choose with --grid NAME where the file itself is opened, "
        "or with \"grid\": \"NAME\" in a scene file",
        file, candidates)};
}

void noteMissingClass(const GridInfo& grid, const std::string& file, GridSelection& selection) {
    if (grid.gridClass == "unknown")
        selection.notes.push_back(
            fmt::format("'{}': grid '{}' does not say its class and is taken as a fog volume", file,
                        grid.name));
}

} // namespace

std::string describeGrids(std::span<const GridInfo> grids) {
    if (grids.empty()) return "no grids";
    std::string text;
    constexpr size_t kShown = 12;
    for (size_t i = 0; i < std::min(grids.size(), kShown); ++i)
        text += (i ? ", " : "") + describe(grids[i]);
    if (grids.size() > kShown) text += fmt::format(" and {} more", grids.size() - kShown);
    return text;
}

Result<GridSelection> selectGrids(std::span<const GridInfo> grids, const GridRequest& request,
                                  const std::string& file) {
    GridSelection selection;
    const Result<size_t> density = selectDensity(grids, request, file, selection);
    if (!density) return density.error();
    selection.density = *density;
    noteMissingClass(grids[*density], file, selection);

    if (!request.temperature.empty()) {
        const Result<size_t> temperature =
            requireNamed(grids, request.temperature, "temperature", file);
        if (!temperature) return temperature.error();
        selection.temperature = *temperature;
    } else if (request.findTemperature) {
        selection.temperature = findSynonym(grids, kTemperatureNames);
        if (selection.temperature &&
            !sameIgnoringCase(grids[*selection.temperature].name, kTemperatureNames[0]))
            selection.notes.push_back(fmt::format("'{}': grid '{}' is taken as temperature", file,
                                                  grids[*selection.temperature].name));
    }
    return selection;
}

} // namespace tyndall
