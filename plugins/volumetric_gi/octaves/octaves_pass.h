#pragma once
// The baseline technique: multiple scattering as octaves of single scattering (Wrenninge, Kulla and Lundqvist 2013, "Oz: The
// Great and Volumetric"). Octave i scatters scatteringFactor^i as much, lets light through extinctionFactor^i of the
// optical depth and scatters with phaseFactor^i of the anisotropy; bounded when scatteringFactor ≤ extinctionFactor.
// Roughly LVVE and LXVVE together: it knows neither surfaces nor where the light was scattered before.

#include <span>

#include "plugin/plugin_api.h"

namespace tyndall::volumetric_gi {

struct OctavesSettings {
    int32_t count;
    float scatteringFactor, extinctionFactor, phaseFactor;
};
std::span<const SettingDesc> octavesSettings();
std::span<const PresetEntry> octavesPresets();

/// View-sized RGBA32F nits that reach the eye: the octaves 1 … count. Skipped where no medium scatters or no octave is asked for.
fg::TextureHandle addOctavesPass(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                                 const OctavesSettings& settings);

} // namespace tyndall::volumetric_gi
