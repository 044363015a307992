#pragma once
// The base class of this plugin's techniques, and what they share.

#include <cstddef>
#include <memory>
#include <span>

#include "plugin/plugin_api.h"
#include "volumetric_gi/shared/traced_scene.h"

namespace tyndall::volumetric_gi {

/// Which equations a technique uses: gi.mode.
enum class Mode : int32_t { Corrected = 0, Paper = 1 };

/// Shared by all techniques of the plugin; it outlives them.
struct SharedParts {
    plugin::Host* host = nullptr; // from the plugin's set-up on
    Mode mode = Mode::Corrected;
    TracedScene traced; // update() it before use; only the first call in a frame costs time
};

class GiTechnique : public plugin::Technique {
public:
    explicit GiTechnique(SharedParts& shared) : shared_(shared) {}
    virtual ~GiTechnique() = default;
    GiTechnique(const GiTechnique&) = delete;
    GiTechnique& operator=(const GiTechnique&) = delete;

protected:
    [[nodiscard]] plugin::Host& host() const { return *shared_.host; }
    [[nodiscard]] bool asPrinted() const { return shared_.mode == Mode::Paper; }
    /// The table for `fields`, whose values are in `values`.
    static plugin::SettingsTable table(std::span<const SettingDesc> fields, void* values,
                                       std::span<const PresetEntry> presets) {
        return {fields.data(), uint32_t(fields.size()), values, presets.data(),
                uint32_t(presets.size())};
    }

    SharedParts& shared_;
};

} // namespace tyndall::volumetric_gi
