#include "renderer/converge_settings.h"

namespace tyndall {
namespace {

const SettingDesc kConvergeSettings[] = {
    TYNDALL_FLOAT(
        ConvergeSettings, relmse, "converge.relmse", "Target error", "", 0, 1, 1e-5,
        "An average of frames has converged when its estimated relative mean square error is below this. Lower is less noise and more frames."),
    TYNDALL_INT(ConvergeSettings, maximumFrames, "converge.maximumFrames", "Maximum frames", "", 1,
                1000000, 512, "Averaging stops after this many frames, converged or not."),
    TYNDALL_INT(
        ConvergeSettings, checkEvery, "converge.checkEvery", "Frames between checks", "", 2, 1024,
        16,
        "The error is measured every so many frames. Each measurement reads the picture back, so fewer are faster; more stop sooner."),
};

} // namespace

std::span<const SettingDesc> convergeSettings() { return kConvergeSettings; }

} // namespace tyndall
