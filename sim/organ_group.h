#pragma once
// Organs that may touch each other, or that threads tie together, step together: all take the same number of
// steps a frame, of the same length, and after each step the coupling stage changes where their nodes have
// come, in place, as x' and u' of each (x = x' - u' is where the step began):
//   1. threads and clips pull their ends together (sim/thread_hold.h);
//   2. skins that would pass through each other stop (sim/pair_contact.h): last, so that nothing passes.
// For solvers whose state lies in textures, both are passes over these, with nothing read back
// (sim/pair_contact_pass.h). Whatever the stage gives to one organ it takes from another: momentum is kept.

#include "base/result.h"
#include "sim/pair_contact_skin.h"
#include "sim/solver.h"
#include "sim/thread_hold.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace serosa::sim {

struct GroupMember {
    Solver* solver = nullptr; // not null; outlives the group
    bool touches = false;     // others that touch
    bool touchesItself = false;
};

struct GroupSettings {
    double friction = 0; // Coulomb's coefficient where organs touch; at least 0
    std::vector<TiedThread> threads;
};

/// What one organ got from another through contact.
struct PairLoad {
    glm::dvec3 impulse{0}; // N s
    double pressed = 0;    // N s: sum of the sizes of the normal impulses
};
/// Of organ a, from organ b: [a][b]. [a][a] of contact with itself has no impulse, but is pressed.
using PairLoads = std::vector<std::vector<PairLoad>>;

/// The coupling stage of one kind of solver.
class Coupling {
public:
    virtual ~Coupling() = default;
    /// After step number `step` of all organs.
    virtual void couple(std::int64_t step) = 0;
    /// Cuts changed an organ's connections. Reads them back (stalls).
    virtual void reconnect(std::size_t organ) = 0;
    /// Since the last call. Waits for the GPU.
    virtual PairLoads takeLoads() = 0;
    virtual std::vector<ThreadState> threads() const = 0;
    virtual void setThreads(const std::vector<ThreadState>& states) = 0;
};

class OrganGroup {
public:
    /// Members' setups have one time step; their solvers are all of the CPU, or all of the GPU. Errors: of
    /// the shaders.
    static Result<std::unique_ptr<OrganGroup>> create(const std::vector<GroupMember>& members,
                                                      const GroupSettings& settings);
    /// Takes `count` steps of all organs.
    void advance(int count);
    /// The solvers' states were set from elsewhere: these are those after `step` steps, with their threads
    /// (empty: as at the start). Loads are forgotten.
    void restart(std::int64_t step, const std::vector<ThreadState>& threads = {});
    /// An organ was cut, or its cuts undone.
    void reconnect(std::size_t organ) { coupling_->reconnect(organ); }
    PairLoads takeLoads() { return coupling_->takeLoads(); }
    /// Impulses and work since the last takeThreads().
    std::vector<ThreadState> threads() const { return coupling_->threads(); }
    /// The same, and they count from now on.
    std::vector<ThreadState> takeThreads();

    std::size_t size() const { return members_.size(); }
    const GroupSettings& settings() const { return settings_; }

private:
    OrganGroup(const std::vector<GroupMember>& members, const GroupSettings& settings)
        : members_(members), settings_(settings) {}

    std::vector<GroupMember> members_;
    GroupSettings settings_;
    std::unique_ptr<Coupling> coupling_;
    std::int64_t step_ = 0;
};

/// For coupleOrgans: what cuts left, and the nodes of threads.
std::vector<CoupledMember> coupledMembers(const std::vector<GroupMember>& members,
                                          const GroupSettings& settings);

} // namespace serosa::sim
