#pragma once
// What every handle does when it is made and when it dies. Private to gpu/.

#include "base/check.h"
#include "gpu/gl.h"

#include <string>

namespace serosa::gpu {

/// A handle that is made before, or dies after, its context is a broken promise: say so instead of calling
/// null.
inline void checkContext(const std::string& what) {
    SEROSA_CHECK(glObjectLabel != nullptr, what + ": no GL context is current");
}

/// Shows in debug messages and in frame debuggers.
inline void labelObject(GLenum type, GLuint id, const std::string& label) {
    constexpr std::size_t kMostBytes = 250; // GL_MAX_LABEL_LENGTH is at least 256
    const std::string text = label.substr(0, kMostBytes);
    glObjectLabel(type, id, static_cast<GLsizei>(text.size()), text.data());
}

} // namespace serosa::gpu
