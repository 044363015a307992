#include "renderer/light_settings.h"

namespace tyndall {
namespace {

// clang-format off
const SettingDesc kLights[] = {
    TYNDALL_FLOAT(LightSettings, cutoff, "lights.cutoff", "Light cutoff", "", 0, 0.1, 0,
                  "With many lights, each counts only as far as all that is dropped together stays below this part of what they all give across the scene; 0 drops nothing."),
    TYNDALL_INT(LightSettings, clusterMinimum, "lights.clusterMinimum", "Lights before lists", "lights", 0, 100000, 16,
                "Up to so many lights, every light is looked at everywhere; above, each cluster of the view has a list."),
    TYNDALL_INT(LightSettings, clusterColumns, "lights.clusterColumns", "Cluster columns", "", 1, 64, 16, "Clusters across the view."),
    TYNDALL_INT(LightSettings, clusterRows, "lights.clusterRows", "Cluster rows", "", 1, 64, 9, "Clusters from the bottom of the view to its top."),
    TYNDALL_INT(LightSettings, clusterSlices, "lights.clusterSlices", "Cluster slices", "", 1, 64, 24, "Clusters along the distance from the camera."),
    TYNDALL_INT(LightSettings, clusterCapacity, "lights.clusterCapacity", "Lights per cluster", "lights", 1, 1024, 128,
                "Longest list; a cluster that more lights reach looks at every light."),
    TYNDALL_INT(LightSettings, environmentLights, "environment.lights", "Environment lights", "lights", 0, 256, 16,
                "Directional lights, with shadows, that stand for the environment's light; 0 leaves surfaces and media unlit by it."),
    TYNDALL_INT(LightSettings, mediumLights, "lights.media", "Lights of a glowing medium", "lights", 0, 64, 4,
                "Lights, with shadows, that stand for the light of each glowing medium (a fire); 0: it is seen, but lights nothing."),
};

const SettingDesc kShadows[] = {
    TYNDALL_BOOL(ShadowSettings, enabled, "shadows.enabled", "Shadows", true, "Whether surfaces cast shadows."),
    TYNDALL_INT(ShadowSettings, maxLights, "shadows.maxLights", "Lights with shadows", "lights", 0, 256, 16,
                "So many lights of the scene cast shadows: those that matter most to the view. Environment lights come on top."),
    TYNDALL_INT(ShadowSettings, resolution, "shadows.resolution", "Shadow map size", "px", 16, 8192, 2048,
                "Side of a directional light's cascade and of a spot light's map; rounded down to a power of two."),
    TYNDALL_INT(ShadowSettings, localResolution, "shadows.localResolution", "Point shadow size", "px", 16, 8192, 1024,
                "Side of each of the six maps of a point, wide spot or rect light; rounded down to a power of two."),
    TYNDALL_INT(ShadowSettings, environmentResolution, "shadows.environmentResolution", "Environment shadow size", "px", 16, 8192, 1024,
                "Side of an environment light's map; rounded down to a power of two."),
    TYNDALL_INT(ShadowSettings, cascades, "shadows.cascades", "Cascades", "", 1, 8, 4,
                "Maps of a directional light: the last covers the whole scene, those before it the nearer parts of the view."),
    TYNDALL_FLOAT(ShadowSettings, cascadeSplit, "shadows.cascadeSplit", "Cascade split", "", 0, 1, 0.8,
                  "How cascades share the distance: 0 evenly, 1 in equal ratios, which gives the foreground more."),
    TYNDALL_INT(ShadowSettings, atlasSize, "shadows.atlasSize", "Atlas size", "px", 64, 8192, 4096,
                "Side of a layer of the shadow atlas; rounded down to a power of two."),
    TYNDALL_INT(ShadowSettings, atlasLayers, "shadows.atlasLayers", "Atlas layers", "", 1, 64, 4,
                "Layers of the shadow atlas (each 64 MiB at 4096 px); maps shrink when they do not fit."),
    TYNDALL_INT(ShadowSettings, taps, "shadows.taps", "Filter taps", "", 1, 64, 4, "Lookups that soften the edge of a shadow on a surface."),
    TYNDALL_INT(ShadowSettings, searchTaps, "shadows.searchTaps", "Search taps", "", 0, 64, 12,
                "Lookups that find how far away the caster of a soft shadow is; 0 makes all shadows hard."),
};

const PresetEntry kPresets[] = {
    {Quality::Low, "lights.cutoff", "0.01"},            {Quality::Medium, "lights.cutoff", "0.003"},
    {Quality::High, "lights.cutoff", "0.001"},          {Quality::Ultra, "lights.cutoff", "0"},
    {Quality::Low, "environment.lights", "4"},          {Quality::Medium, "environment.lights", "8"},
    {Quality::High, "environment.lights", "16"},        {Quality::Ultra, "environment.lights", "64"},
    {Quality::Low, "lights.media", "1"},                {Quality::Medium, "lights.media", "2"},
    {Quality::High, "lights.media", "4"},               {Quality::Ultra, "lights.media", "8"},
    {Quality::Low, "shadows.maxLights", "4"},           {Quality::Medium, "shadows.maxLights", "8"},
    {Quality::High, "shadows.maxLights", "16"},         {Quality::Ultra, "shadows.maxLights", "64"},
    {Quality::Low, "shadows.resolution", "1024"},       {Quality::Medium, "shadows.resolution", "2048"},
    {Quality::High, "shadows.resolution", "2048"},      {Quality::Ultra, "shadows.resolution", "4096"},
    {Quality::Low, "shadows.localResolution", "256"},   {Quality::Medium, "shadows.localResolution", "512"},
    {Quality::High, "shadows.localResolution", "1024"}, {Quality::Ultra, "shadows.localResolution", "2048"},
    {Quality::Low, "shadows.environmentResolution", "256"},  {Quality::Medium, "shadows.environmentResolution", "512"},
    {Quality::High, "shadows.environmentResolution", "1024"}, {Quality::Ultra, "shadows.environmentResolution", "2048"},
    {Quality::Low, "shadows.cascades", "2"},            {Quality::Medium, "shadows.cascades", "3"},
    {Quality::High, "shadows.cascades", "4"},           {Quality::Ultra, "shadows.cascades", "4"},
    {Quality::Low, "shadows.atlasSize", "2048"},        {Quality::Medium, "shadows.atlasSize", "4096"},
    {Quality::High, "shadows.atlasSize", "4096"},       {Quality::Ultra, "shadows.atlasSize", "8192"},
    {Quality::Low, "shadows.taps", "1"},                {Quality::Medium, "shadows.taps", "4"},
    {Quality::High, "shadows.taps", "4"},               {Quality::Ultra, "shadows.taps", "16"},
    {Quality::Low, "shadows.searchTaps", "6"},          {Quality::Medium, "shadows.searchTaps", "12"},
    {Quality::High, "shadows.searchTaps", "12"},        {Quality::Ultra, "shadows.searchTaps", "32"},
};
// clang-format on

} // namespace

std::span<const SettingDesc> lightSettingsTable() { return kLights; }
std::span<const SettingDesc> shadowSettingsTable() { return kShadows; }
std::span<const PresetEntry> lightPresets() { return kPresets; }

} // namespace tyndall
