#include "gl/context.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <mutex>
#include <utility>

#include "core/log.h"
#include "gl/api.h"
#include "gl/context_state.h"

namespace tyndall::gl {
namespace {

thread_local Context::State* gCurrent = nullptr;

/// The contexts of the process: which exist, and whose functions gl/api.h holds. Process-wide because glad's pointers
/// are.
struct Registry {
    std::mutex mutex;
    uint64_t lastSerial = 0;
    uint64_t functionsOf = 0; // serial; 0: of none
    std::vector<uint64_t> existing;
};
Registry& registry() {
    static Registry instance;
    return instance;
}

GLADapiproc loadFunction(void* platform, const char* name) {
    return reinterpret_cast<GLADapiproc>(
        static_cast<ContextPlatform*>(platform)->getProcAddress(name));
}

/// Points gl/api.h at the functions of the context that is current. Errors: fewer functions than OpenGL 4.5.
Result<void> loadFunctions(Context::State& state) {
    std::lock_guard lock(registry().mutex);
    if (registry().functionsOf == state.serial) return {};
    registry().functionsOf = 0;
    const int version = gladLoadGLUserPtr(loadFunction, state.platform.get());
    if (version < GLAD_MAKE_VERSION(4, 5)) {
        if (version == 0)
            return Error{
                fmt::format("{}: the context has no OpenGL functions", state.platform->name())};
        return Error{fmt::format("{}: the context has OpenGL {}.{}, and 4.5 is needed",
                                 state.platform->name(), GLAD_VERSION_MAJOR(version),
                                 GLAD_VERSION_MINOR(version))};
    }
    registry().functionsOf = state.serial;
    return {};
}

std::set<std::string, std::less<>> disabledExtensions(const ContextOptions& options) {
    std::set<std::string, std::less<>> names(options.disabledExtensions.begin(),
                                             options.disabledExtensions.end());
    const char* listed = std::getenv("TYNDALL_GL_DISABLE");
    std::string name;
    for (const char* c = listed ? listed : ""; *c != '\0'; ++c) {
        if (*c != ',' && *c != ' ') {
            name += *c;
            continue;
        }
        if (!name.empty()) names.insert(std::exchange(name, {}));
    }
    if (!name.empty()) names.insert(name);
    return names;
}

/// State that no pass ever changes.
void setConventions() {
    glClipControl(GL_LOWER_LEFT,
                  GL_ZERO_TO_ONE); // reversed depth needs all the precision of floats near 0
    glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
}

/// The back ends that `auto` tries, in order, as factories.
struct Candidate {
    const char* name;
    Result<Context> (*make)(const ContextOptions& options);
};

Result<Context> makeOnHardware(const ContextOptions& options) {
    const Result<std::vector<EglDevice>> devices = eglDevices();
    if (!devices) return devices.error();
    std::string failures;
    for (const EglDevice& device : *devices) {
        if (device.software) continue;
        Result<Context> context = Context::createEglDevice(device.index, options);
        if (context) return context;
        failures += (failures.empty() ? "" : "; ") + context.message();
    }
    if (failures.empty()) failures = "EGL lists no hardware device";
    return Error{failures};
}

Result<Context> tryInOrder(std::span<const Candidate> candidates, const ContextOptions& options,
                           std::string& failures) {
    for (const Candidate& candidate : candidates) {
        Result<Context> context = candidate.make(options);
        if (context) return context;
        failures += fmt::format("{}{} ({})", failures.empty() ? "" : ", ", candidate.name,
                                context.message());
    }
    return Error{fmt::format("no OpenGL 4.5 context could be made: {}", failures)};
}

} // namespace

const char* backendOptionName(Backend backend) {
    static constexpr const char* kNames[] = {"auto", "egl", "osmesa"};
    return kNames[size_t(backend)];
}

Result<Backend> parseBackend(std::string_view name) {
    for (Backend backend : {Backend::Auto, Backend::Egl, Backend::Osmesa})
        if (name == backendOptionName(backend)) return backend;
    return Error{fmt::format("back end '{}' is unknown: it is auto, egl or osmesa", name)};
}

Context::State* currentState() { return gCurrent; }

bool contextExists(uint64_t serial) {
    std::lock_guard lock(registry().mutex);
    return std::ranges::find(registry().existing, serial) != registry().existing.end();
}

const Capabilities& currentCapabilities() {
    CHECK(gCurrent != nullptr, "no GL context is current on this thread");
    return gCurrent->capabilities;
}

bool hasCurrentContext() { return gCurrent != nullptr; }

Result<Context> Context::create(const ContextOptions& options) {
    if (options.device >= 0 && options.backend != Backend::Osmesa)
        return createEglDevice(options.device, options);
    static constexpr Candidate kAll[] = {{"egl-device", makeOnHardware},
                                         {"egl-surfaceless", createEglSurfaceless},
                                         {"osmesa", createOsmesa}};
    std::span<const Candidate> candidates = kAll;
    if (options.backend == Backend::Egl) candidates = candidates.first(2);
    if (options.backend == Backend::Osmesa) candidates = candidates.last(1);

    std::string failures;
    Result<Context> context = tryInOrder(candidates, options, failures);
    if (context && !failures.empty())
        context->state_->choice =
            fmt::format("rendering with {}; not available: {}",
                        context->backendName(), failures);
    return context;
}

Result<Context> Context::createEglDevice(int index, const ContextOptions& options) {
    Result<std::unique_ptr<ContextPlatform>> platform = makeEglDevicePlatform(index, options.debug);
    if (!platform) return platform.error();
    return adopt(std::move(*platform), options);
}

Result<Context> Context::createEglSurfaceless(const ContextOptions& options) {
    Result<std::unique_ptr<ContextPlatform>> platform = makeEglSurfacelessPlatform(options.debug);
    if (!platform) return platform.error();
    return adopt(std::move(*platform), options);
}

Result<Context> Context::createOsmesa(const ContextOptions& options) {
    Result<std::unique_ptr<ContextPlatform>> platform = makeOsmesaPlatform();
    if (!platform) return platform.error();
    return adopt(std::move(*platform), options);
}

Result<Context> Context::adopt(std::unique_ptr<ContextPlatform> platform,
                               const ContextOptions& options) {
    CHECK(platform != nullptr, "adopt() needs a platform");
    // Only one context is current: the one before gives way first.
    if (gCurrent != nullptr) {
        gCurrent->platform->releaseCurrent();
        gCurrent = nullptr;
    }
    auto state = std::make_unique<State>();
    state->platform = std::move(platform);
    if (Result<void> current = state->platform->makeCurrent(); !current) return current.error();
    {
        std::lock_guard lock(registry().mutex);
        state->serial = ++registry().lastSerial;
    }
    if (Result<void> loaded = loadFunctions(*state); !loaded) {
        state->platform->releaseCurrent();
        return loaded.error();
    }
    {
        std::lock_guard lock(registry().mutex);
        registry().existing.push_back(state->serial);
    }
    gCurrent = state.get();
    state->capabilities = Capabilities::query(disabledExtensions(options));
    state->choice = fmt::format("rendering with {}", state->platform->name());
    if (options.debug != DebugMode::Off)
        state->debugLog.install(state->capabilities.vendor + " " + state->capabilities.renderer,
                                options.debug == DebugMode::Synchronous);
    setConventions();
    return Context(std::move(state));
}

Context::Context(std::unique_ptr<State> state) : state_(std::move(state)) {}
Context::Context() noexcept = default;
Context::Context(Context&&) noexcept = default;

Context& Context::operator=(Context&& other) noexcept {
    if (this == &other) return *this;
    Context old(std::move(*this));
    state_ = std::move(other.state_);
    return *this;
}

Context::~Context() {
    if (!state_) return;
    if (state_->live.total() != 0)
        log::error(fmt::format("GL objects were left when their context ended: {}",
                               state_->live.describe()));
    if (gCurrent == state_.get()) {
        glDebugMessageCallback(nullptr, nullptr);
        gCurrent->platform->releaseCurrent();
        gCurrent = nullptr;
    }
    std::lock_guard lock(registry().mutex);
    std::erase(registry().existing, state_->serial);
    if (registry().functionsOf == state_->serial) registry().functionsOf = 0;
}

void Context::makeCurrent() {
    CHECK(state_ != nullptr, "an empty Context cannot be made current");
    if (gCurrent == state_.get()) return;
    if (gCurrent != nullptr) {
        gCurrent->platform->releaseCurrent();
        gCurrent = nullptr;
    }
    const Result<void> current = state_->platform->makeCurrent();
    CHECK(current.ok(), current.ok() ? "" : current.message());
    const Result<void> loaded = loadFunctions(*state_);
    CHECK(loaded.ok(), loaded.ok() ? "" : loaded.message());
    gCurrent = state_.get();
}

void Context::release() {
    if (!state_ || gCurrent != state_.get()) return;
    state_->platform->releaseCurrent();
    gCurrent = nullptr;
}

bool Context::isCurrent() const { return state_ && gCurrent == state_.get(); }

std::string_view Context::backendName() const {
    CHECK(state_ != nullptr, "the Context is empty");
    return state_->platform->name();
}
const std::string& Context::choice() const {
    CHECK(state_ != nullptr, "the Context is empty");
    return state_->choice;
}
const Capabilities& Context::capabilities() const {
    CHECK(state_ != nullptr, "the Context is empty");
    return state_->capabilities;
}
DebugLog& Context::debugLog() {
    CHECK(state_ != nullptr, "the Context is empty");
    return state_->debugLog;
}
const LiveObjects& Context::liveObjects() const {
    CHECK(state_ != nullptr, "the Context is empty");
    return state_->live;
}

} // namespace tyndall::gl
