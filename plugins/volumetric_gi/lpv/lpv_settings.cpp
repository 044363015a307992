#include "volumetric_gi/lpv/lpv_settings.h"

namespace tyndall::volumetric_gi {
namespace {

constexpr const char* kShowNames[] = {"nothing",  "light",    "directions", "medium",
                                      "surfaces", "residual", "losses"};
constexpr const char* kMarchNames[] = {"full", "half", "quarter"};
constexpr const char* kAxisNames[] = {"x", "y", "z"};

const SettingDesc kLpvSettings[] = {
    TYNDALL_INT(
        LpvSettings, resolution, "gi.lpv.resolution", "Lattice cells", "", 4, 64, 32,
        "Cells along the longest side of the finest lattice; the others follow from its shape."),
    TYNDALL_INT(
        LpvSettings, cascades, "gi.lpv.cascades", "Lattices", "", 1, 4, 4,
        "Lattices at most: one around what is in the scene, coarser ones around it out to the landscape."),
    TYNDALL_FLOAT(
        LpvSettings, extent, "gi.lpv.extent", "Extent of the finest", "m", 0.0f, 1e6f, 0.0f,
        "Longest side of the finest lattice; shorter than the scene it follows the camera. 0: from the scene."),
    TYNDALL_INT(
        LpvSettings, steps, "gi.lpv.steps", "Steps a frame", "", 2, 4096, 256,
        "Steps in a frame at most: they end where light is settled, and go on in the next frame where it is not."),
    TYNDALL_FLOAT(
        LpvSettings, tolerance, "gi.lpv.tolerance", "Settled below", "", 0.0f, 1.0f, 0.002f,
        "Steps end when what is left to come, over what there is, is estimated to be less."),
    TYNDALL_INT(LpvSettings, rsmSize, "gi.lpv.rsmSize", "Map size", "texels", 16, 2048, 128,
                "Side of a reflective shadow map: of each light, of each of its six directions."),
    TYNDALL_INT(
        LpvSettings, rsmLights, "gi.lpv.rsmLights", "Lights", "", 1, 1024, 64,
        "Lights whose light is propagated, the strongest first and those of the environment last; the others light directly alone."),
    TYNDALL_INT(LpvSettings, rsmRectPoints, "gi.lpv.rsmRectPoints", "Points of a rect", "", 1, 64,
                4, "Points of a rectangular light that have reflective shadow maps."),
    TYNDALL_BOOL(LpvSettings, reflected, "gi.lpv.reflected", "Reflected light", true,
                 "Light that surfaces reflect goes into the lattice."),
    TYNDALL_BOOL(LpvSettings, scattered, "gi.lpv.scattered", "Scattered light", true,
                 "Light that media scatter once goes into the lattice."),
    TYNDALL_BOOL(
        LpvSettings, keep, "gi.lpv.keep", "Keep light", true,
        "Where nothing has changed light is kept from frame to frame; off: found anew in each, to be timed."),
    TYNDALL_ENUM(
        LpvSettings, march, "gi.lpv.march", "March resolution", kMarchNames, 1,
        "Rays along which media show the lattices' light: for every pixel, every 2x2 or every 4x4 pixels; upsampled as media.march.refine and the tolerances "
        "beside it say."),
    TYNDALL_ENUM(
        LpvSettings, show, "gi.lpv.show", "Show", kShowNames, 0,
        "A slice of the finest lattice in the picture: its light, where light goes, the depth of a cell of medium (2: white), its surfaces, what the last "
        "step changed (a tenth: white), the part of the light that media and surfaces absorb."),
    TYNDALL_ENUM(LpvSettings, showAxis, "gi.lpv.showAxis", "Across", kAxisNames, 2,
                 "The axis that the slice is across."),
    TYNDALL_FLOAT(LpvSettings, showAt, "gi.lpv.showAt", "At", "", 0.0f, 1.0f, 0.5f,
                  "Where on that axis: 0 the lattice's one end, 1 its other."),
};

constexpr PresetEntry kLpvPresets[] = {
    {Quality::Low, "gi.lpv.resolution", "16"},      {Quality::Low, "gi.lpv.steps", "96"},
    {Quality::Low, "gi.lpv.cascades", "2"},         {Quality::Low, "gi.lpv.tolerance", "0.01"},
    {Quality::Low, "gi.lpv.rsmSize", "64"},         {Quality::Low, "gi.lpv.rsmRectPoints", "1"},
    {Quality::Low, "gi.lpv.march", "quarter"},      {Quality::Medium, "gi.lpv.resolution", "24"},
    {Quality::Medium, "gi.lpv.steps", "128"},       {Quality::Medium, "gi.lpv.cascades", "3"},
    {Quality::Medium, "gi.lpv.tolerance", "0.005"}, {Quality::Medium, "gi.lpv.rsmSize", "96"},
    {Quality::Medium, "gi.lpv.rsmRectPoints", "4"}, {Quality::Medium, "gi.lpv.march", "half"},
    {Quality::High, "gi.lpv.resolution", "32"},     {Quality::High, "gi.lpv.steps", "256"},
    {Quality::High, "gi.lpv.cascades", "4"},        {Quality::High, "gi.lpv.tolerance", "0.002"},
    {Quality::High, "gi.lpv.rsmSize", "128"},       {Quality::High, "gi.lpv.rsmRectPoints", "4"},
    {Quality::High, "gi.lpv.march", "half"},        {Quality::Ultra, "gi.lpv.resolution", "64"},
    {Quality::Ultra, "gi.lpv.steps", "512"},        {Quality::Ultra, "gi.lpv.cascades", "4"},
    {Quality::Ultra, "gi.lpv.tolerance", "0.001"},  {Quality::Ultra, "gi.lpv.rsmSize", "256"},
    {Quality::Ultra, "gi.lpv.rsmRectPoints", "9"},  {Quality::Ultra, "gi.lpv.march", "full"},
    {Quality::Ultra, "gi.lpv.rsmLights", "160"}, // environment.lights has 64 then
};

} // namespace

std::span<const SettingDesc> lpvSettings() { return kLpvSettings; }
std::span<const PresetEntry> lpvPresets() { return kLpvPresets; }

} // namespace tyndall::volumetric_gi
