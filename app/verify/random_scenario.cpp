// See app/verify/random_scenario.h.
#include "app/verify/random_scenario.h"

#include "app/organ_setup.h"
#include "models/phantom.h"
#include "shaders/shared_constants.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <set>
#include <tuple>

namespace serosa::app {

namespace {

constexpr double kFrameTime = 1.0 / 60;
constexpr double kFastestTool = 1; // m/s
constexpr std::size_t kFewestNodes = 60;

/// Meshing a phantom takes longer than a scenario.
Result<const sim::TriangleMesh*> phantomMesh(const std::string& name, std::size_t faces) {
    static std::mutex mutex;
    static std::map<std::string, sim::TriangleMesh> made;
    const std::lock_guard lock(mutex);
    if (!made.contains(name)) {
        SEROSA_ASSIGN(made[name], models::phantomInMetres(name, faces));
    }
    return &made[name];
}

/// Cells of a few balls, a random walk, or both, so that some hang on by an edge or a corner.
std::vector<sim::LatticeCell> blobCells(Random& random, std::size_t nodes) {
    std::set<std::tuple<int, int, int>> cells; // z, y, x
    const double radius = 0.5 * std::cbrt(double(nodes));
    const int balls = random.whole(1, 4);
    for (int ball = 0; ball < balls; ++ball) {
        const glm::dvec3 centre = random.within(radius);
        glm::dvec3 half(random.number(0.4, 1) * radius / std::cbrt(double(balls)));
        half.x *= random.number(0.5, 1.5);
        half.y *= random.number(0.5, 1.5);
        const glm::ivec3 low(glm::floor(centre - half)), high(glm::ceil(centre + half));
        for (int z = low.z; z <= high.z; ++z)
            for (int y = low.y; y <= high.y; ++y)
                for (int x = low.x; x <= high.x; ++x) {
                    const glm::dvec3 from = (glm::dvec3(x, y, z) + 0.5 - centre) / half;
                    if (glm::dot(from, from) < 1)
                        cells.emplace(z, y, x);
                }
    }
    glm::ivec3 at(0);
    for (int i = random.whole(0, 40); i > 0 || cells.size() < 27; --i) {
        cells.emplace(at.z, at.y, at.x);
        for (int axis = 0; axis < 3; ++axis)
            at[axis] += random.whole(-1, 1);
    }
    std::vector<sim::LatticeCell> list;
    const int fills = random.whole(0, 4);
    for (const auto& [z, y, x] : cells) {
        int fill = 255;
        if (fills == 1 || (fills == 2 && random.chance(0.2)))
            fill = random.whole(1, 255);
        else if ((fills == 3 && random.chance(0.2)) || (fills == 4 && random.chance(0.9)))
            fill = 1;
        list.push_back({{x, y, z}, std::uint8_t(fill)});
    }
    return list;
}

/// The middle and half the size of the rest lattice, m.
struct Bounds {
    glm::dvec3 middle{0};
    double radius = 0;
};
Bounds boundsOf(const sim::Lattice& lattice) {
    glm::dvec3 low(1e9), high(-1e9);
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
        low = glm::min(low, lattice.toWorld(lattice.restPosition(node)));
        high = glm::max(high, lattice.toWorld(lattice.restPosition(node)));
    }
    return {0.5 * (low + high), 0.5 * glm::length(high - low)};
}

/// A path from key to key at random speeds, around and through the organ, until `end`.
std::vector<sim::ToolKey> randomPath(Random& random, double time, const glm::dvec3& start,
                                     const Bounds& bounds, double reach, double end) {
    std::vector<sim::ToolKey> keys{{time, start}};
    while (keys.size() < 2 || (keys.back().time < end && keys.size() < 40)) {
        const glm::dvec3 to = bounds.middle + random.within(reach);
        const bool first = keys.size() == 1; // must arrive in time to do something
        const double speed =
            random.chance(first ? 0.7 : 0.3) ? kFastestTool : random.logNumber(0.02, kFastestTool);
        const double path = std::max(glm::length(to - keys.back().at), 1e-4);
        keys.push_back({keys.back().time + path / speed, to});
    }
    return keys;
}

/// \param pushes else it grasps
sim::Tool randomTool(Random& random, bool pushes, const sim::Lattice& lattice, const Bounds& bounds,
                     double end) {
    sim::Tool tool;
    tool.name = "tool";
    tool.radius = random.number(1.5, 4) * lattice.spacing;
    if (pushes) {
        // From where it touches nothing.
        const glm::dvec3 start =
            bounds.middle + random.direction() * (bounds.radius + tool.radius + 2 * lattice.spacing);
        tool.keys = randomPath(random, 0, start, bounds, bounds.radius + tool.radius, end);
        return tool;
    }
    tool.mode = sim::ToolMode::grasp;
    const std::size_t node = std::size_t(random.whole(0, int(lattice.nodeCount()) - 1));
    const glm::dvec3 at = lattice.toWorld(lattice.restPosition(node));
    const double closes = random.number(0, 0.3) * end, opens = random.number(0.5, 1) * end,
                 reach = random.number(0.2, 1) * bounds.radius;
    tool.keys = randomPath(random, closes, at, {at, 0}, reach, opens);
    return tool;
}

sim::Cut randomCut(Random& random, const sim::Lattice& lattice, const Bounds& bounds, double end) {
    sim::Cut cut;
    double time = random.number(0, 0.8) * end;
    const auto point = [&] { return bounds.middle + random.within(bounds.radius); };
    if (random.chance(0.25)) {
        cut.kind = sim::StrokeKind::cauterize;
        cut.radius = random.number(0.5, 2) * lattice.spacing;
        cut.keys = {{time, point(), glm::dvec3(0)}};
        return cut;
    }
    const glm::dvec3 edge = random.within(2 * bounds.radius, 0.15);
    for (int keys = random.whole(2, 4); keys > 0; --keys) {
        const glm::dvec3 at = point();
        if (!cut.keys.empty())
            time +=
                std::max(1e-4, glm::length(at - cut.keys.back().at) / random.logNumber(0.05, kFastestTool));
        cut.keys.push_back({time, at, at + edge + random.within(0.3 * bounds.radius)});
    }
    return cut;
}

std::vector<bool> randomFixed(Random& random, const sim::Lattice& lattice, const Bounds& bounds) {
    std::vector<bool> fixed(lattice.nodeCount(), false);
    const glm::dvec3 normal = random.direction();
    const double level = random.number(-0.7, -0.1) * bounds.radius;
    std::size_t held = 0;
    for (std::size_t node = 0; node < fixed.size(); ++node) {
        fixed[node] = glm::dot(lattice.toWorld(lattice.restPosition(node)) - bounds.middle, normal) < level;
        held += fixed[node];
    }
    return held == fixed.size() ? std::vector<bool>() : fixed;
}

} // namespace

