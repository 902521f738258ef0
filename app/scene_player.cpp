// See app/scene_player.h.

#include "app/scene_player.h"

#include "app/pose.h"
#include "base/check.h"

#include <algorithm>

namespace serosa::app {

ScenePlayer::ScenePlayer(RunParts& parts)
    : parts_(parts), cuts_(parts.organs.size()), lastCut_(parts.organs.size()),
      shownConnections_(parts.organs.size()), posed_(parts.organs.size()), guards_(parts.organs.size()),
      levelChoices_(parts.organs.size()), changes_(parts.organs.size()) {
    for (std::size_t i = 0; i < parts.organs.size(); ++i)
        if (parts.organs[i]->solver && parts.coupled.placeOf(i) < 0)
            newGuard(i);
    if (parts.coupled.group)
        group_.emplace(parts, cuts_);
    reset();
}

void ScenePlayer::cut(std::size_t i) {
    OrganParts& organ = *parts_.organs[i];
    const double from = (frame_ - 1) / parts_.scene.frameRate, to = time();
    const std::int64_t step = std::int64_t(frame_) * organ.step.stepsPerFrame;
    std::vector<sim::Stroke> strokes;
    for (std::size_t c = 0; c < parts_.scene.cuts.size(); ++c) {
        std::vector<sim::Stroke> more = parts_.scene.cuts[c].strokes(from, to);
        if (more.empty())
            continue;
        // A part continues the stroke before it; where several cuts move at once, each part is a stroke.
        more.front().continues = more.front().continues && lastCut_[i] == c;
        lastCut_[i] = c;
        // Once more over the last frame's sweep: tissue that swings against the blade would slip by between
        // frames.
        for (sim::Stroke& again : parts_.scene.cuts[c].strokes(std::max(0.0, from - (to - from)), from)) {
            if (again.kind != sim::StrokeKind::blade || !more.front().continues)
                break;
            again.continues = true;
            strokes.push_back(again);
        }
        strokes.insert(strokes.end(), more.begin(), more.end());
    }
    if (const double strain = parts_.scene.organs[i].tearStrain; strain > 0) {
        sim::Stroke tear;
        tear.kind = sim::StrokeKind::tear;
        tear.strain = strain;
        tear.continues = strokes.empty() && !cuts_[i].entries().empty();
        strokes.push_back(tear);
    }
    const auto sweeps = [](const sim::Stroke& stroke) { return stroke.kind != sim::StrokeKind::tear; };
    if (organ.uploaded && std::any_of(strokes.begin(), strokes.end(), sweeps))
        organ.uploaded->upload(organ.solver->state()); // the mask is painted by the state as it is cut
    for (const sim::Stroke& stroke : strokes) {
        const Status painted = parts_.renderer->paintCut(i, organ.lattice, organ.textures(), stroke);
        SEROSA_CHECK(painted.ok(), "prepareRun made the mask");
        const Status done = cuts_[i].cut(*organ.solver, step, stroke);
        SEROSA_CHECK(done.ok(), "a context of GL 4.5 has double precision in shaders");
    }
    parts_.renderer->setBlendFrame(i, frame_ - levelChoices_[i].changedAt);
    if (!strokes.empty())
        showCuts(i, true);
}

void ScenePlayer::setCutMask(std::size_t i, std::string_view bytes) {
    const OrganParts& organ = *parts_.organs[i];
    const Status done = parts_.renderer->restoreCuts(i, organ.lattice, organ.textures(), bytes);
    SEROSA_CHECK(done.ok(), "a snapshot of this scene");
}

void ScenePlayer::showCuts(std::size_t i, bool inMotion) {
    const OrganParts& organ = *parts_.organs[i];
    inMotion = inMotion &&
               parts_.scene.look.show != sim::Show::both; // what is ray-cast does not wait for what fades
    const std::vector<std::uint32_t> connections = organ.solver->state().connections;
    if (connections != shownConnections_[i] && parts_.coupled.placeOf(i) >= 0)
        parts_.coupled.group->reconnect(std::size_t(parts_.coupled.placeOf(i)));
    if (connections != shownConnections_[i]) {
        const Status shown = parts_.renderer->showCuts(
            i, organ.lattice, organ.surface.metres, organ.binding, organ.textures(),
            connections.empty() ? organ.lattice.connections : connections, parts_.surfaceMapping(), inMotion);
        SEROSA_CHECK(shown.ok(), "shaders that compiled before");
        if (inMotion)
            levelChoices_[i].changedAt = frame_;
    }
    shownConnections_[i] = connections;
}

void ScenePlayer::advanceCoupled() {
    if (!group_ || group_->frozen())
        return;
    const std::vector<std::size_t>& organs = parts_.coupled.organs;
    parts_.coupled.group->advance(parts_.organs[organs.front()]->step.stepsPerFrame);
    for (const std::size_t i : organs)
        cut(i);
    group_->endFrame(frame_);
    for (const std::size_t i : organs)
        if (parts_.organs[i]->uploaded)
            parts_.organs[i]->uploaded->upload(parts_.organs[i]->solver->state());
}

void ScenePlayer::advance() {
    ++frame_;
    advanceCoupled();
    for (std::size_t i = 0; i < parts_.organs.size(); ++i) {
        if (parts_.coupled.placeOf(i) >= 0)
            continue;
        if (guards_[i]) {
            if (!guards_[i]->frozen())
                takeSteps(i);
            continue;
        }
        OrganParts& organ = *parts_.organs[i];
        const double share = std::min(1.0, double(frame_) / parts_.scene.frames());
        posed_[i] = bentState(organ.lattice, share / parts_.scene.organs[i].pose->bendRadius);
        posed_[i]->step = frame_;
        organ.uploaded->upload(*posed_[i]);
    }
    if (frame_ % kFramesBetweenChecks == 0) {
        check();
        lookAtLevels();
    }
}

void ScenePlayer::check() {
    for (std::size_t i = 0; i < parts_.organs.size(); ++i)
        check(i);
    if (group_ && group_->check(frame_))
        for (const std::size_t i : parts_.coupled.organs)
            showState(i);
}

void ScenePlayer::check(std::size_t i) {
    if (guards_[i] && guards_[i]->check(frame_))
        showState(i);
}

void ScenePlayer::showState(std::size_t i) {
    OrganParts& organ = *parts_.organs[i];
    showCuts(i);
    if (organ.uploaded)
        organ.uploaded->upload(organ.solver->state());
}

void ScenePlayer::reset() {
    frame_ = 0;
    lastCut_.assign(lastCut_.size(), 0);
    for (std::size_t i = 0; i < parts_.organs.size(); ++i) {
        OrganParts& organ = *parts_.organs[i];
        posed_[i].reset();
        if (organ.solver) {
            organ.solver->setState(sim::startState(organ.setup));
            organ.solver->forgetCuts();
            cuts_[i].clear();
            setCutMask(i, {});
            showCuts(i);
            startLevel(i);
            if (guards_[i])
                guards_[i]->restart(0);
        }
        OrganParts& now = *parts_.organs[i]; // on its first level of detail
        if (now.uploaded)
            now.uploaded->upload(sim::restState(now.lattice));
    }
    if (group_)
        group_->restart(0);
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

std::optional<sim::Alarm> ScenePlayer::alarm(std::size_t organ) const {
    if (parts_.coupled.placeOf(organ) >= 0)
        return group_->alarm(organ);
    return guards_[organ] ? guards_[organ]->alarm() : std::nullopt;
}

std::vector<std::string> ScenePlayer::alarmLines() const {
    std::vector<std::string> lines;
    for (std::size_t i = 0; i < guards_.size(); ++i)
        if (const std::optional<sim::Alarm> found = alarm(i))
            lines.push_back(parts_.scene.organs[i].name + ": " + found->text());
    return lines;
}

std::vector<sim::ThreadState> ScenePlayer::threads() const {
    return group_ ? parts_.coupled.group->threads() : std::vector<sim::ThreadState>();
}

sim::PairLoads ScenePlayer::takePairLoads() {
    return group_ ? group_->takePairLoads() : sim::PairLoads();
}

std::vector<FrameLoads> ScenePlayer::takeLoads(std::size_t organ, bool all) {
    if (parts_.coupled.placeOf(organ) >= 0)
        return group_->takeLoads(organ, all);
    return guards_[organ] ? guards_[organ]->takeLoads(all) : std::vector<FrameLoads>();
}

} // namespace serosa::app
