#pragma once
// The shader sources of shaders/, embedded at build time (cmake/embed_shaders.cmake).

namespace serosa::gpu {

struct EmbeddedShader {
    const char* name;   // file name without folder, for example "solver_step.frag"
    const char* source; // whole text
};

/// All embedded shaders; the list ends with an entry whose name is null.
const EmbeddedShader* embeddedShaders();

} // namespace serosa::gpu
