// Opening libEGL.so.1 and asking what it offers before any display exists.

#include "gpu/egl_library.h"

#include <dlfcn.h>

#include <array>
#include <cstdio>
#include <cstdlib>

namespace serosa::gpu {

namespace {

EglLibrary openEgl() {
    EglLibrary egl;
    // Mesa prints "libEGL warning: ..." about every GPU that it looks for and does not find; what matters
    // comes back as an error. A user's own setting stays.
    setenv("EGL_LOG_LEVEL", "fatal", 0);
    void* library = dlopen("libEGL.so.1", RTLD_LOCAL | RTLD_NOW);
    if (!library) {
        egl.problem = dlerror();
        return egl;
    }
    const auto find = [&](auto& function, const char* name) {
        function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(dlsym(library, name));
        if (!function)
            egl.problem = std::string("libEGL.so.1 lacks ") + name;
    };
    find(egl.getProcAddress, "eglGetProcAddress");
    find(egl.getError, "eglGetError");
    find(egl.queryString, "eglQueryString");
    find(egl.initialize, "eglInitialize");
    find(egl.bindApi, "eglBindAPI");
    find(egl.chooseConfig, "eglChooseConfig");
    find(egl.createContext, "eglCreateContext");
    find(egl.destroyContext, "eglDestroyContext");
    find(egl.makeCurrent, "eglMakeCurrent");
    if (!egl.problem.empty())
        return egl;
    if (const char* list = egl.queryString(EGL_NO_DISPLAY, EGL_EXTENSIONS))
        egl.clientExtensions = list;
    if (!egl.hasClientExtension("EGL_EXT_platform_base")) {
        egl.problem = "EGL has no platform displays (EGL_EXT_platform_base): no driver is registered with it";
        return egl;
    }
    egl.getPlatformDisplay =
        reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(egl.getProcAddress("eglGetPlatformDisplayEXT"));
    if (egl.hasClientExtension("EGL_EXT_device_base") || egl.hasClientExtension("EGL_EXT_device_enumeration"))
        egl.queryDevices =
            reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(egl.getProcAddress("eglQueryDevicesEXT"));
    if (egl.hasClientExtension("EGL_EXT_device_base") || egl.hasClientExtension("EGL_EXT_device_query"))
        egl.queryDeviceString =
            reinterpret_cast<PFNEGLQUERYDEVICESTRINGEXTPROC>(egl.getProcAddress("eglQueryDeviceStringEXT"));
    return egl;
}

} // namespace

bool hasExtension(const std::string& list, const std::string& name) {
    return (" " + list + " ").find(" " + name + " ") != std::string::npos;
}

bool EglLibrary::hasClientExtension(const char* name) const {
    return hasExtension(clientExtensions, name);
}

std::string EglLibrary::lastError() const {
    const EGLint code = getError();
    const char* name = "EGL error";
    switch (code) {
    case EGL_NOT_INITIALIZED:
        name = "EGL_NOT_INITIALIZED";
        break;
    case EGL_BAD_ACCESS:
        name = "EGL_BAD_ACCESS";
        break;
    case EGL_BAD_ALLOC:
        name = "EGL_BAD_ALLOC";
        break;
    case EGL_BAD_ATTRIBUTE:
        name = "EGL_BAD_ATTRIBUTE";
        break;
    case EGL_BAD_CONFIG:
        name = "EGL_BAD_CONFIG";
        break;
    case EGL_BAD_MATCH:
        name = "EGL_BAD_MATCH";
        break;
    case EGL_BAD_PARAMETER:
        name = "EGL_BAD_PARAMETER";
        break;
    }
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), "%s (0x%x)", name, static_cast<unsigned>(code));
    return text.data();
}

const EglLibrary& eglLibrary() {
    static const EglLibrary egl = openEgl();
    return egl;
}

std::vector<EglDevice> eglDevices() {
    const EglLibrary& egl = eglLibrary();
    if (!egl.problem.empty() || !egl.queryDevices || !egl.queryDeviceString)
        return {};
    EGLint count = 0;
    if (!egl.queryDevices(0, nullptr, &count) || count <= 0)
        return {};
    std::vector<EGLDeviceEXT> raw(static_cast<std::size_t>(count));
    egl.queryDevices(count, raw.data(), &count);
    raw.resize(static_cast<std::size_t>(count));
    std::vector<EglDevice> devices;
    for (EGLDeviceEXT device : raw) {
        const char* list = egl.queryDeviceString(device, EGL_EXTENSIONS);
        const std::string extensions = list ? list : "";
        const bool software = hasExtension(extensions, "EGL_MESA_device_software");
        std::string name = software ? "software device" : "device " + std::to_string(devices.size());
        if (hasExtension(extensions, "EGL_EXT_device_drm"))
            if (const char* file = egl.queryDeviceString(device, EGL_DRM_DEVICE_FILE_EXT))
                name = file;
        devices.push_back({device, software, name});
    }
    return devices;
}

} // namespace serosa::gpu
