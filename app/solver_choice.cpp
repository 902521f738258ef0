// See app/solver_choice.h.

#include "app/solver_choice.h"

#include "base/check.h"
#include "sim/cpu_solver.h"

namespace serosa::app {

namespace {

using Made = Result<std::unique_ptr<sim::Solver>>;
struct Entry {
    std::string name;
    Made (*make)(const sim::SolverSetup& setup, int layout);
};

template <class Options>
Options withLayout(int layout) {
    Options options;
    options.layout = layout;
    return options;
}

const std::vector<Entry>& entries() {
    static const std::vector<Entry> list{
        {"fragment",
         [](const sim::SolverSetup& setup, int layout) -> Made {
             return sim::makeFragmentSolver(setup, withLayout<sim::FragmentOptions>(layout));
         }},
        {"compute",
         [](const sim::SolverSetup& setup, int layout) -> Made {
             return sim::makeComputeSolver(setup, withLayout<sim::ComputeOptions>(layout));
         }},
        {"cpu", [](const sim::SolverSetup& setup, int) -> Made { return sim::makeCpuSolver(setup); }},
        {"reference",
         [](const sim::SolverSetup& setup, int) -> Made { return sim::makeReferenceSolver(setup); }}};
    return list;
}

} // namespace

const std::vector<std::string>& solverNames() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> list;
        for (const Entry& entry : entries())
            list.push_back(entry.name);
        return list;
    }();
    return names;
}

Made makeSolver(const std::string& name, const sim::SolverSetup& setup, int layout) {
    for (const Entry& entry : entries())
        if (entry.name == name)
            return entry.make(setup, layout);
    SEROSA_CHECK(false, "a name of solverNames()");
    return Error{name};
}

} // namespace serosa::app
