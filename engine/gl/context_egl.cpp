// Contexts without a window by EGL: on a device, or on Mesa's surfaceless platform. libEGL is loaded at run time, so
// that a machine without it gets a sentence instead of a loader error.

#include <dlfcn.h>
#include <fmt/format.h>

#define EGL_NO_X11
#define MESA_EGL_NO_X11_HEADERS
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <cstdlib>
#include <map>
#include <mutex>
#include <string>

#include "gl/context_state.h"

namespace tyndall::gl {
namespace {

/// The functions of libEGL that are used.
struct EglLibrary {
    decltype(&::eglGetProcAddress) getProcAddress = nullptr;
    decltype(&::eglQueryString) queryString = nullptr;
    decltype(&::eglInitialize) initialize = nullptr;
    decltype(&::eglTerminate) terminate = nullptr;
    decltype(&::eglBindAPI) bindApi = nullptr;
    decltype(&::eglChooseConfig) chooseConfig = nullptr;
    decltype(&::eglCreateContext) createContext = nullptr;
    decltype(&::eglDestroyContext) destroyContext = nullptr;
    decltype(&::eglMakeCurrent) makeCurrent = nullptr;
    decltype(&::eglGetError) getError = nullptr;
    PFNEGLGETPLATFORMDISPLAYEXTPROC getPlatformDisplay = nullptr;
    PFNEGLQUERYDEVICESEXTPROC queryDevices = nullptr;           // null: devices cannot be listed
    PFNEGLQUERYDEVICESTRINGEXTPROC queryDeviceString = nullptr; // null: likewise
    std::string clientExtensions;
    std::string failure; // a sentence when the library cannot be used
};

template <typename Function>
void findSymbol(void* library, const char* name, Function& function, std::string& failure) {
    function = reinterpret_cast<Function>(dlsym(library, name));
    if (function == nullptr && failure.empty()) failure = fmt::format("libEGL.so.1 lacks {}", name);
}

bool listed(std::string_view extensions, std::string_view name) {
    for (size_t at = extensions.find(name); at != std::string_view::npos;
         at = extensions.find(name, at + 1)) {
        const size_t end = at + name.size();
        if ((at == 0 || extensions[at - 1] == ' ') &&
            (end == extensions.size() || extensions[end] == ' '))
            return true;
    }
    return false;
}

EglLibrary openEgl() {
    EglLibrary egl;
    // Mesa prints what it tried on the way to a driver; what matters is in the sentences returned here. A user's own
    // level stays.
    setenv("EGL_LOG_LEVEL", "fatal", 0);
    void* library = dlopen(
        "libEGL.so.1",
        RTLD_NOW | RTLD_LOCAL); // never closed: drivers leave thread-local destructors behind
    if (library == nullptr) {
        egl.failure = "libEGL.so.1 is not installed";
        return egl;
    }
    findSymbol(library, "eglGetProcAddress", egl.getProcAddress, egl.failure);
    findSymbol(library, "eglQueryString", egl.queryString, egl.failure);
    findSymbol(library, "eglInitialize", egl.initialize, egl.failure);
    findSymbol(library, "eglTerminate", egl.terminate, egl.failure);
    findSymbol(library, "eglBindAPI", egl.bindApi, egl.failure);
    findSymbol(library, "eglChooseConfig", egl.chooseConfig, egl.failure);
    findSymbol(library, "eglCreateContext", egl.createContext, egl.failure);
    findSymbol(library, "eglDestroyContext", egl.destroyContext, egl.failure);
    findSymbol(library, "eglMakeCurrent", egl.makeCurrent, egl.failure);
    findSymbol(library, "eglGetError", egl.getError, egl.failure);
    if (!egl.failure.empty()) return egl;

    const char* extensions = egl.queryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    egl.clientExtensions = extensions ? extensions : "";
    if (listed(egl.clientExtensions, "EGL_EXT_platform_base"))
        egl.getPlatformDisplay = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(
            egl.getProcAddress("eglGetPlatformDisplayEXT"));
    if (egl.getPlatformDisplay == nullptr) egl.failure = "libEGL lacks EGL_EXT_platform_base";
    if (listed(egl.clientExtensions, "EGL_EXT_device_enumeration") ||
        listed(egl.clientExtensions, "EGL_EXT_device_base")) {
        egl.queryDevices =
            reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(egl.getProcAddress("eglQueryDevicesEXT"));
        egl.queryDeviceString = reinterpret_cast<PFNEGLQUERYDEVICESTRINGEXTPROC>(
            egl.getProcAddress("eglQueryDeviceStringEXT"));
    }
    return egl;
}

const EglLibrary& eglLibrary() {
    static const EglLibrary library = openEgl();
    return library;
}

const char* eglErrorName(EGLint error) {
    switch (error) {
    case EGL_SUCCESS: return "no error code";
    case EGL_NOT_INITIALIZED: return "EGL_NOT_INITIALIZED";
    case EGL_BAD_ACCESS: return "EGL_BAD_ACCESS";
    case EGL_BAD_ALLOC: return "EGL_BAD_ALLOC";
    case EGL_BAD_ATTRIBUTE: return "EGL_BAD_ATTRIBUTE";
    case EGL_BAD_CONFIG: return "EGL_BAD_CONFIG";
    case EGL_BAD_CONTEXT: return "EGL_BAD_CONTEXT";
    case EGL_BAD_DISPLAY: return "EGL_BAD_DISPLAY";
    case EGL_BAD_MATCH: return "EGL_BAD_MATCH";
    case EGL_BAD_PARAMETER: return "EGL_BAD_PARAMETER";
    case EGL_CONTEXT_LOST: return "EGL_CONTEXT_LOST";
    default: return "an unknown error";
    }
}

/// An initialised display. Ending one ends it for the whole process, so contexts on it share it.
class Display {
public:
    explicit Display(EGLDisplay handle) : handle_(handle) {}
    ~Display() { eglLibrary().terminate(handle_); }
    Display(const Display&) = delete;
    Display& operator=(const Display&) = delete;
    [[nodiscard]] EGLDisplay handle() const { return handle_; }

private:
    EGLDisplay handle_;
};

Result<std::shared_ptr<Display>> openDisplay(EGLenum platform, void* native, const char* name) {
    static std::mutex mutex;
    static std::map<EGLDisplay, std::weak_ptr<Display>> open;
    const EglLibrary& egl = eglLibrary();
    const EGLDisplay handle = egl.getPlatformDisplay(platform, native, nullptr);
    if (handle == EGL_NO_DISPLAY)
        return Error{
            fmt::format("{}: EGL gives no display ({})", name, eglErrorName(egl.getError()))};
    std::lock_guard lock(mutex);
    if (std::shared_ptr<Display> display = open[handle].lock()) return display;
    EGLint major = 0, minor = 0;
    if (!egl.initialize(handle, &major, &minor))
        return Error{fmt::format("{}: EGL cannot start ({})", name, eglErrorName(egl.getError()))};
    auto display = std::make_shared<Display>(handle);
    open[handle] = display;
    return display;
}

class EglPlatform final : public ContextPlatform {
public:
    EglPlatform(const char* name, std::shared_ptr<Display> display, EGLContext context)
        : name_(name), display_(std::move(display)), context_(context) {}
    ~EglPlatform() override { eglLibrary().destroyContext(display_->handle(), context_); }