double Random::logNumber(double low, double high) {
    return low * std::exp(number(0, std::log(high / low)));
}

glm::dvec3 Random::direction() {
    for (;;) {
        const double x = number(-1, 1), y = number(-1, 1), z = number(-1, 1), square = x * x + y * y + z * z;
        if (square > 0.01 && square < 1)
            return glm::dvec3(x, y, z) / std::sqrt(square);
    }
}

glm::dvec3 Random::within(double radius, double low) {
    const glm::dvec3 to = direction();
    return to * (number(low, 1) * radius);
}

sim::Tissue randomTissue(Random& random, Wildness wildness) {
    sim::Tissue tissue;
    const bool damped = wildness == Wildness::damped;
    const auto fill = [&random, damped](sim::Material& material) {
        material.young = random.logNumber(500, 1e5);
        material.poisson = random.chance(0.4) ? 0.25 : random.chance(0.2) ? 0.49 : random.number(0.25, 0.49);
        material.density = random.number(900, 1200);
        material.dampingTime = damped               ? random.logNumber(5e-5, 2e-3)
                               : random.chance(0.4) ? 0
                                                    : random.logNumber(5e-5, 2e-3);
        if (random.chance(0.15)) {
            material.fibre = random.direction();
            material.fibreYoung = random.number(1, 5) * material.young;
        }
    };
    fill(tissue);
    tissue.airDrag = random.chance(0.7) ? 0 : random.number(0, 20);
    tissue.recovery = random.chance(0.3);
    for (int others = random.chance(0.3) ? random.whole(1, 2) : 0; others > 0; --others) {
        sim::Material other;
        fill(other);
        other.name = "other";
        tissue.others.push_back(other);
    }
    return tissue;
}

void stiffenSome(Random& random, sim::Tissue& tissue) {
    for (std::size_t i = 0; i < tissue.materialCount(); ++i) {
        sim::Material& material = i == 0 ? tissue : tissue.others[i - 1];
        if (random.chance(0.2)) {
            const double toe = random.number(0.02, 0.1), stress = toe * material.young,
                         slope = random.number(0.5, 6) * material.young;
            material.curve = {{toe, stress}, {2 * toe, stress + toe * slope}};
        }
        if (random.chance(0.15))
            material.strainLimit = random.number(0.25, 0.6);
    }
}

void paintMaterials(Random& random, const sim::Tissue& tissue, sim::Lattice& lattice) {
    const glm::dvec3 half = 0.5 * glm::dvec3(lattice.nodeDims);
    for (std::size_t material = 1; material < tissue.materialCount(); ++material) {
        const glm::dvec3 centre = half + random.within(1) * half;
        const double radius = random.number(0.2, 0.8) * std::max({half.x, half.y, half.z});
        for (sim::LatticeCell& cell : lattice.cells)
            if (glm::length(glm::dvec3(cell.grid) + 0.5 - centre) < radius)
                cell.material = std::uint8_t(material);
    }
}

