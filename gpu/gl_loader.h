#pragma once
// Fills the function pointers of gpu/gl.h from a context's own loader. Each context keeps its list, so that
// switching between live contexts copies pointers and asks nobody.

#include "base/result.h"

#include <functional>
#include <vector>

namespace serosa::gpu {

using GlProc = void (*)();
/// One pointer for each line of gpu/gl_functions.inc, in its order.
using GlFunctions = std::vector<GlProc>;

/// Asks `loader` for every entry point. Errors (exit code 5): names all that are missing.
Result<GlFunctions> loadGl(const std::function<GlProc(const char* name)>& loader);
/// Points gpu/gl.h at these.
void installGl(const GlFunctions& functions);
/// Back to null: a call without a context then stops at once instead of doing something by chance.
void clearGl();

} // namespace serosa::gpu
