// See app/organ_coupling.h.
#include "app/organ_coupling.h"

#include "app/organ_setup.h"
#include "app/run_setup.h"
#include "base/check.h"
#include "sim/byte_stream.h"
#include "sim/quantity.h"

#include <algorithm>

namespace serosa::app {

namespace {

// Of the finer of its two lattices' spacing: what a thread and a clip are drawn as thick as.
constexpr double kThreadRadius = 0.12, kClipRadius = 0.2;

/// "scene.toml:12: " or "".
std::string sceneLine(const sim::Scene& scene, int line) {
    return scene.file.empty() || line == 0 ? "" : scene.file.string() + ":" + std::to_string(line) + ": ";
}

const PlacedOrgan& placedBy(const std::string& name, const std::vector<PlacedOrgan>& organs) {
    const auto found = std::find_if(organs.begin(), organs.end(), [&name](const PlacedOrgan& placed) {
        return placed.organ->name == name;
    });
    SEROSA_CHECK(found != organs.end(), "the reader knows the organs of threads");
    return *found;
}

Result<sim::ThreadAnchor> anchorOf(const sim::Scene& scene, const sim::Thread& thread,
                                   const sim::ThreadEnd& end, const PlacedOrgan& placed) {
    double outside = 0;
    const sim::ThreadAnchor anchor = sim::anchorAt(*placed.lattice, end.at, outside);
    if (outside > placed.lattice->spacing)
        return Error{sceneLine(scene, end.line) + "an end of " + thread.name + " reaches no node of " +
                     end.organ + ": it lies " + shortNumber(1e3 * outside) +
                     " mm outside of its lattice: put it on or into the organ (serosa inspect says where "
                     "that is)"};
    return anchor;
}

bool isFixed(const sim::ThreadAnchor& anchor, const std::vector<bool>& fixed) {
    for (std::size_t i = 0; i < anchor.nodes.size(); ++i)
        if (anchor.weights[i] > 0 && !fixed[anchor.nodes[i]])
            return false;
    return true;
}

/// Nodes of an organ that lie a spacing and more inside of another one, at rest.
std::size_t nodesInside(const sim::Lattice& organ, const sim::Lattice& other) {
    std::size_t inside = 0;
    for (std::size_t node = 0; node < organ.nodeCount(); ++node) {
        const glm::dvec3 at =
            other.toLattice(organ.toWorld(organ.restPosition(node))) + glm::dvec3(other.centre);
        const std::int64_t nearest = other.nodeAt(glm::ivec3(glm::round(at)));
        inside += organ.restDepth(node) >= 0 && nearest >= 0 && other.restDepth(std::size_t(nearest)) >= 1;
    }
    return inside;
}

} // namespace

int CoupledOrgans::placeOf(std::size_t organ) const {
    const auto found = std::find(organs.begin(), organs.end(), organ);
    return found == organs.end() ? -1 : int(found - organs.begin());
}

std::vector<std::size_t> coupledOrgans(const sim::Scene& scene) {
    std::vector<std::size_t> organs;
    for (std::size_t i = 0; i < scene.organs.size(); ++i)
        if (sim::couplingOf(scene, i).any())
            organs.push_back(i);
    return organs;
}

Result<std::vector<sim::TiedThread>> tieThreads(const sim::Scene& scene,
                                                const std::vector<PlacedOrgan>& organs) {
    const std::vector<std::size_t> coupled = coupledOrgans(scene);
    std::vector<sim::TiedThread> all;
    for (const sim::Thread& thread : scene.threads) {
        sim::TiedThread tied;
        tied.thread = thread;
        bool fixed = true;
        for (std::size_t i = 0; i < 2; ++i) {
            const PlacedOrgan& placed = placedBy(thread.ends[i].organ, organs);
            SEROSA_ASSIGN(tied.anchors[i], anchorOf(scene, thread, thread.ends[i], placed));
            const auto place = std::find_if(coupled.begin(), coupled.end(), [&](std::size_t organ) {
                return &scene.organs[organ] == placed.organ;
            });
            tied.organs[i] = std::uint32_t(place - coupled.begin());
            fixed = fixed && isFixed(tied.anchors[i], *placed.fixed);
        }
        if (fixed)
            return Error{sceneLine(scene, thread.line) + thread.name +
                         " has no effect: both its ends are tied to fixed nodes; move one of them"};
        all.push_back(std::move(tied));
    }
    return all;
}

void shareStep(const std::vector<sim::StableStep*>& steps, double frameTime) {
    int most = 1;
    for (const sim::StableStep* step : steps)
        most = std::max(most, step->stepsPerFrame);
    for (sim::StableStep* step : steps) {
        step->stepsPerFrame = most;
        step->timeStep = frameTime / most;
    }
}

Status prepareCoupling(RunParts& parts) {
    CoupledOrgans& coupled = parts.coupled;
    coupled.organs = coupledOrgans(parts.scene);
    std::vector<sim::StableStep*> steps;
    for (const std::size_t i : coupled.organs) {
        if (parts.organs[i]->setup.method == sim::StepMethod::implicit)
            return Error{sceneLine(parts.scene, sim::couplingOf(parts.scene, i).line) +
                         "organs that touch or are tied take explicit steps, and " +
                         parts.scene.organs[i].name +
                         " asks for implicit ones: remove its method, or the coupling"};
        steps.push_back(&parts.organs[i]->step);
    }
    shareStep(steps, 1 / parts.scene.frameRate);
    for (const std::size_t i : coupled.organs)
        parts.organs[i]->setup.timeStep = parts.organs[i]->step.timeStep;
    SEROSA_ASSIGN(coupled.threads, tieThreads(parts.scene, parts.placedOrgans()));
    return {};
}

Status makeGroup(RunParts& parts) {
    CoupledOrgans& coupled = parts.coupled;
    if (coupled.organs.empty())
        return {};
    std::vector<sim::GroupMember> members;
    for (const std::size_t i : coupled.organs) {
        const sim::OrganCoupling coupling = sim::couplingOf(parts.scene, i);
        members.push_back({parts.organs[i]->solver.get(), coupling.touches, coupling.touchesItself});
    }
    SEROSA_ASSIGN(coupled.group,
                  sim::OrganGroup::create(members, {parts.scene.organFriction, coupled.threads}));
    return {};
}

std::vector<std::string> couplingNotes(const sim::Scene& scene, const std::vector<PlacedOrgan>& organs) {
    std::vector<std::string> notes;
    for (std::size_t i = 0; i < organs.size() && scene.organsTouch; ++i)
        for (std::size_t j = i + 1; j < organs.size(); ++j)
            if (const std::size_t inside = nodesInside(*organs[i].lattice, *organs[j].lattice) +
                                           nodesInside(*organs[j].lattice, *organs[i].lattice);
                inside > 0)
                notes.push_back(organs[i].organ->name + " and " + organs[j].organ->name +
                                " begin inside of each other, with " + grouped(inside) +
                                " nodes deeper than a spacing, which contact leaves alone; put them apart "
                                "('at' of an organ)");
    return notes;
}

std::vector<render::DrawnThread> drawnThreads(const RunParts& parts,
                                              const std::vector<sim::ThreadState>& states, double time) {
    std::vector<render::DrawnThread> drawn;
    for (std::size_t i = 0; i < states.size(); ++i) {
        const sim::TiedThread& tied = parts.coupled.threads[i];
        if (states[i].broken || tied.thread.time > time)
            continue;
        render::DrawnThread thread;
        thread.clip = tied.thread.clip;
        double finest = 0;
        for (std::size_t e = 0; e < 2; ++e) {
            const std::size_t organ = parts.coupled.organs[tied.organs[e]];
            thread.ends[e] = {organ, tied.anchors[e].nodes, tied.anchors[e].weights};
            const double spacing = parts.organs[organ]->lattice.spacing;
            finest = e == 0 ? spacing : std::min(finest, spacing);
        }
        thread.radius = (thread.clip ? kClipRadius : kThreadRadius) * finest;
        drawn.push_back(thread);
    }
    return drawn;
}

std::vector<sim::Trait> couplingTraits(const sim::Scene& scene, std::size_t organ) {
    const sim::OrganCoupling coupling = sim::couplingOf(scene, organ);
    if (!coupling.any())
        return {};
    sim::ByteWriter bytes;
    for (const sim::Thread& thread : scene.threads) {
        for (const sim::ThreadEnd& end : thread.ends) {
            bytes.text(end.organ);
            for (int axis = 0; axis < 3; ++axis)
                bytes.f64(end.at[axis]);
        }
        for (const double value : {thread.time, thread.length, thread.tightening, thread.strength})
            bytes.f64(value);
        bytes.u8(thread.clip ? 1 : 0);
    }
    return {{"organs_touch", coupling.touches ? "true" : "false"},
            {"self_contact", coupling.touchesItself ? "true" : "false"},
            {"organ_friction", sim::traitValue({scene.organFriction}, "")},
            {"threads", std::to_string(scene.threads.size()) + " (" +
                            sim::checksumText(sim::checksumOf(bytes.bytes())) + ")"}};
}

} // namespace serosa::app
