// See sim/organ_group.h; and the coupling stage of CPU solvers.
#include "sim/organ_group.h"

#include "base/check.h"
#include "sim/pair_contact.h"
#include "sim/pair_contact_pass.h"

#include <algorithm>
#include <optional>

namespace serosa::sim {

namespace {

class CpuCoupling final : public Coupling {
public:
    CpuCoupling(const std::vector<GroupMember>& members, const GroupSettings& settings)
        : members_(members), settings_(settings), timeStep_(members.front().solver->setup().timeStep),
          states_(settings.threads.size()) {
        rebuild();
    }

    void couple(std::int64_t step) override {
        read();
        const std::vector<glm::dvec3> before = motion_.increments;
        if (!settings_.threads.empty())
            threads_->solve(step, motion_, states_);
        contacts_->solve(motion_);
        write(before);
        for (const PairContact& c : contacts_->contacts()) {
            const std::uint32_t own = group_.organOf[c.node];
            loads_[own][c.organ].pressed += c.normalImpulse;
            if (own == c.organ)
                continue;
            loads_[own][c.organ].impulse += c.impulse();
            loads_[c.organ][own].pressed += c.normalImpulse;
            for (int corner = 0; corner < 3; ++corner)
                loads_[c.organ][own].impulse -= c.weights[corner] * c.impulse();
        }
    }

    void reconnect(std::size_t) override { rebuild(); }

    PairLoads takeLoads() override {
        const double unit = group_.mass * group_.length / timeStep_; // to N s
        PairLoads taken = loads_;
        for (std::vector<PairLoad>& row : taken)
            for (PairLoad& load : row) {
                load.impulse *= unit;
                load.pressed *= unit;
            }
        loads_.assign(members_.size(), std::vector<PairLoad>(members_.size()));
        return taken;
    }

    std::vector<ThreadState> threads() const override { return states_; }
    void setThreads(const std::vector<ThreadState>& states) override { states_ = states; }

private:
    void rebuild() {
        group_ = coupleOrgans(coupledMembers(members_, settings_));
        contacts_.emplace(group_, settings_.friction);
        threads_.emplace(group_, settings_.threads, timeStep_);
        motion_.positions.resize(group_.nodeCount());
        motion_.increments.resize(group_.nodeCount());
        motion_.inverseMass.resize(group_.nodeCount());
        if (loads_.empty())
            loads_.assign(members_.size(), std::vector<PairLoad>(members_.size()));
    }

    void read() {
        for (std::size_t i = 0; i < members_.size(); ++i) {
            const CoupledOrgan& organ = group_.organs[i];
            nodes_.resize(organ.nodes);
            const std::span<const std::uint32_t> numbers(&group_.latticeNode[organ.firstNode], organ.nodes);
            members_[i].solver->readNodes(numbers, nodes_);
            for (std::size_t k = 0; k < organ.nodes; ++k) {
                const std::size_t node = organ.firstNode + k;
                motion_.positions[node] = organ.toGroup(nodes_[k].position - nodes_[k].increment);
                motion_.increments[node] = organ.scale * nodes_[k].increment;
                motion_.inverseMass[node] = nodes_[k].held ? 0 : group_.inverseMass[node];
            }
        }
    }

    void write(const std::vector<glm::dvec3>& before) {
        for (std::size_t i = 0; i < members_.size(); ++i) {
            const CoupledOrgan& organ = group_.organs[i];
            std::vector<std::uint32_t> numbers;
            std::vector<glm::dvec3> by;
            for (std::size_t node = organ.firstNode; node < organ.firstNode + organ.nodes; ++node)
                if (motion_.increments[node] != before[node]) {
                    numbers.push_back(group_.latticeNode[node]);
                    by.push_back((motion_.increments[node] - before[node]) / organ.scale);
                }
            if (!numbers.empty())
                members_[i].solver->moveNodes(numbers, by);
        }
    }

    std::vector<GroupMember> members_;
    GroupSettings settings_;
    double timeStep_;
    CoupledGroup group_;
    std::optional<PairContacts> contacts_;
    std::optional<ThreadHold> threads_;
    CoupledMotion motion_;
    std::vector<NodeMotion> nodes_;
    std::vector<ThreadState> states_;
    PairLoads loads_; // group units
};

} // namespace

std::vector<CoupledMember> coupledMembers(const std::vector<GroupMember>& members,
                                          const GroupSettings& settings) {
    std::vector<CoupledMember> coupled;
    for (std::size_t i = 0; i < members.size(); ++i) {
        CoupledMember member;
        member.setup = &members[i].solver->setup();
        member.connections = members[i].solver->state().connections;
        member.touches = members[i].touches;
        member.touchesItself = members[i].touchesItself;
        for (const TiedThread& thread : settings.threads)
            for (std::size_t end = 0; end < 2; ++end)
                if (thread.organs[end] == i)
                    member.others.insert(member.others.end(), thread.anchors[end].nodes.begin(),
                                         thread.anchors[end].nodes.end());
        std::sort(member.others.begin(), member.others.end());
        coupled.push_back(std::move(member));
    }
    return coupled;
}

Result<std::unique_ptr<OrganGroup>> OrganGroup::create(const std::vector<GroupMember>& members,
                                                       const GroupSettings& settings) {
    SEROSA_CHECK(!members.empty(), "a group has members");
    const bool textures = members.front().solver->textures() != nullptr;
    for (const GroupMember& member : members)
        SEROSA_CHECK(member.solver->setup().timeStep == members.front().solver->setup().timeStep &&
                         (member.solver->textures() != nullptr) == textures,
                     "one time step and one kind of solver");
    std::unique_ptr<OrganGroup> group(new OrganGroup(members, settings));
    if (textures) {
        SEROSA_ASSIGN(group->coupling_, makeTextureCoupling(members, settings));
    } else {
        group->coupling_ = std::make_unique<CpuCoupling>(members, settings);
    }
    return group;
}

void OrganGroup::advance(int count) {
    for (int i = 0; i < count; ++i) {
        for (const GroupMember& member : members_)
            member.solver->advance(1);
        coupling_->couple(step_);
        ++step_;
    }
}

void OrganGroup::restart(std::int64_t step, const std::vector<ThreadState>& threads) {
    step_ = step;
    coupling_->takeLoads();
    coupling_->setThreads(threads.empty() ? std::vector<ThreadState>(settings_.threads.size()) : threads);
}

std::vector<ThreadState> OrganGroup::takeThreads() {
    std::vector<ThreadState> taken = coupling_->threads(), rest = taken;
    for (ThreadState& state : rest)
        state.impulse = state.work = 0;
    coupling_->setThreads(rest);
    return taken;
}

} // namespace serosa::sim
