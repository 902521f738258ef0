// What contact, friction, grasps and the readback of forces cost: whole frames with them over frames without,
// for every solver that is meant to be fast, in one interleaved table. Frames are not waited for one by one:
// where loads are not asked for, the CPU runs ahead of the GPU as in a viewer.

#include "app/solver_choice.h"
#include "bench/cases.h"
#include "gpu/gl.h"
#include "sim/cpu_solver.h"

#include <functional>
#include <limits>
#include <map>

namespace serosa::bench {

namespace {

constexpr double kYoung = 5000;
constexpr int kEdge = 27; // nodes along an edge of the block
constexpr int kSteps = 8; // a frame; about what the step's bound asks for
constexpr int kSettle = 240;

enum class Loads { none, ring, atOnce };

struct Row {
    std::string name;
    std::function<void(sim::SolverSetup& setup)> setup;
    Loads loads = Loads::none;
};

/// \param x, up in spacings from the middle of the block's top
sim::Tool tool(const sim::Lattice& lattice, sim::ShapeKind kind, double x, double up) {
    const double h = lattice.spacing;
    sim::Tool tool;
    tool.name = "tool";
    tool.shape.kind = kind;
    tool.radius = kind == sim::ShapeKind::box ? 0.2 * h : 4 * h;
    if (kind == sim::ShapeKind::capsule) {
        tool.radius = 0.5 * h;
        tool.shape.length = 20 * h;
    }
    if (kind == sim::ShapeKind::box)
        tool.shape.halfSize = glm::dvec3(0.5, 3, 3) * h;
    tool.shape.radius = tool.radius;
    // A capsule lies from its end along z: turned, it stands on it.
    const glm::dquat turn = kind == sim::ShapeKind::capsule
                                ? glm::angleAxis(glm::radians(-90.0), glm::dvec3(1, 0, 0))
                                : glm::dquat(1, 0, 0, 0);
    tool.keys = {{0, lattice.toWorld({x, 0.5 * (kEdge - 1) + up, 0}), turn}};
    return tool;
}

std::vector<sim::Tool> tools(const sim::Lattice& lattice, double up, double friction) {
    std::vector<sim::Tool> all = {tool(lattice, sim::ShapeKind::sphere, -7, 4 + up),
                                  tool(lattice, sim::ShapeKind::capsule, 0, 0.5 + up),
                                  tool(lattice, sim::ShapeKind::box, 7, 3.2 + up)};
    for (sim::Tool& one : all)
        one.friction = friction;
    return all;
}

/// Below the block, whose lowest nodes are no longer fixed.
void putOnFloor(sim::SolverSetup& setup, double below, double friction) {
    sim::Body floor;
    floor.name = "floor";
    floor.shape.kind = sim::ShapeKind::halfSpace;
    floor.shape.radius = 0;
    floor.friction = friction;
    floor.pose.at = setup.lattice->toWorld({0, -0.5 * (kEdge - 1) - below, 0});
    setup.bodies = {floor};
    if (below <= 0)
        setup.fixed.assign(setup.fixed.size(), false);
}

std::vector<Row> rows() {
    std::vector<Row> list;
    const auto add = [&list](const char* name, std::function<void(sim::SolverSetup&)> setup,
                             Loads loads = Loads::none) {
        list.push_back({name, std::move(setup), loads});
    };
    const auto press = [](double up, double friction) {
        return [up, friction](sim::SolverSetup& setup) { setup.tools = tools(*setup.lattice, up, friction); };
    };
    add("nothing to touch", [](sim::SolverSetup&) {}); // what the others are compared with
    add("sphere, probe and blade far away", press(20, 0));
    add("the same pressed in by 1.5 spacings", press(-1.5, 0));
    add("with friction", press(-1.5, 0.3));
    add("with friction, loads through the ring", press(-1.5, 0.3), Loads::ring);
    add("with friction, loads waited for in each frame", press(-1.5, 0.3), Loads::atOnce);
    add("a floor far below", [](sim::SolverSetup& setup) { putOnFloor(setup, 20, 0); });
    add("lying on a floor, friction", [](sim::SolverSetup& setup) { putOnFloor(setup, 0, 0.3); });
    add("a grasp with a grip of 0.05 N", [](sim::SolverSetup& setup) {
        setup.tools = {tool(*setup.lattice, sim::ShapeKind::sphere, 0, 1)};
        setup.tools[0].mode = sim::ToolMode::grasp;
        setup.tools[0].gripForce = 0.05;
        sim::ToolKey away = setup.tools[0].keys[0];
        away.time = 1e6; // it never opens
        setup.tools[0].keys.push_back(away);
    });
    return list;
}

constexpr const char* kSolvers[] = {"fragment", "compute", "cpu"};

struct Measured {
    std::unique_ptr<Block> block;
    std::map<std::string, std::unique_ptr<sim::Solver>> solvers;
};

Result<Measured> prepare(const Row& row) {
    Measured measured;
    measured.block = std::make_unique<Block>(denseLattice(kEdge), kYoung);
    sim::SolverSetup& setup = measured.block->setup;
    setup.tissue.airDrag = 10; // comes to rest
    row.setup(setup);
    for (const char* solver : kSolvers) {
        SEROSA_ASSIGN(measured.solvers[solver], app::makeSolver(solver, setup));
        measured.solvers[solver]->advance(kSettle);
        measured.solvers[solver]->takeLoads();
    }
    return measured;
}

void playFrames(sim::Solver& solver, Loads loads, int frames) {
    for (int frame = 0; frame < frames; ++frame) {
        solver.advance(kSteps);
        if (loads == Loads::atOnce)
            solver.takeLoads();
        if (loads == Loads::ring) {
            solver.endFrame();
            solver.frameLoads();
        }
    }
    if (solver.textures())
        glFinish();
}

} // namespace

Status benchContact(const Options& options, Report& report) {
    const std::vector<Row> list = rows();
    std::vector<Measured> measured;
    Rounds rounds;
    for (const Row& row : list) {
        SEROSA_ASSIGN(Measured one, prepare(row));
        for (const char* solver : kSolvers)
            rounds.add(solver + row.name, [&solver = *one.solvers[solver], loads = row.loads](int repeats) {
                playFrames(solver, loads, repeats);
            });
        measured.push_back(std::move(one));
    }
    rounds.measure(options.rounds, options.seconds);

    report.heading("Contact: frames of " + std::to_string(kSteps) + " steps, block of " +
                   std::to_string(kEdge) + "^3 nodes");
    std::vector<std::string> columns = {""};
    for (const char* solver : kSolvers) {
        columns.push_back(std::string(solver) + ", ms a frame");
        columns.push_back("over the first");
    }
    std::vector<std::vector<std::string>> table;
    for (const Row& row : list) {
        table.push_back({row.name});
        for (const char* solver : kSolvers) {
            table.back().push_back(figure(rounds.milliseconds(solver + row.name).median));
            table.back().push_back(figure(rounds.ratio(solver + row.name, solver + list[0].name)));
        }
    }
    report.table(columns, table);
    for (const char* solver : kSolvers)
        report.ratio(std::string("loads_ring_over_none_") + solver,
                     rounds.ratio(solver + list[4].name, solver + list[3].name));
    return benchCoupling(options, report);
}

} // namespace serosa::bench
