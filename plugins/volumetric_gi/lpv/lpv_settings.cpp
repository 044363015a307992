#include "volumetric_gi/lpv/lpv_settings.h"

namespace tyndall::volumetric_gi {
namespace {

constexpr const char* kShowNames[] = {"nothing",  "light",    "directions", "medium",
                                      "surfaces", "residual", "losses"};
constexpr const char* kMarchNames[] = {"full", "half", "quarter"};
constexpr const char* kAxisNames[] = {"x", "y", "z"};

const SettingDesc kLpvSettings[] = {
    TYNDALL_INT(
        LpvSettings, resolution, "gi.lpv.resolution", "Lattice cells", "", 4, 64, 16,
        "Cells along the longest side of the finest lattice. More resolve finer detail; time and memory grow with the cube."),
    TYNDALL_INT(
        LpvSettings, cascades, "gi.lpv.cascades", "Nested lattices", "", 1, 4, 3,
        "Maximum number of lattices: one around the objects of the scene, coarser ones around it out to the landscape. More reach farther and cost a lattice each."),
    TYNDALL_FLOAT(
        LpvSettings, extent, "gi.lpv.extent", "Finest extent", "m", 0.0f, 1e6f, 0.0f,
        "Longest side of the finest lattice; if it is shorter than the scene, the lattice follows the camera. Shorter is sharper nearby; 0 fits the scene."),
    TYNDALL_INT(
        LpvSettings, steps, "gi.lpv.steps", "Steps per frame", "", 2, 4096, 96,
        "Maximum propagation steps in a frame; they end early when light has settled, else continue in the next frame. More settle sooner and cost time."),
    TYNDALL_FLOAT(
        LpvSettings, tolerance, "gi.lpv.tolerance", "Settled below", "", 0.0f, 1.0f, 0.02,
        "Steps end when the estimated remaining light, over the light that is there, is below this. Lower is more accurate and takes more steps."),
    TYNDALL_INT(
        LpvSettings, rsmSize, "gi.lpv.rsmSize", "Shadow map size", "texels", 16, 2048, 96,
        "Side of each reflective shadow map. Larger maps inject light more evenly and cost time with their area."),
    TYNDALL_INT(
        LpvSettings, rsmLights, "gi.lpv.rsmLights", "Lights", "", 1, 1024, 64,
        "Lights whose light is propagated, the strongest first and those of the environment last; the others give direct light alone. More cost a map each."),
    TYNDALL_INT(
        LpvSettings, rsmRectPoints, "gi.lpv.rsmRectPoints", "Rect light points", "", 1, 64, 4,
        "Points of a rect light that have reflective shadow maps. More represent large panels better and cost maps."),
    TYNDALL_BOOL(LpvSettings, reflected, "gi.lpv.reflected", "Reflected light", true,
                 "Injects light that surfaces reflect. Off shows the light of media alone."),
    TYNDALL_BOOL(LpvSettings, scattered, "gi.lpv.scattered", "Scattered light", true,
                 "Injects light that media scatter once. Off shows the light of surfaces alone."),
    TYNDALL_BOOL(
        LpvSettings, keep, "gi.lpv.keep", "Keep light", true,
        "Keeps light from frame to frame while nothing changes. Off propagates all of it again in each frame, for timing."),
    TYNDALL_ENUM(
        LpvSettings, march, "gi.lpv.march", "March resolution", kMarchNames, 1,
        "One ray through media for each pixel, each 2x2 or each 4x4 pixels. Fewer are faster and blur outlines; refinement follows the media.march settings."),
    TYNDALL_ENUM(
        LpvSettings, show, "gi.lpv.show", "Show", kShowNames, 0,
        "Draws a slice of the finest lattice: fluence, directions, optical depth of a cell (2 is white), surfaces, change of the last step (a tenth is white), or the part of light that is absorbed."),
    TYNDALL_ENUM(LpvSettings, showAxis, "gi.lpv.showAxis", "Slice axis", kAxisNames, 2,
                 "The axis that the slice is perpendicular to."),
    TYNDALL_FLOAT(LpvSettings, showAt, "gi.lpv.showAt", "Slice position", "", 0.0f, 1.0f, 0.5f,
                  "Position of the slice on its axis: 0 is one end of the lattice, 1 the other."),
};

constexpr PresetEntry kLpvPresets[] = {
    {Quality::Low, "gi.lpv.resolution", "16"},      {Quality::Low, "gi.lpv.steps", "96"},
    {Quality::Low, "gi.lpv.cascades", "2"},         {Quality::Low, "gi.lpv.tolerance", "0.02"},
    {Quality::Low, "gi.lpv.rsmSize", "64"},         {Quality::Low, "gi.lpv.rsmRectPoints", "1"},
    {Quality::Low, "gi.lpv.march", "quarter"},      {Quality::Medium, "gi.lpv.resolution", "16"},
    {Quality::Medium, "gi.lpv.steps", "96"},       {Quality::Medium, "gi.lpv.cascades", "3"},
    {Quality::Medium, "gi.lpv.tolerance", "0.02"}, {Quality::Medium, "gi.lpv.rsmSize", "96"},
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
