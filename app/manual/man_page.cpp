// serosa.1 in the man macros of roff: a section for each command, from the same texts as its --help.

#include "app/manual/command_tree.h"

#include <sstream>

namespace serosa::app {

namespace {

/// Text that roff prints as it is: hyphens stay hyphens (options can be copied), no line is taken for a
/// request.
std::string roff(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if ((c == '.' || c == '\'') && (out.empty() || out.back() == '\n'))
            out += "\\&";
        out += c == '\\' ? "\\e" : c == '-' ? "\\-" : std::string(1, c);
    }
    return out;
}

std::string bold(const std::string& text) {
    return "\\fB" + roff(text) + "\\fR";
}
std::string italic(const std::string& text) {
    return "\\fI" + roff(text) + "\\fR";
}

std::string usage(const Command& command) {
    std::string line = bold(command.path);
    if (!command.options.empty())
        line += " [" + italic("options") + "]";
    for (const Argument& argument : command.positionals) {
        const std::string name =
            italic(argument.valueName) + (argument.repeated ? std::string("...") : std::string());
        line += argument.required ? " " + name : " [" + name + "]";
    }
    if (!command.commands.empty())
        line += " " + italic("command");
    return line;
}

void writeArgument(std::ostream& out, const Argument& argument) {
    out << ".TP\n";
    const bool positional = argument.names.front().front() != '-';
    if (positional) {
        out << italic(argument.valueName);
    } else {
        for (std::size_t i = 0; i < argument.names.size(); ++i)
            out << (i > 0 ? ", " : "") << bold(argument.names[i]);
        if (!argument.valueName.empty())
            out << " " << italic(argument.valueName);
    }
    out << "\n" << roff(argument.description);
    if (!argument.defaultText.empty())
        out << " (default: " << roff(argument.defaultText) << ")";
    if (argument.required && !positional)
        out << " (required)";
    out << "\n";
    if (!argument.words.empty()) {
        out << ".br\nOne of:";
        for (std::size_t i = 0; i < argument.words.size(); ++i)
            out << (i > 0 ? ", " : " ") << bold(argument.words[i]);
        out << ".\n";
    }
}

void writeFooter(std::ostream& out, const Command& command) {
    if (!command.footer.empty())
        out << ".PP\n.nf\n" << roff(command.footer) << "\n.fi\n";
}

} // namespace

std::string manualPage(const Command& command, const std::string& version) {
    std::ostringstream out;
    out << ".\\\" Written from the program's own options (app/manual/): do not edit.\n"
        << ".TH SEROSA 1 \"\" \"serosa " << roff(version) << "\" \"User Commands\"\n"
        << ".SH NAME\nserosa \\- simulate soft organs in real time\n.SH SYNOPSIS\n";
    for (const Command* each : allCommands(command))
        if (each->commands.empty())
            out << usage(*each) << "\n.br\n";
    out << bold("serosa --version") << "\n.SH DESCRIPTION\n"
        << roff(command.description) << "\n.SH OPTIONS\nThese stand before or after the command.\n";
    for (const Argument& option : command.options)
        writeArgument(out, option);
    out << ".SH COMMANDS\n";
    for (const Command* each : allCommands(command)) {
        if (each == &command)
            continue;
        out << ".SS \"" << roff(each->path.substr(command.path.size() + 1)) << "\"\n"
            << usage(*each) << "\n.PP\n"
            << roff(each->description) << ".\n";
        for (const Argument& positional : each->positionals)
            writeArgument(out, positional);
        for (const Argument& option : each->options)
            writeArgument(out, option);
        writeFooter(out, *each);
    }
    out << ".SH EXAMPLES\n.nf\n" << roff(command.footer) << "\n.fi\n";
    out << ".SH EXIT STATUS\n";
    const char* const kExitCodes[][2] = {
        {"0", "done"},
        {"1", "a check failed, or the watchdog stopped an organ of a run"},
        {"2", "bad input: a file, a scene, an option, a folder, a full disk"},
        {"3", "a child program crashed or took too long"},
        {"4", "no baseline to compare with"},
        {"5", "no OpenGL context: see \\fBserosa doctor\\fR"},
        {"130", "interrupted: what was done until then is kept"}};
    for (const auto& [code, meaning] : kExitCodes)
        out << ".TP\n.B " << code << "\n" << meaning << "\n";
    return out.str();
}

} // namespace serosa::app
