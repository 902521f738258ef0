#pragma once
// The levels of detail of one organ of a run (sim/lod.h): the same surface and material on lattices of
// spacing h, 2h, 4h, each with a solver of its own. One of them steps and is drawn: that is the OrganParts in
// RunParts::organs; the others wait here.

#include "app/organ_setup.h"
#include "sim/lod_pass.h"

#include <glm/glm.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace serosa::app {

struct OrganParts;
struct RunParts;
struct RunOptions;

class OrganLevels {
public:
    /// Of an organ whose own level (1) is prepared and drawn. Makes the further levels that the scene asks
    /// for, and their solvers; the renderer gets them. Errors: a region that holds nothing on a coarse
    /// lattice, and all that an organ's own level may meet.
    static Status prepare(const RunOptions& options, RunParts& parts, std::size_t organ);

    int count() const { return parked_.empty() ? 1 : int(parked_.size()); }
    /// 1: the organ's own, the finest.
    int active() const { return active_; }
    /// Spacing of level 1, m.
    double finest(const RunParts& parts, std::size_t organ) const;
    /// Nodes of a level's lattice.
    std::size_t nodes(const RunParts& parts, std::size_t organ, int level) const;
    /// One line a further level: "level 2: 2,613 nodes, spacing 6.6 mm, 7 steps a frame".
    const std::vector<std::string>& lines() const { return lines_; }

    /// Another level is the organ's from now on, in the state that its solver is in: at rest, or about to be
    /// set. Forgets detail.
    void select(RunParts& parts, std::size_t organ, int level);

    /// Hands the motion over, after `frame` frames, by way of the levels between; the drawn surface fades.
    /// \param before increments of the step before the last, of a solver without textures; one with them has
    /// taken a step since its state was set
    void change(RunParts& parts, std::size_t organ, int level, int frame,
                const std::vector<glm::dvec3>& before);

    /// Detail that finer levels left (sim/lod.h), for snapshots: one a pair of neighbouring levels.
    std::vector<sim::LodDetail> details() const;
    void setDetails(const std::vector<sim::LodDetail>& details);

private:
    struct Pair {                                           // levels i + 1 and i + 2
        std::optional<sim::LodPass> pass;                   // solvers in textures
        std::optional<sim::LodTransfer> toCoarser, toFiner; // others
        sim::LodDetail detail;                              // of those
    };
    Status makePairs(const RunParts& parts, std::size_t organ);
    OrganParts& at(RunParts& parts, std::size_t organ, int level);
    const OrganParts& at(const RunParts& parts, std::size_t organ, int level) const;
    /// Puts a level in RunParts::organs.
    void place(RunParts& parts, std::size_t organ, int level);

    int active_ = 1;
    std::vector<std::unique_ptr<OrganParts>> parked_; // level - 1; null for the one that is active
    std::vector<Pair> pairs_;
    std::vector<std::string> lines_;
};

} // namespace serosa::app
