#include "volumetric_gi/vpl/vpl_settings.h"

namespace tyndall::volumetric_gi {
namespace {

constexpr const char* kCompensationNames[] = {"clamped", "closed", "traced"};
constexpr const char* kMarchNames[] = {"full", "half", "quarter", "eighth"};

constexpr const char* kMapsNames[] = {"rays", "points"};
constexpr const char* kShowNames[] = {"nothing", "lights", "map", "atlas", "lost"};

const SettingDesc kVplSettings[] = {
    TYNDALL_INT(
        VplSettings, walks, "gi.vpl.walks", "Walks", "", 1, 65536, 512,
        "Random walks from the lights; each leaves a virtual light wherever it is scattered."),
    TYNDALL_INT(
        VplSettings, candidates, "gi.vpl.candidates", "Walks to choose from", "", 1, 64, 16,
        "So many times as many walks are traced, and of their virtual lights one in so many is kept: such as matter to the picture. 1: all are, whatever the picture shows."),
    TYNDALL_INT(
        VplSettings, renewed, "gi.vpl.renewed", "Walks renewed a frame", "", 0, 65536, 0,
        "After a change of lights or media so many walks are traced anew in each frame, in turn, and light lags behind until all are; of candidates there is no choice then. 0: all at once."),
    TYNDALL_INT(
        VplSettings, classes, "gi.vpl.classes", "Classes", "", 1, 1024, 8,
        "A point along a ray through media gathers one in so many walks; the points before and behind it gather others."),
    TYNDALL_INT(VplSettings, surfaceClasses, "gi.vpl.surfaceClasses", "Classes on surfaces", "", 1,
                1024, 1, "A surface gathers one in so many walks, its neighbours others; 1: all."),
    TYNDALL_ENUM(
        VplSettings, maps, "gi.vpl.maps", "Visibility maps from", kMapsNames, 0,
        "What virtual lights see: by rays on the processor, or by points of surfaces that the graphics processor splats."),
    TYNDALL_INT(VplSettings, points, "gi.vpl.points", "Points of a map", "", 64, 65536, 4096,
                "Points of surfaces that are splatted into a virtual light's map."),
    TYNDALL_INT(VplSettings, mapSide, "gi.vpl.mapSide", "Visibility map", "texels", 0, 512, 64,
                "Side of a virtual light's map of what it sees; 0: nothing hides it."),
    TYNDALL_INT(
        VplSettings, depthSide, "gi.vpl.depthSide", "Map of optical depth", "texels", 0, 64, 16,
        "Side of a virtual light's map of the grids' optical depth around it; 0: grids are marched for each light and point."),
    TYNDALL_INT(VplSettings, samples, "gi.vpl.samples", "Points of a ray", "", 1, 1024, 24,
                "Points along a ray through media at which virtual lights are gathered."),
    TYNDALL_ENUM(
        VplSettings, compensation, "gi.vpl.compensation", "Compensation", kCompensationNames, 2,
        "What the bound takes away: missing, made up for as if light were even, or gathered from a point near by."),
    TYNDALL_INT(
        VplSettings, nearPaths, "gi.vpl.nearPaths", "Paths for what is missed", "", 0, 1024, 1,
        "In averaged frames, with traced compensation: paths on the processor for each square of surfaces and each ray, which bring what the bound takes away and the traced step does not make up for; 0: it is missing."),
    TYNDALL_ENUM(
        VplSettings, march, "gi.vpl.march", "March resolution", kMarchNames, 1,
        "Rays along which media show virtual lights: for every pixel, or for squares of 2, 4 or 8 pixels a side."),
    TYNDALL_ENUM(
        VplSettings, surfaces, "gi.vpl.surfaces.resolution", "Surface resolution", kMarchNames, 1,
        "Surfaces that gather virtual lights: of every pixel, or of one pixel of squares of 2, 4 or 8 pixels a side."),
    TYNDALL_FLOAT(
        VplSettings, clamp, "gi.vpl.clamp", "Bound", "", 0.0f, 100.0f, 1.0f,
        "Distance below which a virtual light counts as this far, over the mean distance between virtual lights."),
    TYNDALL_FLOAT(
        VplSettings, surfaceClamp, "gi.vpl.surfaceClamp", "Bound between surfaces", "", 0.0f,
        100.0f, 0.5f,
        "The same for light from surface to surface and, where it is less, from surfaces to media: in one frame nothing makes up for it."),
    TYNDALL_FLOAT(
        VplSettings, relaxed, "gi.vpl.relaxed", "Relaxed bound", "", 1.0f, 1000.0f, 2.0f,
        "Traced compensation gathers with a bound at so many times less distance; at more in averaged frames, as they come."),
    TYNDALL_FLOAT(
        VplSettings, roughness, "gi.vpl.roughness", "Least roughness", "", 0.0f, 1.0f, 0.4f,
        "Smoother surfaces reflect virtual lights as if they were this rough: else each light is a spot. Less in averaged frames, as they come."),
    TYNDALL_BOOL(VplSettings, fromSurfaces, "gi.vpl.fromSurfaces", "On surfaces", true,
                 "Virtual lights on surfaces."),
    TYNDALL_BOOL(VplSettings, fromMedia, "gi.vpl.fromMedia", "In media", true,
                 "Virtual lights in media."),
    TYNDALL_BOOL(
        VplSettings, keep, "gi.vpl.keep", "Keep walks", true,
        "Walks and maps are kept while nothing has changed; off: made anew each frame, to be timed."),
    TYNDALL_BOOL(
        VplSettings, incremental, "gi.vpl.incremental", "Keep walks while media change", false,
        "Walks and maps stay while nothing but media changes a little: only what walks carry is told anew. Noisier where media are uneven."),
    TYNDALL_ENUM(
        VplSettings, show, "gi.vpl.show", "Show", kShowNames, 0,
        "In the picture the virtual lights, green on surfaces and red in media, or the map of what one of them or all of them see; or nothing but the light that the bound takes away."),
    TYNDALL_INT(VplSettings, showLight, "gi.vpl.showLight", "Light shown", "", 0, 1000000, 0,
                "Number of the virtual light whose map is shown."),
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
