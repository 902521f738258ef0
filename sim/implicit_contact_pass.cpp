// See sim/implicit_contact_pass.h.
#include "sim/implicit_contact_pass.h"

#include "shaders/implicit_constants.h"
#include "shaders/shared_constants.h"

#include <cmath>

namespace serosa::sim {

namespace {

SolverSetup withoutFriction(SolverSetup setup) {
    for (Tool& tool : setup.tools)
        tool.friction = 0;
    for (Body& body : setup.bodies)
        body.friction = 0;
    return setup;
}

} // namespace

Status ImplicitContactPass::initialize(const SolverSetup& setup, const StateTextures& textures,
                                       ContactPass& pushes, const gpu::Buffer& loads,
                                       const std::function<void(gpu::Program&)>& share) {
    pushes_ = &pushes;
    nodes_ = setup.lattice->nodeCount();
    if (empty())
        return {};
    pushing_ = !setup.bodies.empty();
    for (const Tool& tool : setup.tools) {
        pushing_ = pushing_ || tool.mode == ToolMode::push;
        finite_ = finite_ || (tool.mode == ToolMode::grasp && std::isfinite(tool.gripForce));
    }
    SEROSA_TRY(asks_.initialize(withoutFriction(setup), textures, loads, ContactPass::Purpose::asks));
    std::vector<gpu::ShaderDefine> defines = pushes.colliders().defines();
    defines.push_back({"SRS_CONTACT", "1"});
    if (finite_)
        defines.push_back({"SRS_FINITE_GRIPS", "1"});
    const gpu::ShaderLibrary library;
    const struct {
        gpu::Program* program;
        const char* file;
        bool needed;
    } all[] = {{&place_, "implicit_place.comp", true},
               {&support_, "implicit_support.comp", true},
               {&loads_, "implicit_loads.comp", true},
               {&grip_, "implicit_grip.comp", finite_},
               {&settle_, "implicit_settle.comp", pushing_}};
    for (const auto& [program, file, needed] : all) {
        if (!needed)
            continue;
        SEROSA_ASSIGN(*program, gpu::Program::create(library, {file}, defines));
        share(*program);
    }
    for (gpu::Program* program : {&loads_, &grip_})
        if (*program)
            program->buffer("b_loads", loads);
    if (finite_)
        support_.buffer("b_held", pushes.heldNodes());
    return {};
}

void ImplicitContactPass::bind(gpu::Program& program, std::int64_t step) const {
    pushes_->colliders().bind(program, step, ContactColliders::Precision::exact, &program == &grip_);
}

void ImplicitContactPass::run(gpu::Program& program) {
    program.dispatch({int(nodes_), 1, 1});
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
}

void ImplicitContactPass::close(const StateTextures& textures, std::int64_t step) {
    pushes_->close(textures, step);
}

void ImplicitContactPass::place(StateTextures& textures, int round) {
    place_.set("u_round", round);
    place_.image("i_newPositions", textures.positions(), GL_WRITE_ONLY);
    place_.image("i_newIncrements", textures.increments(), GL_WRITE_ONLY);
    run(place_);
}

void ImplicitContactPass::support(StateTextures& textures, std::int64_t step, int round) {
    place(textures, round);
    asks_.push(textures, step);
    bind(support_, step);
    support_.set("u_round", round);
    support_.image("i_increments", textures.increments(), GL_READ_ONLY);
    if (finite_) {
        support_.set("u_now", int(step % 3));
        support_.image("i_nodeInfo", textures.nodeInfo(), GL_READ_ONLY);
    }
    run(support_);
}

void ImplicitContactPass::take(StateTextures& textures, int rounds) {
    place(textures, rounds);
}

void ImplicitContactPass::countLoads(const StateTextures& textures, std::int64_t step) {
    bind(loads_, step);
    loads_.image("i_nodeInfo", textures.nodeInfo(), GL_READ_ONLY);
    loads_.image("i_increments", textures.increments_[1 - textures.current_], GL_READ_ONLY);
    run(loads_);
}

void ImplicitContactPass::finish(StateTextures& textures, std::int64_t step) {
    pushes_->push(textures, step);
    if (finite_) {
        bind(grip_, step);
        grip_.image("i_nodeInfo", textures.nodeInfo(), GL_READ_WRITE);
        grip_.image("i_positions", textures.positions(), GL_READ_WRITE);
        grip_.image("i_increments", textures.increments(), GL_READ_WRITE);
        run(grip_);
    }
    if (pushing_) {
        settle_.image("i_increments", textures.increments(), GL_READ_ONLY);
        settle_.image("i_earlier", textures.earlier_, GL_READ_WRITE);
        run(settle_);
    }
}

} // namespace serosa::sim
