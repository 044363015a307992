#include "validation/recipes.h"

#include <stdexcept>

#include <fmt/format.h>

namespace tyndall::validation {
namespace {

std::optional<Recipe> outOfScope(const Row& row) {
    if (row.name == "Giovanelli")
        return Recipe{"", Skipped{"the boundary refracts (n = 1.5): the material model has no "
                                  "dielectric boundaries"}};
    if (row.name == "VPL-clamp-loss")
        return Recipe{"", Skipped{"belongs to a technique, not to light transport: what clamping "
                                  "removes of a virtual point light"}};
    if (row.name == "infinite-point" && row.quantityHas("diffusion length"))
        return Recipe{"", Skipped{"the root of an equation, not a quantity of light; it rules the "
                                  "fluence far from the source, measured at r = 5, 8 and 10 mfp"}};
    if (row.name == "half-space-albedo" && Row::number(row.albedo) == 1)
        return Recipe{"",
                      Skipped{"conservation of energy in a half-space without absorption: its "
                              "paths have no mean length. Measured as white furnace, and as R + T "
                              "of the slabs of albedo 1"}};
    return std::nullopt;
}

std::optional<Recipe> monteCarloTwin(const Row& row, const std::vector<Row>& table) {
    if (row.name != "slab-MC" && row.name != "infinite-point-MC") return std::nullopt;
    const Row* twin = betterTwin(table, row);
    if (!twin) return std::nullopt;
    return Recipe{"", Skipped{fmt::format("a Monte Carlo value of what the table also has from "
                                          "theory, at least ten times as precise; "
                                          "measured there (rows of {})",
                                          twin->name)}};
}

} // namespace

Recipe recipeFor(const Row& row, const std::vector<Row>& table) {
    if (auto recipe = outOfScope(row)) return *recipe;
    if (auto recipe = monteCarloTwin(row, table)) return *recipe;
    using Family = std::optional<Recipe> (*)(const Row&);
    for (const Family family :
         {Family(slabRecipe), Family(halfSpaceRecipe), Family(bodyRecipe),
          Family(pointSourceRecipe), Family(walkRecipe), Family(closedFormRecipe)})
        if (auto recipe = family(row)) return *recipe;
    throw std::runtime_error(
        fmt::format("line {} ({}, {}) has no recipe", row.line, row.name, row.quantity));
}

} // namespace tyndall::validation
