#include "core/settings.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <numeric>

namespace tyndall {
namespace {

constexpr std::string_view kQualityNames[] = {"low", "medium", "high", "ultra"};

template <typename T> T load(const SettingDesc& field, const void* values) {
    T value;
    std::memcpy(&value, static_cast<const char*>(values) + field.offset, sizeof(T));
    return value;
}

template <typename T> void store(const SettingDesc& field, void* values, T value) {
    std::memcpy(static_cast<char*>(values) + field.offset, &value, sizeof(T));
}

void storeNumber(const SettingDesc& field, void* values, double number) {
    switch (field.type) {
    case SettingType::Bool: store<bool>(field, values, number != 0); break;
    case SettingType::Int:
    case SettingType::Enum: store<int32_t>(field, values, int32_t(number)); break;
    case SettingType::Float: store<float>(field, values, float(number)); break;
    case SettingType::Text: break; // no number
    }
}

void storeText(const SettingDesc& field, void* values, std::string_view text) {
    SettingText stored{};
    text.copy(stored.bytes, SettingText::kLongest);
    store(field, values, stored);
}

std::string numberText(double value) {
    char buffer[64];
    auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value);
    (void)error; // 64 characters hold any double in shortest form.
    return {buffer, end};
}

std::string floatText(float value) {
    char buffer[64];
    auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value);
    (void)error;
    return {buffer, end};
}

Error outOfRange(const SettingDesc& field, std::string_view text) {
    return Error{"setting '" + std::string(field.key) + "' = '" + std::string(text) +
                 "' is out of range: it takes " + numberText(field.minimum) + " to " +
                 numberText(field.maximum) + (*field.unit ? " " + std::string(field.unit) : "")};
}

std::string enumList(const SettingDesc& field) {
    std::string list;
    for (uint32_t i = 0; i < field.enumCount; ++i)
        list += (i ? ", " : "") + std::string(field.enumNames[i]);
    return list;
}

size_t editDistance(std::string_view a, std::string_view b) {
    std::vector<size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), size_t(0));
    for (size_t i = 1; i <= a.size(); ++i) {
        size_t diagonal = row[0];
        row[0] = i;
        for (size_t j = 1; j <= b.size(); ++j) {
            const size_t substituted = diagonal + (a[i - 1] != b[j - 1]);
            diagonal = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
        }
    }
    return row[b.size()];
}

/// The error is that of settingFromText(); the values stay as they are.
Result<void> checkText(SettingDesc field, std::string_view text) {
    alignas(8) char scratch[sizeof(SettingText)] = {};
    field.offset = 0;
    return settingFromText(field, scratch, text);
}

} // namespace

std::string_view qualityName(Quality quality) { return kQualityNames[size_t(quality)]; }

Result<Quality> parseQuality(std::string_view name) {
    for (size_t i = 0; i < std::size(kQualityNames); ++i)
        if (kQualityNames[i] == name) return Quality(i);
    return Error{"quality '" + std::string(name) +
                 "' is unknown: it takes low, medium, high or ultra"};
}

std::string nearestName(std::string_view word, std::span<const std::string_view> candidates) {
    std::string_view best;
    size_t bestDistance = std::max<size_t>(2, word.size() / 3) + 1;
    for (std::string_view candidate : candidates) {
        const size_t distance = editDistance(word, candidate);
        if (distance < bestDistance) {
            bestDistance = distance;
            best = candidate;
        }
    }
    return std::string(best);
}

std::string settingToText(const SettingDesc& field, const void* values) {
    switch (field.type) {
    case SettingType::Bool: return load<bool>(field, values) ? "true" : "false";
    case SettingType::Int: return std::to_string(load<int32_t>(field, values));
    case SettingType::Float: return floatText(load<float>(field, values));
    case SettingType::Enum: {
        const auto index = load<int32_t>(field, values);
        CHECK(index >= 0 && uint32_t(index) < field.enumCount, field.key);
        return field.enumNames[index];
    }
    case SettingType::Text: return std::string(load<SettingText>(field, values).view());
    }
    return {};
}

std::string settingDefaultText(const SettingDesc& field) {
    switch (field.type) {
    case SettingType::Bool: return field.defaultValue != 0 ? "true" : "false";
    case SettingType::Int: return std::to_string(int32_t(field.defaultValue));
    case SettingType::Float: return floatText(float(field.defaultValue));
    case SettingType::Enum: return field.enumNames[size_t(field.defaultValue)];
    case SettingType::Text: return field.defaultText;
    }
    return {};
}