    [[nodiscard]] const char* name() const override { return name_; }
    [[nodiscard]] Result<void> makeCurrent() override {
        const EglLibrary& egl = eglLibrary();
        egl.bindApi(EGL_OPENGL_API);
        if (egl.makeCurrent(display_->handle(), EGL_NO_SURFACE, EGL_NO_SURFACE, context_))
            return {};
        return Error{fmt::format("{}: EGL cannot make the context current ({})", name_,
                                 eglErrorName(egl.getError()))};
    }
    void releaseCurrent() override {
        eglLibrary().makeCurrent(display_->handle(), EGL_NO_SURFACE, EGL_NO_SURFACE,
                                 EGL_NO_CONTEXT);
    }
    [[nodiscard]] void* getProcAddress(const char* function) override {
        return reinterpret_cast<void*>(eglLibrary().getProcAddress(function));
    }

private:
    const char* name_;
    std::shared_ptr<Display> display_;
    EGLContext context_;
};

/// Any configuration that OpenGL can use: nothing is drawn to a surface.
Result<EGLConfig> chooseConfig(const Display& display, std::string_view extensions,
                               const char* name) {
    if (listed(extensions, "EGL_KHR_no_config_context"))
        return EGLConfig(nullptr); // EGL_NO_CONFIG_KHR
    const EglLibrary& egl = eglLibrary();
    const EGLint attributes[] = {EGL_SURFACE_TYPE, EGL_DONT_CARE, EGL_RENDERABLE_TYPE,
                                 EGL_OPENGL_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (egl.chooseConfig(display.handle(), attributes, &config, 1, &count) && count > 0)
        return config;
    return Error{fmt::format("{}: EGL has no configuration for OpenGL", name)};
}

Result<std::unique_ptr<ContextPlatform>> makePlatform(std::shared_ptr<Display> display,
                                                      const char* name, DebugMode debug) {
    const EglLibrary& egl = eglLibrary();
    const char* text = egl.queryString(display->handle(), EGL_EXTENSIONS);
    const std::string extensions = text ? text : "";
    if (!listed(extensions, "EGL_KHR_surfaceless_context"))
        return Error{fmt::format(
            "{}: EGL lacks EGL_KHR_surfaceless_context, so there is no context without a surface",
            name)};
    if (!egl.bindApi(EGL_OPENGL_API))
        return Error{fmt::format("{}: this EGL has OpenGL ES only, and OpenGL is needed", name)};
    const Result<EGLConfig> config = chooseConfig(*display, extensions, name);
    if (!config) return config.error();
    const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                 4,
                                 EGL_CONTEXT_MINOR_VERSION,
                                 5,
                                 EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                 EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                 EGL_CONTEXT_OPENGL_DEBUG,
                                 debug == DebugMode::Off ? EGL_FALSE : EGL_TRUE,
                                 EGL_NONE};
    const EGLContext context =
        egl.createContext(display->handle(), *config, EGL_NO_CONTEXT, attributes);
    if (context == EGL_NO_CONTEXT)
        return Error{fmt::format("{}: the driver refuses an OpenGL 4.5 core context ({})", name,
                                 eglErrorName(egl.getError()))};
    return std::unique_ptr<ContextPlatform>(
        std::make_unique<EglPlatform>(name, std::move(display), context));
}

Result<std::vector<EGLDeviceEXT>> deviceHandles() {
    const EglLibrary& egl = eglLibrary();
    if (!egl.failure.empty()) return Error{egl.failure};
    if (egl.queryDevices == nullptr || egl.queryDeviceString == nullptr)
        return Error{"libEGL cannot list devices (EGL_EXT_device_enumeration)"};
    EGLint count = 0;
    if (!egl.queryDevices(0, nullptr, &count))
        return Error{fmt::format("libEGL cannot list devices ({})", eglErrorName(egl.getError()))};
    std::vector<EGLDeviceEXT> handles{size_t(count)};
    if (count > 0 && !egl.queryDevices(count, handles.data(), &count))
        return Error{fmt::format("libEGL cannot list devices ({})", eglErrorName(egl.getError()))};
    handles.resize(size_t(count));
    return handles;
}

} // namespace

Result<std::vector<EglDevice>> eglDevices() {
    const EglLibrary& egl = eglLibrary();
    const Result<std::vector<EGLDeviceEXT>> handles = deviceHandles();
    if (!handles) return handles.error();
    std::vector<EglDevice> devices;
    for (EGLDeviceEXT handle : *handles) {
        EglDevice device;
        device.index = int(devices.size());
        const char* text = egl.queryDeviceString(handle, EGL_EXTENSIONS);
        const std::string_view extensions = text ? text : "";
        device.software = listed(extensions, "EGL_MESA_device_software");
        const char* file = listed(extensions, "EGL_EXT_device_drm")
                               ? egl.queryDeviceString(handle, EGL_DRM_DEVICE_FILE_EXT)
                               : nullptr;
        device.description = device.software ? "software"
                             : file          ? file
                                             : fmt::format("EGL device {}", device.index);
        devices.push_back(std::move(device));
    }
    return devices;
}

Result<std::unique_ptr<ContextPlatform>> makeEglDevicePlatform(int index, DebugMode debug) {
    const Result<std::vector<EGLDeviceEXT>> handles = deviceHandles();
    if (!handles) return handles.error();
    if (index < 0 || size_t(index) >= handles->size())
        return Error{fmt::format("device {} does not exist: EGL lists {} device{}, counted from 0",
                                 index, handles->size(), handles->size() == 1 ? "" : "s")};
    if (!listed(eglLibrary().clientExtensions, "EGL_EXT_platform_device"))
        return Error{"libEGL lacks EGL_EXT_platform_device"};
    Result<std::shared_ptr<Display>> display =
        openDisplay(EGL_PLATFORM_DEVICE_EXT, (*handles)[size_t(index)], "egl-device");
    if (!display) return display.error();
    return makePlatform(std::move(*display), "egl-device", debug);
}

Result<std::unique_ptr<ContextPlatform>> makeEglSurfacelessPlatform(DebugMode debug) {
    const EglLibrary& egl = eglLibrary();
    if (!egl.failure.empty()) return Error{egl.failure};
    if (!listed(egl.clientExtensions, "EGL_MESA_platform_surfaceless"))
        return Error{"libEGL lacks EGL_MESA_platform_surfaceless"};
    Result<std::shared_ptr<Display>> display =
        openDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, "egl-surfaceless");
    if (!display) return display.error();
    return makePlatform(std::move(*display), "egl-surfaceless", debug);
}

} // namespace tyndall::gl
