#include "volumetric_gi/surfels/surfels_settings.h"

namespace tyndall::volumetric_gi {
namespace {

constexpr const char* kSurfelizerNames[] = {"tessellator", "compute"};
constexpr const char* kIntervalNames[] = {"8", "16", "32"};
constexpr const char* kPairsNames[] = {"hierarchy", "all"};
constexpr const char* kRaysNames[] = {"none", "one", "every"};
constexpr const char* kMarchNames[] = {"full", "half", "quarter", "eighth"};
constexpr const char* kShowNames[] = {"nothing", "surfels", "levels", "unshuffled", "intervals"};

const SettingDesc kSurfelsSettings[] = {
    TYNDALL_FLOAT(
        SurfelsSettings, size, "gi.surfels.size", "Surfel size", "pixels", 0.5f, 256.0f, 10.0f,
        "Edge of the square that a surfel stands for, as large as this in the picture. Smaller surfels resolve light near surfaces better and cost time with their number."),
    TYNDALL_INT(
        SurfelsSettings, most, "gi.surfels.most", "Most surfels", "", 64, 1048576, 65536,
        "Surfels grow where there would be more than this. More cost time and memory in proportion."),
    TYNDALL_FLOAT(
        SurfelsSettings, far, "gi.surfels.far", "Size far from media", "", 0.0f, 1.0f, 0.03f,
        "A surfel is at least as large as this times its distance from the media. Higher has fewer surfels far from media of limited extent; 0 has no such limit."),
    TYNDALL_ENUM(
        SurfelsSettings, surfelizer, "gi.surfels.surfelizer", "Made by", kSurfelizerNames, 0,
        "Makes surfels by the GPU's tessellator, or by a compute shader for drivers without storage buffers in tessellation. The surfels are the same."),
    TYNDALL_ENUM(
        SurfelsSettings, intervals, "gi.surfels.intervals", "Intervals per ray", kIntervalNames, 1,
        "Intervals of an eye ray that receive light. More resolve light along the ray better; time and memory grow in proportion."),
    TYNDALL_BOOL(
        SurfelsSettings, jitter, "gi.surfels.jitter", "Jitter", true,
        "Moves the points of intervals from ray to ray, which turns bands into fine noise."),
    TYNDALL_INT(
        SurfelsSettings, levels, "gi.surfels.levels", "Levels", "", 1, 6, 6,
        "Levels of the interleaved framebuffer: on each, four times fewer surfels stand for all, farther away. More are faster and need more blur."),
    TYNDALL_FLOAT(
        SurfelsSettings, threshold, "gi.surfels.epsilon", "Error threshold", "", 0.0001f, 10.0f,
        0.06f,
        "A surfel counts at the finest level where its light in the media is more than this part of the average. Lower is less noisy and slower, in inverse proportion."),
    TYNDALL_ENUM(
        SurfelsSettings, pairs, "gi.surfels.pairs", "Pairs", kPairsNames, 0,
        "Pairs of surfels and intervals: those that the hierarchy chooses, or all of them, which is slow and has no sampling noise."),
    TYNDALL_ENUM(
        SurfelsSettings, rays, "gi.surfels.rays", "Rays per pair", kRaysNames, 1,
        "What lies between a surfel and a ray's intervals: not asked but for media without a grid, asked for one interval that stands for all, or for every one, which is slow."),
    TYNDALL_BOOL(
        SurfelsSettings, attenuation, "gi.surfels.attenuation", "Attenuation", true,
        "Media take light away between surfels and intervals. Off is brighter inside dense media, as in the paper, and faster in grids."),
    TYNDALL_BOOL(
        SurfelsSettings, visibility, "gi.surfels.visibility", "Visibility", true,
        "Surfaces block light between surfels and intervals. Off is faster and lets light through walls, as in the paper."),
    TYNDALL_BOOL(
        SurfelsSettings, blur, "gi.surfels.blur", "Blur", true,
        "Averages coarse levels over neighbouring rays that see media alike. Off shows the noise of the hierarchy; averaged frames do not blur."),
    TYNDALL_ENUM(
        SurfelsSettings, march, "gi.surfels.march", "March resolution", kMarchNames, 1,
        "One ray through media for each pixel, or for a square of 2, 4 or 8 pixels a side. Fewer are faster and blur outlines."),
    TYNDALL_ENUM(
        SurfelsSettings, show, "gi.surfels.show", "Show", kShowNames, 0,
        "Draws surfels as disks, the levels of the framebuffer as they are or unshuffled, or four depths of intervals."),
};

constexpr PresetEntry kSurfelsPresets[] = {
    {Quality::Low, "gi.surfels.size", "16"},
    {Quality::Low, "gi.surfels.most", "16384"},
    {Quality::Low, "gi.surfels.intervals", "8"},
    {Quality::Low, "gi.surfels.epsilon", "0.12"},
    {Quality::Low, "gi.surfels.march", "quarter"},
    {Quality::Medium, "gi.surfels.size", "10"},
    {Quality::Medium, "gi.surfels.most", "65536"},
    {Quality::Medium, "gi.surfels.intervals", "16"},
    {Quality::Medium, "gi.surfels.epsilon", "0.06"},
    {Quality::Medium, "gi.surfels.march", "half"},
    {Quality::High, "gi.surfels.size", "6"},
    {Quality::High, "gi.surfels.most", "131072"},
    {Quality::High, "gi.surfels.intervals", "16"},
    {Quality::High, "gi.surfels.epsilon", "0.03"},
    {Quality::High, "gi.surfels.march", "half"},
    {Quality::Ultra, "gi.surfels.size", "4"},
    {Quality::Ultra, "gi.surfels.most", "262144"},
    {Quality::Ultra, "gi.surfels.intervals", "32"},
    {Quality::Ultra, "gi.surfels.epsilon", "0.015"},
    {Quality::Ultra, "gi.surfels.march", "full"},
};

} // namespace

std::span<const SettingDesc> surfelsSettings() { return kSurfelsSettings; }
std::span<const PresetEntry> surfelsPresets() { return kSurfelsPresets; }

} // namespace tyndall::volumetric_gi
