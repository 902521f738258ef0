// Group `lod`: a heart that swings and tumbles is handed from level of detail to level of detail, on the GPU
// and on the CPU. Momentum, free fall, the fine shape and the drawn surface are compared across each switch;
// the levels' sag under their weight; and what the GPU's tree answers with loops over all triangles.
#include "app/verify/lattice_statics.h"
#include "app/verify/verify.h"
#include "models/phantom.h"
#include "render/surface_renderer.h"
#include "shaders/shared_constants.h"
#include "sim/lod_pass.h"
#include "sim/tissue_field.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>

namespace serosa::app {

namespace {

using sim::LatticeState;

constexpr double kMillimetre = 1e-3, kFrame = 1.0 / 60;
constexpr std::size_t kHeartFaces = 12000;

/// One level of the heart.
struct Level {
    std::unique_ptr<sim::Lattice> lattice;
    sim::SolverSetup setup;
    std::unique_ptr<sim::Solver> solver;
    render::SurfaceBinding binding;
    int steps = 0; // a frame
};

/// A heart on its levels, stepped in textures (`fragment`) or in double.
class Heart {
public:
    sim::TriangleMesh metres;
    std::vector<Level> levels;
    std::vector<sim::LodPass> passes; // levels i and i + 1

    /// \param held the vessels above are fixed
    static Result<Heart> make(std::size_t nodes, bool held, double gravity, bool onGpu) {
        Heart heart;
        heart.onGpu_ = onGpu;
        SEROSA_ASSIGN(heart.metres, models::makePhantom("heart", kHeartFaces));
        for (glm::dvec3& position : heart.metres.positions)
            position *= kMillimetre;
        for (int level = 0; level < sim::kMostLevels; ++level)
            SEROSA_TRY(heart.addLevel(nodes, held, gravity));
        for (std::size_t i = 0; onGpu && i + 1 < heart.levels.size(); ++i) {
            const Level &fine = heart.levels[i], &coarse = heart.levels[i + 1];
            SEROSA_ASSIGN(sim::LodPass pass,
                          sim::LodPass::create(fine.setup, fine.solver->textures()->layout(), coarse.setup,
                                               coarse.solver->textures()->layout()));
            heart.passes.push_back(std::move(pass));
        }
        return heart;
    }

    /// Motion that no level is at home in: it swings, twists, and is bent.
    void start(const glm::dvec3& drift) {
        const Level& own = levels.front();
        LatticeState state = sim::restState(*own.lattice);
        for (std::size_t i = 0; i < state.positions.size(); ++i) {
            if (!own.setup.fixed.empty() && own.setup.fixed[i])
                continue;
            const glm::dvec3 p = own.lattice->toWorld(state.positions[i]);
            const glm::dvec3 v = drift + glm::cross(glm::dvec3(2, 4, -3), p) +
                                 0.1 * glm::sin(40.0 * glm::dvec3(p.y, p.z, p.x));
            state.increments[i] = glm::vec3(own.setup.timeStep / own.lattice->spacing * v);
        }
        own.solver->setState(state);
        active_ = 0;
        frame_ = 0;
    }

