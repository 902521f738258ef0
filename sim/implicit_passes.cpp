// See sim/implicit_passes.h.
#include "sim/implicit_passes.h"

#include "base/check.h"
#include "shaders/implicit_constants.h"
#include "shaders/shared_constants.h"
#include "sim/implicit_contact.h"
#include "sim/solver_program.h"
#include "sim/tissue_field.h"
#include "sim/tissue_uniforms.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace serosa::sim {

namespace {

/// As the block b_progress of shaders/implicit_common.glsl.
struct Progress {
    float goal = 0, first = 0;
    int doneAt = 1 << 30, iterations = 0;
    float share = 1;
};

template <std::size_t Count>
int addColumns(std::vector<int>& table, const std::vector<std::array<std::int32_t, Count>>& rows) {
    const int first = int(table.size());
    for (std::size_t column = 0; column < Count; ++column)
        for (const auto& row : rows)
            table.push_back(row[column]);
    return first;
}

gpu::Buffer emptyBuffer(const std::string& label, std::size_t bytes) {
    const std::vector<char> zero(bytes, 0);
    return gpu::Buffer(label, bytes, zero.data());
}

/// \param volume the program has the volumetric term's, \param springs those of the springs
void setMaterials(gpu::Program& program, const SolverSetup& setup, bool volume, bool springs) {
    const MaterialArrays materials(setup.tissue, setup.timeStep);
    if (springs || setup.tissue.stiffens())
        program.set("u_springs", std::span<const float>(materials.springs));
    if (volume)
        materials.setVolume(program);
    if (springs)
        program.set("u_dampingTimes", std::span<const float>(materials.dampingTimes));
    if (setup.tissue.stiffens())
        materials.setCurves(program);
}

} // namespace

Status ImplicitPasses::initialize(const SolverSetup& setup, StateTextures& textures,
                                  const ImplicitLimits& limits, ContactPass& pushes,
                                  const gpu::Buffer& loads) {
    setup_ = setup;
    limits_ = limits;
    levels_ = implicitLevels(*setup.lattice);
    const std::size_t most = std::max(levels_[0].nodes.size(), levels_[0].cells.size());
    groups_ = int((most + SRS_IMPLICIT_GROUP - 1) / SRS_IMPLICIT_GROUP);
    std::size_t inTail = 0;
    for (tail_ = int(levels_.size()); tail_ > 1; --tail_) {
        inTail += levels_[std::size_t(tail_ - 1)].nodes.size();
        if (inTail > SRS_IMPLICIT_TAIL && tail_ < int(levels_.size()))
            break;
    }
    textures.keepEarlier();
    createTables(textures.layout());
    createConstants(!pushes.empty());
    SEROSA_TRY(createPrograms(pushes));
    return contact_.initialize(setup, textures, pushes, loads,
                               [this](gpu::Program& program) { share(program); });
}

void ImplicitPasses::createTables(const TextureLayout& layout) {
    const Lattice& lattice = *setup_.lattice;
    const std::size_t nodes = lattice.nodeCount();
    std::vector<int> table(levels_.size() * SRS_LEVEL_INTS, 0);
    std::size_t vectors = 0, quadratures = 0; // vec4
    for (std::size_t l = 0; l < levels_.size(); ++l) {
        const ImplicitLevel& level = levels_[l];
        const auto header = [&](int what) -> int& { return table[l * SRS_LEVEL_INTS + std::size_t(what)]; };
        const auto put = [&](int what, const auto& rows) {
            const int place = addColumns(table, rows);
            header(what) = place;
        };
        put(SRS_LEVEL_AROUND, level.cellsAround);
        put(SRS_LEVEL_CORNERS, level.cells);
        put(SRS_LEVEL_COARSER, level.coarser);
        put(SRS_LEVEL_FINER, level.finer);
        put(SRS_LEVEL_PARTS, level.finerCells);
        header(SRS_LEVEL_NODES) = int(level.nodes.size());
        header(SRS_LEVEL_CELLS) = int(level.cells.size());
        // Of level 0 only the last two arrays are kept here.
        header(SRS_LEVEL_VECTORS) = int(vectors) - (l == 0 ? 4 * int(nodes) : 0);
        vectors += (l == 0 ? 2 : 6) * level.nodes.size();
        header(SRS_LEVEL_QUADRATURE) = int(quadratures);
        quadratures += SRS_QUADRATURE * level.cells.size();
        header(SRS_LEVEL_BLOCKS) = int(quadratures);
        quadratures += l == 0 ? 0 : 16 * level.cells.size();
    }
    const int neighbours = int(table.size());
    for (int d = 0; d < SRS_NEIGHBOURS; ++d)
        for (std::size_t node = 0; node < nodes; ++node)
            table.push_back(int(lattice.neighbour(node, d)));
    const int texels = int(table.size());
    for (std::size_t node = 0; node < nodes; ++node)
        table.push_back(int(layout.texelOfNode[node].x) | int(layout.texelOfNode[node].y) << 16);
    tables_ = gpu::Buffer("implicit tables", std::span<const int>(table));
    levelArrays_ = emptyBuffer("implicit levels", vectors * 16);
    quadratures_ = emptyBuffer("implicit quadratures", quadratures * 16);
    neighbours_ = neighbours;
    texels_ = texels;
}

