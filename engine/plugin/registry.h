#pragma once
// Plugins of one renderer: built-in ones from a list that CMake makes, shared libraries by path. A plugin that does not fit
// is refused with a message; one whose set-up fails is left out, and the renderer goes on without it.

#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "plugin/plugin_api.h"
#include "transport/plan.h"

namespace tyndall::plugin {

/// A technique of the registry, and the plugin that computes it.
struct RegisteredTechnique {
    tyndall::Technique description;
    Technique* technique;
};

class PluginRegistry {
public:
    PluginRegistry() = default;
    ~PluginRegistry();
    PluginRegistry(const PluginRegistry&) = delete;
    PluginRegistry& operator=(const PluginRegistry&) = delete;

    /// Adds built-in plugins. CHECKs that their descriptors fit: they were compiled with this program.
    void addBuiltins(std::span<const EntryPoint> entryPoints);
    /// Loads a shared library; a plugin of the same name that is there already is replaced.
    /// Errors: no such file, no entry point, another ABI version, other headers or sizes, an incomplete description.
    Result<void> load(const std::filesystem::path& file);

    /// Sets every plugin up with `host` and registers its settings. One that fails is dropped; the messages are returned.
    std::vector<std::string> setup(Host& host, SettingsRegistry& settings);

    [[nodiscard]] size_t count() const { return plugins_.size(); }
    [[nodiscard]] Plugin& plugin(size_t index) { return *plugins_[index].instance; }
    [[nodiscard]] const std::string& origin(size_t index) const { return plugins_[index].origin; }
    [[nodiscard]] std::span<const RegisteredTechnique> techniques() const { return techniques_; }

private:
    struct Loaded {
        Plugin* instance = nullptr;
        void* library = nullptr; // dlopen handle; null for a built-in one
        std::string name;
        std::string origin; // "built in" or the file
    };
    static void unload(Loaded& loaded);
    static void addSettings(const SettingsTable& table, SettingsRegistry& settings);
    void addTechniques(Plugin& plugin, SettingsRegistry& settings);
    Result<void> adopt(const PluginDescriptor* descriptor, void* library,
                       const std::string& origin);

    std::vector<Loaded> plugins_;
    std::vector<RegisteredTechnique> techniques_;
};

} // namespace tyndall::plugin
