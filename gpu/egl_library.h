#pragma once
// libEGL, opened at run time so that the program starts (and says what is missing) on a machine without it.
// Private to gpu/.

#include <string>
#include <vector>

#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>

namespace serosa::gpu {

struct EglLibrary {
    std::string problem; // empty when everything was found
    std::string clientExtensions;

    PFNEGLGETPROCADDRESSPROC getProcAddress = nullptr;
    PFNEGLGETERRORPROC getError = nullptr;
    PFNEGLQUERYSTRINGPROC queryString = nullptr;
    PFNEGLINITIALIZEPROC initialize = nullptr;
    PFNEGLBINDAPIPROC bindApi = nullptr;
    PFNEGLCHOOSECONFIGPROC chooseConfig = nullptr;
    PFNEGLCREATECONTEXTPROC createContext = nullptr;
    PFNEGLDESTROYCONTEXTPROC destroyContext = nullptr;
    PFNEGLMAKECURRENTPROC makeCurrent = nullptr;
    PFNEGLGETPLATFORMDISPLAYEXTPROC getPlatformDisplay = nullptr;
    PFNEGLQUERYDEVICESEXTPROC queryDevices = nullptr;           // null without EGL_EXT_device_enumeration
    PFNEGLQUERYDEVICESTRINGEXTPROC queryDeviceString = nullptr; // null without EGL_EXT_device_query

    bool hasClientExtension(const char* name) const;
    /// "EGL_BAD_ALLOC (0x3003)" of the last call in this thread.
    std::string lastError() const;
};

/// Opened at the first call and never closed (drivers do not survive being unloaded).
const EglLibrary& eglLibrary();

/// Whether `name` stands in the space-separated `list`.
bool hasExtension(const std::string& list, const std::string& name);

/// An EGL device with whether it is Mesa's software rasterizer.
struct EglDevice {
    EGLDeviceEXT device;
    bool software;
    std::string name; // for messages
};
std::vector<EglDevice> eglDevices();

} // namespace serosa::gpu
