#pragma once
// What `serosa run` says before its first step: surfaces, lattices, tissue, steps, notes, context.

#include <iosfwd>
#include <string>
#include <vector>

namespace serosa::app {

struct RunParts;

/// Says what was set up. Returns the notes among it.
std::vector<std::string> describeSetup(const RunParts& parts, std::ostream& out);

} // namespace serosa::app
