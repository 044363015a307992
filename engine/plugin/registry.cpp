#include "plugin/registry.h"

#include <algorithm>
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
        for (uint32_t group = 0; group < loaded.instance->settingsGroupCount(); ++group) {
            const SettingDesc* fields = nullptr;
            uint32_t count = 0;
            void* values = nullptr;
            loaded.instance->settingsGroup(group, &fields, &count, &values);
            settings.add({{fields, count}, values});
        }
        const PresetEntry* entries = nullptr;
        uint32_t entryCount = 0;
        loaded.instance->presets(&entries, &entryCount);
        settings.addPreset({entries, entryCount});
        const PluginInfo& info = loaded.instance->info();
        for (uint32_t t = 0; t < info.techniqueCount; ++t) {
            const TechniqueInfo& technique = info.techniques[t];
            techniques_.push_back({{technique.name, technique.title, technique.help, info.name,
                                    technique.claims, technique.automatic != 0},
                                   i,
                                   t});
        }
        ++i;
    }
    return failures;
}

} // namespace tyndall::plugin
