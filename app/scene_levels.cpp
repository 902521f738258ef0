// How the player moves organs between their levels of detail: see app/scene_player.h.
#include "app/level_rule.h"
#include "app/scene_player.h"

#include <algorithm>
#include <utility>

namespace serosa::app {

void ScenePlayer::newGuard(std::size_t i) {
    guards_[i].emplace(*parts_.organs[i], cuts_[i], 1 / parts_.scene.frameRate);
}

void ScenePlayer::startLevel(std::size_t i) {
    OrganLevels& levels = parts_.levels[i];
    levelChoices_[i] = {};
    if (levels.count() == 1)
        return;
    const sim::Organ& organ = parts_.scene.organs[i];
    levels.select(parts_, i, organ.levelsByRule ? 1 : scriptedLevel(organ, 0));
    const OrganParts& now = *parts_.organs[i];
    now.solver->setState(sim::startState(now.setup));
    now.solver->forgetCuts();
    newGuard(i);
    changes_[i] = {{0, levels.active()}};
}

int ScenePlayer::wantedLevel(std::size_t i) const {
    const OrganLevels& levels = parts_.levels[i];
    const auto& tools = parts_.scene.tools;
    const bool held = std::any_of(tools.begin(), tools.end(), [this](const sim::Tool& tool) {
        return tool.mode == sim::ToolMode::grasp && tool.activeAt(time());
    });
    if (levels.count() == 1 || held || !shownConnections_[i].empty())
        return levels.active();
    const sim::Organ& organ = parts_.scene.organs[i];
    return organ.levelsByRule ? levelChoices_[i].wanted : scriptedLevel(organ, time());
}

void ScenePlayer::takeSteps(std::size_t i) {
    OrganParts& organ = *parts_.organs[i];
    const int steps = organ.step.stepsPerFrame;
    std::vector<glm::dvec3> before;
    if (wantedLevel(i) != parts_.levels[i].active() && !organ.solver->textures()) {
        if (steps > 1)
            organ.solver->advance(steps - 1);
        before = organ.solver->state().increments;
        organ.solver->advance(1);
    } else {
        organ.solver->advance(steps);
    }
    cut(i);
    guards_[i]->endFrame(frame_);
    if (organ.uploaded) // what a change of level fades from, too
        organ.uploaded->upload(organ.solver->state());
    if (const int level = wantedLevel(i); level != parts_.levels[i].active()) // nothing was cut
        changeLevel(i, level, before);
    if (parts_.levels[i].count() > 1)
        parts_.renderer->setBlendFrame(i, frame_ - levelChoices_[i].changedAt);
}

void ScenePlayer::changeLevel(std::size_t i, int level, const std::vector<glm::dvec3>& before) {
    check(i); // nothing is handed on that is wrong
    if (guards_[i]->frozen())
        return;
    std::vector<FrameLoads> loads = guards_[i]->takeLoads(true);
    parts_.levels[i].change(parts_, i, level, frame_, before);
    cuts_[i].clear(); // strokes that cut nothing, before steps of another length
    newGuard(i);
    guards_[i]->restart(frame_);
    guards_[i]->carry(std::move(loads));
    levelChoices_[i].changedAt = frame_;
    levelChoices_[i].looks = 0;
    if (level > changes_[i].back().level && parts_.scene.organs[i].levelsByRule)
        levelChoices_[i].coarserAt = frame_;
    changes_[i].push_back({frame_, level});
}

void ScenePlayer::lookAtLevels() {
    for (std::size_t i = 0; i < parts_.organs.size(); ++i) {
        const sim::Organ& organ = parts_.scene.organs[i];
        if (!organ.levelsByRule || parts_.levels[i].count() == 1 || guards_[i]->frozen())
            continue;
        const OrganParts& now = *parts_.organs[i];
        const RuledLevel asked = ruledLevel(
            {&parts_.scene, &organ, parts_.levels[i].finest(parts_, i), double(now.step.stepsPerFrame)},
            now.lattice, guards_[i]->lastGood(), frame_);
        LevelChoice& choice = levelChoices_[i];
        const int active = parts_.levels[i].active();
        const int level = asked.level;
        if (level < active && !asked.disturbed && choice.coarserAt >= 0 &&
            frame_ - choice.coarserAt <= kSettleFrames) { // the switch itself set it in motion
            choice.patience = std::min(2 * choice.patience, kMostPatience);
            choice.coarserAt = -1;
        }
        choice.looks = level > active ? std::min(choice.looks + 1, kMostPatience) : 0;
        choice.wanted = level <= active                   ? level
                        : choice.looks >= choice.patience ? std::max(active, std::min(level, choice.calmer))
                                                          : active;
        choice.calmer = level;
    }
}

LevelState ScenePlayer::levelState(std::size_t i) const {
    return {levelChoices_[i], parts_.levels[i].details(), parts_.renderer->blend(i)};
}

void ScenePlayer::restoreLevel(std::size_t i, int level, const LevelState& state) {
    OrganLevels& levels = parts_.levels[i];
    if (levels.count() == 1)
        return;
    levels.select(parts_, i, level);
    levels.setDetails(state.details);
    newGuard(i);
    changes_[i] = {{frame_, level}};
}

void ScenePlayer::restoreBlend(std::size_t i, const LevelState& state) {
    levelChoices_[i] = state.choice;
    parts_.renderer->setBlend(i, parts_.surfaceMapping(), state.blend, parts_.levels[i].finest(parts_, i));
    parts_.renderer->setBlendFrame(i, frame_ - state.choice.changedAt);
}

} // namespace serosa::app
