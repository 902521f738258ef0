#pragma once
// Random organs and what is done to them, for `serosa verify stability`: wild, but nothing that a scene file
// could not ask for. All of a scenario follows from its seed, on every machine.

#include "base/result.h"
#include "sim/cut_motion.h"
#include "sim/lattice.h"
#include "sim/solver.h"

#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

namespace serosa::app {

/// mt19937 with distributions of our own: those of the standard library differ between libraries.
class Random {
public:
    explicit Random(std::uint32_t seed) : engine_(seed) {}
    double number(double low, double high) { return low + (high - low) * double(engine_()) / 4294967296.0; }
    /// As often between 1 and 2 as between 2 and 4.
    double logNumber(double low, double high);
    int whole(int low, int high) { return low + int(engine_() % std::uint32_t(high - low + 1)); }
    bool chance(double share) { return number(0, 1) < share; }
    glm::dvec3 direction();
    /// In a random direction, as far as a random share of `radius` between `low` and 1.
    glm::dvec3 within(double radius, double low = 0);

private:
    std::mt19937 engine_;
};

/// `damped` is tissue with at least 0.05 ms of damping along springs (a scene's default is 0.5 ms); `any` can
/// have none at all: nothing takes away what thousands of steps of folding and snapping add, so that some of
/// it runs away in the end and is stopped.
enum class Wildness { damped, any };

/// Soft to stiff, Poisson's ratio 0.25 (two in five) to 0.49, with and without damping and recovery; one to
/// three materials, some with fibres. Linear: a curve's bound on the step is that of its steepest part.
sim::Tissue randomTissue(Random& random, Wildness wildness);
/// Gives some of the materials a curve or a strain limit.
void stiffenSome(Random& random, sim::Tissue& tissue);
/// Gives each of the materials but the first a ball of cells.
void paintMaterials(Random& random, const sim::Tissue& tissue, sim::Lattice& lattice);

/// A phantom or a blob of cells with fills of its own (full, random, a few of 1/255, or all of 1/255), 60 to
/// `mostNodes` nodes, spacing 1 to 6 mm.
Result<sim::Lattice> randomLattice(Random& random, std::size_t mostNodes);

struct RandomScenario {
    std::uint32_t seed = 0;
    sim::Lattice lattice;
    sim::SolverSetup setup; // points at `lattice`; fixed nodes, tools up to 1 m/s, gravity, method
    sim::StableStep step;
    sim::LatticeState start;    // with random velocities in every fourth
    std::vector<sim::Cut> cuts; // m, s, as a scene's
    double tearStrain = 0;      // 0: it does not tear

    RandomScenario() = default;
    RandomScenario(const RandomScenario&) = delete;
    RandomScenario& operator=(const RandomScenario&) = delete;
    /// "seed 7: 812 nodes, nu 0.41, 2 tools, ...": enough to know what is special about it.
    std::string words() const;
    /// The strokes and tears of one frame, as ScenePlayer makes them. Errors: as Solver::cut.
    Status cutFrame(sim::Solver& solver, double from, double to) const;
};

/// \param steps how many it will take: keys of tools and cuts lie within. Implicit ones are of 1/60 s, or as
/// short as the tools ask for; `steps` then counts frames. The
/// same organ for either method. Errors: of the phantoms.
Result<std::unique_ptr<RandomScenario>>
randomScenario(std::uint32_t seed, std::size_t mostNodes, int steps, Wildness wildness,
               sim::StepMethod method = sim::StepMethod::explicitSteps);

} // namespace serosa::app
