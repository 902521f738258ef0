// The words that options take, for every command that has such an option; positionals by command. The parsers
// of app/cli.cpp compare strings, so CLI11 does not know them; tests/app/manual_test.cpp holds this list to
// what the program says about a wrong word.

#include "app/manual/command_tree.h"
#include "app/solver_choice.h"
#include "app/verify/verify.h"
#include "models/phantom.h"
#include "sim/scene_keys.h"

#include <map>

namespace serosa::app {

namespace {

using Words = std::vector<std::string>;

const std::map<std::string, Words>& table() {
    static const std::map<std::string, Words> kTable = [] {
        Words phantoms, groups;
        for (const models::PhantomInfo& info : models::phantoms())
            phantoms.push_back(info.name);
        for (const VerifyGroup& group : verifyGroups())
            groups.push_back(group.name);
        Words solvers = solverNames();
        solvers.push_back("picked");
        return std::map<std::string, Words>{
            {"--gl", {"auto", "egl", "egl-device", "osmesa"}},
            {"--inject", {"stiffness=", "drop-spring", "stale-normal"}},
            {"--layout", {"auto", "grid", "rows"}},
            {"--length-unit", {"mm", "cm", "m", "um", "in"}},
            {"--mapping", sim::findSceneKey("look", "mapping")->words},
            {"--show", sim::findSceneKey("look", "show")->words},
            {"--solver", solvers},
            {"serosa phantom name", phantoms},
            {"serosa verify groups", groups},
        };
    }();
    return kTable;
}

} // namespace

std::vector<std::string> commandWords(const std::string& path, const std::string& argument) {
    const auto found = table().find(argument.front() == '-' ? argument : path + " " + argument);
    return found == table().end() ? Words() : found->second;
}

std::vector<std::string> argumentsWithWords() {
    Words names;
    for (const auto& entry : table())
        names.push_back(entry.first);
    return names;
}

} // namespace serosa::app
