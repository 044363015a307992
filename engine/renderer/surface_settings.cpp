#include "renderer/surface_settings.h"

#include <algorithm>

namespace tyndall {
namespace {

// clang-format off
const SettingDesc kGBuffer[] = {
    TYNDALL_FLOAT(GBufferSettings, textureLodBias, "gbuffer.textureLodBias", "Texture detail bias", "levels", -4, 4, 0,
                  "Added to the mip level of material textures: lower is sharper and may alias, higher is smoother. Averaged frames always use the finest level."),
    TYNDALL_FLOAT(GBufferSettings, anisotropy, "gbuffer.anisotropy", "Anisotropic filter", "x", 1, 16, 2,
                  "Largest ratio of length to width of the area that a texture lookup averages on slanted surfaces. Higher is sharper and slower; 1 is off."),
};

const SettingDesc kSurfaceLight[] = {
    TYNDALL_INT(SurfaceLightSettings, rectSamples, "lights.rectSamples", "Rect light samples", "", 1, 64, 4,
                "Points of a rect light for its reflection and for the media before it; its diffuse light is exact without them. More are smoother and slower."),
    TYNDALL_INT(SurfaceLightSettings, environmentSamples, "environment.specularSamples", "Environment reflection samples", "", 0, 64, 8,
                "Directions in which a smooth surface samples the environment. More are less noisy and slower; 0 removes reflections of the environment."),
    TYNDALL_FLOAT(SurfaceLightSettings, mapRoughness, "environment.mapRoughness", "Map reflections below", "", 0, 1, 0.5,
                  "Up to this roughness reflections come from the environment map, with estimated shadows. Raise it for less noise and less exact shadows."),
    TYNDALL_FLOAT(SurfaceLightSettings, lightsRoughness, "environment.lightsRoughness", "Light reflections above", "", 0, 1, 0.8,
                  "From this roughness on reflections come from the environment's shadowed lights; in between both are blended. Lower it for exact shadows; few lights then show as spots."),
    TYNDALL_FLOAT(SurfaceLightSettings, convergeMapRoughness, "environment.convergeMapRoughness", "Map reflections below, averaged", "", 0, 1, 0.2,
                  "environment.mapRoughness for averaged frames, which sample many more lights in all."),
    TYNDALL_FLOAT(SurfaceLightSettings, convergeLightsRoughness, "environment.convergeLightsRoughness", "Light reflections above, averaged", "", 0, 1, 0.35,
                  "environment.lightsRoughness for averaged frames, which sample many more lights in all."),
    TYNDALL_BOOL(SurfaceLightSettings, materialOcclusion, "environment.materialOcclusion", "Occlusion textures", true,
                 "Whether occlusion textures darken the light of the environment, as glTF defines it for ambient light."),
};

const PresetEntry kPresets[] = {
    {Quality::Low, "gbuffer.anisotropy", "1"},          {Quality::Medium, "gbuffer.anisotropy", "2"},
    {Quality::High, "gbuffer.anisotropy", "4"},         {Quality::Ultra, "gbuffer.anisotropy", "16"},
    {Quality::Low, "lights.rectSamples", "1"},          {Quality::Medium, "lights.rectSamples", "4"},
    {Quality::High, "lights.rectSamples", "4"},         {Quality::Ultra, "lights.rectSamples", "16"},
    {Quality::Low, "environment.specularSamples", "4"}, {Quality::Medium, "environment.specularSamples", "8"},
    {Quality::High, "environment.specularSamples", "8"}, {Quality::Ultra, "environment.specularSamples", "32"},
};
// clang-format on

} // namespace

std::span<const SettingDesc> gbufferSettings() { return kGBuffer; }
std::span<const SettingDesc> surfaceLightSettings() { return kSurfaceLight; }
std::span<const PresetEntry> surfacePresets() { return kPresets; }

gpu::SurfaceLightParams surfaceLightParams(const SurfaceLightSettings& settings, bool converge) {
    gpu::SurfaceLightParams params{};
    params.rectSamples = uint32_t(settings.rectSamples);
    params.environmentSamples = uint32_t(settings.environmentSamples);
    params.roughnessOfMap = converge ? settings.convergeMapRoughness : settings.mapRoughness;
    // smoothstep needs two different ends.
    params.roughnessOfLights =
        std::max(converge ? settings.convergeLightsRoughness : settings.lightsRoughness,
                 params.roughnessOfMap + 1e-3f);
    params.materialOcclusion = settings.materialOcclusion ? 1u : 0u;
    return params;
}

} // namespace tyndall