void ImplicitPasses::createConstants(bool contact) {
    const Lattice& lattice = *setup_.lattice;
    const TissueField field(lattice, setup_.tissue);
    const std::size_t nodes = lattice.nodeCount(), cells = lattice.cells.size();
    const double dt = setup_.timeStep, scale = dt * dt * setup_.tissue.stiffnessOverMass(lattice.spacing);
    std::vector<float> masses, weights;
    totalMass_ = 0;
    for (std::size_t node = 0; node < nodes; ++node) {
        masses.push_back(float(field.massShare(node)));
        totalMass_ += double(masses.back());
    }
    for (int d = 0; d < SRS_NEIGHBOURS; ++d)
        for (std::size_t node = 0; node < nodes; ++node)
            weights.push_back(float(scale * field.springWeight(node, d)));
    for (int d = 0; d < SRS_NEIGHBOURS && setup_.tissue.ownDampers(); ++d)
        for (std::size_t node = 0; node < nodes; ++node)
            weights.push_back(float(scale * field.dampingWeight(node, d) / dt));
    std::vector<glm::vec2> shares;
    for (const LatticeCell& cell : lattice.cells)
        shares.emplace_back(scale * cell.fill / 255.0, cell.material);
    masses_ = gpu::Buffer("implicit masses", std::span<const float>(masses));
    weights_ = gpu::Buffer("implicit weights", std::span<const float>(weights));
    cellShares_ = gpu::Buffer("implicit cell shares", std::span<const glm::vec2>(shares));
    vectors_ = emptyBuffer("implicit vectors", (contact ? SRS_CONTACT_VECS : SRS_VECS) * nodes * 16);
    if (contact) {
        std::vector<glm::vec4> stiffness;
        for (const double r : contactStiffness(setup_, field))
            stiffness.emplace_back(0, 0, 0, r);
        vectors_.upload(SRS_VEC_W * nodes * 16, nodes * 16, stiffness.data());
    }
    sums_ = emptyBuffer("implicit sums", SRS_SUMS * std::size_t(groups_) * 16);
    const Progress progress;
    progress_ = gpu::Buffer("implicit progress", sizeof progress, &progress);
    cellArrays_ = emptyBuffer("implicit cells", SRS_CELLS * cells * 16);
    connections_ = emptyBuffer("implicit connections", nodes * 4);
    springs_ = emptyBuffer("implicit springs", SRS_NEIGHBOURS * nodes * 16);
    const std::size_t size = 3 * levels_.back().nodes.size();
    coarsest_ = emptyBuffer("implicit coarsest level", (size * size + size) * 4);
}

/// What all passes read.
void ImplicitPasses::share(gpu::Program& program) const {
    program.buffer("b_vectors", vectors_).buffer("b_sums", sums_).buffer("b_progress", progress_);
    program.set("u_nodes", int(setup_.lattice->nodeCount())).set("u_groups", groups_);
    program.buffer("b_tables", tables_).set("u_levels", int(levels_.size()));
    program.set("u_neighbours", neighbours_).set("u_texels", texels_);
}

