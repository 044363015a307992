// Contexts by Mesa's off-screen library, loaded at run time: newer Mesa no longer has it. Its interface is declared
// here, so that no header of it is needed either (values: Mesa's include/GL/osmesa.h, OSMesa 9 and later).

#include <dlfcn.h>
#include <fmt/format.h>

#include <array>
#include <mutex>
#include <string>
#include <vector>

#include "gl/api.h"
#include "gl/context_state.h"

namespace tyndall::gl {
namespace {

constexpr int kOsmesaFormat = 0x22;
constexpr int kOsmesaDepthBits = 0x30;
constexpr int kOsmesaStencilBits = 0x31;
constexpr int kOsmesaAccumBits = 0x32;
constexpr int kOsmesaProfile = 0x33;
constexpr int kOsmesaCoreProfile = 0x34;
constexpr int kOsmesaMajorVersion = 0x36;
constexpr int kOsmesaMinorVersion = 0x37;

using OsmesaContext = void*;

struct OsmesaLibrary {
    OsmesaContext (*createContextAttribs)(const int* attributes, OsmesaContext shared) = nullptr;
    void (*destroyContext)(OsmesaContext) = nullptr;
    unsigned char (*makeCurrent)(OsmesaContext, void* buffer, GLenum type, GLsizei width,
                                 GLsizei height) = nullptr;
    void* (*getProcAddress)(const char* name) = nullptr;
    std::string failure; // a sentence when the library cannot be used
};

template <typename Function>
void findSymbol(void* library, const char* name, Function& function, std::string& failure) {
    function = reinterpret_cast<Function>(dlsym(library, name));
    if (function == nullptr && failure.empty()) failure = fmt::format("libOSMesa lacks {}", name);
}

OsmesaLibrary openOsmesa() {
    OsmesaLibrary osmesa;
    void* library = nullptr; // never closed: the driver leaves thread-local destructors behind
    for (const char* name : {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"})
        if (library == nullptr) library = dlopen(name, RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) {
        osmesa.failure = "libOSMesa.so.8 is not installed";
        return osmesa;
    }
    findSymbol(library, "OSMesaCreateContextAttribs", osmesa.createContextAttribs, osmesa.failure);
    findSymbol(library, "OSMesaDestroyContext", osmesa.destroyContext, osmesa.failure);
    findSymbol(library, "OSMesaMakeCurrent", osmesa.makeCurrent, osmesa.failure);
    findSymbol(library, "OSMesaGetProcAddress", osmesa.getProcAddress, osmesa.failure);
    return osmesa;
}

const OsmesaLibrary& osmesaLibrary() {
    static const OsmesaLibrary library = openOsmesa();
    return library;
}

class OsmesaPlatform final : public ContextPlatform {
public:
    explicit OsmesaPlatform(OsmesaContext context) : context_(context) {}
    ~OsmesaPlatform() override { osmesaLibrary().destroyContext(context_); }

    [[nodiscard]] const char* name() const override { return "osmesa"; }
    [[nodiscard]] Result<void> makeCurrent() override {
        if (osmesaLibrary().makeCurrent(context_, pixels_.data(), GL_UNSIGNED_BYTE, kSize, kSize))
            return {};
        return Error{"osmesa: the context cannot be made current"};
    }
    void releaseCurrent() override { osmesaLibrary().makeCurrent(nullptr, nullptr, 0, 0, 0); }
    [[nodiscard]] void* getProcAddress(const char* function) override {
        return osmesaLibrary().getProcAddress(function);
    }

private:
    // OSMesa wants memory for its window; everything is drawn to framebuffer objects, so the smallest will do.
    static constexpr GLsizei kSize = 1;
    OsmesaContext context_;
    std::array<unsigned char, 4> pixels_{};
};

} // namespace

Result<std::unique_ptr<ContextPlatform>> makeOsmesaPlatform() {
    const OsmesaLibrary& osmesa = osmesaLibrary();
    if (!osmesa.failure.empty()) return Error{osmesa.failure};
    const int attributes[] = {kOsmesaFormat,
                              GL_RGBA,
                              kOsmesaDepthBits,
                              0,
                              kOsmesaStencilBits,
                              0,
                              kOsmesaAccumBits,
                              0,
                              kOsmesaProfile,
                              kOsmesaCoreProfile,
                              kOsmesaMajorVersion,
                              4,
                              kOsmesaMinorVersion,
                              5,
                              0};
    OsmesaContext context = osmesa.createContextAttribs(attributes, nullptr);
    if (context == nullptr) return Error{"osmesa: the driver refuses an OpenGL 4.5 core context"};
    return std::unique_ptr<ContextPlatform>(std::make_unique<OsmesaPlatform>(context));
}

} // namespace tyndall::gl
