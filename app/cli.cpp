// CLI11 reads the options; each command has one function that adds it, and leaves what to do in
// `Choice::action`.

#include "app/cli.h"

#include "app/cli_run.h"
#include "app/commands.h"
#include "app/doctor.h"
#include "app/map_nodes.h"
#include "app/scene_snapshot.h"
#include "app/verify/verify.h"
#include "app/version.h"
#include "models/phantom.h"
#include "sim/quantity.h"
#include "sim/scene_keys.h"
#include "sim/suggest.h"

#include <CLI/CLI.hpp>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <exception>
#include <filesystem>
#include <functional>
#include <iostream>
#include <new>

namespace serosa::app {

namespace {

/// What the user asked for: set by the command's callback, run after all of the line is read.
struct Choice {
    std::function<Result<int>()> action;
    int verbosity = 0;
};

std::string oneLine(std::string text) {
    while (!text.empty() && (text.back() == '\n' || text.back() == ' '))
        text.pop_back();
    for (char& c : text)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
            c = ' ';
    return text;
}

int report(const Error& error) {
    std::cerr << "serosa: error: " << oneLine(error.message) << "\n";
    return error.exitCode;
}

Result<Injection> parseInjection(const std::string& text) {
    const std::string name = text.substr(0, text.find('='));
    const std::string value = name.size() < text.size() ? text.substr(name.size() + 1) : "";
    SEROSA_ASSIGN(const int fault, wordIndex("--inject", name, {"stiffness", "drop-spring", "stale-normal"}));
    Injection injection{Fault(fault + 1), 1};
    if (injection.fault != Fault::stiffness && name.size() < text.size())
        return Error{"--inject: " + name + " takes no value"};
    if (injection.fault == Fault::stiffness) {
        char* end = nullptr;
        injection.factor = std::strtod(value.c_str(), &end);
        if (value.empty() || *end != '\0' || !(injection.factor > 0 && injection.factor < 100))
            return Error{"--inject: stiffness needs a factor from 0 to 100, such as stiffness=1.05"};
    }
    return injection;
}

void addInspect(CLI::App& app, Choice& choice) {
    CLI::App* command = app.add_subcommand(
        "inspect", "Say what a mesh is and what lattice it would give, or what a snapshot holds");
    struct Arguments {
        std::string file, lengthUnit, spacing;
        std::size_t nodes = 20000;
        bool repair = false;
    };
    auto given = std::make_shared<Arguments>();
    command
        ->add_option("file", given->file, "surface: OBJ, PLY, OFF, STL, VTK or TetGen; or a .serosa snapshot")
        ->required()
        ->type_name("FILE");
    command->add_option("--length-unit", given->lengthUnit, "unit of its coordinates: mm, cm, m, um, in")
        ->type_name("U");
    command->add_option("--nodes", given->nodes, "lattice nodes aimed at")
        ->type_name("N")
        ->check(CLI::Range(8, 1000000000))
        ->default_str("20000");
    command
        ->add_option("--spacing", given->spacing, "lattice spacing, such as \"2.5 mm\", instead of --nodes")
        ->type_name("L")
        ->excludes("--nodes");
    addRepairFlag(*command, given->repair);
    command->footer("Example:\n  serosa inspect liver.stl --length-unit mm\n"
                    "Exit codes: 0 usable, 2 unreadable, or no closed solid.");
    command->callback([given, command, &choice] {
        choice.action = [given, command]() -> Result<int> {
            if (std::filesystem::path(given->file).extension() == ".serosa") {
                if (command->count("--length-unit") + command->count("--nodes") +
                        command->count("--spacing") + command->count("--repair") >
                    0)
                    return Error{"inspect takes no other options beside a snapshot: leave them out"};
                return inspectSnapshot(given->file, std::cout);
            }
            std::optional<double> spacing;
            if (!given->spacing.empty()) {
                if (given->lengthUnit.empty())
                    return Error{"--spacing needs --length-unit: without it the mesh has no unit"};
                SEROSA_ASSIGN(spacing, parseSpacing(given->spacing));
            }
            return inspectModel(given->file, given->repair, given->lengthUnit, given->nodes, spacing,
                                std::cout);
        };
    });
}

void addRepair(CLI::App& app, Choice& choice) {
    CLI::App* command = app.add_subcommand("repair", "Mend a surface's named faults and write it");
    struct Arguments {
        std::string from, to;
        bool force = false;
    };
    auto given = std::make_shared<Arguments>();
    command->add_option("file", given->from, "surface: OBJ, PLY, OFF, STL, VTK or TetGen")
        ->required()
        ->type_name("FILE");
    command->add_option("-o,--output", given->to, "file to write: .ply, .obj, .off or .stl")
        ->required()
        ->type_name("OUT");
    command->add_flag("--force", given->force, "replace an existing file");
    command->footer(
        "Mends faces with a repeated corner, duplicate faces, winding, holes of at most 128 edges "
        "and a fifth of the surface's size, and stray vertices; says what it did. All else is "
        "refused (docs/import.md).\n"
        "Example:\n  serosa repair scan.obj -o organ.ply\n"
        "Exit codes: 0 written, 2 unreadable, or a fault that is not mended.");
    command->callback([given, &choice] {
        choice.action = [given] { return repairModel(given->from, given->to, given->force, std::cout); };
    });
}

void addScene(CLI::App& app, Choice& choice) {
    CLI::App* scene = app.add_subcommand("scene", "Check or explain a scene file");
    scene->require_subcommand(1);
    auto file = std::make_shared<std::string>();
    CLI::App* check = scene->add_subcommand("check", "Check a scene, its model and its lattice; run nothing");
    check->add_option("file", *file, "scene file")->required()->type_name("SCENE");
    check->callback([file, &choice] { choice.action = [file] { return checkSceneFile(*file, std::cout); }; });
    CLI::App* explain = scene->add_subcommand(
        "explain", "Print every value in SI units, where it comes from, and what follows");
    explain->add_option("file", *file, "scene file")->required()->type_name("SCENE");
    explain->callback(
        [file, &choice] { choice.action = [file] { return explainSceneFile(*file, std::cout); }; });
    CLI::App* keys =
        scene->add_subcommand("keys", "Print the reference of all keys of a scene file (Markdown)");
    keys->callback([&choice] { choice.action = [] { return printSceneKeys(std::cout); }; });
    struct Texture {
        std::string file, out;
        std::size_t number = 1;
        bool force = false;
    };
    auto texture = std::make_shared<Texture>();
    CLI::App* deformation = scene->add_subcommand(
        "deformation", "Write one of a scene's deformations as a texture, for kind = \"texture\"");
    deformation->add_option("file", texture->file, "scene file")->required()->type_name("SCENE");
    deformation->add_option("-o,--out", texture->out, "texture (.nrrd, .mha)")->required()->type_name("FILE");
    deformation->add_option("--number", texture->number, "which of them, from 1")->type_name("N");
    deformation->add_flag("--force", texture->force, "replace an existing file");
    deformation->callback([texture, &choice] {
        choice.action = [texture] {
            return writeSceneDeformation(texture->file, texture->number, texture->out, texture->force,
                                         std::cout);
        };
    });
    scene->footer("Examples:\n  serosa scene check heart.toml\n  serosa scene explain heart.toml");
}

void addPhantom(CLI::App& app, Choice& choice) {
    CLI::App* command = app.add_subcommand("phantom", "Generate an organ, in millimetres");
    struct Arguments {
        std::string name, file, volume;
        std::size_t faces = 0;
        double voxel = 1;
        bool force = false;
    };
    auto given = std::make_shared<Arguments>();
    command->add_option("name", given->name, "which one (below)")->required()->type_name("NAME");
    command->add_option("--faces", given->faces, "at least so many faces, at most 5% more")
        ->type_name("N")
        ->check(CLI::Range(1, 100000000));
    CLI::Option* surface =
        command->add_option("-o,--output", given->file, "file to write: .ply, .obj, .off or .stl")
            ->type_name("FILE");
    CLI::Option* volume = command
                              ->add_option("--volume", given->volume,
                                           "write what cuts through it show, too: colours, .nrrd or .mha")
                              ->type_name("FILE");
    command->add_option("--voxel", given->voxel, "of the volume (default 1)")->type_name("MM")->needs(volume);
    command->add_flag("--force", given->force, "replace an existing file");
    std::string list = "Phantoms:\n";
    for (const models::PhantomInfo& info : models::phantoms())
        list += "  " + info.name + std::string(info.name.size() < 8 ? 8 - info.name.size() : 1, ' ') +
                info.description + " (default " + std::to_string(info.defaultFaces) + " faces)\n";
    command->footer(list + "Example:\n  serosa phantom heart --faces 50000 -o heart.ply");
    command->callback([given, surface, volume, &choice] {
        if (surface->empty() && volume->empty())
            throw CLI::RequiredError("--output or --volume");
        choice.action = [given] {
            return writePhantom(
                {given->name, given->faces, given->file, given->volume, given->voxel, given->force},
                std::cout);
        };
    });
}

void addMap(CLI::App& app, Choice& choice) {
    CLI::App* command =
        app.add_subcommand("map", "Let a detailed surface follow a coarse mesh that something else moves");
    struct Arguments {
        MapOptions options;
        std::string mapping, size, gl = "auto";
    };
    auto given = std::make_shared<Arguments>();
    command->add_option("surface", given->options.surface, "detailed surface at rest; need not be closed")
        ->required()
        ->type_name("SURFACE");
    command->add_option("--nodes", given->options.nodes, "coarse mesh at rest, in the same unit and place")
        ->required()
        ->type_name("FILE");
    command
        ->add_option("--frames", given->options.frames,
                     "folder with that mesh in each frame, in the order of the file names")
        ->required()
        ->type_name("DIR");
    command->add_option("--length-unit", given->options.lengthUnit, "unit of all files: mm, cm, m, um, in")
        ->required()
        ->type_name("U");
    command
        ->add_option("--mapping", given->mapping,
                     "triangle, curvature, chosen, normal-offset or node-frames (default)")
        ->type_name("M");
    command->add_option("--out", given->options.out, "folder for surface_000001.ply and on")
        ->required()
        ->type_name("DIR");
    command->add_flag("--pictures", given->options.pictures, "draw frame_000001.png and on, too");
    command->add_option("--size", given->size, "size of the pictures in pixels (default: 960x960)")
        ->type_name("WxH");
    addGlOption(*command, given->gl);
    command->add_flag("--force", given->options.force, "replace surfaces of an earlier run");
    command->footer(
        "Example:\n  serosa map fine.ply --nodes coarse.ply --frames moving --length-unit mm --out "
        "moved\n"
        "Exit codes: 0 written, 2 bad input, 5 no OpenGL context for pictures.");
    command->callback([given, &choice] {
        choice.action = [given]() -> Result<int> {
            if (!given->mapping.empty()) {
                SEROSA_ASSIGN(const int mapping, wordIndex("--mapping", given->mapping,
                                                           sim::findSceneKey("look", "mapping")->words));
                given->options.mapping = sim::Mapping(mapping);
            }
            SEROSA_ASSIGN(given->options.gl, gpu::parseGlChoice(given->gl));
            if (!given->size.empty()) {
                SEROSA_ASSIGN(const glm::ivec2 size, parseSize(given->size));
                given->options.width = size.x;
                given->options.height = size.y;
            }
            return mapNodes(given->options, std::cout);
        };
    });
}

void addVerify(CLI::App& app, Choice& choice) {
    CLI::App* command =
        app.add_subcommand("verify", "Verify this program on this machine against known results");
    struct Arguments {
        std::vector<std::string> groups;
        std::string out, gl = "auto", inject, solver;
        bool allowSkip = false, full = false;
    };
    auto given = std::make_shared<Arguments>();
    command->add_option("groups", given->groups, "groups to run; all without")->type_name("GROUP");
    command->add_option("--out", given->out, "folder for verify.json and report.html (docs/cli.md)")
        ->type_name("DIR");
    command
        ->add_option("--solver", given->solver,
                     "group solver: the one that is compared with the reference on the heart; all without")
        ->type_name("NAME");
    command->add_flag("--full", given->full, "every figure at its full length (slow)");
    command->add_flag("--allow-skip", given->allowSkip, "a check that cannot run here is no failure");
    command
        ->add_option(
            "--inject", given->inject,
            "put a fault in, to see the group that owns it fail: stiffness=1.05, drop-spring, stale-normal")
        ->type_name("FAULT");
    addGlOption(*command, given->gl);
    std::string list = "Groups:\n";
    for (const VerifyGroup& group : verifyGroups())
        list += "  " + group.name + std::string(group.name.size() < 9 ? 9 - group.name.size() : 1, ' ') +
                group.description + "\n";
    command->footer(list +
                    "Examples:\n  serosa verify\n  serosa verify solver --out report\n"
                    "Exit codes: 0 all passed, 1 a check failed, 2 unknown group, 5 no OpenGL context.");
    command->callback([given, &choice] {
        choice.action = [given]() -> Result<int> {
            VerifyOptions options;
            SEROSA_ASSIGN(options.gl, gpu::parseGlChoice(given->gl));
            if (!given->inject.empty()) {
                SEROSA_ASSIGN(options.inject, parseInjection(given->inject));
            }
            options.full = given->full;
            if (!given->solver.empty()) {
                SEROSA_ASSIGN(options.solver, chosenSolver(given->solver));
            }
            return runVerify(given->groups, options, given->out, given->allowSkip, std::cout);
        };
    });
}

void addDoctor(CLI::App& app, Choice& choice) {
    CLI::App* command =
        app.add_subcommand("doctor", "Say what this machine's OpenGL offers, what is missing, what to do");
    command->footer(doctorHelp());
    command->callback([&choice] { choice.action = []() -> Result<int> { return runDoctor(std::cout); }; });
}

/// Logs go to stderr and are quiet but for errors: a failed command says one line.
void setUpLog(int verbosity) {
    spdlog::set_default_logger(
        std::make_shared<spdlog::logger>("serosa", std::make_shared<spdlog::sinks::stderr_sink_st>()));
    spdlog::set_pattern("serosa: %l: %v");
    spdlog::set_level(verbosity == 0   ? spdlog::level::err
                      : verbosity == 1 ? spdlog::level::info
                                       : spdlog::level::debug);
}

/// The command that a usage error belongs to, for the hint.
std::string commandName(const CLI::App& app) {
    std::string name = "serosa";
    for (const CLI::App* at = &app; !at->get_subcommands().empty();) {
        at = at->get_subcommands().front();
        name += " " + at->get_name();
    }
    return name;
}

std::string usageMessage(const CLI::App& app, const CLI::ParseError& problem, int argc, char** argv) {
    std::string message = oneLine(problem.what());
    // An unknown command is an extra argument to CLI11: name the nearest one instead.
    if (app.get_subcommands().empty() && argc > 1 && argv[1][0] != '-') {
        std::vector<std::string> names;
        for (const CLI::App* command : app.get_subcommands(nullptr))
            names.push_back(command->get_name());
        message = "unknown command " + sim::inQuotes(argv[1]) + sim::suggestion(argv[1], names);
    }
    return message + " (see '" + commandName(app) + " --help')";
}

/// All commands and options. `choice` outlives the tree.
std::unique_ptr<CLI::App> makeCommandTree(Choice& choice) {
    auto tree = std::make_unique<CLI::App>(
        "Serosa simulates soft organs in real time: a coarse lattice of springs moves, and a "
        "detailed surface follows.",
        "serosa");
    CLI::App& app = *tree;
    app.set_version_flag("--version", std::string("serosa ") + programVersion());
    app.require_subcommand(1);
    app.fallthrough();
    app.add_flag("-v,--verbose", choice.verbosity, "log to stderr; -vv says more");
    addRun(app, choice.action);
    addView(app, choice.action);
    addInspect(app, choice);
    addRepair(app, choice);
    addScene(app, choice);
    addPhantom(app, choice);
    addMap(app, choice);
    addVerify(app, choice);
    addBench(app, choice.action);
    addDoctor(app, choice);
    app.footer("First steps:\n"
               "  serosa phantom heart -o heart.ply\n"
               "  serosa run --model heart.ply --length-unit mm\n"
               "'serosa COMMAND --help' says more. Exit codes: 0 ok, 1 a check failed, 2 bad input, 5 no "
               "OpenGL context.");
    return tree;
}

int runChecked(int argc, char** argv) {
    Choice choice;
    const std::unique_ptr<CLI::App> tree = makeCommandTree(choice);
    CLI::App& app = *tree;
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& problem) {
        if (problem.get_exit_code() == 0)
            return app.exit(problem); // help and version
        return report(Error{usageMessage(app, problem, argc, argv)});
    }
    setUpLog(choice.verbosity);
    const Result<int> code = choice.action();
    std::cout.flush();
    if (code && !std::cout)
        return report(Error{"cannot write to the standard output: is its disk full, or its reader gone?"});
    return code ? *code : report(code.error());
}

} // namespace

void describeCommandLine(const std::function<void(const CLI::App&)>& describe) {
    Choice choice;
    describe(*makeCommandTree(choice));
}

int runCommandLine(int argc, char** argv) {
    try {
        return runChecked(argc, argv);
    } catch (const std::bad_alloc&) {
        return report(Error{"out of memory: use fewer nodes, a coarser spacing or smaller pictures"});
    } catch (const std::filesystem::filesystem_error& problem) {
        return report(Error{problem.what()});
    }
}

} // namespace serosa::app
