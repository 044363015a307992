#pragma once
// How each kind of row is measured, or why it is not.

#include <string>
#include <variant>

#include "validation/measure.h"
#include "validation/table.h"

namespace tyndall::validation {

struct Skipped {
    std::string reason;
};
/// Computed without chance: a closed form that the tracer uses, or a quadrature over a function of it.
struct Computed {
    double value = 0;
    double tolerance = 1e-6; // relative
};
struct Recipe {
    std::string how; // one sentence
    std::variant<Skipped, Computed, Probe> what;
};

/// `table`: to find a row's twin. Throws std::runtime_error for a row that nobody knows how to treat.
Recipe recipeFor(const Row& row, const std::vector<Row>& table);

/// The families; each says nothing (no value) about rows that are not its own.
std::optional<Recipe> slabRecipe(const Row& row);
std::optional<Recipe> halfSpaceRecipe(const Row& row);
std::optional<Recipe> bodyRecipe(const Row& row);
std::optional<Recipe> pointSourceRecipe(const Row& row);
std::optional<Recipe> walkRecipe(const Row& row);
std::optional<Recipe> closedFormRecipe(const Row& row);

/// Of a slab lit from all of one side, through reciprocity: eyes just above it see a bright sky above (R) or below (T).
enum class Side { Reflected = 0, Transmitted = 1 };
/// `mu0`: cosine of incidence; no value: diffuse.
Probe slabFluxProbe(double albedo, double anisotropy, double tau, std::optional<double> mu0,
                    Side side);
/// Radiance that leaves a slab at cosine `mu`, lit from above at `mu0` with a perpendicular irradiance of π. At `mu` 0 the ray
/// runs inside, along the face: it sees the source function there.
Probe slabRadianceProbe(double albedo, double anisotropy, double tau, double mu0, double mu,
                        Side side);

/// Mean free paths from a point source beyond which its fluence is measured by walks away from it.
inline constexpr double kFar = 4;

/// Case, de Hoffmann and Placzek 1953.
inline constexpr double kMilneExtrapolation = 0.7104460896;

} // namespace tyndall::validation
