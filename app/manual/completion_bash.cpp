// Completion for bash: one function that finds the command on the line, then offers the values of the option
// before the cursor, or options, or what the command takes. It needs no bash-completion library.

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

std::string offer(const Argument& argument) {
    switch (argument.kind) {
    case ValueKind::words:
        return "_serosa_offer -W '" + joined(argument.words) + "'";
    case ValueKind::file:
        return "_serosa_offer -f";
    case ValueKind::folder:
        return "_serosa_offer -d";
    case ValueKind::none:
        break;
    }
    return ":";
}

/// Options of the command and those of the program, which stand behind a command too.
std::vector<const Argument*> optionsOf(const Command& program, const Command& command) {
    std::vector<const Argument*> options;
    for (const Argument& option : command.options)
        options.push_back(&option);
    for (const Argument& option : program.options)
        if (&program != &command && option.names.back() != "--help")
            options.push_back(&option);
    return options;
}

} // namespace

std::string bashCompletion(const Command& program) {
    const std::vector<const Command*> commands = allCommands(program);
    std::ostringstream out;
    out << R"(# Written from the program's own options (app/manual/): do not edit.
_serosa_offer() {
    [[ $1 == -W ]] || compopt -o filenames 2>/dev/null
    mapfile -t COMPREPLY < <(compgen "$@" -- "$word")
    [[ ${#COMPREPLY[@]} != 1 || ${COMPREPLY[0]} != *= ]] || compopt -o nospace 2>/dev/null
}
_serosa() {
    local word=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD-1]} command=serosa i
    COMPREPLY=()
    # Bash splits --gl=egl into three words.
    if [[ $word == "=" ]]; then
        word=
    elif [[ $previous == "=" ]]; then
        previous=${COMP_WORDS[COMP_CWORD-2]}
    fi
    for ((i = 1; i < COMP_CWORD; i++)); do
        case "$command ${COMP_WORDS[i]}" in
)";
    for (const Command* command : commands)
        if (command != &program)
            out << "        '" << command->path << "') command='" << command->path << "' ;;\n";
    out << "        esac\n    done\n    case \"$command $previous\" in\n";
    for (const Command* command : commands)
        for (const Argument& option : command->options)
            if (!option.valueName.empty())
                for (const std::string& name : option.names)
                    out << "    '" << command->path << " " << name << "') " << offer(option)
                        << "; return ;;\n";
    out << "    esac\n    if [[ $word == -* ]]; then\n        case $command in\n";
    for (const Command* command : commands) {
        std::vector<std::string> names;
        for (const Argument* option : optionsOf(program, *command))
            names.insert(names.end(), option->names.begin(), option->names.end());
        out << "        '" << command->path << "') _serosa_offer -W '" << joined(names) << "' ;;\n";
    }
    out << "        esac\n        return\n    fi\n    case $command in\n";
    for (const Command* command : commands) {
        Argument what = command->positionals.empty() ? Argument() : command->positionals.front();
        for (const Command& child : command->commands) {
            what.kind = ValueKind::words;
            what.words.push_back(child.name);
        }
        out << "    '" << command->path << "') " << offer(what) << " ;;\n";
    }
    out << "    esac\n}\ncomplete -F _serosa serosa\n";
    return out.str();
}

} // namespace serosa::app
