#pragma once
// Which technique computes indirect light.

#include <span>

#include "core/settings.h"

namespace tyndall {

struct TechniqueSettings {
    SettingText technique; // as makePlan() takes it
};
std::span<const SettingDesc> techniqueSettings();

} // namespace tyndall
