#pragma once
// When an organ is simulated on which level of detail: what the scene's script says, or a rule over what
// happens to it (`level_of_detail = "auto"`, docs/methods/lod.md).
//
// The rule, with the lattice state that the watchdog reads every ten frames anyway:
//   - level 1 while a tool is near (the spheres around tool and organ come closer than four of the
//     coarsest level's spacings, now or within the twenty frames to come), while a cut moves or will within
//     them, and while the fastest node covers more than a fifth of the finest spacing a frame;
//   - else the coarsest level where no node covers more than a fiftieth of it, level 2 between;
//   - finer at once, coarser only when kLeastPatience looks in a row say so. A coarser lattice of thin parts
//   comes
//     to rest elsewhere: where motion alone asks for the finer level again within kSettleFrames of such a
//     change, twice as many looks must say so from then on, up to kMostPatience. So an organ that lies still
//     ends on a level, and is not kept in motion by its switches.

#include "sim/lattice.h"
#include "sim/lattice_state.h"
#include "sim/scene.h"

#include <cstdint>

namespace serosa::app {

/// The level that a script asks for at a time, s: of the last key that it has reached, 1 before.
int scriptedLevel(const sim::Organ& organ, double time);

inline constexpr int kLeastPatience = 2, kMostPatience = 1 << 14; // looks
inline constexpr int kSettleFrames = 120;

/// What the rule looks at.
struct LevelScene {
    const sim::Scene* scene = nullptr;
    const sim::Organ* organ = nullptr;
    double finest = 0;      // m: spacing of level 1
    double stepsAFrame = 0; // of the level that the state is of
};

struct RuledLevel {
    int level = 1;
    bool disturbed = false; // a tool or a cut asks for it, and not motion alone
};

/// The level that the rule asks for after `frame` frames. \param state on `lattice`
RuledLevel ruledLevel(const LevelScene& what, const sim::Lattice& lattice, const sim::LatticeState& state,
                      int frame);

} // namespace serosa::app