    Level& active() { return levels[active_]; }
    int frame() const { return frame_; }
    void frames(int count) {
        for (int i = 0; i < count; ++i, ++frame_) {
            if (active().steps > 1)
                active().solver->advance(active().steps - 1);
            before_ = active().solver->state().increments;
            active().solver->advance(1);
        }
    }
    /// Momentum at the half step before now of another time step, by the last two increments.
    sim::Momentum momentumFor(double timeStep) {
        LatticeState state = active().solver->state();
        const double lead = sim::lodLead(active().setup.timeStep, timeStep);
        for (std::size_t i = 0; i < before_.size(); ++i)
            state.increments[i] += lead * (state.increments[i] - before_[i]);
        return sim::momentumOf(active().setup, state);
    }
    /// To a neighbouring level.
    void change(std::size_t level) {
        Level &from = levels[active_], &to = levels[level];
        const double lead = sim::lodLead(from.setup.timeStep, to.setup.timeStep);
        const std::int64_t step = std::int64_t(frame_) * to.steps;
        if (onGpu_) {
            sim::StateTextures* textures = to.solver->replaceState(step);
            level > active_ ? passes[active_].toCoarser(*from.solver->textures(), *textures, lead)
                            : passes[level].toFiner(*from.solver->textures(), *textures, lead);
        } else {
            const sim::LodTransfer transfer = sim::LodTransfer::make(from.setup, to.setup);
            to.solver->setState(
                sim::transferState(transfer, *to.lattice, from.solver->state(), before_, lead, step));
        }
        active_ = level;
    }

private:
    Status addLevel(std::size_t nodes, bool held, double gravity) {
        Level level;
        sim::LatticeRequest request;
        request.nodes = nodes;
        if (!levels.empty()) {
            const sim::Lattice& own = *levels.front().lattice;
            request.spacing = own.spacing * double(std::size_t(1) << levels.size());
            request.gridPoint = own.toWorld(-glm::dvec3(own.centre));
        }
        SEROSA_ASSIGN(sim::Lattice lattice, sim::buildLattice(metres, request));
        level.lattice = std::make_unique<sim::Lattice>(std::move(lattice));
        level.setup.lattice = level.lattice.get();
        level.setup.tissue.young = 2600;
        level.setup.tissue.dampingTime = 0.0002;
        level.setup.gravity = {0, -gravity, 0};
        if (!levels.empty())
            level.setup.tissue =
                sim::matchedTissue(levels.front().setup.tissue, *levels.front().lattice, *level.lattice);
        const sim::StableStep step = sim::stableStep(*level.lattice, level.setup.tissue, kFrame);
        level.setup.timeStep = step.timeStep;
        level.steps = step.stepsPerFrame;
        for (std::size_t i = 0; held && i < level.lattice->nodeCount(); ++i)
            level.setup.fixed.push_back(level.lattice->toWorld(level.lattice->restPosition(i)).y > 0.024);
        if (onGpu_) {
            SEROSA_ASSIGN(level.solver, sim::makeFragmentSolver(level.setup));
        } else {
            level.solver = sim::makeReferenceSolver(level.setup);
        }
        levels.push_back(std::move(level));
        return {};
    }

