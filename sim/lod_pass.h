#pragma once
// Level of detail on the GPU: what sim/lod.h does, in passes over the state textures of both levels, with
// nothing read back.

#include "base/result.h"
#include "gpu/program.h"
#include "sim/lod.h"
#include "sim/state_textures.h"

#include <cstdint>
#include <vector>

namespace serosa::sim {

/// Two neighbouring levels of one organ, both ways. Keeps the detail that the coarse level cannot hold.
class LodPass {
public:
    /// Needs a current context; layouts are those of the textures given later. Errors: of the shaders.
    static Result<LodPass> create(const SolverSetup& fine, const TextureLayout& fineLayout,
                                  const SolverSetup& coarse, const TextureLayout& coarseLayout);

    /// Writes the motion of one level into the other's textures: positions, increments, normals; node info as
    /// it is in the beginning (nothing held, nothing cut).
    /// \param lead lodLead to the level that goes on; 0 where the other half of `from` does not hold the step
    /// before (after a state was set), so that the acceleration is not known
    void toCoarser(const StateTextures& fine, StateTextures& coarse, double lead);
    void toFiner(const StateTextures& coarse, StateTextures& fine, double lead);

    /// Detail of the fine shape that toFiner will add; reads back (stalls). Empty: none.
    LodDetail detail() const;
    void setDetail(const LodDetail& detail);

private:
    /// One way.
    struct Way {
        LodTransfer transfer;
        gpu::Buffer sources, targets, entries, sourceMasses, targetMasses;
        gpu::Program finish; // of the target's layout
        int sourceGroups = 0, targetGroups = 0;
    };
    LodPass() = default;
    static Result<Way> makeWay(const SolverSetup& from, const TextureLayout& fromLayout,
                               const SolverSetup& to, const TextureLayout& toLayout);
    void run(Way& way, const StateTextures& from, StateTextures& to, float lead);
    void sum(const gpu::Buffer& masses, int nodes, int firstGroup, int groups, const StateTextures& state,
             int half);

    Way toCoarser_, toFiner_;
    gpu::Program gather_, sums_, correct_, detailProgram_;
    gpu::Buffer partialSums_, motion_, detail_; // a vec4 a fine node
    bool hasDetail_ = false;
};

} // namespace serosa::sim
