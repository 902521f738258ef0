#pragma once
// The options of commands that take a scene or a model, `run` and `view`, of `bench`, and what others share
// with them.

#include "app/run.h"
#include "base/result.h"

#include <glm/glm.hpp>

#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace serosa::app {

/// The index of a word, or an error that names the option.
Result<int> wordIndex(const std::string& option, const std::string& text,
                      const std::vector<std::string>& words);
/// A name of solverNames(); for "picked", the one that the user's configuration has. Errors name --solver.
Result<std::string> chosenSolver(const std::string& text);
/// "2.5 mm" in metres, more than 0. Errors name --spacing.
Result<double> parseSpacing(const std::string& text);

/// "960x540" in pixels. Errors name --size.
Result<glm::ivec2> parseSize(const std::string& text);

void addGlOption(CLI::App& command, std::string& gl);
void addRepairFlag(CLI::App& command, bool& repair);

/// Each adds its command, which leaves what to do in `action`.
void addRun(CLI::App& app, std::function<Result<int>()>& action);
void addBench(CLI::App& app, std::function<Result<int>()>& action);
void addView(CLI::App& app, std::function<Result<int>()>& action);

} // namespace serosa::app