Status ImplicitPasses::createPrograms(const ContactPass& pushes) {
    const gpu::ShaderLibrary library;
    std::vector<gpu::ShaderDefine> defines = tissueDefines(setup_.tissue);
    if (!pushes.empty()) {
        defines.push_back({"SRS_CONTACT", "1"});
        const std::vector<gpu::ShaderDefine> colliders = pushes.colliders().defines();
        defines.insert(defines.end(), colliders.begin(), colliders.end());
    }
    const struct {
        gpu::Program* program;
        const char* file;
    } all[] = {{&begin_, "begin"},
               {&cells_, "cells"},
               {&linearize_, "linearize"},
               {&coarsenCells_, "coarsen_cells"},
               {&coarsenNodes_, "coarsen_nodes"},
               {&invert_, "invert"},
               {&pull_, "pull"},
               {&apply_, "apply"},
               {&update_, "update"},
               {&restrict_, "restrict"},
               {&tailProgram_, "tail"},
               {&prolong_, "prolong"},
               {&direction_, "direction"},
               {&changes_, "changes"},
               {&take_, "take"},
               {&finish_, "finish"}};
    const double dt = setup_.timeStep;
    for (const auto& [program, file] : all) {
        SEROSA_ASSIGN(*program,
                      gpu::Program::create(library, {std::string("implicit_") + file + ".comp"}, defines));
        const auto mentions = [&](std::initializer_list<gpu::Program*> users) {
            return std::find(users.begin(), users.end(), program) != users.end();
        };
        if (mentions({&update_, &direction_, &take_})) {
            program->buffer("b_vectors", vectors_).buffer("b_sums", sums_).buffer("b_progress", progress_);
            program->set("u_nodes", int(setup_.lattice->nodeCount())).set("u_groups", groups_);
        } else {
            share(*program);
        }
        const bool volume = setup_.tissue.volumetric();
        if (mentions({&cells_, &linearize_, &pull_, &changes_}) || (volume && mentions({&apply_}))) {
            program->buffer("b_cells", cellArrays_).buffer("b_cellShares", cellShares_);
            program->buffer("b_connections", connections_).set("u_cells", int(setup_.lattice->cells.size()));
        }
        if (mentions({&begin_, &finish_}))
            program->buffer("b_connections", connections_);
        if (mentions({&linearize_, &changes_}))
            program->buffer("b_weights", weights_)
                .set("u_damping", float(setup_.tissue.dampingTime / dt))
                .set("u_gravity", glm::vec3(setup_.gravity * (dt * dt / setup_.lattice->spacing)));
        if (mentions({&linearize_, &changes_, &apply_}))
            program->set("u_drag", float(setup_.tissue.airDrag * dt));
        if (mentions({&linearize_, &apply_}))
            program->buffer("b_springs", springs_);
        if (mentions({&linearize_, &coarsenNodes_, &invert_, &restrict_, &tailProgram_, &prolong_}))
            program->buffer("b_levels", levelArrays_);
        if (mentions({&cells_, &coarsenCells_, &coarsenNodes_, &invert_}))
            program->buffer("b_quadratures", quadratures_);
        if (mentions({&invert_, &tailProgram_}))
            program->buffer("b_coarsest", coarsest_);
    }
    begin_.buffer("b_masses", masses_);
    setMaterials(cells_, setup_, true, true);
    setMaterials(changes_, setup_, setup_.tissue.volumetric(), false);
    setMaterials(linearize_, setup_, false, false);
    tailProgram_.set("u_level", tail_);
    const double accuracy = (pushes.empty() ? 1 : SRS_SUPPORTED_ACCURACY) * limits_.accuracy;
    direction_.set("u_accuracy", float(accuracy * accuracy))
        .set("u_floor", float(limits_.floor * limits_.floor * totalMass_));
    return {};
}

