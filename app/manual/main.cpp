// serosa_manual FOLDER: writes the manual page and the shell completions. Run while building.

#include "app/cli.h"
#include "app/manual/command_tree.h"
#include "app/version.h"

#include <fstream>
#include <iostream>

namespace {

bool write(const std::string& file, const std::string& text) {
    std::ofstream stream(file, std::ios::binary);
    stream << text;
    stream.close();
    if (!stream)
        std::cerr << "serosa_manual: cannot write " << file << "\n";
    return bool(stream);
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::cerr << "usage: serosa_manual FOLDER\n";
        return 2;
    }
    const std::string folder = argv[1];
    int code = 0;
    serosa::app::describeCommandLine([&](const CLI::App& app) {
        const auto tree = serosa::app::commandTree(app);
        if (!tree) {
            std::cerr << "serosa_manual: " << tree.error().message << "\n";
            code = 2;
            return;
        }
        const bool written =
            write(folder + "/serosa.1", serosa::app::manualPage(*tree, serosa::app::programVersion())) &&
            write(folder + "/serosa.bash", serosa::app::bashCompletion(*tree)) &&
            write(folder + "/_serosa", serosa::app::zshCompletion(*tree)) &&
            write(folder + "/serosa.fish", serosa::app::fishCompletion(*tree));
        code = written ? 0 : 2;
    });
    return code;
}
