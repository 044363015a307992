#include "setting_options.h"

#include <cstddef>
#include <optional>

#include "core/check.h"

namespace tyndall::editor {
namespace {

using Texts = std::map<std::string, std::string>; // by key

/// As settingToText() writes it: presets may say 1.50 for 1.5.
std::string usualText(const SettingDesc& field, const char* text) {
    std::vector<std::byte> values(field.offset + sizeof(SettingText));
    const Result<void> done = settingFromText(field, values.data(), text);
    CHECK(done.ok(), done.ok() ? std::string() : done.message());
    return settingToText(field, values.data());
}

/// What the scene file and then the preset set.
Texts withPreset(const SettingsRegistry& settings, const Texts& ofScene, Quality quality) {
    Texts result = ofScene;
    for (const SettingsGroup& group : settings.groups())
        for (const SettingDesc& field : group.fields)
            for (const PresetEntry& entry : settings.presets())
                if (entry.quality == quality && std::string_view(entry.key) == field.key)
                    result[field.key] = usualText(field, entry.value);
    return result;
}

std::vector<std::string> differences(const SettingsRegistry& settings, const Texts& before,
                                     const std::string& techniqueKey) {
    std::vector<std::string> options;
    for (const SettingsGroup& group : settings.groups())
        for (const SettingDesc& field : group.fields) {
            const std::string key = field.key, text = settingToText(field, group.values);
            if (key.starts_with("inspect.") || before.at(key) == text) continue;
            options.push_back(key == techniqueKey ? "--gi " + shellWord(text)
                                                  : "--set " + shellWord(key + "=" + text));
        }
    return options;
}

} // namespace

std::string shellWord(const std::string& text) {
    const bool plain =
        !text.empty() &&
        text.find_first_not_of(
            "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-+=./,:@%") ==
            std::string::npos;
    if (plain) return text;
    std::string word = "'";
    for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return word + "'";
}

std::vector<std::string> settingOptions(const SettingsRegistry& settings, const Texts& ofScene,
                                        const std::string& techniqueKey) {
    std::vector<std::string> shortest = differences(settings, ofScene, techniqueKey);
    for (const Quality quality : {Quality::Low, Quality::Medium, Quality::High, Quality::Ultra}) {
        std::vector<std::string> options =
            differences(settings, withPreset(settings, ofScene, quality), techniqueKey);
        options.insert(options.begin(), "--quality " + std::string(qualityName(quality)));
        if (options.size() < shortest.size()) shortest = std::move(options);
    }
    return shortest;
}

} // namespace tyndall::editor
