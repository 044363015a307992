#include "renderer/converge_settings.h"

namespace tyndall {
namespace {

const SettingDesc kConvergeSettings[] = {
    TYNDALL_FLOAT(
        ConvergeSettings, relmse, "converge.relmse", "Target error", "", 0, 1, 1e-5,
        "An average of frames has converged when its variance accounts for no more than this relative mean square error."),
    TYNDALL_INT(ConvergeSettings, maximumFrames, "converge.maximumFrames", "Frames at most", "", 1,
                1000000, 512, "Frames after which averaging stops, converged or not."),
    TYNDALL_INT(
        ConvergeSettings, checkEvery, "converge.checkEvery", "Frames between checks", "", 2, 1024,
        16, "The error is measured every so many frames; each measurement reads the picture back."),
};

} // namespace

std::span<const SettingDesc> convergeSettings() { return kConvergeSettings; }

} // namespace tyndall
