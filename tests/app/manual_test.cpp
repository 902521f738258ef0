// The manual page and the shell completions against what the program says of itself: both are written from
// its options, and `serosa COMMAND --help` is the witness.

#include "tests/app/child.h"

#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <sstream>

namespace serosa::app {
namespace {

const std::string kManual = std::string(SEROSA_BINARY_DIR) + "/manual/";

std::string shell(const std::string& command) {
    FILE* pipe = popen(command.c_str(), "r");
    std::string out;
    for (int c; pipe && (c = std::fgetc(pipe)) != EOF;)
        out += char(c);
    return pclose(pipe) == 0 ? out : "failed: " + command + "\n" + out;
}

std::set<std::string> wordsOf(const std::string& text) {
    std::istringstream stream(text);
    return {std::istream_iterator<std::string>(stream), {}};
}

/// What a command's --help lists: options (all their names) with descriptions, and subcommands.
struct Help {
    std::map<std::string, std::string> options;
    std::vector<std::string> commands;
};

Help helpOf(const std::string& command) {
    const TestFolder folder;
    std::istringstream path(command);
    std::vector<std::string> arguments{std::istream_iterator<std::string>(path), {}};
    arguments.push_back("--help");
    std::istringstream lines(runSerosa(folder.path(), arguments).out);
    Help help;
    std::vector<std::string> names;
    bool subcommands = false;
    for (std::string line; std::getline(lines, line);) {
        if (line.empty() || line[0] != ' ') {
            subcommands = line == "Subcommands:";
            continue;
        }
        std::smatch match;
        static const std::regex option("^  (-[^ ]+)( [A-Z].*?)?(  +(.*))?$"), subcommand("^  ([a-z]+)  +.*$");
        static const std::regex wrapped("^    +(.*)$");
        if (subcommands && std::regex_match(line, match, subcommand)) {
            help.commands.push_back(match[1]);
        } else if (std::regex_match(line, match, option)) {
            names.clear();
            std::istringstream list(match[1]);
            for (std::string name; std::getline(list, name, ',');) {
                names.push_back(name);
                help.options[name] = match[4];
            }
        } else if (std::regex_match(line, match, wrapped)) {
            for (const std::string& name : names)
                help.options[name] += (help.options[name].empty() ? "" : " ") + match[1].str();
        }
    }
    return help;
}

/// "" (the program), "run", ..., "scene check", as the help of each lists them.
std::vector<std::string> allCommands() {
    std::vector<std::string> all{""};
    for (std::size_t i = 0; i < all.size(); ++i)
        for (const std::string& name : helpOf(all[i]).commands)
            all.push_back(all[i].empty() ? name : all[i] + " " + name);
    return all;
}

/// Text of a section of the page, without roff's escapes.
std::string section(const std::string& title) {
    const std::string page = readWhole(kManual + "serosa.1");
    const std::size_t start = page.find("\n" + title + "\n");
    if (start == std::string::npos)
        return "";
    const std::size_t end = std::min(page.find("\n.SH ", start + 1), page.find("\n.SS ", start + 1));
    const std::string raw = page.substr(start, end - start);
    return std::regex_replace(std::regex_replace(raw, std::regex("\\\\f[BIR]|\\\\&"), ""),
                              std::regex("\\\\([-e])"), "$1");
}

TEST(Manual, EachCommandHasTheOptionsOfItsHelpAndNoOthers) {
    const std::vector<std::string> commands = allCommands();
    ASSERT_GE(commands.size(), 10u);
    for (const std::string& command : commands) {
        const Help help = helpOf(command);
        ASSERT_TRUE(help.options.count("--help")) << command;
        const std::string text = section(command.empty() ? ".SH OPTIONS" : ".SS \"" + command + "\"");
        ASSERT_NE(text, "") << command << " has no section";
        std::set<std::string> listed;
        std::istringstream lines(text);
        for (std::string line, before; std::getline(lines, line); before = line) {
            if (before != ".TP" || line[0] != '-')
                continue;
            std::istringstream names(std::regex_replace(line, std::regex(" [A-Z].*|,"), ""));
            for (std::string name; names >> name;)
                listed.insert(name);
        }
        for (const auto& [name, description] : help.options) {
            EXPECT_TRUE(listed.count(name)) << command << " " << name;
            const std::string words = description.substr(0, description.find(" Excludes:"));
            EXPECT_NE(text.find(words), std::string::npos) << command << " " << name << ": " << words;
        }
        for (const std::string& name : listed)
            EXPECT_TRUE(help.options.count(name)) << command << " " << name;
    }
}

TEST(Manual, GroffTakesItWithoutAWarning) {
    const std::string out = shell("groff -man -Tutf8 -ww -z '" + kManual + "serosa.1' 2>&1");
    EXPECT_EQ(out, "");
    const std::string page =
        shell("groff -man -Tascii '" + kManual + "serosa.1' | sed 's/\\x1b\\[[0-9;]*m//g'");
    EXPECT_NE(page.find("--length-unit"), std::string::npos);
    EXPECT_NE(page.find("SEROSA(1)"), std::string::npos);
}

/// What bash offers at the end of a line; the last word is being typed.
std::set<std::string> bashOffers(const std::string& line) {
    return wordsOf(shell("bash -c 'source \"" + kManual + "serosa.bash\"; COMP_WORDS=(" + line + "); [[ \"" +
                         line +
                         "\" != *\" \" ]] || COMP_WORDS+=(\"\"); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); "
                         "_serosa; printf \"%s\\n\" \"${COMPREPLY[@]}\"' 2>&1"));
}

std::set<std::string> fishOffers(const std::string& line) {
    std::set<std::string> offers;
    std::istringstream lines(
        shell("HOME=/nonexistent XDG_CONFIG_HOME=/nonexistent XDG_DATA_HOME=/nonexistent fish -N "
              "-c 'source \"" +
              kManual + "serosa.fish\"; complete -C \"" + line + "\"' 2>/dev/null"));
    for (std::string offer; std::getline(lines, offer);)
        offers.insert(offer.substr(0, offer.find('\t')));
    return offers;
}

TEST(Completion, BashAndFishOfferTheCommandsAndOptionsOfTheHelp) {
    for (const std::string& command : allCommands()) {
        const Help help = helpOf(command);
        const std::string line = "serosa " + command + (command.empty() ? "" : " ");
        std::set<std::string> expected;
        for (const auto& [name, description] : help.options)
            expected.insert(name);
        if (!command.empty()) // options of the program stand behind a command too
            expected.insert({"-v", "--verbose", "--version"});
        EXPECT_EQ(bashOffers(line + "-"), expected) << command;
        std::set<std::string> longNames, offered = fishOffers(line + "--");
        for (const std::string& name : expected)
            if (name.compare(0, 2, "--") == 0)
                longNames.insert(name);
        EXPECT_EQ(offered, longNames) << command;
        if (!help.commands.empty()) {
            const std::set<std::string> commands(help.commands.begin(), help.commands.end());
            EXPECT_EQ(bashOffers(line), commands) << command;
            EXPECT_EQ(fishOffers(line), commands) << command;
        }
    }
}

TEST(Completion, BashOffersValuesAndFiles) {
    using Words = std::set<std::string>;
    EXPECT_EQ(bashOffers("serosa r"), (Words{"repair", "run"}));
    EXPECT_EQ(bashOffers("serosa run --gl egl"), (Words{"egl", "egl-device"}));
    EXPECT_EQ(bashOffers("serosa run --gl = os"), Words{"osmesa"}); // as bash splits --gl=os
    EXPECT_EQ(bashOffers("serosa run --out /usr/shar"), Words{"/usr/share"});
    EXPECT_EQ(bashOffers("serosa run --model " + kManual + "serosa.b"), Words{kManual + "serosa.bash"});
    EXPECT_EQ(bashOffers("serosa run " + kManual + "serosa.f"), Words{kManual + "serosa.fish"});
    EXPECT_EQ(bashOffers("serosa run --frames 1"), Words{});
    EXPECT_EQ(bashOffers("serosa -v scene ch"), Words{"check"});
    EXPECT_TRUE(bashOffers("serosa phantom h").count("heart"));
    EXPECT_EQ(fishOffers("serosa run --mapping cu"), Words{"curvature"});
}

TEST(Completion, EveryWordOfferedIsTakenAndNoneIsMissing) {
    const TestFolder folder;
    folder.write("ball.ply", "no mesh");
    const std::vector<std::pair<std::string, std::string>> options{
        {"run --model ball.ply --length-unit mm", "--solver"},
        {"run --model ball.ply --length-unit mm", "--layout"},
        {"run --model ball.ply --length-unit mm", "--gl"},
        {"run --model ball.ply --length-unit mm", "--mapping"},
        {"run --model ball.ply", "--length-unit"},
        {"inspect ball.ply", "--length-unit"},
        {"verify nosuchgroup", "--gl"},
        {"verify", "--inject"},
        {"phantom -o other.ply", ""},
        {"verify", ""},
    };
    for (const auto& [line, option] : options) {
        const std::string command = line.substr(0, line.find(' '));
        const std::set<std::string> words =
            bashOffers("serosa " + command + " " + (option.empty() ? "" : option + " "));
        EXPECT_GE(words.size(), 2u) << line;
        std::istringstream list(line);
        std::vector<std::string> arguments{std::istream_iterator<std::string>(list), {}};
        if (!option.empty())
            arguments.push_back(option);
        // A word that is far from all others: the message lists what there is.
        arguments.push_back("0123456789");
        const std::string message = runSerosa(folder.path(), arguments).err;
        for (std::string word : words) {
            word = word.substr(0, word.find('=')); // "stiffness=" takes a number
            EXPECT_TRUE(std::regex_search(message, std::regex("\\b" + word + "\\b")))
                << word << ": " << message;
        }
        const std::size_t open = message.find("known: ");
        if (open != std::string::npos) {
            const std::string known = message.substr(open + 7, message.find(')', open) - open - 7);
            EXPECT_EQ(words.size(), std::size_t(std::count(known.begin(), known.end(), ',')) + 1) << message;
        }
    }
}

} // namespace
} // namespace serosa::app
