#include "plugin/registry.h"

#include <algorithm>
#include <array>
#include <dlfcn.h>

namespace tyndall::plugin {
namespace {

Result<void> checkDescriptor(const PluginDescriptor* descriptor, const std::string& origin) {
    if (!descriptor)
        return Error{"plugin '" + origin +
                     "' returned no description: its entry point must return a PluginDescriptor"};
    if (descriptor->abiVersion != kAbiVersion)
        return Error{"plugin '" + origin + "' was built for plugin ABI " +
                     std::to_string(descriptor->abiVersion) + ", and this program has ABI " +
                     std::to_string(kAbiVersion) + ": build it again with this program's headers"};
    if (descriptor->structSize != sizeof(PluginDescriptor))
        return Error{"plugin '" + origin + "' has a description of " +
                     std::to_string(descriptor->structSize) + " bytes where " +
                     std::to_string(sizeof(PluginDescriptor)) +
                     " are expected: build it again with this program's headers"};
    if (descriptor->headers != kHeadersHash || !(descriptor->sizes == AbiSizes{}))
        return Error{"plugin '" + origin +
                     "' was built with other headers than this program, or so that they are laid out in another way: " 
                     "build it again with this program's headers"};
    if (!descriptor->name || !descriptor->create)
        return Error{"plugin '" + origin +
                     "' has an incomplete description: it lacks a name or a constructor"};
    return {};
}

} // namespace

PluginRegistry::~PluginRegistry() {
    for (Loaded& loaded : plugins_) unload(loaded);
}

void PluginRegistry::unload(Loaded& loaded) {
    if (loaded.instance) loaded.instance->destroy();
    if (loaded.library) dlclose(loaded.library);
    loaded = {};
}

Result<void> PluginRegistry::adopt(const PluginDescriptor* descriptor, void* library,
                                   const std::string& origin) {
    if (Result<void> fits = checkDescriptor(descriptor, origin); !fits) return fits;
    Plugin* instance = descriptor->create();
    if (!instance) return Error{"plugin '" + origin + "' could not be created"};
    Loaded loaded{instance, library, descriptor->name, origin};
    const auto same = std::find_if(plugins_.begin(), plugins_.end(),
                                   [&](const Loaded& p) { return p.name == loaded.name; });
    if (same == plugins_.end())
        plugins_.push_back(loaded);
    else {
        unload(*same);
        *same = loaded;
    }
    return {};
}

void PluginRegistry::addBuiltins(std::span<const EntryPoint> entryPoints) {
    for (EntryPoint entryPoint : entryPoints) {
        const Result<void> adopted = adopt(entryPoint(), nullptr, "built in");
        CHECK(adopted.ok(), adopted.ok() ? "" : adopted.message());
    }
}

Result<void> PluginRegistry::load(const std::filesystem::path& file) {
    std::error_code error;
    const std::filesystem::path absolute = std::filesystem::absolute(file, error);
    if (!std::filesystem::is_regular_file(absolute, error))
        return Error{"plugin '" + file.string() + "' does not exist"};
    void* library = dlopen(absolute.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library) return Error{"plugin '" + file.string() + "' cannot be loaded: " + dlerror()};
    const auto entryPoint = reinterpret_cast<EntryPoint>(dlsym(library, kEntryPointName));
    Result<void> adopted =
        entryPoint ? adopt(entryPoint(), library, file.string())
                   : Error{"'" + file.string() + "' is not a Tyndall plugin: it has no symbol '" +
                           kEntryPointName + "'"};
    if (!adopted) dlclose(library);
    return adopted;
}

void PluginRegistry::addSettings(const SettingsTable& table, SettingsRegistry& settings) {
    if (table.count > 0) settings.add({{table.fields, table.count}, table.values});
    if (table.presetCount > 0) settings.addPreset({table.presets, table.presetCount});
}

void PluginRegistry::addTechniques(Plugin& plugin, SettingsRegistry& settings) {
    for (uint32_t i = 0; i < plugin.techniqueCount(); ++i) {
        Technique& technique = *plugin.technique(i);
        addSettings(technique.settings(), settings);
        const TechniqueInfo& info = technique.info();
        techniques_.push_back({{info.name, info.title, info.help, plugin.info().name, info.claims,
                                info.automatic != 0,
                                std::vector<TermSet>(info.sets, info.sets + info.setCount),
                                info.media, info.separatesMedia != 0,
                                std::to_array(info.expected)},
                               &technique});
    }
}

std::vector<std::string> PluginRegistry::setup(Host& host, SettingsRegistry& settings) {
    std::vector<std::string> failures;
    for (size_t i = 0; i < plugins_.size();) {
        Loaded& loaded = plugins_[i];
        char message[512] = "it did not say why";
        if (!loaded.instance->setup(host, message, sizeof message)) {
            message[sizeof message - 1] = 0;
            failures.push_back("plugin '" + loaded.name + "' (" + loaded.origin +
                               ") could not be set up and is left out: " + message);
            unload(loaded);
            plugins_.erase(plugins_.begin() + std::ptrdiff_t(i));
            continue;
        }
        addSettings(loaded.instance->settings(), settings);
        addTechniques(*loaded.instance, settings);
        ++i;
    }
    return failures;
}

} // namespace tyndall::plugin
