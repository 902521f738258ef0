// Taking, checking and giving back: see sim/snapshot.h. The file is in sim/snapshot_file.cpp.
#include "sim/snapshot.h"

#include "shaders/shared_constants.h"
#include "sim/quantity.h"

#include <algorithm>

namespace serosa::sim {

namespace {

/// Values that no run of this lattice could have left: the file was made by hand.
Status checkState(const OrganSnapshot& organ, const Lattice& lattice, std::size_t tools) {
    const LatticeState& state = organ.state;
    const std::size_t nodes = lattice.nodeCount();
    const auto wrong = [&organ](const std::string& what) {
        return Error{organ.name + ": " + what + ": write the snapshot again"};
    };
    if (state.positions.size() != nodes)
        return wrong("the snapshot has " + std::to_string(state.positions.size()) + " nodes, the lattice " +
                     std::to_string(nodes));
    if (state.step < 0)
        return wrong("the snapshot counts " + std::to_string(state.step) + " steps");
    if (std::any_of(state.heldBy.begin(), state.heldBy.end(),
                    [tools](std::uint32_t tool) { return tool > tools; }))
        return wrong("a node is held by a tool that is not there");
    for (std::size_t node = 0; node < state.connections.size(); ++node)
        if ((state.connections[node] & ~lattice.connections[node]) != 0)
            return wrong("node " + std::to_string(node) + " has a connection that the lattice has not");
    if (!organ.cuts.empty() && organ.cuts.front().stroke.continues)
        return wrong("the first stroke continues another");
    for (const CutLayer& layer : organ.layers)
        for (const ClearedBits& cleared : layer)
            if (cleared.node >= nodes || (cleared.bits & ~lattice.connections[cleared.node]) != 0)
                return wrong("a stroke cut a connection that the lattice has not");
    return {};
}

} // namespace

void takeSnapshot(Solver& solver, OrganSnapshot& organ) {
    organ.solver = solver.name();
    organ.state = solver.state();
    organ.layers = solver.cutLayers();
    organ.impulses = solver.takeToolImpulses();
}

Status checkSnapshot(const OrganSnapshot& organ, const std::string& name, const std::string& solver,
                     const std::vector<Trait>& traits, const Lattice& lattice) {
    if (organ.name != name)
        return Error{"belongs to another scene: the organ is " + inQuotes(organ.name) + " in the snapshot, " +
                     inQuotes(name) + " here"};
    if (const auto difference = firstDifference(organ.traits, traits))
        return Error{"belongs to another scene: " + organ.name + ": " + *difference};
    const bool posed = organ.solver == "pose" || solver == "pose";
    if (organ.solver != solver && (!solver.empty() || posed))
        return Error{"belongs to another solver: " + organ.name + " was stepped by " + organ.solver +
                     ", here by " + (solver.empty() ? "a solver" : solver) +
                     ": the bytes would not be those of a run that never stopped"};
    return checkState(organ, lattice, SRS_MAX_TOOLS);
}

Status restoreSnapshot(const OrganSnapshot& organ, Solver& solver) {
    solver.setState(organ.state);
    solver.takeToolImpulses();
    return solver.setCutLayers(organ.layers);
}

} // namespace serosa::sim