Result<void> settingFromText(const SettingDesc& field, void* values, std::string_view text) {
    if (field.type == SettingType::Bool) {
        const bool on = text == "true" || text == "on" || text == "1";
        if (!on && text != "false" && text != "off" && text != "0")
            return Error{"setting '" + std::string(field.key) + "' = '" + std::string(text) +
                         "' is not a switch: it takes true or false"};
        store<bool>(field, values, on);
        return {};
    }
    if (field.type == SettingType::Enum) {
        for (uint32_t i = 0; i < field.enumCount; ++i)
            if (text == field.enumNames[i]) {
                store<int32_t>(field, values, int32_t(i));
                return {};
            }
        return Error{"setting '" + std::string(field.key) + "' = '" + std::string(text) +
                     "' is unknown: it takes " + enumList(field)};
    }
    if (field.type == SettingType::Text) {
        if (text.size() > SettingText::kLongest || text.find('\0') != std::string_view::npos)
            return Error{"setting '" + std::string(field.key) + "' = '" +
                         std::string(text.substr(0, 32)) + "...' is too long: it takes up to " +
                         std::to_string(SettingText::kLongest) + " characters"};
        storeText(field, values, text);
        return {};
    }
    double number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    const bool whole = field.type != SettingType::Int || number == std::floor(number);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(number) ||
        !whole)
        return Error{"setting '" + std::string(field.key) + "' = '" + std::string(text) +
                     "' is not a " + (field.type == SettingType::Int ? "whole number" : "number")};
    if (!(number >= field.minimum && number <= field.maximum)) return outOfRange(field, text);
    storeNumber(field, values, number);
    return {};
}

void SettingsRegistry::add(SettingsGroup group) {
    CHECK(group.values != nullptr);
    for (const SettingDesc& field : group.fields) {
        CHECK(find(field.key).field == nullptr,
              "setting registered twice: " + std::string(field.key));
        CHECK(field.defaultValue >= field.minimum && field.defaultValue <= field.maximum,
              field.key);
        CHECK(field.type != SettingType::Text || checkText(field, field.defaultText).ok(),
              field.key);
        reset(field, group.values);
    }
    groups_.push_back(group);
}

void SettingsRegistry::addPreset(std::span<const PresetEntry> entries) {
    for (const PresetEntry& entry : entries) {
        const Found found = find(entry.key);
        CHECK(found.field != nullptr, "preset for an unknown setting: " + std::string(entry.key));
        const Result<void> parsed = checkText(*found.field, entry.value);
        CHECK(parsed.ok(), parsed.ok() ? "" : parsed.message());
        presets_.push_back(entry);
    }
}

SettingsRegistry::Found SettingsRegistry::find(std::string_view key) const {
    for (const SettingsGroup& group : groups_)
        for (const SettingDesc& field : group.fields)
            if (key == field.key) return {&field, group.values};
    return {nullptr, nullptr};
}

Result<void> SettingsRegistry::set(std::string_view key, std::string_view text) {
    const Found found = find(key);
    if (found.field) return settingFromText(*found.field, found.values, text);
    std::vector<std::string_view> keys;
    for (const SettingsGroup& group : groups_)
        for (const SettingDesc& field : group.fields) keys.emplace_back(field.key);
    const std::string nearest = nearestName(key, keys);
    return Error{"setting '" + std::string(key) + "' is unknown" +
                 (nearest.empty() ? ": 'tyndall info --settings' lists them all"
                                  : ": did you mean '" + nearest + "'?")};
}

Result<void> SettingsRegistry::assign(std::string_view assignment) {
    const size_t equals = assignment.find('=');
    if (equals == std::string_view::npos)
        return Error{"'" + std::string(assignment) + "' is not an assignment: write KEY=VALUE"};
    return set(assignment.substr(0, equals), assignment.substr(equals + 1));
}

Result<std::string> SettingsRegistry::get(std::string_view key) const {
    const Found found = find(key);
    if (!found.field) return Error{"setting '" + std::string(key) + "' is unknown"};
    return settingToText(*found.field, found.values);
}

void SettingsRegistry::reset(const SettingDesc& field, void* values) {
    if (field.type == SettingType::Text)
        storeText(field, values, field.defaultText);
    else
        storeNumber(field, values, field.defaultValue);
}

void SettingsRegistry::resetAll() {
    for (const SettingsGroup& group : groups_)
        for (const SettingDesc& field : group.fields) reset(field, group.values);
}

void SettingsRegistry::applyPreset(Quality quality) {
    for (const PresetEntry& entry : presets_)
        if (entry.quality == quality) {
            const Result<void> done = set(entry.key, entry.value);
            CHECK(done.ok(), done.ok() ? "" : done.message());
        }
}

std::vector<std::string> SettingsRegistry::differences() const {
    std::vector<std::string> result;
    for (const SettingsGroup& group : groups_)
        for (const SettingDesc& field : group.fields) {
            const std::string now = settingToText(field, group.values);
            if (now != settingDefaultText(field))
                result.push_back(std::string(field.key) + "=" + now);
        }
    return result;
}

} // namespace tyndall
