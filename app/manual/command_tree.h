#pragma once
// The command line as plain data: what the manual page and the shell completions have in common. Taken from
// the options that the program itself parses, so that none of them can fall behind.

#include "base/result.h"

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace serosa::app {

/// What a shell should offer for a value.
enum class ValueKind { none, file, folder, words };

/// An option, or a positional argument.
struct Argument {
    std::vector<std::string> names; // "-o", "--output"; one bare name for a positional
    std::string valueName;          // "FILE"; empty for a flag
    std::string description, defaultText;
    ValueKind kind = ValueKind::none;
    std::vector<std::string> words; // what the value may be, where that is a short list
    bool required = false, repeated = false;
};

struct Command {
    std::string path; // "serosa scene check"
    std::string name, description, footer;
    std::vector<Argument> options, positionals;
    std::vector<Command> commands;
};

/// Errors: the list of words (app/manual/command_words.cpp) names an option that there is not.
Result<Command> commandTree(const CLI::App& app);

/// The command and all below it, parents first.
std::vector<const Command*> allCommands(const Command& command);

/// Words of one argument, none where it takes anything. \param argument "--gl" or a positional's name.
std::vector<std::string> commandWords(const std::string& path, const std::string& argument);
/// "--gl", "serosa phantom name", ...: all that have words.
std::vector<std::string> argumentsWithWords();

std::string manualPage(const Command& command, const std::string& version);
std::string bashCompletion(const Command& command);
std::string zshCompletion(const Command& command);
std::string fishCompletion(const Command& command);

} // namespace serosa::app
