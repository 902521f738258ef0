// Dimitriadis, Horkay, Maresca, Kachar and Chadwick 2002, Determination of elastic moduli of thin layers of
// soft material using the atomic force microscope, Biophys. J. 82, 2798: the bonded layer. Its general
// formula ends in -0.0975 chi^4 for nu = 1/2, where its formula for that case prints +0.0975; the other
// coefficients of the two agree, and chi^4 is 1/256 and less here.
#include "app/verify/tool_measures.h"

#include <cmath>

namespace serosa::app {

namespace {

constexpr double kPi = 3.141592653589793;

/// A setup whose slowest mode, of angular frequency `rate`, is damped critically by drag: all comes to rest
/// within a few times 1/rate.
sim::SolverSetup restingSetup(const sim::Lattice& lattice, const sim::Tissue& tissue, double rate) {
    sim::SolverSetup setup;
    setup.lattice = &lattice;
    setup.tissue = tissue;
    setup.tissue.airDrag = 2 * rate;
    setup.tissue.dampingTime = 0;
    setup.timeStep = sim::stableStep(lattice, setup.tissue, 1).timeStep;
    return setup;
}

/// Mean force of the first tool over the next `time` seconds, N.
glm::dvec3 toolForce(const sim::SolverSetup& setup, sim::Solver& solver, double time) {
    const int steps = int(time / setup.timeStep) + 1;
    solver.takeToolImpulses();
    solver.advance(steps);
    return solver.takeToolImpulses()[0] / (steps * setup.timeStep);
}

} // namespace

double layerForce(const sim::Tissue& tissue, double radius, double depth, double thickness) {
    const double nu = tissue.poisson, chi = std::sqrt(radius * depth) / thickness;
    const double alpha = -(1.2876 - 1.4678 * nu + 1.3442 * nu * nu) / (1 - nu);
    const double beta = (0.6387 - 1.0277 * nu + 1.5164 * nu * nu) / (1 - nu);
    const double cube = alpha * alpha * alpha, pi2 = kPi * kPi;
    const double correction = 1 - 2 * alpha / kPi * chi + 4 * alpha * alpha / pi2 * chi * chi -
                              8 / (pi2 * kPi) * (cube + 4 * pi2 / 15 * beta) * std::pow(chi, 3) +
                              16 * alpha / (pi2 * pi2) * (cube + 3 * pi2 / 5 * beta) * std::pow(chi, 4);
    return 4.0 / 3 * tissue.young / (1 - nu * nu) * std::sqrt(radius) * std::pow(depth, 1.5) * correction;
}

double Indentation::contactRadius() const {
    return std::sqrt(radius * depth);
}

Result<IndentationForce> measureIndentation(const Indentation& piece, const sim::Tissue& tissue,
                                            double spacing, const SolverMaker& make) {
    // The block is the layer and a base below it, whose nodes are all held: turned layers are bonded, too.
    const double base = 4;
    const Beam block = makeBeam(piece.width, piece.thickness + base, piece.turn, spacing);
    const double surface = 0.5 * (piece.thickness + base), floor = surface - piece.thickness;
    const double shear = tissue.young / (2 * (1 + tissue.poisson));
    const double rate = 0.5 * kPi * std::sqrt(shear / tissue.density) / (piece.thickness * spacing);
    sim::SolverSetup setup = restingSetup(block.lattice, tissue, rate);
    for (std::size_t node = 0; node < block.lattice.nodeCount(); ++node)
        setup.fixed.push_back(glm::dot(piece.turn[2], block.lattice.restPosition(node) - block.middle) <
                              floor + 1e-6);
    const auto at = [&](double height) {
        return block.lattice.toWorld(block.middle + height * piece.turn[2]);
    };
    const double press = 12 / rate, hold = 20 / rate, top = surface + piece.radius;
    setup.tools = {{"indenter",
                    sim::ToolMode::push,
                    piece.radius * spacing,
                    {{0, at(top)}, {press, at(top - piece.depth)}}}};
    SEROSA_ASSIGN(const std::unique_ptr<sim::Solver> solver, make(setup));
    solver->advance(int((press + 0.8 * hold) / setup.timeStep));
    const auto force = [&] { return glm::transpose(piece.turn) * toolForce(setup, *solver, 0.1 * hold); };
    const glm::dvec3 before = force(), now = force();
    return IndentationForce{-now.z, std::hypot(now.x, now.y), std::abs(now.z / before.z - 1),
                            block.lattice.nodeCount()};
}

Result<double> measurePulledBar(const Beam& beam, const sim::Tissue& tissue, double strain,
                                const SolverMaker& make) {
    const sim::Lattice& lattice = beam.lattice;
    const double h = lattice.spacing, end = 0.5 * beam.length - 1, reach = 20 * beam.thickness;
    const double rate = 0.5 * kPi * std::sqrt(tissue.young / tissue.density) / (beam.length * h);
    sim::SolverSetup setup = restingSetup(lattice, tissue, rate);
    const auto axial = [&](const glm::dvec3& x) { return glm::dot(beam.turn[2], x - beam.middle); };
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        setup.fixed.push_back(axial(lattice.restPosition(node)) < -end);
    const auto at = [&](double place) { return lattice.toWorld(beam.middle + place * beam.turn[2]); };
    const double pull = 12 / rate, hold = 20 / rate, centre = end + reach;
    setup.tools = {{"forceps",
                    sim::ToolMode::grasp,
                    reach * h,
                    {{0, at(centre)},
                     {pull, at(centre + strain * beam.length)},
                     {2 * (pull + hold), at(centre + strain * beam.length)}}}};
    SEROSA_ASSIGN(const std::unique_ptr<sim::Solver> solver, make(setup));
    solver->advance(int((pull + 0.9 * hold) / setup.timeStep));
    const double force = glm::dot(beam.turn[2], toolForce(setup, *solver, 0.1 * hold));
    const sim::LatticeState state = solver->state();
    double volume = 0, mass = 0, z1 = 0, u1 = 0, zz = 0, zu = 0; // volume in cells; least squares of u over z
    for (const sim::LatticeCell& cell : lattice.cells)
        volume += cell.fill / 255.0;
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
        const double z = axial(lattice.restPosition(node)), m = lattice.massShare(node);
        if (std::abs(z) > beam.length / 6)
            continue;
        const double u = axial(state.positions[node]) - z;
        mass += m;
        z1 += m * z;
        u1 += m * u;
        zz += m * z * z;
        zu += m * z * u;
    }
    const double stretch = (zu - z1 * u1 / mass) / (zz - z1 * z1 / mass);
    return force / (volume / beam.length * h * h * stretch);
}

} // namespace serosa::app
