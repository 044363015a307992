#pragma once
// Reflected settings. A settings struct is plain data; beside it stands a constant table of
// `SettingDesc`. Command line, JSON, presets and the editor are drawn from that table, so nothing is
// typed twice. The table is plain data too: a plugin hands it across its C boundary.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

namespace tyndall {

enum class SettingType : uint32_t {
    Bool = 0,  // bool
    Int = 1,   // int32_t
    Float = 2, // float
    Enum = 3,  // enum class : int32_t with values 0..enumCount-1
    Text = 4,  // SettingText
};

/// A short text as plain data, so that a settings struct that has one can still cross the plugin boundary.
struct SettingText {
    static constexpr size_t kLongest = 255; // bytes before the final zero
    char bytes[kLongest + 1];
    [[nodiscard]] std::string_view view() const { return bytes; }
};

/// One field of a settings struct. All pointers are to static storage.
struct SettingDesc {
    const char* key;  // dotted, as in `--set media.march.steps=64`
    const char* name; // for a person: "March steps"
    const char* unit; // "m", "px", "ms", "" where there is none
    const char* help; // one sentence
    SettingType type;
    uint32_t offset;         // of the field in its struct, bytes
    double minimum, maximum; // inclusive; for Bool and Enum 0 and the largest value; not for Text
    double defaultValue;
    const char* const* enumNames; // enumCount names, or null
    uint32_t enumCount;
    const char* defaultText; // of a Text, else null
};

/// A table and the struct it describes.
struct SettingsGroup {
    std::span<const SettingDesc> fields;
    void* values;
};

enum class Quality : int32_t { Low = 0, Medium = 1, High = 2, Ultra = 3 };
std::string_view qualityName(Quality quality);
Result<Quality> parseQuality(std::string_view name);

/// "At quality Q, KEY is VALUE": presets are lists of assignments, printed by `tyndall info --settings`.
struct PresetEntry {
    Quality quality;
    const char* key;
    const char* value;
};

/// All settings that one renderer has: looked up by key, never by position.
class SettingsRegistry {
public:
    /// Adds a group and writes its defaults into `group.values`, which must outlive the registry.
    /// CHECKs: keys unique, defaults in range.
    void add(SettingsGroup group);
    void addPreset(std::span<const PresetEntry> entries);

    /// Sets `key` from text: "true/false/on/off/1/0", a number in range, an enum's name, or a text as it is.
    /// Errors: unknown key (with the nearest one), not a number, out of range (with the range), a text that is too long.
    Result<void> set(std::string_view key, std::string_view text);
    /// "KEY=VALUE" as on the command line.
    Result<void> assign(std::string_view assignment);
    /// The value as text that set() would take back.
    [[nodiscard]] Result<std::string> get(std::string_view key) const;
    void reset(const SettingDesc& field, void* values);
    void resetAll();
    /// All entries of `quality` over the values that are there.
    void applyPreset(Quality quality);

    [[nodiscard]] std::span<const SettingsGroup> groups() const { return groups_; }
    [[nodiscard]] std::span<const PresetEntry> presets() const { return presets_; }
    /// Every field whose value is not its default, as "KEY=VALUE", in order of registration.
    [[nodiscard]] std::vector<std::string> differences() const;

private:
    struct Found {
        const SettingDesc* field;
        void* values;
    };
    [[nodiscard]] Found find(std::string_view key) const;
    std::vector<SettingsGroup> groups_;
    std::vector<PresetEntry> presets_;
};

/// The field's value as text; Float round-trips.
std::string settingToText(const SettingDesc& field, const void* values);
/// The default as settingToText() would give it.
std::string settingDefaultText(const SettingDesc& field);
/// See SettingsRegistry::set.
Result<void> settingFromText(const SettingDesc& field, void* values, std::string_view text);

/// The nearest of `candidates` to `word` by edit distance, for "did you mean"; empty when none is near.
std::string nearestName(std::string_view word, std::span<const std::string_view> candidates);

// Table entries. FIELD is a member of the struct STRUCT, e.g.
//   TYNDALL_FLOAT(MarchSettings, stepScale, "media.march.stepScale", "Step", "voxels", 0.05, 16, 1, "…")
// clang-format off
#define TYNDALL_BOOL(STRUCT, FIELD, KEY, NAME, DEFAULT, HELP) \
    ::tyndall::SettingDesc{KEY, NAME, "", HELP, ::tyndall::SettingType::Bool, uint32_t(offsetof(STRUCT, FIELD)), 0, 1, (DEFAULT) ? 1.0 : 0.0, nullptr, 0, nullptr}
#define TYNDALL_INT(STRUCT, FIELD, KEY, NAME, UNIT, MIN, MAX, DEFAULT, HELP) \
    ::tyndall::SettingDesc{KEY, NAME, UNIT, HELP, ::tyndall::SettingType::Int, uint32_t(offsetof(STRUCT, FIELD)), double(MIN), double(MAX), double(DEFAULT), nullptr, 0, nullptr}
#define TYNDALL_FLOAT(STRUCT, FIELD, KEY, NAME, UNIT, MIN, MAX, DEFAULT, HELP) \
    ::tyndall::SettingDesc{KEY, NAME, UNIT, HELP, ::tyndall::SettingType::Float, uint32_t(offsetof(STRUCT, FIELD)), double(MIN), double(MAX), double(DEFAULT), nullptr, 0, nullptr}
#define TYNDALL_ENUM(STRUCT, FIELD, KEY, NAME, NAMES, DEFAULT, HELP) \
    ::tyndall::SettingDesc{KEY, NAME, "", HELP, ::tyndall::SettingType::Enum, uint32_t(offsetof(STRUCT, FIELD)), 0, double(::std::size(NAMES) - 1), double(int32_t(DEFAULT)), NAMES, uint32_t(::std::size(NAMES)), nullptr}
#define TYNDALL_TEXT(STRUCT, FIELD, KEY, NAME, DEFAULT, HELP) \
    ::tyndall::SettingDesc{KEY, NAME, "", HELP, ::tyndall::SettingType::Text, uint32_t(offsetof(STRUCT, FIELD)), 0, 0, 0, nullptr, 0, DEFAULT}
// clang-format on

} // namespace tyndall
