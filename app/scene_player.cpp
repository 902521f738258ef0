// See app/scene_player.h.

#include "app/scene_player.h"

#include "app/pose.h"
#include "app/summary.h"

#include <algorithm>

namespace serosa::app {

ScenePlayer::ScenePlayer(RunParts& parts) : parts_(parts), posed_(parts.organs.size()) {
    reset();
}

void ScenePlayer::advance() {
    ++frame_;
    for (std::size_t i = 0; i < parts_.organs.size(); ++i) {
        OrganParts& organ = *parts_.organs[i];
        if (organ.solver) {
            organ.solver->advance(organ.step.stepsPerFrame);
            if (organ.uploaded)
                organ.uploaded->upload(organ.solver->state());
            continue;
        }
        const double share = std::min(1.0, double(frame_) / parts_.scene.frames());
        posed_[i] = bentState(organ.lattice, share / parts_.scene.organs[i].pose->bendRadius);
        posed_[i]->step = frame_;
        organ.uploaded->upload(*posed_[i]);
    }
}

void ScenePlayer::reset() {
    frame_ = 0;
    for (std::size_t i = 0; i < parts_.organs.size(); ++i) {
        OrganParts& organ = *parts_.organs[i];
        posed_[i].reset();
        if (organ.solver) {
            organ.solver->setState(sim::startState(organ.setup));
            organ.solver->takeToolImpulses();
        }
        if (organ.uploaded)
            organ.uploaded->upload(sim::restState(organ.lattice));
    }
}

int ScenePlayer::stepsPerFrame() const {
    int steps = 0;
    for (const auto& organ : parts_.organs)
        steps += organ->solver ? organ->step.stepsPerFrame : 0;
    return steps;
}

sim::LatticeState ScenePlayer::state(std::size_t organ) const {
    const OrganParts& parts = *parts_.organs[organ];
    return parts.solver    ? parts.solver->state()
           : posed_[organ] ? *posed_[organ]
                           : sim::restState(parts.lattice);
}

std::string ScenePlayer::stateHash() const {
    std::string joined;
    for (std::size_t i = 0; i < parts_.organs.size(); ++i)
        joined += (i > 0 ? "-" : "") + state(i).hash();
    return joined;
}

std::string ScenePlayer::runaway() const {
    for (std::size_t i = 0; i < parts_.organs.size(); ++i) {
        const Displacement moved = largestDisplacement(parts_.organs[i]->lattice, state(i));
        if (!moved.finite)
            return parts_.scene.organs[i].name + ": the position of node " + std::to_string(moved.node) +
                   " is not finite";
    }
    return "";
}

} // namespace serosa::app
