#include "volumetric_gi/vpl/vpl_settings.h"

namespace tyndall::volumetric_gi {
namespace {

constexpr const char* kCompensationNames[] = {"clamped", "closed", "traced"};
constexpr const char* kMarchNames[] = {"full", "half", "quarter", "eighth"};

constexpr const char* kMapsNames[] = {"rays", "points"};
constexpr const char* kShowNames[] = {"nothing", "lights", "map", "atlas", "lost"};

const SettingDesc kVplSettings[] = {
    TYNDALL_INT(
        VplSettings, walks, "gi.vpl.walks", "Walks", "", 1, 65536, 128,
        "Random walks from the lights; each leaves a virtual light wherever it scatters. More are less noisy; maps and gathering take time in proportion."),
    TYNDALL_INT(
        VplSettings, candidates, "gi.vpl.candidates", "Candidates per walk", "", 1, 64, 1,
        "Traces this many times as many walks and keeps the virtual lights of highest importance for the view. More are less noisy and cost processor time; 1 keeps all lights."),
    TYNDALL_INT(
        VplSettings, renewed, "gi.vpl.renewed", "Walks renewed per frame", "", 0, 65536, 0,
        "After a change of lights or media, traces this many walks again in each frame; indirect light lags behind until all are renewed. 0 renews all at once. Turns off candidates."),
    TYNDALL_INT(
        VplSettings, subsets, "gi.vpl.classes", "Interleaved subsets", "", 1, 1024, 8,
        "A point on a ray through media gathers one of this many subsets of the walks, the next point another. More are faster and noisier."),
    TYNDALL_INT(
        VplSettings, surfaceSubsets, "gi.vpl.surfaceClasses", "Subsets on surfaces", "", 1, 1024, 1,
        "A surface point gathers one of this many subsets of the walks, its neighbours others. More are faster and noisier; 1 gathers all."),
    TYNDALL_ENUM(
        VplSettings, maps, "gi.vpl.maps", "Visibility maps from", kMapsNames, 0,
        "Makes visibility maps by rays on the processor, or by points that the GPU splats (for a fast GPU)."),
    TYNDALL_INT(
        VplSettings, points, "gi.vpl.points", "Points per map", "", 64, 65536, 4096,
        "Points of surfaces splatted into each visibility map, for maps from points. More leave fewer gaps and cost time."),
    TYNDALL_INT(
        VplSettings, mapSide, "gi.vpl.mapSide", "Visibility map size", "texels", 0, 512, 24,
        "Side of a virtual light's visibility map. Larger maps find thinner occluders and cost time and memory with their area; 0: no shadows."),
    TYNDALL_INT(
        VplSettings, depthSide, "gi.vpl.depthSide", "Depth map size", "texels", 0, 64, 16,
        "Side of a virtual light's map of the optical depth of grids. Larger maps have sharper shadows in smoke and cost time and memory with their area; 0 marches grids for each pair, which is slow."),
    TYNDALL_INT(
        VplSettings, samples, "gi.vpl.samples", "Points per ray", "", 1, 1024, 16,
        "Points along a ray through media that gather virtual lights. More are less noisy; time grows in proportion."),
    TYNDALL_ENUM(
        VplSettings, compensation, "gi.vpl.compensation", "Bias compensation", kCompensationNames,
        2,
        "Light removed by clamping: left out (clamped), estimated as if light were even (closed), or gathered at a point nearby (traced, slower)."),
    TYNDALL_INT(
        VplSettings, compensationPaths, "gi.vpl.nearPaths", "Compensation paths", "", 0, 1024, 1,
        "Processor paths for each square of surfaces and each ray that add light which traced compensation lacks; in averaged frames alone. More are less noisy and slower; 0 leaves it out."),
    TYNDALL_ENUM(
        VplSettings, march, "gi.vpl.march", "March resolution", kMarchNames, 1,
        "One ray through media for each pixel, or for a square of 2, 4 or 8 pixels a side. Fewer are faster and blur outlines."),
    TYNDALL_ENUM(
        VplSettings, surfaces, "gi.vpl.surfaces.resolution", "Surface resolution", kMarchNames, 1,
        "One gathering on surfaces for each pixel, or for a square of 2, 4 or 8 pixels a side. Fewer are faster and blur outlines."),
    TYNDALL_FLOAT(
        VplSettings, clamp, "gi.vpl.clamp", "Clamping distance", "", 0.0f, 100.0f, 1.0f,
        "A virtual light nearer than this, in mean distances between lights, is clamped to it. Higher removes bright spots and adds bias or work for the compensation."),
    TYNDALL_FLOAT(
        VplSettings, surfaceClamp, "gi.vpl.surfaceClamp", "Clamping between surfaces", "", 0.0f,
        100.0f, 0.5f,
        "The clamping distance for light between surfaces and from surfaces to media near them. Higher removes bright spots and darkens corners; single frames do not compensate for it."),
    TYNDALL_FLOAT(
        VplSettings, relaxed, "gi.vpl.relaxed", "Relaxed clamping", "", 1.0f, 1000.0f, 2.0f,
        "Traced compensation clamps at this many times less distance, and still less in averaged frames. Higher is less bias and more noise."),
    TYNDALL_FLOAT(
        VplSettings, roughness, "gi.vpl.roughness", "Minimum roughness", "", 0.0f, 1.0f, 0.4f,
        "Smoother surfaces reflect virtual lights as if they had this roughness; it falls in averaged frames. Lower is sharper and shows single lights as spots."),
    TYNDALL_BOOL(VplSettings, fromSurfaces, "gi.vpl.fromSurfaces", "Lights on surfaces", true,
                 "Gathers virtual lights on surfaces. Off shows the others alone."),
    TYNDALL_BOOL(VplSettings, fromMedia, "gi.vpl.fromMedia", "Lights in media", true,
                 "Gathers virtual lights in media. Off shows the others alone."),
    TYNDALL_BOOL(
        VplSettings, keep, "gi.vpl.keep", "Keep walks", true,
        "Keeps walks and maps while nothing changes. Off makes them again in each frame, for timing."),
    TYNDALL_BOOL(
        VplSettings, incremental, "gi.vpl.incremental", "Keep walks in moving media", false,
        "Keeps walks and maps while only media change a little, and updates the power of the lights. Faster, but noisier in uneven media."),
    TYNDALL_ENUM(
        VplSettings, show, "gi.vpl.show", "Show", kShowNames, 0,
        "Draws virtual lights (green on surfaces, red in media), the visibility map of one light, all maps, or the light removed by clamping alone (lost)."),
    TYNDALL_INT(VplSettings, showLight, "gi.vpl.showLight", "Light shown", "", 0, 1000000, 0,
                "Number of the virtual light whose visibility map is shown."),
};

constexpr PresetEntry kVplPresets[] = {
    {Quality::Low, "gi.vpl.samples", "8"},
    {Quality::Medium, "gi.vpl.samples", "16"},
    {Quality::High, "gi.vpl.samples", "24"},
    {Quality::Ultra, "gi.vpl.samples", "32"},
    {Quality::Low, "gi.vpl.nearPaths", "1"},
    {Quality::Medium, "gi.vpl.nearPaths", "1"},
    {Quality::High, "gi.vpl.nearPaths", "4"},
    {Quality::Ultra, "gi.vpl.nearPaths", "16"},
    {Quality::Low, "gi.vpl.surfaces.resolution", "quarter"},
    {Quality::Medium, "gi.vpl.surfaces.resolution", "half"},
    {Quality::High, "gi.vpl.surfaces.resolution", "half"},
    {Quality::Ultra, "gi.vpl.surfaces.resolution", "full"},
    {Quality::Low, "gi.vpl.depthSide", "16"},
    {Quality::Medium, "gi.vpl.depthSide", "16"},
    {Quality::High, "gi.vpl.depthSide", "16"},
    {Quality::Ultra, "gi.vpl.depthSide", "32"},
    {Quality::Low, "gi.vpl.walks", "64"},
    {Quality::Low, "gi.vpl.candidates", "1"},
    {Quality::Low, "gi.vpl.classes", "16"},
    {Quality::Low, "gi.vpl.mapSide", "16"},
    {Quality::Low, "gi.vpl.march", "quarter"},
    {Quality::Medium, "gi.vpl.walks", "128"},
    {Quality::Medium, "gi.vpl.candidates", "1"},
    {Quality::Medium, "gi.vpl.classes", "8"},
    {Quality::Medium, "gi.vpl.mapSide", "24"},
    {Quality::Medium, "gi.vpl.march", "half"},
    {Quality::High, "gi.vpl.walks", "512"},
    {Quality::High, "gi.vpl.candidates", "16"},
    {Quality::High, "gi.vpl.classes", "8"},
    {Quality::High, "gi.vpl.mapSide", "32"},
    {Quality::High, "gi.vpl.march", "half"},
    {Quality::Ultra, "gi.vpl.walks", "512"},
    {Quality::Ultra, "gi.vpl.candidates", "16"},
    {Quality::Ultra, "gi.vpl.classes", "4"},
    {Quality::Ultra, "gi.vpl.mapSide", "64"},
    {Quality::Ultra, "gi.vpl.march", "full"},
};

} // namespace

std::span<const SettingDesc> vplSettings() { return kVplSettings; }
std::span<const PresetEntry> vplPresets() { return kVplPresets; }

} // namespace tyndall::volumetric_gi
