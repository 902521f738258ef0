// What each part of the law costs: one step with it over one step of plain springs, for every solver that is
// meant to be fast, in one interleaved table. A row more is one entry more in rows().

#include "app/solver_choice.h"
#include "bench/cases.h"
#include "gpu/gl.h"
#include "sim/cpu_solver.h"

#include <functional>
#include <map>

namespace serosa::bench {

namespace {

constexpr double kYoung = 5000, kFrame = 1.0 / 60;
constexpr int kEdge = 27; // nodes along an edge of the block

/// What a row changes of the block of plain springs; what is not set stays.
struct Row {
    std::string name;
    std::function<void(sim::SolverSetup& setup)> setup;
    std::function<void(sim::LatticeCell& cell)> cell;
    std::function<Status(sim::Solver& solver, const sim::Lattice& lattice)> prepare;
    bool normalsEveryStep = false, fills = true;
};

/// A blade across the whole block, a quarter of the way between two planes of nodes. \param share of the
/// width at which it cuts
sim::Stroke bladeAcross(const sim::Lattice& lattice, double share) {
    const double middle = std::floor(share * kEdge) - 0.5 * kEdge + 0.25, reach = kEdge;
    const auto at = [&](double y, double z) { return lattice.toWorld({middle, y, z}); };
    sim::Stroke stroke;
    stroke.from = {at(-reach, -reach), at(-reach, reach)};
    stroke.to = {at(reach, -reach), at(reach, reach)};
    return stroke;
}

sim::Tool probe(const sim::Lattice& lattice, double x) {
    const glm::dvec3 top = lattice.toWorld({x, 0.5 * kEdge + 2, 0});
    return {"probe", sim::ToolMode::push, 4 * lattice.spacing, {{0, top}}};
}

/// Layers along x of so many materials, each a fifth stiffer than the one before.
Row layers(const std::string& name, int count) {
    Row row;
    row.name = name;
    row.setup = [count](sim::SolverSetup& setup) {
        for (int i = 1; i < count; ++i) {
            sim::Material next = setup.tissue.material(std::size_t(i - 1));
            next.name = "layer " + std::to_string(i);
            next.young *= 1.2;
            setup.tissue.others.push_back(next);
        }
    };
    row.cell = [count](sim::LatticeCell& cell) { cell.material = std::uint8_t(cell.grid.x % count); };
    return row;
}

std::vector<Row> rows() {
    std::vector<Row> list;
    const auto add = [&list](const char* name) -> Row& {
        list.push_back({});
        list.back().name = name;
        return list.back();
    };
    const auto change = [&add](const char* name, void (*setup)(sim::SolverSetup&)) {
        add(name).setup = setup;
    };
    add("plain springs, damped, normals in the last step"); // what the others are compared with
    add("every cell counted as full (no fills read)").fills = false;
    add("normals in every step").normalsEveryStep = true;
    change("without damping", [](sim::SolverSetup& setup) { setup.tissue.dampingTime = 0; });
    change("Poisson's ratio 0.45", [](sim::SolverSetup& setup) { setup.tissue.poisson = 0.45; });
    change("recovery", [](sim::SolverSetup& setup) { setup.tissue.recovery = true; });
    list.push_back(layers("two materials", 2));
    list.push_back(layers("eight materials", 8));
    change("fibres", [](sim::SolverSetup& setup) {
        setup.tissue.fibre = {1, 0.3, 0};
        setup.tissue.fibreYoung = 2 * setup.tissue.young;
    });
    change("stiffening curve", [](sim::SolverSetup& setup) {
        const double young = setup.tissue.young;
        setup.tissue.curve = {{0.1, 0.1 * young}, {0.3, 0.9 * young}};
    });
    change("strain limit", [](sim::SolverSetup& setup) { setup.tissue.strainLimit = 0.3; });
    change("one probe", [](sim::SolverSetup& setup) { setup.tools = {probe(*setup.lattice, 0)}; });
    change("four probes", [](sim::SolverSetup& setup) {
        for (const double x : {-9.0, -3.0, 3.0, 9.0})
            setup.tools.push_back(probe(*setup.lattice, x));
    });
    add("cut into five pieces").prepare = [](sim::Solver& solver, const sim::Lattice& lattice) -> Status {
        for (const double share : {0.2, 0.4, 0.6, 0.8})
            SEROSA_TRY(solver.cut(bladeAcross(lattice, share)));
        return {};
    };
    Row& cutBulky = add("the same, Poisson's ratio 0.45");
    cutBulky.setup = [](sim::SolverSetup& setup) { setup.tissue.poisson = 0.45; };
    cutBulky.prepare = list[list.size() - 2].prepare;
    return list;
}

constexpr const char* kSolvers[] = {"fragment", "compute", "cpu"};

Result<std::unique_ptr<sim::Solver>> makeSolver(const std::string& solver, const Row& row,
                                                const sim::SolverSetup& setup) {
    if (solver == "cpu")
        return sim::makeCpuSolver(setup, {0, row.normalsEveryStep});
    if (solver == "compute") {
        sim::ComputeOptions options;
        options.normalsEveryStep = row.normalsEveryStep;
        options.fills = row.fills;
        return sim::makeComputeSolver(setup, options);
    }
    sim::FragmentOptions options;
    options.normalsEveryStep = row.normalsEveryStep;
    options.fills = row.fills;
    return sim::makeFragmentSolver(setup, options);
}

/// A row's organ, and its solvers; kernels that do not read fills are of the textures alone.
struct Measured {
    std::unique_ptr<Block> block;
    double stepsPerSecond = 0; // simulated
    std::map<std::string, std::unique_ptr<sim::Solver>> solvers;
};

Result<Measured> prepare(const Row& row) {
    sim::Lattice plain = denseLattice(kEdge);
    std::vector<sim::LatticeCell> cells = plain.cells;
    if (row.cell)
        for (sim::LatticeCell& cell : cells)
            row.cell(cell);
    Measured measured;
    measured.block = std::make_unique<Block>(
        sim::latticeFromCells(std::move(cells), plain.spacing, plain.origin), kYoung, kFrame);
    sim::SolverSetup& setup = measured.block->setup;
    if (row.setup)
        row.setup(setup);
    setup.timeStep = sim::stableStep(measured.block->lattice, setup.tissue, kFrame).timeStep;
    measured.stepsPerSecond = 1 / setup.timeStep;
    for (const std::string solver : kSolvers) {
        if (solver == "cpu" && !row.fills)
            continue;
        SEROSA_ASSIGN(measured.solvers[solver], makeSolver(solver, row, setup));
        if (row.prepare)
            SEROSA_TRY(row.prepare(*measured.solvers[solver], measured.block->lattice));
    }
    return measured;
}

/// A stroke across the block and its undoing, which gives the next one something to cut.
Status benchStroke(const Options& options, Report& report) {
    const Block block(denseLattice(kEdge), kYoung);
    const sim::Stroke stroke = bladeAcross(block.lattice, 0.5);
    std::map<std::string, std::unique_ptr<sim::Solver>> solvers;
    Rounds rounds;
    Status failed;
    for (const std::string name : kSolvers) {
        SEROSA_ASSIGN(solvers[name], app::makeSolver(name, block.setup));
        addSolver(rounds, name + ", a step", *solvers[name]);
        rounds.add(name, [&solver = *solvers[name], &stroke, &failed](int repeats) {
            for (int i = 0; i < repeats && failed.ok(); ++i) {
                failed = solver.cut(stroke);
                solver.undoCut();
            }
            glFinish();
        });
    }
    rounds.measure(options.rounds, options.seconds);
    SEROSA_TRY(failed);
    std::vector<std::vector<std::string>> table;
    for (const std::string name : kSolvers)
        table.push_back(
            {name, figure(rounds.milliseconds(name)), figure(rounds.ratio(name, name + ", a step"))});
    report.heading("A stroke of a blade through the whole block, and its undoing");
    report.table({"solver", "ms", "over a step"}, table);
    return {};
}

} // namespace

Status benchTissue(const Options& options, Report& report) {
    const std::vector<Row> list = rows();
    std::vector<Measured> measured;
    Rounds rounds;
    for (const Row& row : list) {
        SEROSA_ASSIGN(Measured one, prepare(row));
        measured.push_back(std::move(one));
        for (const auto& [name, solver] : measured.back().solvers)
            addSolver(rounds, name + row.name, *solver);
    }
    rounds.measure(options.rounds, options.seconds);

    std::vector<std::vector<std::string>> table;
    for (std::size_t i = 0; i < list.size(); ++i) {
        std::vector<std::string> line{list[i].name, figure(measured[i].stepsPerSecond)};
        for (const std::string name : kSolvers) {
            const bool there = measured[i].solvers.count(name) > 0;
            line.push_back(there ? figure(rounds.milliseconds(name + list[i].name).median) : "-");
            line.push_back(there ? figure(rounds.ratio(name + list[i].name, name + list[0].name)) : "-");
        }
        table.push_back(std::move(line));
    }
    report.heading("What tissue, tools and cuts cost a step, dense block of 27^3 nodes, 5 kPa");
    std::vector<std::string> columns{"block", "steps a simulated second"};
    for (const std::string name : kSolvers)
        columns.insert(columns.end(), {name + ", ms a step", "over plain"});
    report.table(columns, table);
    return benchStroke(options, report);
}

} // namespace serosa::bench
