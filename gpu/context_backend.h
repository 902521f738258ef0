#pragma once
// What the kinds of context share, private to gpu/: one current context a thread, loading, version check,
// debug output.

#include "gpu/context.h"
#include "gpu/gl_loader.h"

#include <memory>
#include <string>

namespace serosa::gpu {

class BackendContext : public Context {
public:
    void makeCurrent() final;
    /// First use: binds, loads the entry points, checks version and profile, fills info(), turns debug output
    /// on. Leaves the context current.
    Status start();

    /// The context that is current in this thread, or null.
    static BackendContext* current();
    /// Releases whatever is current in this thread.
    static void releaseCurrent();

protected:
    virtual Status bind() = 0;
    virtual void unbind() = 0;
    virtual GlProc proc(const char* name) const = 0;
    /// For destructors of derived classes: releases this context if it is current.
    void releaseThis();

private:
    GlFunctions functions_;
};

/// One kind tried: a started, current context, or why not and what to do.
struct Attempt {
    std::unique_ptr<BackendContext> context;
    std::string problem, advice;
};

enum class DeviceFilter { hardwareOnly, hardwareFirst };

Attempt tryEglSurfaceless();
Attempt tryEglDevice(DeviceFilter filter);
Attempt tryOsmesa();
/// A hidden window, for surveys; gpu/context_window.h opens those that are seen.
Attempt tryWindow();
/// Why SEROSA_GL_DISABLE rules a kind out, or empty.
std::string disabledBecause(ContextKind kind);
/// One kind by name; heeds SEROSA_GL_DISABLE.
Attempt tryKind(ContextKind kind, DeviceFilter filter);

/// Turns debug output on in the current context and sends GL errors where setGlErrorPolicy says.
void installDebugCallback();

} // namespace serosa::gpu
