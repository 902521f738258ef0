#pragma once
// The coupling stage of solvers whose state lies in StateTextures, as compute passes: threads
// (shaders/thread_hold.comp) and contact (shaders/pair_*.comp), twins of sim/thread_hold.cpp and
// sim/pair_contact.cpp in float32. Nothing is read back but what is asked for. A step is
//   read    each organ's textures into one list of nodes in group units
//   threads one invocation, if there are any
//   skin    points and normals of the skins; then boxes of 16 triangles, and of 16 of these
//   find    what touches: one invocation a node goes through the boxes, and appends
//   solve, apply   SRS_PAIR_ROUNDS times: impulses of all touches, then what nodes make of their sums
//   write   what changed into the textures, in place
// Impulses are rounded to integers before they are added: the same bytes in whatever order, and what one
// organ gets another gives to the last bit.

#include "base/result.h"
#include "sim/organ_group.h"

#include <memory>
#include <vector>

namespace serosa::sim {

/// Needs a current context, in which the members' solvers were made. Errors: of the shaders.
Result<std::unique_ptr<Coupling>> makeTextureCoupling(const std::vector<GroupMember>& members,
                                                      const GroupSettings& settings);

} // namespace serosa::sim
