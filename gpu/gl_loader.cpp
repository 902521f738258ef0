// The entry points of gpu/gl.h: definitions, loading, switching.

#include "gpu/gl_loader.h"

#include "base/check.h"
#include "gpu/gl.h"

#include <string>

namespace serosa {

#define SEROSA_GL(type, name) type name = nullptr;
#include "gpu/gl_functions.inc"
#undef SEROSA_GL

} // namespace serosa

namespace serosa::gpu {

namespace {

const char* const kNames[] = {
#define SEROSA_GL(type, name) #name,
#include "gpu/gl_functions.inc"
#undef SEROSA_GL
};

} // namespace

Result<GlFunctions> loadGl(const std::function<GlProc(const char* name)>& loader) {
    GlFunctions functions;
    std::string missing;
    for (const char* name : kNames) {
        functions.push_back(loader(name));
        if (!functions.back())
            missing += (missing.empty() ? "" : ", ") + std::string(name);
    }
    if (!missing.empty())
        return Error{"the driver lacks OpenGL entry points (" + missing + "): OpenGL 4.5 core is needed",
                     exitNoGl};
    return functions;
}

void installGl(const GlFunctions& functions) {
    SEROSA_CHECK(functions.size() == std::size(kNames), "a list of another length");
    std::size_t index = 0;
#define SEROSA_GL(type, name) name = reinterpret_cast<type>(functions[index++]);
#include "gpu/gl_functions.inc"
#undef SEROSA_GL
}

void clearGl() {
#define SEROSA_GL(type, name) name = nullptr;
#include "gpu/gl_functions.inc"
#undef SEROSA_GL
}

} // namespace serosa::gpu
