// OSMesa: Mesa's software renderer without any window system. libOSMesa exports every gl name, so it is
// opened with RTLD_LOCAL and never linked. It wants a buffer of the caller's as default framebuffer; ours is
// small and never drawn to.

#include "gpu/context_backend.h"
#include "gpu/gl.h"

#include <dlfcn.h>

#include <array>

namespace serosa::gpu {

namespace {

// GL/osmesa.h drags in GL/gl.h, which quarrels with glcorearb.h; these are all that we need of it.
constexpr int kOsmesaFormat = 0x22, kOsmesaDepthBits = 0x30, kOsmesaProfile = 0x33, kOsmesaCoreProfile = 0x34;
constexpr int kOsmesaMajor = 0x36, kOsmesaMinor = 0x37;
constexpr int kBufferSize = 16; // pixels a side

struct Osmesa {
    void* library = nullptr;
    void* (*createContextAttribs)(const int* attributes, void* share) = nullptr;
    void (*destroyContext)(void* context) = nullptr;
    unsigned char (*makeCurrent)(void* context, void* buffer, GLenum type, GLsizei width,
                                 GLsizei height) = nullptr;
    GlProc (*getProcAddress)(const char* name) = nullptr;
    std::string problem;
};

template <class T>
void find(Osmesa& osmesa, T& function, const char* name) {
    function = reinterpret_cast<T>(dlsym(osmesa.library, name));
    if (!function)
        osmesa.problem = std::string("libOSMesa.so.8 lacks ") + name;
}

Osmesa openOsmesa() {
    Osmesa osmesa;
    osmesa.library = dlopen("libOSMesa.so.8", RTLD_LOCAL | RTLD_NOW);
    if (!osmesa.library) {
        osmesa.problem = dlerror();
        return osmesa;
    }
    find(osmesa, osmesa.createContextAttribs, "OSMesaCreateContextAttribs");
    find(osmesa, osmesa.destroyContext, "OSMesaDestroyContext");
    find(osmesa, osmesa.makeCurrent, "OSMesaMakeCurrent");
    find(osmesa, osmesa.getProcAddress, "OSMesaGetProcAddress");
    return osmesa;
}

/// Opened once and never closed: LLVM inside it does not survive being unloaded.
const Osmesa& osmesaLibrary() {
    static const Osmesa osmesa = openOsmesa();
    return osmesa;
}

class OsmesaContext final : public BackendContext {
public:
    explicit OsmesaContext(void* context) : context_(context) {}
    ~OsmesaContext() override {
        releaseThis();
        osmesaLibrary().destroyContext(context_);
    }
    ContextKind kind() const override { return ContextKind::osmesa; }

protected:
    Status bind() override {
        if (!osmesaLibrary().makeCurrent(context_, buffer_.data(), GL_UNSIGNED_BYTE, kBufferSize,
                                         kBufferSize))
            return Error{"OSMesaMakeCurrent failed", exitNoGl};
        return {};
    }
    void unbind() override { osmesaLibrary().makeCurrent(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0); }
    GlProc proc(const char* name) const override { return osmesaLibrary().getProcAddress(name); }

private:
    void* context_;
    std::array<unsigned char, std::size_t{4} * kBufferSize * kBufferSize> buffer_{};
};

} // namespace

Attempt tryOsmesa() {
    const Osmesa& osmesa = osmesaLibrary();
    if (!osmesa.problem.empty())
        return {nullptr, osmesa.problem, "install the Debian package libosmesa6"};
    const int attributes[] = {kOsmesaFormat,
                              GL_RGBA,
                              kOsmesaDepthBits,
                              24,
                              kOsmesaProfile,
                              kOsmesaCoreProfile,
                              kOsmesaMajor,
                              4,
                              kOsmesaMinor,
                              5,
                              0};
    BackendContext::releaseCurrent();
    void* raw = osmesa.createContextAttribs(attributes, nullptr);
    if (!raw)
        return {nullptr, "OSMesa gave no OpenGL 4.5 core context",
                "update the Debian package libosmesa6 to 22.3 or later"};
    auto context = std::make_unique<OsmesaContext>(raw);
    if (const Status started = context->start(); !started.ok())
        return {nullptr, started.error().message, "update the Debian package libosmesa6 to 22.3 or later"};
    return {std::move(context), "", ""};
}

} // namespace serosa::gpu
