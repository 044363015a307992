#include "renderer/surface_settings.h"

#include <algorithm>

namespace tyndall {
namespace {

// clang-format off
const SettingDesc kGBuffer[] = {
    TYNDALL_FLOAT(GBufferSettings, textureLodBias, "gbuffer.textureLodBias", "Texture detail bias", "levels", -4, 4, 0,
                  "Added to the mip level of material textures: negative is sharper. Averaged frames always use the finest level."),
    TYNDALL_FLOAT(GBufferSettings, anisotropy, "gbuffer.anisotropy", "Anisotropic filter", "x", 1, 16, 4,
                  "How many times longer than wide the area is that a texture lookup averages on slanted surfaces; 1 is off."),
};

const SettingDesc kSurfaceLight[] = {
    TYNDALL_INT(SurfaceLightSettings, rectSamples, "lights.rectSamples", "Rect light samples", "", 1, 64, 4,
                "Points of a rect light that its reflection and the media before it are computed from; its diffuse light is exact without."),
    TYNDALL_INT(SurfaceLightSettings, environmentSamples, "environment.specularSamples", "Environment reflections", "", 0, 64, 8,
                "Directions in which a smooth surface looks up the environment; 0 leaves it without reflections of the environment."),
    TYNDALL_FLOAT(SurfaceLightSettings, mapRoughness, "environment.mapRoughness", "Roughness of the map", "", 0, 1, 0.5,
                  "Up to this roughness the environment's reflection comes from its map, with its shadows estimated."),
    TYNDALL_FLOAT(SurfaceLightSettings, lightsRoughness, "environment.lightsRoughness", "Roughness of the lights", "", 0, 1, 0.8,
                  "From this roughness on the environment's reflection comes from its shadowed lights; in between both share."),
    TYNDALL_FLOAT(SurfaceLightSettings, convergeMapRoughness, "environment.convergeMapRoughness", "Roughness of the map, averaged", "", 0, 1, 0.2,
                  "The same for frames that are averaged, where many more lights are seen in all."),
    TYNDALL_FLOAT(SurfaceLightSettings, convergeLightsRoughness, "environment.convergeLightsRoughness", "Roughness of the lights, averaged", "", 0, 1, 0.35,
                  "The same for frames that are averaged, where many more lights are seen in all."),
    TYNDALL_BOOL(SurfaceLightSettings, materialOcclusion, "environment.materialOcclusion", "Occlusion textures", true,
                 "Whether occlusion textures darken the environment's light, as glTF has it for light from all around."),
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
