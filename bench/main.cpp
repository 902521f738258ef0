// serosa_bench: the ratios and tables of docs/performance.md. `scripts/bench` builds and runs it.

#include "bench/cases.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <iostream>

namespace serosa::bench {

namespace {

struct Group {
    const char* name;
    Status (*run)(const Options&, Report&);
};
constexpr Group kGroups[] = {
    {"solver", benchSolver},     {"cpu", benchCpu},         {"compute", benchCompute},
    {"tissue", benchTissue},     {"contact", benchContact}, {"realtime", benchRealtime},
    {"mapping", benchMapping},   {"look", benchLook},       {"lod", benchLod},
    {"growth", benchGrowth},     {"gpu", benchGpu},         {"large", benchLarge},
    {"implicit", benchImplicit}, {"rivals", benchRivals},   {"raycast", benchRaycast}};

Status runAll(const std::vector<std::string>& groups, const Options& options, const gpu::Context& context,
              Report& report) {
    report.line("Renderer: " + context.info().renderer + ", " + context.info().version + ". " +
                std::to_string(options.rounds) +
                " interleaved rounds; median (smallest-largest). Only ratios count.");
    for (const Group& group : kGroups)
        if (groups.empty() || std::find(groups.begin(), groups.end(), group.name) != groups.end())
            SEROSA_TRY(group.run(options, report));
    report.ratioTable();
    return {};
}

} // namespace

} // namespace serosa::bench

int main(int argc, char** argv) {
    using namespace serosa;
    CLI::App app{"Measures Serosa in interleaved rounds. Exit code 1: a ratio misses its target."};
    bench::Options options;
    std::vector<std::string> groups;
    std::string folder = "out/bench", gl = "auto";
    std::vector<std::string> names;
    for (const bench::Group& group : bench::kGroups)
        names.push_back(group.name);
    app.add_option("group", groups, "what to measure; everything if none is named")
        ->check(CLI::IsMember(names));
    app.add_option("--rounds", options.rounds, "interleaved rounds")->check(CLI::Range(1, 1000));
    app.add_option("--seconds", options.seconds, "length of a turn of a case")
        ->check(CLI::Range(0.001, 60.0));
    app.add_option("--largest", options.largest, "largest lattice of the tables that grow, nodes");
    app.add_option("--gl", gl, "auto, egl, egl-device or osmesa");
    app.add_option("--out", folder, "folder for ratios.json and bench.md");
    CLI11_PARSE(app, argc, argv);

    const auto failed = [](const Error& error) {
        std::cerr << "serosa_bench: error: " << error.message << "\n";
        return error.exitCode;
    };
    const auto choice = gpu::parseGlChoice(gl);
    if (!choice.ok())
        return failed(choice.error());
    const auto context = gpu::createContext(*choice);
    if (!context.ok())
        return failed(context.error());
    bench::Report report(std::cout);
    if (const Status status = bench::runAll(groups, options, **context, report); !status.ok())
        return failed(status.error());
    if (const Status status = report.write(folder); !status.ok())
        return failed(status.error());
    std::cout << "\nwrote " << folder << "/ratios.json and bench.md\n";
    return report.missedTargets() == 0 ? exitOk : exitCheckFailed;
}
