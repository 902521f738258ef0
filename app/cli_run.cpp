// See app/cli_run.h.

#include "app/cli_run.h"

#include "app/pick_solver.h"
#include "app/solver_choice.h"
#include "app/user_config.h"
#include "app/view.h"
#include "shaders/shared_constants.h"
#include "sim/quantity.h"
#include "sim/scene_keys.h"
#include "sim/suggest.h"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>

namespace serosa::app {

namespace {

struct RunArguments {
    std::string scene, model, lengthUnit, gl = "auto", size, mapping, show, out, spacing, layout = "auto",
                                          from;
    std::optional<std::string> solver;
    int frames = 0;
    std::string upAxis;
    std::vector<std::string> surfaces;
    std::size_t nodes = 0;
    bool force = false, repair = false, anySolver = false;
};

Result<RunOptions> runOptions(const std::string& command, const RunArguments& given) {
    RunOptions options;
    if (given.scene.empty() == given.model.empty())
        return Error{given.scene.empty()
                         ? command +
                               " needs a scene file, or --model FILE with --length-unit U (see 'serosa " +
                               command + " --help')"
                         : command + " takes a scene file or --model, not both"};
    if (!given.model.empty() && given.lengthUnit.empty())
        return Error{"--model needs --length-unit: a mesh file has no unit (mm, cm, m, um, in)"};
    const bool file = !given.model.empty() || !given.surfaces.empty();
    if (!given.model.empty() && !given.surfaces.empty())
        return Error{"--surface belongs to a scene file: it stands in for an organ's own surface"};
    if (!file && !given.lengthUnit.empty())
        return Error{"--length-unit belongs to --model and --surface; a scene file says length_unit"};
    if (!file && given.repair)
        return Error{"--repair belongs to --model and --surface; a scene file says repair = true"};
    if (!file && !given.upAxis.empty())
        return Error{"--up-axis belongs to --model and --surface; a scene file says up_axis"};
    options.scene = given.scene;
    options.model = given.model;
    options.lengthUnit = given.lengthUnit;
    options.repair = given.repair;
    if (!given.upAxis.empty()) {
        SEROSA_ASSIGN(const int axis,
                      wordIndex("--up-axis", given.upAxis, sim::findSceneKey("organ", "up_axis")->words));
        options.upAxis = sim::UpAxis(axis);
        options.surfaces.upAxis = options.upAxis;
    }
    options.surfaces.wanted = given.surfaces;
    options.surfaces.repair = given.repair;
    if (!given.surfaces.empty() && !given.lengthUnit.empty()) {
        SEROSA_ASSIGN(options.surfaces.lengthUnit, sim::parseLengthUnit(given.lengthUnit));
    }
    options.from = given.from;
    options.anySolver = given.anySolver;
    if (given.anySolver && (given.from.empty() || !given.solver))
        return Error{"--any-solver belongs to --from with --solver: it lets the two name different solvers"};
    if (given.solver) {
        SEROSA_ASSIGN(options.solver, chosenSolver(*given.solver));
    } else if (!given.from.empty()) {
        options.solver.clear();
    }
    SEROSA_ASSIGN(options.gl, gpu::parseGlChoice(given.gl));
    SEROSA_ASSIGN(const int layout, wordIndex("--layout", given.layout, {"auto", "grid", "rows"}));
    options.layout = layout == 0 ? -1 : layout == 1 ? SRS_LAYOUT_GRID : SRS_LAYOUT_ROWS;
    if (given.frames > 0)
        options.frames = given.frames;
    if (!given.size.empty()) {
        SEROSA_ASSIGN(const glm::ivec2 size, parseSize(given.size));
        options.width = size.x;
        options.height = size.y;
    }
    if (!given.mapping.empty()) {
        SEROSA_ASSIGN(const int mapping,
                      wordIndex("--mapping", given.mapping, sim::findSceneKey("look", "mapping")->words));
        options.mapping = sim::Mapping(mapping);
    }
    if (!given.show.empty()) {
        SEROSA_ASSIGN(const int show,
                      wordIndex("--show", given.show, sim::findSceneKey("look", "show")->words));
        options.show = sim::Show(show);
    }
    if (given.nodes > 0)
        options.nodes = given.nodes;
    if (!given.spacing.empty()) {
        SEROSA_ASSIGN(options.spacing, parseSpacing(given.spacing));
    }
    options.out = given.out;
    options.force = given.force;
    return options;
}

/// What both commands take.
void addSceneOptions(CLI::App& command, RunArguments& given) {
    command.add_option("scene", given.scene, "scene file (docs/scene.md)")->type_name("SCENE");
    command
        .add_option(
            "--model", given.model,
            "instead of a scene: a closed surface (OBJ, PLY, OFF, STL, VTK, TetGen) with a default tissue (5 "
            "kPa) and probe")
        ->type_name("FILE");
    command
        .add_option("--surface", given.surfaces,
                    "another closed surface for an organ of the scene, brought to the size and place of its "
                    "own (with --length-unit: in its own); once for each")
        ->type_name("ORGAN=FILE")
        ->allow_extra_args(false);
    command
        .add_option("--length-unit", given.lengthUnit,
                    "unit of the coordinates of --model or --surface: mm, cm, m, um, in")
        ->type_name("U");
    command
        .add_option("--up-axis", given.upAxis,
                    "axis of --model or --surface that points up: x, y, z, -x, -y, -z (default: y)")
        ->type_name("A");
    addRepairFlag(command, given.repair);
    command.add_option("--size", given.size, "size of the pictures in pixels (default: 960x960)")
        ->type_name("WxH");
    command
        .add_option("--mapping", given.mapping,
                    "how the surface follows the lattice: one-to-one, triangle, curvature, chosen, "
                    "normal-offset, trilinear, node-frames")
        ->type_name("M");
    command
        .add_option("--show", given.show,
                    "what is drawn of organs: surface, implicit (ray-cast through the lattice), both")
        ->type_name("S");
    command.add_option("--nodes", given.nodes, "lattice nodes aimed at (default: 20000)")
        ->type_name("N")
        ->check(CLI::Range(8, 1000000000));
    command
        .add_option("--spacing", given.spacing,
                    "lattice spacing with its unit, such as \"2.5 mm\", instead of --nodes")
        ->type_name("L")
        ->excludes("--nodes");
    command
        .add_option(
            "--solver", given.solver,
            "fragment or compute (on the GPU), cpu (all cores), reference (CPU, double precision, slow), or "
            "picked: what 'serosa bench --pick' found fastest here")
        ->default_str("fragment");
    command
        .add_option("--layout", given.layout,
                    "textures of the lattice: auto (by how full its grid is), grid, rows")
        ->default_str("auto");
}

} // namespace

Result<glm::ivec2> parseSize(const std::string& text) {
    glm::ivec2 size(0);
    char rest = 0;
    if (text.size() > 16 || std::sscanf(text.c_str(), "%dx%d%c", &size.x, &size.y, &rest) != 2)
        return Error{"--size: " + sim::inQuotes(text) +
                     " is not a size: write width x height in pixels, such as 960x540"};
    const sim::ValueRange range = sim::findSceneKey("output", "size")->range;
    if (!range.holds(size.x) || !range.holds(size.y))
        return Error{"--size: " + sim::inQuotes(text) + ": each side goes " + range.text() + " pixels"};
    return size;
}

Result<int> wordIndex(const std::string& option, const std::string& text,
                      const std::vector<std::string>& words) {
    for (std::size_t i = 0; i < words.size(); ++i)
        if (text == words[i])
            return int(i);
    return Error{option + ": unknown value " + sim::inQuotes(text) + sim::suggestion(text, words)};
}

Result<double> parseSpacing(const std::string& text) {
    Result<double> spacing = sim::parseQuantity(text, sim::Dimension::length);
    if (!spacing)
        return Error{"--spacing: " + spacing.error().message};
    if (!(*spacing > 0))
        return Error{"--spacing: " + sim::inQuotes(text) + " is not greater than 0"};
    return spacing;
}

void addGlOption(CLI::App& command, std::string& gl) {
    command
        .add_option("--gl", gl,
                    "OpenGL context: auto (a GPU's EGL device, EGL, then OSMesa), egl, egl-device, osmesa")
        ->default_str("auto");
}

void addRepairFlag(CLI::App& command, bool& repair) {
    command.add_flag("--repair", repair,
                     "mend winding, small holes, duplicate faces and stray vertices (docs/import.md)");
}

/// An unset variable of a script must not choose a folder.
std::string notEmpty(const std::string& text) {
    return text.empty() ? "is empty: name a folder, or leave the option out" : "";
}

Result<std::string> chosenSolver(const std::string& text) {
    std::vector<std::string> words = solverNames();
    words.push_back("picked");
    SEROSA_TRY(wordIndex("--solver", text, words));
    if (text != "picked")
        return text;
    const Result<PickedSolver> picked = readPickedSolver();
    if (!picked)
        return Error{"--solver picked: " + picked.error().message};
    return picked->solver;
}

void addBench(CLI::App& app, std::function<Result<int>()>& action) {
    CLI::App* command =
        app.add_subcommand("bench", "Measure the solvers on this machine and pick the fastest");
    struct Arguments {
        std::string gl = "auto";
        bool pick = false;
        PickOptions options;
    };
    auto given = std::make_shared<Arguments>();
    command->add_flag("--pick", given->pick, "write the fastest to the user's configuration (required)")
        ->required();
    command->add_option("--nodes", given->options.nodes, "lattice nodes aimed at")
        ->type_name("N")
        ->check(CLI::Range(8, 1000000000))
        ->default_str("20000");
    command->add_option("--rounds", given->options.rounds, "interleaved rounds")
        ->type_name("N")
        ->check(CLI::Range(1, 1000))
        ->default_str("5");
    command->add_option("--seconds", given->options.seconds, "length of a turn of a solver")
        ->type_name("S")
        ->check(CLI::Range(0.001, 60.0))
        ->default_str("0.3");
    addGlOption(*command, given->gl);
    command->footer(
        "Let nothing else run meanwhile. The configuration is $XDG_CONFIG_HOME/serosa/config.toml, or "
        "~/.config/serosa/config.toml;\n"
        "'--solver picked' of run, view and verify reads it, nothing else does.\n"
        "Example:\n  serosa bench --pick --nodes 50000\n"
        "Exit codes: 0 picked, 1 a solver does not agree with the reference, 2 bad input, 5 no OpenGL "
        "context.");
    command->callback([given, &action] {
        action = [given]() -> Result<int> {
            SEROSA_ASSIGN(given->options.gl, gpu::parseGlChoice(given->gl));
            return pickFastestSolver(given->options, std::cout);
        };
    });
}

void addRun(CLI::App& app, std::function<Result<int>()>& action) {
    CLI::App* command = app.add_subcommand(
        "run", "Simulate a scene or a model; write pictures, surfaces, summary.json, report.html");
    auto given = std::make_shared<RunArguments>();
    addSceneOptions(*command, *given);
    command->add_option("--out", given->out, "output folder (default: name of the scene or model with -out)")
        ->type_name("DIR")
        ->check(notEmpty);
    command->add_flag("--force", given->force,
                      "write into a folder that holds something; results of an earlier run are replaced");
    command
        ->add_option("--frames", given->frames,
                     "number of frames, instead of the scene's duration (default model: 120)")
        ->type_name("N")
        ->check(CLI::Range(1, 1000000));
    command
        ->add_option("--from", given->from,
                     "go on from a snapshot that a run of this scene wrote (docs/snapshots.md), with its "
                     "solver")
        ->type_name("FILE")
        ->check(notEmpty);
    command->add_flag("--any-solver", given->anySolver,
                      "with --from: go on with --solver, though another made the snapshot; the bytes are not "
                      "those of a run that never stopped");
    addGlOption(*command, given->gl);
    command->footer(
        "Examples:\n"
        "  serosa run heart.toml\n"
        "  serosa run heart.toml --from heart-out/snapshot_000060.serosa --out later\n"
        "  serosa run --model liver.stl --length-unit mm --nodes 5000 --frames 60 --out liver\n"
        "Exit codes: 0 done, 1 an organ was stopped, 2 bad input, 5 no OpenGL context, 130 interrupted.");
    command->callback([given, &action] {
        action = [given]() -> Result<int> {
            SEROSA_ASSIGN(const RunOptions options, runOptions("run", *given));
            return runScene(options, std::cout);
        };
    });
}

void addView(CLI::App& app, std::function<Result<int>()>& action) {
    CLI::App* command = app.add_subcommand("view", "Show a scene or a model in a window (docs/view.md)");
    struct Arguments : RunArguments {
        std::string shaders;
        int quitAfter = 0;
        bool fast = false, noPanel = false;
    };
    auto given = std::make_shared<Arguments>();
    addSceneOptions(*command, *given);
    command->add_option("--out", given->out, "folder for screenshots (default: the current one)")
        ->type_name("DIR");
    command
        ->add_option("--shaders", given->shaders,
                     "folder that F5 takes the drawing shaders from: edit them while they are in use")
        ->type_name("DIR");
    command
        ->add_option("--quit-after", given->quitAfter,
                     "close after that many frames of the scene; the last line has the hash of the state")
        ->type_name("N")
        ->check(CLI::Range(1, 1000000));
    command->add_flag("--fast", given->fast, "as fast as it goes, not in real time");
    command->add_flag("--no-panel", given->noPanel, "start without the panel (p shows it)");
    command->footer(
        "Keys: space pause, . step, r restart, 1 2 3 4 mapping, l lattice, w wires, n normals, s F12 "
        "screenshots,\n"
        "F5 shaders, c camera, p panel, d next deformation, q quit. Mouse: drag turns, right drag moves, "
        "wheel zooms;\n"
        "ctrl + drag holds tissue, ctrl + right drag pushes it; ctrl + shift + drag moves a deformation, "
        "with the\n"
        "right button turns it, with the wheel scales it.\n"
        "Examples:\n"
        "  serosa view heart.toml\n"
        "  serosa view --model liver.stl --length-unit mm --nodes 5000\n"
        "Exit codes: 0 closed, 1 an organ was stopped, 2 bad input, 5 no display or no OpenGL, 130 "
        "interrupted.");
    command->callback([given, &action] {
        action = [given]() -> Result<int> {
            ViewOptions options;
            SEROSA_ASSIGN(options.run, runOptions("view", *given));
            options.shaders = given->shaders;
            if (!given->out.empty())
                options.pictures = given->out;
            options.quitAfter = given->quitAfter;
            options.fast = given->fast;
            options.panel = !given->noPanel;
            return runView(options, std::cout);
        };
    });
}

} // namespace serosa::app
