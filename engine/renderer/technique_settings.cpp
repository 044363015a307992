#include "renderer/technique_settings.h"

namespace tyndall {
namespace {

const SettingDesc kTechniqueSettings[] = {
    TYNDALL_TEXT(
        TechniqueSettings, technique, "gi.technique", "Technique", "auto",
        "Computes indirect light: auto, none, a technique's name, or TERM=NAME,... for single terms; --gi is short for it."),
};

} // namespace

std::span<const SettingDesc> techniqueSettings() { return kTechniqueSettings; }

} // namespace tyndall
