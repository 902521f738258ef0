// See app/organ_levels.h.
#include "app/organ_levels.h"

#include "app/run_setup.h"
#include "base/check.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace serosa::app {

Status OrganLevels::prepare(const RunOptions& options, RunParts& parts, std::size_t organ) {
    OrganLevels& levels = parts.levels[organ];
    const sim::Organ& wanted = parts.scene.organs[organ];
    if (wanted.levels == 1)
        return {};
    OrganParts& own = *parts.organs[organ];
    levels.parked_.emplace_back();
    for (int level = 2; level <= wanted.levels; ++level) {
        sim::Organ organAt = wanted;
        organAt.name += " at level " + std::to_string(level);
        organAt.spacing = own.lattice.spacing * (1 << (level - 1));
        organAt.gridPoint = own.lattice.toWorld(-glm::dvec3(own.lattice.centre)); // grids are nested
        auto made = std::make_unique<OrganParts>();
        made->surface = own.surface;
        if (const Status done = prepareOrgan(parts.scene, organAt, *made); !done.ok())
            return Error{done.error().message + " (on the lattice of level " + std::to_string(level) +
                             ", spacing " + shortNumber(1e3 * organAt.spacing) +
                             " mm: take fewer levels, or a finer lattice)",
                         done.error().exitCode};
        organAt.tissue = sim::matchedTissue(wanted.tissue, own.lattice, made->lattice);
        made->setup.tissue = organAt.tissue;
        SEROSA_ASSIGN(made->step, organStep(organAt, made->lattice, parts.scene));
        made->setup.timeStep = made->step.timeStep;
        SEROSA_TRY(makeOrganSolver(options, false, *made));
        made->binding = render::bindSurface(made->lattice, made->surface.metres, parts.surfaceMapping());
        SEROSA_TRY(parts.renderer->addLevel(organ, made->lattice, made->surface.metres, made->binding,
                                            made->textures(), own.detail ? &*own.detail : nullptr));
        made->surface = {}; // one of them is enough: it goes with the active level
        levels.lines_.push_back("level " + std::to_string(level) + ": " + grouped(made->lattice.nodeCount()) +
                                " nodes, spacing " + shortNumber(1e3 * made->lattice.spacing) + " mm, " +
                                std::to_string(made->step.stepsPerFrame) + " steps a frame");
        levels.parked_.push_back(std::move(made));
    }
    return levels.makePairs(parts, organ);
}

Status OrganLevels::makePairs(const RunParts& parts, std::size_t organ) {
    for (int level = 1; level < count(); ++level) {
        const OrganParts &fine = at(parts, organ, level), &coarse = at(parts, organ, level + 1);
        Pair pair;
        if (fine.solver->textures()) {
            SEROSA_ASSIGN(sim::LodPass pass, sim::LodPass::create(fine.setup, fine.textures().layout(),
                                                                  coarse.setup, coarse.textures().layout()));
            pair.pass.emplace(std::move(pass));
        } else {
            pair.toCoarser = sim::LodTransfer::make(fine.setup, coarse.setup);
            pair.toFiner = sim::LodTransfer::make(coarse.setup, fine.setup);
        }
        pairs_.push_back(std::move(pair));
    }
    return {};
}

const OrganParts& OrganLevels::at(const RunParts& parts, std::size_t organ, int level) const {
    return level == active_ ? *parts.organs[organ] : *parked_[std::size_t(level - 1)];
}

OrganParts& OrganLevels::at(RunParts& parts, std::size_t organ, int level) {
    return const_cast<OrganParts&>(std::as_const(*this).at(std::as_const(parts), organ, level));
}

void OrganLevels::place(RunParts& parts, std::size_t organ, int level) {
    std::unique_ptr<OrganParts>& now = parts.organs[organ];
    std::unique_ptr<OrganParts>& next = parked_[std::size_t(level - 1)];
    std::swap(now->surface, next->surface);
    parked_[std::size_t(active_ - 1)] = std::move(now);
    now = std::move(next);
    active_ = level;
}

void OrganLevels::select(RunParts& parts, std::size_t organ, int level) {
    SEROSA_CHECK(level >= 1 && level <= count(), "a level of the organ");
    setDetails(std::vector<sim::LodDetail>(pairs_.size()));
    if (level == active_)
        return;
    place(parts, organ, level);
    parts.renderer->setLevel(organ, std::size_t(level - 1));
}

void OrganLevels::change(RunParts& parts, std::size_t organ, int level, int frame,
                         const std::vector<glm::dvec3>& before) {
    SEROSA_CHECK(level >= 1 && level <= count() && level != active_, "another level of the organ");
    OrganParts &first = at(parts, organ, active_), &last = at(parts, organ, level);
    double lead = sim::lodLead(first.step.timeStep, last.step.timeStep);
    sim::LatticeState state; // solvers without textures
    if (!first.solver->textures())
        state = first.solver->state();
    const int towards = level > active_ ? 1 : -1;
    for (int from = active_; from != level; from += towards) {
        OrganParts &source = at(parts, organ, from), &target = at(parts, organ, from + towards);
        Pair& pair = pairs_[std::size_t(std::min(from, from + towards) - 1)];
        const std::int64_t step = std::int64_t(frame) * target.step.stepsPerFrame;
        if (pair.pass) {
            sim::StateTextures* textures = target.solver->replaceState(step);
            SEROSA_CHECK(textures, "a solver in textures");
            towards > 0 ? pair.pass->toCoarser(source.textures(), *textures, lead)
                        : pair.pass->toFiner(source.textures(), *textures, lead);
        } else {
            const sim::LodTransfer& transfer = towards > 0 ? *pair.toCoarser : *pair.toFiner;
            sim::LatticeState next = sim::transferState(
                transfer, target.lattice, state, from == active_ ? before : std::vector<glm::dvec3>(), lead,
                step, towards < 0 ? pair.detail : sim::LodDetail());
            pair.detail = towards > 0 ? sim::detailOf(*pair.toFiner, next, state) : sim::LodDetail();
            state = std::move(next);
        }
        lead = 0; // what the first one took along
    }
    if (!last.solver->textures()) {
        last.solver->setState(state);
        last.solver->forgetCuts();
        last.uploaded->upload(last.solver->state());
    }
    parts.renderer->useLevel(organ, std::size_t(level - 1), first.textures(), last.textures(),
                             parts.surfaceMapping(), finest(parts, organ));
    place(parts, organ, level);
}

double OrganLevels::finest(const RunParts& parts, std::size_t organ) const {
    return at(parts, organ, 1).lattice.spacing;
}

std::size_t OrganLevels::nodes(const RunParts& parts, std::size_t organ, int level) const {
    return at(parts, organ, level).lattice.nodeCount();
}

std::vector<sim::LodDetail> OrganLevels::details() const {
    std::vector<sim::LodDetail> all;
    for (const Pair& pair : pairs_)
        all.push_back(pair.pass ? pair.pass->detail() : pair.detail);
    return all;
}

void OrganLevels::setDetails(const std::vector<sim::LodDetail>& details) {
    for (std::size_t i = 0; i < pairs_.size(); ++i)
        pairs_[i].pass ? pairs_[i].pass->setDetail(details[i]) : void(pairs_[i].detail = details[i]);
}

} // namespace serosa::app
