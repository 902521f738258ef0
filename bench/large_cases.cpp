// Whole runs of the program on large scenes, each in a process of its own: what a headless user waits and
// what memory that takes, from 20,000 nodes and 50,000 faces to a million of both.

#include "bench/cases.h"

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

extern char** environ;

namespace serosa::bench {

namespace {

namespace fs = std::filesystem;

struct Size {
    std::size_t nodes, faces;
};
constexpr Size kSizes[] = {{20000, 50000},   {50000, 100000},  {100000, 200000},
                           {200000, 300000}, {500000, 600000}, {1000000, 1000000}};
constexpr int kFrames = 2;

/// A folder that goes away with the benchmark.
class WorkFolder {
public:
    WorkFolder() {
        std::string name = (fs::temp_directory_path() / "serosa-bench-XXXXXX").string();
        path_ = mkdtemp(name.data());
    }
    ~WorkFolder() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    WorkFolder(const WorkFolder&) = delete;
    WorkFolder& operator=(const WorkFolder&) = delete;
    const fs::path& path() const { return path_; }

private:
    fs::path path_;
};

/// Runs the `serosa` beside this program; what it says goes to `log`.
Status runSerosa(std::vector<std::string> arguments, const fs::path& log) {
    const fs::path program = fs::read_symlink("/proc/self/exe").parent_path().parent_path() / "serosa";
    if (!fs::exists(program))
        return Error{program.string() + " is not there: build the whole preset first"};
    arguments.insert(arguments.begin(), program.string());
    std::vector<char*> argv;
    for (std::string& argument : arguments)
        argv.push_back(argument.data());
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 1, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    posix_spawn_file_actions_adddup2(&actions, 1, 2);
    pid_t child = 0;
    const int failed = posix_spawn(&child, program.c_str(), &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    int status = 0;
    if (failed != 0 || waitpid(child, &status, 0) != child)
        return Error{"cannot run " + program.string()};
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
        std::ifstream stream(log);
        std::string line, last;
        while (std::getline(stream, line))
            last = line;
        return Error{"serosa " + arguments[1] + " failed: " + last};
    }
    return {};
}

Result<std::vector<std::string>> largeRow(const Size& size, const fs::path& folder) {
    const std::string model = (folder / "heart.ply").string(), out = (folder / "out").string();
    const fs::path log = folder / "log";
    SEROSA_TRY(
        runSerosa({"phantom", "heart", "--faces", std::to_string(size.faces), "-o", model, "--force"}, log));
    SEROSA_TRY(
        runSerosa({"run", "--model", model, "--length-unit", "mm", "--nodes", std::to_string(size.nodes),
                   "--frames", std::to_string(kFrames), "--out", out, "--force"},
                  log));
    std::ifstream stream(fs::path(out) / "summary.json");
    const nlohmann::json summary = nlohmann::json::parse(stream, nullptr, false);
    if (summary.is_discarded())
        return Error{"summary.json cannot be read"};
    const nlohmann::json &timing = summary["timing"], &lattice = summary["lattice"];
    const auto seconds = [&](const char* key) { return timing[key].get<double>(); };
    const double nodes = lattice["nodes"].get<double>(), memory = timing["peak_memory_B"].get<double>();
    return std::vector<std::string>{
        std::to_string(lattice["nodes"].get<std::size_t>()),
        std::to_string(summary["organ"]["faces"].get<std::size_t>()),
        figure(1e3 * lattice["spacing_m"].get<double>()),
        figure(seconds("setup_s")),
        figure(seconds("ms_per_step")),
        std::to_string(summary["step"]["steps_per_frame"].get<int>()),
        figure(1e-3 * seconds("ms_steps_per_frame")),
        figure(seconds("ms_draw_per_picture")),
        figure(memory / (1024.0 * 1024.0)),
        figure(memory / nodes),
    };
}

} // namespace

Status benchLarge(const Options& options, Report& report) {
    const WorkFolder folder;
    std::vector<std::vector<std::string>> rows;
    for (const Size& size : kSizes) {
        if (size.nodes > options.largest)
            break;
        SEROSA_ASSIGN(std::vector<std::string> row, largeRow(size, folder.path()));
        rows.push_back(std::move(row));
    }
    report.heading("Whole runs of the heart phantom, " + std::to_string(kFrames) + " frames");
    report.table({"nodes", "faces", "spacing, mm", "set-up, s", "ms a step", "steps a frame", "s a frame",
                  "ms a picture", "peak memory, MiB", "bytes a node"},
                 rows);
    report.line("\nOne run each, 5 kPa, in a process of its own. Memory: of the whole process, with the "
                "surface, Mesa "
                "and what the set-up needs for a while; so bytes a node count the faces too.");
    return {};
}

} // namespace serosa::bench
