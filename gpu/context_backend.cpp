// Making contexts current, whatever their kind. Mesa's EGL and OSMesa share one dispatch table a thread but
// do not know of each other: a context of another kind must be released by its own library before the next is
// bound.

#include "gpu/context_backend.h"

#include "base/check.h"
#include "gpu/gl.h"

namespace serosa::gpu {

namespace {

thread_local BackendContext* currentContext = nullptr;

std::string glString(GLenum name) {
    const GLubyte* text = glGetString(name);
    return text ? reinterpret_cast<const char*>(text) : "";
}

bool isSoftware(const std::string& renderer) {
    for (const char* name : {"llvmpipe", "softpipe", "swrast", "SWR", "Software Rasterizer"})
        if (renderer.find(name) != std::string::npos)
            return true;
    return false;
}

} // namespace

BackendContext* BackendContext::current() {
    return currentContext;
}

void BackendContext::releaseCurrent() {
    if (currentContext)
        currentContext->releaseThis();
}

void BackendContext::releaseThis() {
    if (currentContext != this)
        return;
    glFinish();
    unbind();
    clearGl();
    currentContext = nullptr;
}

void BackendContext::makeCurrent() {
    if (currentContext == this)
        return;
    releaseCurrent();
    const Status bound = bind();
    SEROSA_CHECK(bound.ok(), bound.error().message);
    installGl(functions_);
    currentContext = this;
}

Status BackendContext::start() {
    releaseCurrent();
    SEROSA_TRY(bind());
    auto functions = loadGl([this](const char* name) { return proc(name); });
    if (!functions.ok()) {
        unbind();
        return functions.error();
    }
    functions_ = std::move(functions).value();
    installGl(functions_);
    currentContext = this;

    info_.kind = kind();
    info_.vendor = glString(GL_VENDOR);
    info_.renderer = glString(GL_RENDERER);
    info_.version = glString(GL_VERSION);
    info_.glslVersion = glString(GL_SHADING_LANGUAGE_VERSION);
    info_.software = isSoftware(info_.renderer);
    GLint major = 0, minor = 0, profile = 0;
    glGetIntegerv(GL_MAJOR_VERSION, &major);
    glGetIntegerv(GL_MINOR_VERSION, &minor);
    glGetIntegerv(GL_CONTEXT_PROFILE_MASK, &profile);
    if (major * 10 + minor < 45 || !(profile & GL_CONTEXT_CORE_PROFILE_BIT)) {
        releaseThis();
        return Error{"OpenGL 4.5 core is needed, the driver gave \"" + info_.version + "\"", exitNoGl};
    }
    // Images are tightly packed everywhere in the program.
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    installDebugCallback();
    return {};
}

} // namespace serosa::gpu
