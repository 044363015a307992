#pragma once
// An OpenGL 4.5 core context, with or without a display. Made by factory functions that say why when they cannot.
//
// The functions of gl/api.h are one set for the process and belong to the context that was made current last, so one
// kind of context is current at a time, on one thread.

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "gl/capabilities.h"
#include "gl/debug.h"
#include "gl/object.h"

namespace tyndall::gl {

/// What a user asks for: `--backend auto|egl|osmesa`.
enum class Backend : int32_t { Auto = 0, Egl = 1, Osmesa = 2 };
/// "auto", "egl", "osmesa".
const char* backendOptionName(Backend backend);
/// Errors: not one of the three names.
Result<Backend> parseBackend(std::string_view name);

enum class DebugMode : int32_t {
    Off = 0,
    Asynchronous = 1, // messages arrive when the driver likes, from any of its threads
    Synchronous = 2,  // messages arrive inside the call that caused them
};
#if defined(NDEBUG) && !defined(TYNDALL_ASSERTS)
inline constexpr DebugMode kDefaultDebugMode = DebugMode::Asynchronous;
#else
inline constexpr DebugMode kDefaultDebugMode = DebugMode::Synchronous;
#endif

struct ContextOptions {
    Backend backend = Backend::Auto;
    int device = -1; // of eglDevices(); -1: the first hardware device, else none
    DebugMode debug = kDefaultDebugMode;
    /// Extensions to behave as if absent, beside those in the environment variable TYNDALL_GL_DISABLE
    /// (comma-separated).
    std::vector<std::string> disabledExtensions{};
};

/// The window system's part of a context. Destruction destroys the native context, which is not current then.
class ContextPlatform {
public:
    virtual ~ContextPlatform() = default;
    /// "egl-device", "egl-surfaceless", "osmesa" or "glfw".
    [[nodiscard]] virtual const char* name() const = 0;
    [[nodiscard]] virtual Result<void> makeCurrent() = 0;
    virtual void releaseCurrent() = 0;
    [[nodiscard]] virtual void* getProcAddress(const char* function) = 0;
};

/// One GL context. Empty when moved from. Objects made in it must go before it does: those that are left are logged as
/// leaks.
class Context {
public:
    /// The context that the options ask for. Auto: EGL on a hardware device, then EGL surfaceless, then OSMesa.
    /// Errors: none could be made, with what each said.
    static Result<Context> create(const ContextOptions& options = {});
    /// EGL on device `index` of eglDevices() (EGL_EXT_platform_device).
    static Result<Context> createEglDevice(int index, const ContextOptions& options = {});
    /// Mesa's EGL without a surface: software, or what Mesa chooses.
    static Result<Context> createEglSurfaceless(const ContextOptions& options = {});
    /// Mesa's off-screen library, loaded at run time.
    static Result<Context> createOsmesa(const ContextOptions& options = {});
    /// Takes over a native context of another window system and makes it current.
    /// Errors: it is no OpenGL 4.5 core context, or cannot be made current.
    static Result<Context> adopt(std::unique_ptr<ContextPlatform> platform,
                                 const ContextOptions& options);

    Context() noexcept;
    Context(Context&&) noexcept;
    Context& operator=(Context&&) noexcept;
    ~Context();

    explicit operator bool() const { return state_ != nullptr; }
    /// Makes the context current on this thread and, if another was current last, loads its functions. A factory has
    /// done so already.
    void makeCurrent();
    /// Leaves this thread without a context if this one is current.
    void release();
    [[nodiscard]] bool isCurrent() const;

    /// "egl-device", "egl-surfaceless", "osmesa" or "glfw".
    [[nodiscard]] std::string_view backendName() const;
    /// One sentence: which back end it is, and why those before it were not to be had.
    [[nodiscard]] const std::string& choice() const;
    [[nodiscard]] const Capabilities& capabilities() const;
    [[nodiscard]] DebugLog& debugLog();
    [[nodiscard]] const LiveObjects& liveObjects() const;

    struct State; // stays where it is when the context moves
private:
    explicit Context(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

/// A device that EGL lists.
struct EglDevice {
    int index = 0;
    bool software = false;
    std::string description; // "/dev/dri/card0", "CUDA device 0", "software"
};
/// Errors: no libEGL, or it cannot list devices.
Result<std::vector<EglDevice>> eglDevices();

/// The current context's capabilities, for wrappers. CHECKs that a context is current on this thread.
const Capabilities& currentCapabilities();
/// True when this thread has a context.
bool hasCurrentContext();

} // namespace tyndall::gl
