#pragma once
// When an average of frames is good enough.

#include <cstdint>
#include <span>

#include "core/settings.h"

namespace tyndall {

struct ConvergeSettings {
    float relmse; // of the average, as its own variance estimates it
    int32_t maximumFrames;
    int32_t checkEvery; // frames between measurements, each of which reads the picture back
};
std::span<const SettingDesc> convergeSettings();

} // namespace tyndall
