// CLI11's tree of commands as plain data (command_tree.h).

#include "app/manual/command_tree.h"

#include <CLI/CLI.hpp>

#include <set>

namespace serosa::app {

namespace {

Argument describe(const CLI::Option& option, const std::string& path, std::set<std::string>& unused) {
    Argument argument;
    if (option.nonpositional()) {
        for (const std::string& name : option.get_snames())
            argument.names.push_back("-" + name);
        for (const std::string& name : option.get_lnames())
            argument.names.push_back("--" + name);
    } else {
        argument.names.push_back(option.get_name(true));
    }
    argument.description = option.get_description();
    argument.required = option.get_required();
    argument.repeated = option.get_items_expected_max() > 1 && option.get_items_expected_min() > 0;
    if (option.get_expected_max() == 0) // a flag
        return argument;
    // "INT:INT in [1 - 100]": the checks that follow the name are the help text's own.
    argument.valueName = option.get_type_name().substr(0, option.get_type_name().find(':'));
    argument.defaultText = option.get_default_str();
    for (const std::string& name : argument.names)
        if (argument.words.empty()) {
            argument.words = commandWords(path, name);
            unused.erase(name);
            unused.erase(path + " " + name);
        }
    const std::string& value = argument.valueName;
    argument.kind = !argument.words.empty()               ? ValueKind::words
                    : value == "FILE" || value == "SCENE" ? ValueKind::file
                    : value == "DIR" || value == "FOLDER" ? ValueKind::folder
                                                          : ValueKind::none;
    return argument;
}

Command describe(const CLI::App& app, const std::string& parent, std::set<std::string>& unused) {
    Command command;
    command.name = app.get_name();
    command.path = parent.empty() ? command.name : parent + " " + command.name;
    command.description = app.get_description();
    command.footer = app.get_footer();
    for (const CLI::Option* option : app.get_options()) {
        if (option->get_group().empty()) // hidden
            continue;
        (option->nonpositional() ? command.options : command.positionals)
            .push_back(describe(*option, command.path, unused));
    }
    for (const CLI::App* child : app.get_subcommands({}))
        if (!child->get_group().empty())
            command.commands.push_back(describe(*child, command.path, unused));
    return command;
}

void collect(const Command& command, std::vector<const Command*>& all) {
    all.push_back(&command);
    for (const Command& child : command.commands)
        collect(child, all);
}

} // namespace

Result<Command> commandTree(const CLI::App& app) {
    const std::vector<std::string> known = argumentsWithWords();
    std::set<std::string> unused(known.begin(), known.end());
    Command tree = describe(app, "", unused);
    if (!unused.empty())
        return Error{"app/manual/command_words.cpp: there is no '" + *unused.begin() +
                     "': correct or remove that line"};
    return tree;
}

std::vector<const Command*> allCommands(const Command& command) {
    std::vector<const Command*> all;
    collect(command, all);
    return all;
}

} // namespace serosa::app
