#include "renderer/media_settings.h"

namespace tyndall {
namespace {

constexpr const char* kIntegrationNames[] = {"auto", "steps", "exact"};
constexpr const char* kLightDepthNames[] = {"auto", "volume", "exact"};
constexpr const char* kResolutionNames[] = {"full", "half", "quarter"};

// clang-format off
const SettingDesc kMedia[] = {
    TYNDALL_BOOL(MediaSettings, enabled, "media.enabled", "Media", true, "Whether fog, smoke and other media are rendered."),
    TYNDALL_BOOL(MediaSettings, dropUnseen, "media.dropUnseen", "Cull media", true,
                 "Leaves out media that are neither in view nor between a light and anything in view. The picture stays the same; on is faster."),
    TYNDALL_ENUM(MediaSettings, integration, "media.integration", "Integration of grids", kIntegrationNames, MediaIntegration::Auto,
                 "Integrates grids in steps of media.march.stepScale (steps), or cell by cell without error (exact, slower); auto is exact in averaged frames."),
    TYNDALL_FLOAT(MediaSettings, stepScale, "media.march.stepScale", "Step in grids", "voxels", 0.05, 16, 1.5, "Length of a step through a grid. Longer steps are faster and miss detail."),
    TYNDALL_INT(MediaSettings, steps, "media.march.steps", "Steps in fog", "", 1, 4096, 24,
                "Points at which light is gathered along a ray through a uniform medium or height fog. More resolve shafts of light better and cost time; extinction is exact in any case."),
    TYNDALL_INT(MediaSettings, environmentLights, "media.march.environmentLights", "Environment lights per step", "lights", 1, 256, 4,
                "Environment lights gathered at each step of a ray; the next step gathers others. More are less noisy and cost time."),
    TYNDALL_ENUM(MediaSettings, resolution, "media.march.resolution", "March resolution", kResolutionNames, MarchResolution::Half,
                 "One ray for each pixel, each 2x2 or each 4x4 pixels. Fewer are faster and blur the outlines of light in media; transmittance is computed for every pixel."),
    TYNDALL_BOOL(MediaSettings, smooth, "media.march.smooth", "Smooth", true,
                 "In a single frame, averages the light of each ray with that of the rays around it. Off is sharper and shows where along its ray each gathers light, as a pattern of dots."),
    TYNDALL_BOOL(MediaSettings, refine, "media.march.refine", "Refine misfits", true,
                 "At a reduced resolution, marches pixels on their own where no neighbouring ray fits. Sharper outlines for some more rays."),
    TYNDALL_FLOAT(MediaSettings, depthTolerance, "media.march.depthTolerance", "Depth tolerance", "", 0.0001, 10, 0.05,
                  "At a reduced resolution, the relative difference of distance at which a neighbouring ray has half weight. Raise it for fewer refined pixels and softer outlines."),
    TYNDALL_FLOAT(MediaSettings, transmittanceTolerance, "media.march.transmittanceTolerance", "Transmittance tolerance", "", 0.0001, 10, 0.05,
                  "At a reduced resolution, the difference of transmittance at which a neighbouring ray has half weight. Raise it for fewer refined pixels and softer outlines."),
    TYNDALL_FLOAT(MediaSettings, refineWeight, "media.march.refineWeight", "Refinement threshold", "", 0, 1, 0.25,
                  "At a reduced resolution, pixels whose best neighbouring ray has less weight than this are marched on their own. Raise it for more accuracy and time."),
    TYNDALL_FLOAT(MediaSettings, minTransmittance, "media.march.minTransmittance", "March cutoff", "", 0, 0.1, 0.001,
                  "A ray gathers no more light once its transmittance is below this. Raise it for speed in dense media; light behind is lost."),
    TYNDALL_ENUM(MediaSettings, lightOpticalDepth, "media.lightOpticalDepth", "Shadows of grids", kLightDepthNames, LightOpticalDepth::Auto,
                 "Optical depth of grids towards lights from a light-space volume (fast, blurred), or marched for each point (exact, slow); auto is exact in averaged frames."),
    TYNDALL_INT(MediaSettings, opticalDepthResolution, "media.opticalDepth.resolution", "Light volume size", "texels", 4, 512, 48,
                "Side of a light's volume of optical depth. Larger volumes have sharper shadows in smoke and cost memory with the cube."),
    TYNDALL_INT(MediaSettings, opticalDepthLights, "media.opticalDepth.lights", "Lights with volumes", "lights", 0, 512, 32,
                "Lights that have a volume of optical depth; for the others grids are marched, which is slower. More cost memory."),
};

const PresetEntry kPresets[] = {
    {Quality::Low, "media.march.stepScale", "2"},              {Quality::Medium, "media.march.stepScale", "1.5"},
    {Quality::High, "media.march.stepScale", "1"},             {Quality::Ultra, "media.march.stepScale", "0.5"},
    {Quality::Low, "media.march.steps", "12"},                 {Quality::Medium, "media.march.steps", "24"},
    {Quality::High, "media.march.steps", "32"},                {Quality::Ultra, "media.march.steps", "96"},
    {Quality::Low, "media.march.environmentLights", "2"},      {Quality::Medium, "media.march.environmentLights", "4"},
    {Quality::High, "media.march.environmentLights", "4"},     {Quality::Ultra, "media.march.environmentLights", "16"},
    {Quality::Low, "media.march.resolution", "quarter"},       {Quality::Medium, "media.march.resolution", "half"},
    {Quality::High, "media.march.resolution", "full"},         {Quality::Ultra, "media.march.resolution", "full"},
    {Quality::Low, "media.march.minTransmittance", "0.005"},   {Quality::Medium, "media.march.minTransmittance", "0.001"},
    {Quality::High, "media.march.minTransmittance", "0.0001"}, {Quality::Ultra, "media.march.minTransmittance", "0.00001"},
    {Quality::Low, "media.opticalDepth.resolution", "32"},     {Quality::Medium, "media.opticalDepth.resolution", "48"},
    {Quality::High, "media.opticalDepth.resolution", "64"},    {Quality::Ultra, "media.opticalDepth.resolution", "128"},
    {Quality::Low, "media.opticalDepth.lights", "16"},         {Quality::Medium, "media.opticalDepth.lights", "32"},
    {Quality::High, "media.opticalDepth.lights", "64"},        {Quality::Ultra, "media.opticalDepth.lights", "128"},
};
// clang-format on

} // namespace

std::span<const SettingDesc> mediaSettingsTable() { return kMedia; }
std::span<const PresetEntry> mediaPresets() { return kPresets; }

} // namespace tyndall
