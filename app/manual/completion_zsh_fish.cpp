// Completion for zsh and fish, whose own languages say in one line what an option is and takes.

#include "app/manual/command_tree.h"

#include <sstream>

namespace serosa::app {

namespace {

std::string joined(const std::vector<std::string>& words) {
    std::string line;
    for (const std::string& word : words)
        line += (line.empty() ? "" : " ") + word;
    return line;
}

/// Between single quotes, which hold everything but themselves; `also` gets a backslash in front.
std::string quoted(const std::string& text, const std::string& close, const std::string& also) {
    std::string out;
    for (const char c : text) {
        if (also.find(c) != std::string::npos)
            out += '\\';
        out += c == '\'' ? close : std::string(1, c);
    }
    return "'" + out + "'";
}

std::string zshAction(const Argument& argument) {
    switch (argument.kind) {
    case ValueKind::words:
        return "(" + joined(argument.words) + ")";
    case ValueKind::file:
        return "_files";
    case ValueKind::folder:
        return "_files -/";
    case ValueKind::none:
        break;
    }
    return " ";
}

/// In _arguments, a colon ends a message and brackets hold a description.
std::string zshText(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (std::string(":[]\\").find(c) != std::string::npos)
            out += '\\';
        out += c;
    }
    return out;
}

void writeZshCommand(std::ostream& out, const Command& command) {
    std::string function = "_" + command.path;
    for (char& c : function)
        if (c == ' ')
            c = '_';
    if (command.path == command.name)
        function += "_command";
    out << function << "() {\n    local line state\n    _arguments -C";
    for (const Argument& option : command.options)
        for (const std::string& name : option.names) {
            std::string spec = name + "[" + zshText(option.description) + "]";
            if (!option.valueName.empty())
                spec += ":" + zshText(option.valueName) + ":" + zshAction(option);
            out << " \\\n        " << quoted(spec, "'\\''", "");
        }
    for (const Argument& positional : command.positionals)
        out << " \\\n        "
            << quoted((positional.repeated ? "*:" : ":") + zshText(positional.valueName) + ":" +
                          zshAction(positional),
                      "'\\''", "");
    if (command.commands.empty()) {
        out << "\n}\n";
        return;
    }
    out << " \\\n        ':command:->command' '*::arguments:->arguments'\n"
        << "    case $state in\n    command)\n        local -a commands=(";
    for (const Command& child : command.commands)
        out << "\n            " << quoted(child.name + ":" + zshText(child.description), "'\\''", "");
    out << ")\n        _describe command commands ;;\n    arguments)\n        case $line[1] in\n";
    for (const Command& child : command.commands) {
        std::string name = "_" + child.path;
        for (char& c : name)
            if (c == ' ')
                c = '_';
        out << "        " << child.name << ") " << name << " ;;\n";
    }
    out << "        esac ;;\n    esac\n}\n";
    for (const Command& child : command.commands)
        writeZshCommand(out, child);
}

/// The condition under which fish offers what belongs to a command: all names of its path are on the line.
std::string fishCondition(const Command& command) {
    std::string condition;
    std::istringstream path(command.path);
    std::string name;
    path >> name; // the program
    while (path >> name)
        condition += (condition.empty() ? "" : "; and ") + std::string("__fish_seen_subcommand_from ") + name;
    if (!command.commands.empty()) {
        std::vector<std::string> names;
        for (const Command& child : command.commands)
            names.push_back(child.name);
        condition += (condition.empty() ? "" : "; and ") + std::string("not __fish_seen_subcommand_from ") +
                     joined(names);
    }
    return condition;
}

std::string fishValue(const Argument& argument) {
    switch (argument.kind) {
    case ValueKind::words:
        return " -x -a " + quoted(joined(argument.words), "\\'", "\\");
    case ValueKind::file:
        return " -r -F";
    case ValueKind::folder:
        return " -x -a '(__fish_complete_directories)'";
    case ValueKind::none:
        break;
    }
    return argument.valueName.empty() ? "" : " -x";
}

} // namespace

std::string zshCompletion(const Command& program) {
    std::ostringstream out;
    out << "#compdef serosa\n# Written from the program's own options (app/manual/): do not edit.\n";
    writeZshCommand(out, program);
    out << "_serosa_command \"$@\"\n";
    return out.str();
}

std::string fishCompletion(const Command& program) {
    std::ostringstream out;
    out << "# Written from the program's own options (app/manual/): do not edit.\ncomplete -c serosa -f\n";
    for (const Command* command : allCommands(program)) {
        const std::string start = "complete -c serosa -n '" + fishCondition(*command) + "'";
        for (const Command& child : command->commands)
            out << start << " -a " << child.name << " -d " << quoted(child.description, "\\'", "\\") << "\n";
        for (const Argument& positional : command->positionals)
            if (positional.kind != ValueKind::none)
                out << start << (positional.kind == ValueKind::file ? " -F" : fishValue(positional)) << "\n";
        for (const Argument& option : command->options) {
            // The program's own options stand behind every command too.
            out << (command == &program ? "complete -c serosa" : start);
            for (const std::string& name : option.names)
                out << (name.compare(0, 2, "--") == 0 ? " -l " + name.substr(2) : " -s " + name.substr(1));
            out << fishValue(option) << " -d " << quoted(option.description, "\\'", "\\") << "\n";
        }
    }
    return out.str();
}

} // namespace serosa::app
