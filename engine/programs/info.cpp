// `tyndall info`: what this machine can do, which settings there are, or what is in a file.

#include <cstdio>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/info_file.h"
#include "app/program.h"
#include "gl/context.h"
#include "plugin/builtin_plugins.h"
#include "programs/commands.h"
#include "programs/console_job.h"
#include "renderer/renderer.h"

namespace tyndall {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  tyndall info                  versions, back ends that work here, limits of the driver\n"
    "  tyndall info --settings       every setting that --set takes, and what the presets set\n"
    "  tyndall info smoke.vdb        what is in a file, what is supported, what is ignored";

struct InfoOptions {
    std::string file;
    bool settings = false;
};

Outcome print(const std::string& text) {
    const bool whole =
        std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
    return whole ? Outcome{} : failed("cannot write to standard output");
}

std::string driverLine(const std::string& name, const Result<gl::Context>& context) {
    if (!context.ok()) return fmt::format("  {}: not here: {}\n", name, context.message());
    const gl::Capabilities& c = context->capabilities();
    return fmt::format("  {}: works: {}, {}, OpenGL {}\n", name, c.vendor, c.renderer, c.version);
}

std::string backendLines() {
    std::string text = "Back ends:\n";
    const Result<std::vector<gl::EglDevice>> devices = gl::eglDevices();
    if (!devices.ok())
        text += "  egl devices: not here: " + devices.message() + "\n";
    else
        for (const gl::EglDevice& device : *devices)
            text += driverLine(fmt::format("egl device {} ({})", device.index, device.description),
                               gl::Context::createEglDevice(device.index));
    text += driverLine("egl surfaceless", gl::Context::createEglSurfaceless());
    text += driverLine("osmesa", gl::Context::createOsmesa());
    return text;
}

std::string limitLines(const gl::Context& context) {
    const gl::Limits& limits = context.capabilities().limits;
    std::string text = fmt::format("Chosen: {}\nLimits:\n", context.choice());
    text += fmt::format("  textures: {} px, 3D {} px, {} layers\n", limits.textureSize,
                        limits.texture3DSize, limits.textureLayers);
    text += fmt::format("  storage buffers: {} bindings, {} in a compute shader, {} MiB a block\n",
                        limits.storageBufferBindings, limits.computeStorageBlocks,
                        limits.storageBlockBytes >> 20);
    text += fmt::format("  compute: {} invocations and {} KiB of shared memory a group\n",
                        limits.computeInvocations, limits.computeSharedBytes >> 10);
    text += fmt::format("  timestamps: {} bits\n", limits.timestampBits);
    return text;
}

std::string typeText(const SettingDesc& field) {
    switch (field.type) {
    case SettingType::Bool: return "true or false";
    case SettingType::Enum: {
        std::string names;
        for (uint32_t i = 0; i < field.enumCount; ++i)
            names += (i ? ", " : "") + std::string(field.enumNames[i]);
        return "one of " + names;
    }
    case SettingType::Int:
        return fmt::format("whole number, {} to {}", int64_t(field.minimum),
                           int64_t(field.maximum));
    case SettingType::Float:
        return fmt::format("number, {:g} to {:g}", field.minimum, field.maximum);
    case SettingType::Text: return "text";
    }
    return {};
}

std::string settingLines(const SettingsRegistry& registry) {
    std::string text = "Settings, as --set KEY=VALUE takes them:\n";
    for (const SettingsGroup& group : registry.groups())
        for (const SettingDesc& field : group.fields)
            text += fmt::format("{}\n    {}: {}\n    {}{}{}; default {}\n", field.key, field.name,
                                field.help, typeText(field), *field.unit ? " " : "", field.unit,
                                settingDefaultText(field));
    for (int quality = 0; quality < 4; ++quality) {
        text += fmt::format("--quality {}:\n", qualityName(Quality(quality)));
        for (const PresetEntry& entry : registry.presets())
            if (entry.quality == Quality(quality))
                text += fmt::format("    {}={}\n", entry.key, entry.value);
    }
    return text;
}

std::string techniqueLines(const Renderer& renderer) {
    std::string text =
        "Techniques, as --gi takes them:\n  auto: the best technique for the scene\n  none: direct light alone\n";
    for (const Technique& technique : renderer.techniques())
        text += fmt::format("  {}: {} ({}, computes {})\n", technique.name, technique.help,
                            technique.plugin, termNames(technique.claims));
    return text;
}

Outcome runInfo(const InfoOptions& options) {
    if (!options.file.empty()) {
        ConsoleJob job(ProgressStyle::Quiet);
        const Result<std::string> text = describeFile(options.file, job.control());
        return text.ok() ? print(*text) : wrongInput(text.message());
    }
    std::string text =
        fmt::format("tyndall {}, compiled with GCC {}\n", programVersion(), __VERSION__);
    if (!options.settings) text += backendLines();
    Result<gl::Context> context = gl::Context::create();
    if (!context.ok()) {
        const Outcome printed = print(options.settings ? "" : text);
        return printed.ok() ? failed(context.message()) : printed;
    }
    RendererOptions rendererOptions;
    rendererOptions.builtinPlugins = plugin::builtinPlugins();
    Result<std::unique_ptr<Renderer>> renderer = Renderer::create(*context, rendererOptions);
    if (!renderer.ok()) return failed(renderer.message());
    return print(options.settings ? settingLines((*renderer)->settings())
                                  : text + limitLines(*context) + techniqueLines(**renderer));
}

} // namespace

void addInfoCommand(CLI::App& program, Run& run) {
    auto options = std::make_shared<InfoOptions>();
    CLI::App* command = program.add_subcommand(
        "info", "Print what this machine supports, all settings, or what is in a file");
    command->add_option("FILE", options->file,
                        "A scene file, .gltf, .glb, .vdb, .nvdb, .exr or .hdr");
    command->add_flag("--settings", options->settings,
                      "List every setting with its range, and the presets");
    command->footer(kExamples);
    command->callback(
        [options, &run] { run = [options](const GlobalOptions&) { return runInfo(*options); }; });
}

} // namespace tyndall
