#pragma once
// What a Context owns; for the sources of this folder.

#include <memory>
#include <string>

#include "gl/context.h"

namespace tyndall::gl {

struct Context::State {
    std::unique_ptr<ContextPlatform> platform;
    uint64_t serial = 0; // of the process, from 1
    std::string choice;
    Capabilities capabilities;
    DebugLog debugLog;
    LiveObjects live;
};

/// The context that is current on this thread, or null.
Context::State* currentState();

/// True while the context with this serial number lives, current or not.
bool contextExists(uint64_t serial);

/// The native contexts that exist: each returns a platform whose context is not yet current.
Result<std::unique_ptr<ContextPlatform>> makeEglDevicePlatform(int index, DebugMode debug);
Result<std::unique_ptr<ContextPlatform>> makeEglSurfacelessPlatform(DebugMode debug);
Result<std::unique_ptr<ContextPlatform>> makeOsmesaPlatform();

} // namespace tyndall::gl
