#include "renderer/light_settings.h"

namespace tyndall {
namespace {

// clang-format off
const SettingDesc kLights[] = {
    TYNDALL_FLOAT(LightSettings, cutoff, "lights.cutoff", "Light cutoff", "", 0, 0.1, 0.003,
                  "With many lights, limits the reach of each; the light dropped in all stays below this part of the light across the scene. Raise it for speed; 0 drops none."),
    TYNDALL_INT(LightSettings, clusterMinimum, "lights.clusterMinimum", "Lights without clusters", "lights", 0, 100000, 16,
                "Up to this many lights every light is evaluated everywhere; above, each cluster of the view has a list. Raise it where lists cost more than they save."),
    TYNDALL_INT(LightSettings, clusterColumns, "lights.clusterColumns", "Cluster columns", "", 1, 64, 16, "Clusters across the view. More give shorter light lists and take more time and memory to build."),
    TYNDALL_INT(LightSettings, clusterRows, "lights.clusterRows", "Cluster rows", "", 1, 64, 9, "Clusters from the bottom of the view to its top. More give shorter light lists and take more time and memory to build."),
    TYNDALL_INT(LightSettings, clusterSlices, "lights.clusterSlices", "Cluster slices", "", 1, 64, 24, "Clusters along the distance from the camera. More give shorter light lists and take more time and memory to build."),
    TYNDALL_INT(LightSettings, clusterCapacity, "lights.clusterCapacity", "Lights per cluster", "lights", 1, 1024, 128,
                "Length of a cluster's light list; a cluster with more lights evaluates every light. Raise it for dense groups of lights; costs memory."),
    TYNDALL_INT(LightSettings, environmentLights, "environment.lights", "Environment lights", "lights", 0, 256, 24,
                "Directional lights with shadows that represent the environment. More are smoother and cost a shadow map each; 0 leaves surfaces and media unlit by it."),
    TYNDALL_INT(LightSettings, mediumLights, "lights.media", "Lights per emissive medium", "lights", 0, 64, 2,
                "Lights with shadows that represent the emission of each medium, such as a fire. More are smoother and cost shadow maps; 0: the medium is visible but lights nothing."),
};

const SettingDesc kShadows[] = {
    TYNDALL_BOOL(ShadowSettings, enabled, "shadows.enabled", "Shadows", true, "Whether surfaces cast shadows. Off saves the time of shadow maps."),
    TYNDALL_INT(ShadowSettings, maxLights, "shadows.maxLights", "Lights with shadows", "lights", 0, 256, 8,
                "Lights of the scene that cast shadows, the most important for the view first; environment lights are extra. More cost a shadow map each."),
    TYNDALL_INT(ShadowSettings, resolution, "shadows.resolution", "Shadow map size", "px", 16, 8192, 2048,
                "Side of a directional cascade and of a spot light's map, rounded down to a power of two. Larger maps have sharper shadows and cost memory and drawing time."),
    TYNDALL_INT(ShadowSettings, localResolution, "shadows.localResolution", "Point shadow size", "px", 16, 8192, 512,
                "Side of each of the six maps of a point, wide spot or rect light, rounded down to a power of two. Larger maps have sharper shadows and cost memory and drawing time."),
    TYNDALL_INT(ShadowSettings, environmentResolution, "shadows.environmentResolution", "Environment shadow size", "px", 16, 8192, 512,
                "Side of an environment light's map, rounded down to a power of two. Larger maps have sharper shadows and cost memory and drawing time."),
    TYNDALL_INT(ShadowSettings, cascades, "shadows.cascades", "Cascades", "", 1, 8, 3,
                "Shadow maps of a directional light: the last covers the whole scene, the others nearer parts of the view. More are sharper nearby and cost a map each."),
    TYNDALL_FLOAT(ShadowSettings, cascadeSplit, "shadows.cascadeSplit", "Cascade split", "", 0, 1, 0.8,
                  "How cascades divide the distance: 0 in equal lengths, 1 in equal ratios. Raise it for sharper shadows in the foreground; costs nothing."),
    TYNDALL_INT(ShadowSettings, atlasSize, "shadows.atlasSize", "Atlas size", "px", 64, 8192, 4096,
                "Side of a layer of the shadow atlas, rounded down to a power of two. A larger atlas holds more and larger maps and costs memory."),
    TYNDALL_INT(ShadowSettings, atlasLayers, "shadows.atlasLayers", "Atlas layers", "", 1, 64, 4,
                "Layers of the shadow atlas, each 64 MiB at 4096 px. With too few, shadow maps become smaller."),
    TYNDALL_INT(ShadowSettings, taps, "shadows.taps", "Filter taps", "", 1, 64, 4, "Shadow-map samples that filter the edge of a shadow; a quarter of them for each environment light. More are smoother and cost time for every light and pixel."),
    TYNDALL_INT(ShadowSettings, searchTaps, "shadows.searchTaps", "Search taps", "", 0, 64, 12,
                "Shadow-map samples that estimate the distance of the caster of a soft shadow. More are steadier and slower; 0 makes all shadows hard."),
};

const PresetEntry kPresets[] = {
    {Quality::Low, "lights.cutoff", "0.01"},            {Quality::Medium, "lights.cutoff", "0.003"},
    {Quality::High, "lights.cutoff", "0.001"},          {Quality::Ultra, "lights.cutoff", "0"},
    {Quality::Low, "environment.lights", "4"},          {Quality::Medium, "environment.lights", "24"},
    {Quality::High, "environment.lights", "32"},        {Quality::Ultra, "environment.lights", "64"},
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
