#pragma once
// The plugins linked into this program. The definition is generated (cmake/plugin.cmake): programs link
// Tyndall::builtin_plugins and hand the list to the renderer; there are no global constructors.

#include <span>

#include "plugin/plugin_api.h"

namespace tyndall::plugin {

std::span<const EntryPoint> builtinPlugins();

} // namespace tyndall::plugin
