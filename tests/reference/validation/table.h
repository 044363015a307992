#pragma once
// The table of known results of radiative transfer, rt-tables.csv: one row a quantity. What the columns mean, and where the
// numbers come from, is on the design's validation page; nothing in it comes from this project's own code.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tyndall::validation {

struct Row {
    int line = 0; // in the file, from 1
    std::string name, geometry, albedo, anisotropy, tau, incidence, quantity, value, uncertainty,
        source; // as written
    double expected = 0;
    double margin = 0;      // of the expected value; for a printed one half its last digit
    bool published = false; // printed by others; else recomputed, or exact

    /// The first number behind `label` in `text`.
    [[nodiscard]] static std::optional<double> numberAfter(const std::string& text,
                                                           const std::string& label);
    /// Albedo, anisotropy or tau as a number; CHECKs that it is one.
    [[nodiscard]] static double number(const std::string& text);
    [[nodiscard]] bool quantityHas(const std::string& text) const {
        return quantity.find(text) != std::string::npos;
    }
    /// One line for people: what is measured.
    [[nodiscard]] std::string title() const;
};

/// All rows in the order of the file. Throws std::runtime_error where the file is no such table.
std::vector<Row> readTable(const std::filesystem::path& path);

/// The row that has the same quantity with a smaller margin, where there is one: a Monte Carlo value's exact twin.
const Row* betterTwin(const std::vector<Row>& table, const Row& row);

} // namespace tyndall::validation