Result<sim::Lattice> randomLattice(Random& random, std::size_t mostNodes) {
    const double nodes = random.logNumber(double(kFewestNodes), double(mostNodes));
    if (random.chance(0.35)) {
        static const std::pair<const char*, std::size_t> kPhantoms[] = {
            {"ball", 5000}, {"heart", 12000}, {"liver", 12000}, {"kidney", 6000}};
        const auto& [name, faces] = kPhantoms[random.whole(0, 3)];
        SEROSA_ASSIGN(const sim::TriangleMesh* mesh, phantomMesh(name, faces));
        sim::LatticeRequest request;
        request.nodes = std::size_t(nodes);
        return sim::buildLattice(*mesh, request);
    }
    std::vector<sim::LatticeCell> cells = blobCells(random, std::size_t(nodes));
    return sim::latticeFromCells(std::move(cells), random.number(0.001, 0.006), glm::dvec3(0));
}

Status RandomScenario::cutFrame(sim::Solver& solver, double from, double to) const {
    for (const sim::Cut& cut : cuts)
        for (const sim::Stroke& stroke : cut.strokes(from, to))
            SEROSA_TRY(solver.cut(stroke));
    if (tearStrain > 0) {
        sim::Stroke tear;
        tear.kind = sim::StrokeKind::tear;
        tear.strain = tearStrain;
        SEROSA_TRY(solver.cut(tear));
    }
    solver.forgetCuts(); // nothing is undone here, and layers take memory
    return {};
}

std::string RandomScenario::words() const {
    std::string text =
        "seed " + std::to_string(seed) + ": " + std::to_string(lattice.nodeCount()) + " nodes, h " +
        shortNumber(1e3 * lattice.spacing) + " mm, nu " + shortNumber(setup.tissue.poisson) + ", " +
        shortNumber(setup.tissue.young) + " Pa, damping " + shortNumber(1e3 * setup.tissue.dampingTime) +
        " ms" + (setup.tissue.recovery ? ", recovery" : "") + (setup.tissue.stiffens() ? ", stiffens" : "") +
        (setup.tissue.fibrous() ? ", fibres" : "") +
        (setup.tissue.others.empty() ? "" : ", several materials");
    for (const sim::Tool& tool : setup.tools)
        text += tool.mode == sim::ToolMode::push ? ", push" : ", grasp";
    text += ", " + std::to_string(cuts.size()) + " cuts";
    return text + (tearStrain > 0 ? ", tears at " + shortNumber(tearStrain) : "");
}

Result<std::unique_ptr<RandomScenario>> randomScenario(std::uint32_t seed, std::size_t mostNodes, int steps,
                                                       Wildness wildness, sim::StepMethod method) {
    Random random(seed);
    auto scenario = std::make_unique<RandomScenario>();
    scenario->seed = seed;
    SEROSA_ASSIGN(scenario->lattice, randomLattice(random, mostNodes));
    const sim::Lattice& lattice = scenario->lattice;
    sim::SolverSetup& setup = scenario->setup;
    setup.lattice = &lattice;
    setup.tissue = randomTissue(random, wildness);
    stiffenSome(random, setup.tissue);
    paintMaterials(random, setup.tissue, scenario->lattice);
    scenario->step = sim::stableStep(lattice, setup.tissue, kFrameTime);
    const bool implicit = method == sim::StepMethod::implicit;
    setup.method = method;
    setup.timeStep = implicit ? kFrameTime : scenario->step.timeStep;
    const double end = steps * setup.timeStep;
    const Bounds bounds = boundsOf(lattice);
    if (random.chance(0.6))
        setup.gravity = random.chance(0.5) ? 9.81 * random.direction() : random.within(30);
    if (random.chance(0.7))
        setup.fixed = randomFixed(random, lattice, bounds);
    if (random.chance(0.8))
        setup.tools.push_back(randomTool(random, true, lattice, bounds, end));
    for (int more = random.whole(0, 2); more > 0; --more)
        setup.tools.push_back(randomTool(random, random.chance(0.4), lattice, bounds, end));
    for (int cuts = random.chance(0.6) ? random.whole(1, 4) : 0; cuts > 0; --cuts)
        scenario->cuts.push_back(randomCut(random, lattice, bounds, end));
    if (random.chance(0.25))
        scenario->tearStrain = random.number(0.2, 1.5);
    if (implicit) {
        scenario->step.stepsPerFrame = sim::implicitStepsPerFrame(setup.tools, lattice.spacing, kFrameTime);
        setup.timeStep = kFrameTime / scenario->step.stepsPerFrame;
    }
    scenario->start = sim::startState(setup);
    if (random.chance(0.25))
        for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
            if (setup.fixed.empty() || !setup.fixed[node])
                scenario->start.increments[node] +=
                    random.within(0.1) * (setup.timeStep / scenario->step.timeStep); // as fast, in m/s
    return scenario;
}

} // namespace serosa::app