    bool onGpu_ = false;
    std::size_t active_ = 0;
    int frame_ = 0;
    std::vector<glm::dvec3> before_; // increments of the step before the last
};

double apart(const glm::dvec3& a, const glm::dvec3& b) {
    return glm::distance(a, b) / glm::length(b);
}

/// kg
double massOf(const sim::SolverSetup& setup) {
    const sim::TissueField field(*setup.lattice, setup.tissue);
    double mass = 0;
    for (std::size_t node = 0; node < setup.lattice->nodeCount(); ++node)
        mass += field.massShare(node);
    return mass * setup.tissue.nodeMass(setup.lattice->spacing);
}

void masses(const Heart& heart, CheckList& checks) {
    const sim::SolverSetup& own = heart.levels.front().setup;
    for (std::size_t i = 1; i < heart.levels.size(); ++i) {
        const sim::SolverSetup& setup = heart.levels[i].setup;
        const std::string of = "level " + std::to_string(i + 1) + ": ";
        checks.equalRel(of + "mass", massOf(setup), massOf(own), 1e-9, "kg");
        checks.atMost(of + "density taken to make it so, share",
                      std::abs(setup.tissue.density / own.tissue.density - 1), 0.01, "");
    }
}

/// Down and up again, while it moves.
constexpr std::size_t kWay[] = {1, 2, 1, 0, 1, 0};

/// Momentum across every switch; a free body's against Newton, whatever level it was on.
Status motion(const VerifyOptions& options, bool onGpu, bool held, CheckList& checks) {
    const double gravity = held ? 0 : 9.81;
    const std::size_t nodes = options.full && onGpu ? 20000 : onGpu ? 4000 : 1500;
    SEROSA_ASSIGN(Heart heart, Heart::make(nodes, held, gravity, onGpu));
    heart.start(held ? glm::dvec3(0) : glm::dvec3(0.4, 0.1, 0.2));
    const sim::SolverSetup& own = heart.levels.front().setup;
    const double mass = massOf(own), firstStep = own.timeStep;
    const glm::dvec3 first = sim::momentumOf(own, heart.active().solver->state()).linear;
    double linear = 0, angular = 0, newton = 0;
    for (const std::size_t level : kWay) {
        heart.frames(4);
        const sim::Momentum before = heart.momentumFor(heart.levels[level].setup.timeStep);
        heart.change(level);
        const sim::Momentum after = sim::momentumOf(heart.active().setup, heart.active().solver->state());
        linear = std::max(linear, apart(after.linear, before.linear));
        angular = std::max(angular, apart(after.angular, before.angular));
        // Increments are of half a step before.
        const double time = heart.frame() * kFrame - 0.5 * (heart.active().setup.timeStep - firstStep);
        newton = std::max(newton, apart(after.linear, first + time * mass * glm::dvec3(0, -gravity, 0)));
    }
    const std::string of = std::string(held ? "held heart" : "free heart") + ", " +
                           heart.active().solver->name() + ", 6 switches: ";
    checks.atMost(of + "change of momentum", linear, 1e-4, "");
    checks.atMost(of + "change of angular momentum about its centre", angular, 1e-4, "");
    if (!held)
        checks.atMost(of + "momentum against m (v + g t)", newton, 1e-4, "");
    return {};
}

/// Of the detailed surface as it is drawn: the jump at the switch, the largest step of the fading after it
/// (the lattice stands still), and what would jump without it. In spacings of the finer level.
struct SurfaceMoves {
    double jump = 0, step = 0, unfaded = 0;
};
double farthest(const std::vector<glm::dvec3>& a, const std::vector<glm::dvec3>& b) {
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        most = std::max(most, glm::distance(a[i], b[i]));
    return most;
}

Status surface(const VerifyOptions& options, CheckList& checks) {
    SEROSA_ASSIGN(Heart heart, Heart::make(options.full ? 20000 : 4000, true, 0, true));
    masses(heart, checks);
    constexpr sim::Mapping kMapping = sim::Mapping::curvature;
    std::optional<render::SurfaceRenderer> renderer;
    for (Level& level : heart.levels) {
        level.binding = render::bindSurface(*level.lattice, heart.metres, kMapping);
        if (!renderer) {
            SEROSA_ASSIGN(render::SurfaceRenderer made,
                          render::SurfaceRenderer::create(*level.lattice, heart.metres, level.binding,
                                                          *level.solver->textures(), 64, 64));
            renderer.emplace(std::move(made));
        } else {
            SEROSA_TRY(renderer->addLevel(0, *level.lattice, heart.metres, level.binding,
                                          *level.solver->textures()));
        }
    }
    const auto drawn = [&] {
        return renderer->readDeformedPositions(*heart.active().solver->textures(), kMapping);
    };
    heart.start(glm::dvec3(0));
    SurfaceMoves down, up;
    std::size_t active = 0;
    for (const std::size_t level : kWay) {
        heart.frames(4);
        const std::vector<glm::dvec3> before = drawn();
        const sim::StateTextures& from = *heart.active().solver->textures();
        const double h = std::min(heart.active().lattice->spacing, heart.levels[level].lattice->spacing),
                     finest = heart.levels.front().lattice->spacing;
        heart.change(level);
        renderer->useLevel(0, level, from, *heart.active().solver->textures(), kMapping, finest);
        SurfaceMoves& moves = level > active ? down : up;
        active = level;
        std::vector<glm::dvec3> last = drawn();
        moves.jump = std::max(moves.jump, farthest(last, before) / h);
        for (int i = 1; i <= int(SRS_BLEND_MOST_FRAMES); ++i) {
            renderer->setBlendFrame(0, i);
            const std::vector<glm::dvec3> next = drawn();
            moves.step = std::max(moves.step, farthest(next, last) / h);
            last = next;
        }
        moves.unfaded = std::max(moves.unfaded, farthest(last, before) / h); // all has faded
    }
    for (const auto& [name, moves] : {std::pair("to coarser", &down), std::pair("to finer", &up)}) {
        const std::string of = std::string("drawn surface, ") + name + ": ";
        checks.atMost(of + "jump at the switch", moves->jump, 0.1, "h");
        checks.atMost(of + "most that the fading moves it in a frame", moves->step, 0.1, "h");
        checks.atLeast(of + "what fades (there is something to hide)", moves->unfaded, 0.1, "h");
    }
    return {};
}

/// Down and up at once: the fine lattice is where it was.
Status fineShape(CheckList& checks) {
    SEROSA_ASSIGN(Heart heart, Heart::make(4000, true, 0, true));
    heart.start(glm::dvec3(0));
    heart.frames(6);
    const LatticeState before = heart.active().solver->state();
    const sim::LodTransfer up = sim::LodTransfer::make(heart.levels[1].setup, heart.levels[0].setup);
    heart.change(1);
    const LatticeState coarse = heart.active().solver->state();
    heart.change(0);
    const LatticeState after = heart.active().solver->state();
    const LatticeState plain = sim::transferState(up, *heart.levels[0].lattice, coarse, {}, 0, 0);
    checks.atMost("to coarser and back: nodes that moved, largest",
                  farthest(after.positions, before.positions), 1e-4, "h");
    checks.atLeast("the same without the detail that is kept", farthest(plain.positions, before.positions),
                   0.05, "h");
    return {};
}

/// Linear statics under its own weight: mean displacement along gravity (which is twice the energy), m.
double sagOf(const sim::SolverSetup& setup) {
    const sim::Lattice& lattice = *setup.lattice;
    const sim::TissueField field(lattice, setup.tissue);
    LatticeProblem problem(lattice);
    // Of a full node, in k h.
    const double weight = 9.81 / (setup.tissue.stiffnessOverMass(lattice.spacing) * lattice.spacing);
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        if (setup.fixed[node])
            problem.hold(node);
        else
            problem.push(node, {0, -weight * field.massShare(node), 0});
    const Eigen::VectorXd moved = problem.solve(setup.tissue);
    double sum = 0, mass = 0;
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
        sum -= field.massShare(node) * nodeVector(moved, node).y * lattice.spacing;
        mass += field.massShare(node);
    }
    return sum / mass;
}

/// The same material sags alike on all levels where its lattice resolves the shape: a solid beam, clamped. A
/// thin wall in a coarse cell counts as a thick one of little stiffness, and bends less: the heart.
Status sag(const VerifyOptions& options, CheckList& checks) {
    constexpr double kLength = 0.12, kWidth = 0.03, kSpacing = 0.0025; // m
    double first = 0;
    for (int level = 1; level <= sim::kMostLevels; ++level) {
        const int times = 1 << (level - 1), across = int(std::lround(kWidth / (kSpacing * times)));
        std::vector<sim::LatticeCell> cells;
        for (int z = 0; z < across; ++z)
            for (int y = 0; y < across; ++y)
                for (int x = 0; x < across * int(kLength / kWidth); ++x)
                    cells.push_back({{x, y, z}, 255});
        const sim::Lattice lattice = sim::latticeFromCells(cells, kSpacing * times, glm::dvec3(0));
        sim::SolverSetup setup;
        setup.lattice = &lattice;
        for (const glm::ivec3& node : lattice.nodes)
            setup.fixed.push_back(node.x == 0);
        const double sag = sagOf(setup);
        if (level == 1)
            first = sag;
        else
            checks.equalRel("sag of a clamped beam, " + std::to_string(across) + " cells across against 12",
                            1e3 * sag, 1e3 * first, level == 2 ? 0.05 : 0.12, "mm");
    }
    SEROSA_ASSIGN(Heart heart, Heart::make(options.full ? 20000 : 4000, true, 9.81, false));
    for (std::size_t i = 0; i < heart.levels.size(); ++i) {
        const double sag = sagOf(heart.levels[i].setup);
        if (i == 0)
            first = sag;
        else
            checks.equalRel("sag of a hollow heart, level " + std::to_string(i + 1) + " against level 1",
                            1e3 * sag, 1e3 * first, i == 1 ? 0.4 : 0.6, "mm");
    }
    return {};
}

} // namespace

Status verifyLod(const VerifyOptions& options, CheckList& checks) {
    SEROSA_TRY(motion(options, true, false, checks));
    SEROSA_TRY(motion(options, true, true, checks));
    SEROSA_TRY(motion(options, false, false, checks));
    SEROSA_TRY(surface(options, checks));
    SEROSA_TRY(fineShape(checks));
    SEROSA_TRY(sag(options, checks));
    return verifyNodeTree(options, checks);
}

} // namespace serosa::app
