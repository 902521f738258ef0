#pragma once
// GL types and the entry points that we use, as function pointers in namespace serosa. Context::makeCurrent
// loads them through the context's own loader; before that they are null. To use one more function, add it to
// gpu/gl_functions.inc.

#include <GL/glcorearb.h>

namespace serosa {

#define SEROSA_GL(type, name) extern type name;
#include "gpu/gl_functions.inc"
#undef SEROSA_GL

} // namespace serosa
