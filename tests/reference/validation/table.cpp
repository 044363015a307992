#include "validation/table.h"

#include <cstdlib>
#include <fstream>
#include <stdexcept>

#include <fmt/format.h>

#include "core/check.h"

namespace tyndall::validation {
namespace {

constexpr size_t kColumns = 10;

std::vector<std::string> fieldsOf(const std::string& line) {
    std::vector<std::string> fields(1);
    bool quoted = false;
    for (const char c : line) {
        if (c == '"')
            quoted = !quoted;
        else if (c == ',' && !quoted)
            fields.emplace_back();
        else if (c != '\r')
            fields.back() += c;
    }
    return fields;
}

std::optional<double> wholeNumber(const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (text.empty() || *end != '\0') return std::nullopt;
    return value;
}

bool startsWith(const std::string& text, const std::string& start) {
    return text.compare(0, start.size(), start) == 0;
}

} // namespace

std::optional<double> Row::numberAfter(const std::string& text, const std::string& label) {
    const size_t at = text.find(label);
    if (at == std::string::npos) return std::nullopt;
    const char* begin = text.c_str() + at + label.size();
    char* end = nullptr;
    const double value = std::strtod(begin, &end);
    if (end == begin) return std::nullopt;
    return value;
}

double Row::number(const std::string& text) {
    const std::optional<double> value = wholeNumber(text);
    CHECK(value.has_value(), fmt::format("'{}' is no number", text));
    return *value;
}

std::string Row::title() const {
    std::string what;
    const auto add = [&](const std::string& label, const std::string& text) {
        if (text.empty() || text == "-") return;
        what += (what.empty() ? "" : ", ") + label + text;
    };
    add("albedo ", startsWith(albedo, "coefficient") ? "" : albedo);
    add("g ", anisotropy);
    add(startsWith(tau, "r=") || startsWith(tau, "R=") || startsWith(tau, "n=") ||
                startsWith(tau, "sigma")
            ? ""
            : "tau ",
        tau);
    add("", incidence);
    add("", quantity);
    return what;
}

std::vector<Row> readTable(const std::filesystem::path& path) {
    std::ifstream file(path);
    if (!file) throw std::runtime_error(path.string() + " cannot be read");
    std::vector<Row> rows;
    std::string text;
    for (int line = 1; std::getline(file, text); ++line) {
        if (line == 1 || text.empty()) continue;
        const std::vector<std::string> f = fieldsOf(text);
        if (f.size() != kColumns)
            throw std::runtime_error(fmt::format("{} line {} has {} columns, not {}", path.string(),
                                                 line, f.size(), kColumns));
        Row row{line, f[0], f[1], f[2], f[3], f[4], f[5], f[6], f[7], f[8], f[9]};
        row.expected = wholeNumber(row.value).value_or(0);
        row.published = startsWith(row.source, "published");
        row.margin = startsWith(row.uncertainty, "rel ")
                         ? Row::number(row.uncertainty.substr(4)) * row.expected
                         : Row::number(row.uncertainty);
        rows.push_back(std::move(row));
    }
    return rows;
}

const Row* betterTwin(const std::vector<Row>& table, const Row& row) {
    const auto alike = [](const std::string& a, const std::string& b) {
        const auto x = wholeNumber(a), y = wholeNumber(b);
        return x && y ? *x == *y : a == b;
    };
    // "reflectance" and "reflectance R (…)" are the same.
    for (const Row& other : table)
        if (&other != &row && other.margin < 0.1 * row.margin && alike(other.albedo, row.albedo) &&
            alike(other.anisotropy, row.anisotropy) && alike(other.tau, row.tau) &&
            other.geometry == row.geometry && other.incidence == row.incidence &&
            startsWith(other.quantity, row.quantity))
            return &other;
    return nullptr;
}

} // namespace tyndall::validation
