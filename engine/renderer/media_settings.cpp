#include "renderer/media_settings.h"

namespace tyndall {
namespace {

constexpr const char* kIntegrationNames[] = {"auto", "steps", "exact"};
constexpr const char* kLightDepthNames[] = {"auto", "volume", "exact"};
constexpr const char* kResolutionNames[] = {"full", "half", "quarter"};

// clang-format off
const SettingDesc kMedia[] = {
    TYNDALL_BOOL(MediaSettings, enabled, "media.enabled", "Media", true, "Whether fog, smoke and other media are there at all."),
    TYNDALL_BOOL(MediaSettings, dropUnseen, "media.dropUnseen", "Drop unseen media", true,
                 "Leaves out media that are neither in view nor on the way from a light to anything in view; the picture stays the same."),
    TYNDALL_ENUM(MediaSettings, integration, "media.integration", "Integration of grids", kIntegrationNames, MediaIntegration::Auto,
                 "Grids by steps of media.march.stepScale, or exactly, cell by cell; auto is exact in averaged frames."),
    TYNDALL_FLOAT(MediaSettings, stepScale, "media.march.stepScale", "Step through grids", "voxels", 0.05, 16, 1, "Length of a step through a grid."),
    TYNDALL_INT(MediaSettings, steps, "media.march.steps", "Steps through fog", "", 1, 4096, 32,
                "Points at which light is gathered along a ray through one homogeneous medium or height fog; their extinction is exact anyway."),
    TYNDALL_INT(MediaSettings, environmentLights, "media.march.environmentLights", "Environment lights a step", "lights", 1, 256, 4,
                "Of the environment's lights, so many are gathered at each step along a ray, others at the next."),
    TYNDALL_ENUM(MediaSettings, resolution, "media.march.resolution", "March resolution", kResolutionNames, MarchResolution::Full,
                 "Rays marched for every pixel, every 2x2 or every 4x4 pixels; transmittance is computed for every pixel in any case."),
    TYNDALL_BOOL(MediaSettings, refine, "media.march.refine", "March misfits again", true,
                 "At a reduced resolution, pixels that no neighbouring ray fits are marched on their own."),
    TYNDALL_FLOAT(MediaSettings, depthTolerance, "media.march.depthTolerance", "Depth tolerance", "", 0.0001, 10, 0.05,
                  "At a reduced resolution, the relative difference of distance at which a neighbouring ray counts half."),
    TYNDALL_FLOAT(MediaSettings, transmittanceTolerance, "media.march.transmittanceTolerance", "Transmittance tolerance", "", 0.0001, 10, 0.05,
                  "At a reduced resolution, the difference of transmittance at which a neighbouring ray counts half."),
    TYNDALL_FLOAT(MediaSettings, refineWeight, "media.march.refineWeight", "Misfit limit", "", 0, 1, 0.25,
                  "At a reduced resolution, pixels whose best neighbouring ray counts less than this are misfits."),
    TYNDALL_FLOAT(MediaSettings, minTransmittance, "media.march.minTransmittance", "End of the march", "", 0, 0.1, 0.0001,
                  "A ray gathers no more light where less than this part of it gets through to the eye."),
    TYNDALL_ENUM(MediaSettings, lightOpticalDepth, "media.lightOpticalDepth", "Shadows of grids", kLightDepthNames, LightOpticalDepth::Auto,
                 "Optical depth of grids towards lights from a light-space volume, or marched for each point; auto marches in averaged frames."),
    TYNDALL_INT(MediaSettings, opticalDepthResolution, "media.opticalDepth.resolution", "Light volume", "texels", 4, 512, 64,
                "Edge of a light's volume of optical depth."),
    TYNDALL_INT(MediaSettings, opticalDepthLights, "media.opticalDepth.lights", "Lights with volumes", "lights", 0, 512, 64,
                "So many lights have a volume of optical depth; the grids are marched for the others."),
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
