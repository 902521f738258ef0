// See app/user_config.h.

#include "app/user_config.h"

#include "app/solver_choice.h"
#include "base/atomic_file.h"
#include "sim/quantity.h"
#include "sim/suggest.h"

#include <toml++/toml.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace serosa::app {

namespace {

namespace fs = std::filesystem;

const char* const kHowToPick = "run 'serosa bench --pick', or name the solver";

std::string at(const fs::path& file, const toml::source_region& place) {
    return file.string() + ":" + std::to_string(place.begin.line) + ":" + std::to_string(place.begin.column) +
           ": ";
}

/// The whole file; empty where there is none.
Result<toml::table> readConfig(const fs::path& file) {
    std::error_code ignored;
    if (!fs::exists(file, ignored))
        return toml::table{};
    std::ifstream stream(file);
    std::ostringstream text;
    text << stream.rdbuf();
    if (!stream)
        return Error{file.string() + ": cannot be read"};
    try {
        return toml::parse(text.str(), file.string());
    } catch (const toml::parse_error& problem) {
        return Error{at(file, problem.source()) + std::string(problem.description()) +
                     ": mend or remove this file"};
    }
}

} // namespace

Result<fs::path> userConfigFile() {
    const char* folder = std::getenv("XDG_CONFIG_HOME");
    if (folder && fs::path(folder).is_absolute()) // the standard: others are ignored
        return fs::path(folder) / "serosa" / "config.toml";
    const char* home = std::getenv("HOME");
    if (home && fs::path(home).is_absolute())
        return fs::path(home) / ".config" / "serosa" / "config.toml";
    return Error{"there is no place for the user's configuration: set HOME or XDG_CONFIG_HOME to a folder"};
}

Result<PickedSolver> readPickedSolver() {
    SEROSA_ASSIGN(const fs::path file, userConfigFile());
    SEROSA_ASSIGN(const toml::table config, readConfig(file));
    const toml::node_view<const toml::node> table = config["picked"];
    if (!table)
        return Error{file.string() + ": no solver was picked on this machine: " + kHowToPick};
    PickedSolver picked;
    picked.solver = table["solver"].value_or(std::string());
    picked.nodes = std::size_t(std::max<std::int64_t>(0, table["nodes"].value_or(std::int64_t(0))));
    picked.renderer = table["renderer"].value_or(std::string());
    const std::vector<std::string>& names = solverNames();
    if (std::find(names.begin(), names.end(), picked.solver) == names.end())
        return Error{at(file, table.node()->source()) + "picked.solver is " + sim::inQuotes(picked.solver) +
                     ", which is no solver" + sim::suggestion(picked.solver, names) + ": " + kHowToPick};
    return picked;
}

Status writePickedSolver(const PickedSolver& picked) {
    SEROSA_ASSIGN(const fs::path file, userConfigFile());
    SEROSA_ASSIGN(toml::table config, readConfig(file));
    config.insert_or_assign("picked", toml::table{{"solver", picked.solver},
                                                  {"nodes", std::int64_t(picked.nodes)},
                                                  {"renderer", picked.renderer}});
    std::error_code code;
    fs::create_directories(file.parent_path(), code);
    if (code)
        return Error{file.parent_path().string() + ": cannot make this folder (" + code.message() +
                     "): set XDG_CONFIG_HOME to one that may be written"};
    std::ostringstream text;
    text << "# [picked] is written by `serosa bench --pick` and read by `--solver picked`.\n"
         << config << "\n";
    return writeFileAtomically(file, std::string_view(text.str()));
}

} // namespace serosa::app
