// EGL contexts without a window: the surfaceless platform, and EGL devices (a GPU without a display server).

#include "base/check.h"
#include "gpu/context_backend.h"
#include "gpu/egl_library.h"

#include <map>

namespace serosa::gpu {

namespace {

constexpr const char* kInstallEgl =
    "install the Debian packages libegl1 and libegl-mesa0, or the GPU maker's driver";

/// An initialised display. It is never terminated: EGL gives the same one for the same platform and device,
/// terminating it would end every other context on it, and Mesa would unload its driver, which LLVM inside
/// does not survive.
EGLDisplay openDisplay(EGLenum platform, void* native, std::string& problem) {
    const EglLibrary& egl = eglLibrary();
    EGLDisplay display = egl.getPlatformDisplay(platform, native, nullptr);
    EGLint major = 0, minor = 0;
    if (display == EGL_NO_DISPLAY) {
        problem = "no EGL display, " + egl.lastError();
    } else if (!egl.initialize(display, &major, &minor)) {
        problem = "EGL did not initialise, " + egl.lastError();
        display = EGL_NO_DISPLAY;
    }
    return display;
}

bool displayHas(EGLDisplay display, const char* extension) {
    const char* list = eglLibrary().queryString(display, EGL_EXTENSIONS);
    return list && hasExtension(list, extension);
}

class EglContext final : public BackendContext {
public:
    EglContext(ContextKind kind, EGLDisplay display, EGLContext context)
        : kind_(kind), display_(display), context_(context) {}
    ~EglContext() override {
        releaseThis();
        eglLibrary().destroyContext(display_, context_);
    }
    ContextKind kind() const override { return kind_; }

protected:
    Status bind() override {
        const EglLibrary& egl = eglLibrary();
        egl.bindApi(EGL_OPENGL_API);
        if (!egl.makeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_))
            return Error{"eglMakeCurrent failed, " + egl.lastError(), exitNoGl};
        return {};
    }
    void unbind() override {
        eglLibrary().makeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    }
    GlProc proc(const char* name) const override { return eglLibrary().getProcAddress(name); }

private:
    ContextKind kind_;
    EGLDisplay display_;
    EGLContext context_;
};

/// A config for windowless rendering, or none at all where the display can do without.
std::optional<EGLConfig> chooseConfig(EGLDisplay display) {
    const EGLint attributes[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                                 EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (eglLibrary().chooseConfig(display, attributes, &config, 1, &count) && count > 0)
        return config;
    if (displayHas(display, "EGL_KHR_no_config_context"))
        return EGL_NO_CONFIG_KHR;
    return std::nullopt;
}

Attempt tryDisplay(ContextKind kind, EGLenum platform, void* native) {
    const EglLibrary& egl = eglLibrary();
    Attempt failed{nullptr, "", "install or update the driver of the GPU, or libegl-mesa0"};
    BackendContext::releaseCurrent();
    const EGLDisplay display = openDisplay(platform, native, failed.problem);
    if (display == EGL_NO_DISPLAY) {
        failed.advice = kInstallEgl;
        return failed;
    }
    if (!displayHas(display, "EGL_KHR_surfaceless_context")) {
        failed.problem = "the display cannot render without a surface (EGL_KHR_surfaceless_context)";
        return failed;
    }
    const std::optional<EGLConfig> config = chooseConfig(display);
    if (!config) {
        failed.problem = "the display has no config for OpenGL";
        return failed;
    }
    egl.bindApi(EGL_OPENGL_API);
    const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                 4,
                                 EGL_CONTEXT_MINOR_VERSION,
                                 5,
                                 EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                 EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                 EGL_CONTEXT_OPENGL_DEBUG,
                                 EGL_TRUE,
                                 EGL_NONE};
    const EGLContext raw = egl.createContext(display, *config, EGL_NO_CONTEXT, attributes);
    if (raw == EGL_NO_CONTEXT) {
        failed.problem = "no OpenGL 4.5 core context, " + egl.lastError();
        return failed;
    }
    auto context = std::make_unique<EglContext>(kind, display, raw);
    if (const Status started = context->start(); !started.ok()) {
        failed.problem = started.error().message;
        return failed;
    }
    return {std::move(context), "", ""};
}

} // namespace

Attempt tryEglSurfaceless() {
    const EglLibrary& egl = eglLibrary();
    if (!egl.problem.empty())
        return {nullptr, egl.problem, kInstallEgl};
    if (!egl.hasClientExtension("EGL_MESA_platform_surfaceless"))
        return {nullptr, "EGL has no surfaceless platform (EGL_MESA_platform_surfaceless)",
                "install the Debian package libegl-mesa0"};
    return tryDisplay(ContextKind::egl, EGL_PLATFORM_SURFACELESS_MESA, nullptr);
}

Attempt tryEglDevice(DeviceFilter filter) {
    const EglLibrary& egl = eglLibrary();
    if (!egl.problem.empty())
        return {nullptr, egl.problem, kInstallEgl};
    if (!egl.hasClientExtension("EGL_EXT_platform_device") || !egl.queryDevices || !egl.queryDeviceString)
        return {nullptr, "EGL lists no devices (EGL_EXT_platform_device, EGL_EXT_device_enumeration)",
                kInstallEgl};
    const char* advice =
        "install the GPU's driver; the user needs access to /dev/dri/renderD* (group render)";
    std::string problem;
    for (const bool software : {false, true}) {
        if (software && filter == DeviceFilter::hardwareOnly)
            break;
        for (const EglDevice& device : eglDevices()) {
            if (device.software != software)
                continue;
            Attempt attempt = tryDisplay(ContextKind::eglDevice, EGL_PLATFORM_DEVICE_EXT, device.device);
            // A device without a driver of its own can still end in the software renderer.
            if (attempt.context && filter == DeviceFilter::hardwareOnly && attempt.context->info().software)
                attempt = {nullptr, "renders in software", advice};
            if (attempt.context)
                return attempt;
            problem += (problem.empty() ? "" : ", ") + device.name + ": " + attempt.problem;
        }
    }
    if (problem.empty())
        problem = filter == DeviceFilter::hardwareOnly ? "no hardware device" : "no device";
    return {nullptr, problem, advice};
}

} // namespace serosa::gpu