void ImplicitPasses::run(gpu::Program& program, std::size_t items) {
    program.dispatch({int(items), 1, 1});
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

/// z from r. \param wanted the iteration that must not be over for it, \param prepared the one that needs it
void ImplicitPasses::precondition(int wanted, int prepared) {
    for (int level = 1; level < tail_; ++level) {
        restrict_.set("u_level", level).set("u_iteration", wanted);
        run(restrict_, levels_[std::size_t(level)].nodes.size());
    }
    tailProgram_.set("u_iteration", wanted);
    run(tailProgram_, 1);
    prolong_.set("u_iteration", prepared);
    for (int level = tail_ - 1; level > 0; --level) {
        prolong_.set("u_level", level);
        run(prolong_, levels_[std::size_t(level)].nodes.size());
    }
    prolong_.set("u_level", 0);
    runSums(prolong_);
    direction_.set("u_iteration", prepared);
    runSums(direction_);
}

void ImplicitPasses::linearize() {
    run(cells_, setup_.lattice->cells.size());
    run(linearize_, setup_.lattice->nodeCount());
}

void ImplicitPasses::newtonRound(int round, bool pulled) {
    linearize();
    for (std::size_t level = 1; level < levels_.size(); ++level) {
        coarsenCells_.set("u_level", int(level));
        run(coarsenCells_, levels_[level].cells.size());
        coarsenNodes_.set("u_level", int(level));
        run(coarsenNodes_, levels_[level].nodes.size());
    }
    run(invert_, 1);
    const bool volume = setup_.tissue.volumetric();
    const auto apply = [&](int vector, int iteration) {
        if (volume) {
            pull_.set("u_vector", vector).set("u_iteration", iteration);
            run(pull_, setup_.lattice->cells.size());
        }
        apply_.set("u_vector", vector).set("u_iteration", iteration);
        runSums(apply_);
        update_.set("u_iteration", iteration);
        runSums(update_);
    };
    if (pulled)
        apply(SRS_VEC_S, -1);
    direction_.set("u_round", contact_.empty() ? round : 0);
    precondition(0, 0);
    for (int i = 0; i < limits_.iterations; ++i) {
        apply(SRS_VEC_P, i);
        precondition(i, i + 1);
    }
    const glm::vec4 shares(1, 0.5, 0.2, 0.04);
    changes_.set("u_shares", shares);
    runSums(changes_);
    take_.set("u_shares", shares).set("u_mode", pulled ? 2 : 1);
    runSums(take_);
}

void ImplicitPasses::step(StateTextures& textures, std::int64_t step) {
    const std::size_t nodes = setup_.lattice->nodeCount();
    const bool contact = !contact_.empty();
    const auto start = std::size_t(textures.current_);
    bool holding = false;
    if (contact) {
        for (const ToolMotion& motion : contact_.asks().colliders().motions(step))
            holding = holding || (motion.mode == SRS_TOOL_GRASP && !std::isfinite(motion.grip));
        contact_.close(textures, step);
        contact_.bind(begin_, step);
    }
    begin_.image("i_nodeInfo", textures.nodeInfo(), GL_READ_ONLY);
    begin_.image("i_positions", textures.positions(), GL_READ_ONLY);
    begin_.image("i_increments", textures.increments(), GL_READ_ONLY);
    begin_.image("i_earlier", textures.earlier_, GL_READ_ONLY);
    run(begin_, nodes);
    if (contact)
        textures.current_ = 1 - textures.current_;

    const glm::vec4 shares(1, 0.75, 0.5, 0.25);
    changes_.set("u_shares", shares);
    runSums(changes_);
    take_.set("u_shares", shares).set("u_mode", 0);
    runSums(take_);
    const int rounds = contact ? limits_.supportedRounds : limits_.rounds;
    for (int round = 0; round < rounds; ++round) {
        if (contact)
            contact_.support(textures, step, round);
        newtonRound(round, holding && round == 0);
    }
    if (contact) {
        contact_.take(textures, rounds);
        linearize();
        contact_.countLoads(textures, step);
    }
    const auto current = std::size_t(textures.current_);
    finish_.image("i_newPositions", textures.positions_[current], GL_WRITE_ONLY);
    finish_.image("i_increments", textures.increments_[start], GL_READ_ONLY);
    finish_.image("i_newIncrements", textures.increments_[current], GL_WRITE_ONLY);
    finish_.image("i_newEarlier", textures.earlier_, GL_WRITE_ONLY);
    run(finish_, nodes);
    glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
    if (contact)
        contact_.finish(textures, step);
}

ImplicitEffort ImplicitPasses::effort() const {
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    Progress progress;
    progress_.download(0, sizeof progress, &progress);
    return {limits_.rounds, progress.iterations, double(progress.share)};
}

std::size_t ImplicitPasses::bytes() const {
    std::size_t sum = 0;
    for (const gpu::Buffer* buffer :
         {&vectors_, &sums_, &progress_, &tables_, &cellArrays_, &cellShares_, &connections_, &masses_,
          &weights_, &springs_, &levelArrays_, &quadratures_, &coarsest_})
        sum += buffer->bytes();
    return sum + contact_.bytes();
}

} // namespace serosa::sim
