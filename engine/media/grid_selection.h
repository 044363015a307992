#pragma once
// Which of a file's grids are density and temperature: names, synonyms, and the sentences about what cannot be.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "media/grid_import.h"

namespace tyndall {

struct GridSelection {
    size_t density = 0;
    std::optional<size_t> temperature;
    std::vector<std::string> notes;
};

/// Density: the named grid; else the first of the synonyms density, smoke, soot, fog, cloud, dust, fume (any case); else
/// the only fog volume. Temperature: the named grid; else, if looked for, temperature, temp, heat, flame, fire, fuel.
/// `file` is for the sentences. Errors: none fits, or the named one is missing or no scalar field.
Result<GridSelection> selectGrids(std::span<const GridInfo> grids, const GridRequest& request,
                                  const std::string& file);

/// "'density' (float, fog volume), 'v' (vec3s, staggered)", or "no grids".
[[nodiscard]] std::string describeGrids(std::span<const GridInfo> grids);

} // namespace tyndall
