// Compilers name a source by its number: "0:12(5): error" (Mesa), "0(12) : error" (NVIDIA), "ERROR: 0:12:"
// (AMD). Here they become "solver_step.frag:12", with the lines around and the includes that led there.

#include "gpu/program.h"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <set>
#include <sstream>

namespace serosa::gpu {

namespace {

constexpr int kLinesAround = 2;
constexpr std::size_t kMostExcerpts = 5; // the first errors; the rest usually follow from them

std::string excerpt(const ExpandedShader::File& file, int line) {
    std::istringstream lines(file.text);
    std::string text, result;
    for (int number = 1; std::getline(lines, text); ++number) {
        if (number < line - kLinesAround || number > line + kLinesAround)
            continue;
        char prefix[24];
        std::snprintf(prefix, sizeof prefix, "%c%5d | ", number == line ? '>' : ' ', number);
        result += prefix + text + "\n";
    }
    return result;
}

std::string includeChain(const ExpandedShader& shader, const ExpandedShader::File& file) {
    std::string chain;
    for (const ExpandedShader::File* at = &file; at->includedFrom >= 0;) {
        const int line = at->includedAtLine;
        at = &shader.files[static_cast<std::size_t>(at->includedFrom)];
        chain += "    included from " + at->name + ":" + std::to_string(line) + "\n";
    }
    return chain;
}

struct Position {
    std::size_t source;
    int line;
    std::size_t messageAt; // where the driver's message begins
};

/// Reads a number of at most six digits at `at` and steps over it.
std::optional<int> number(const std::string& text, std::size_t& at) {
    constexpr std::size_t kMostDigits = 6;
    std::size_t end = at;
    while (end < text.size() && end < at + kMostDigits && text[end] >= '0' && text[end] <= '9')
        ++end;
    if (end == at)
        return std::nullopt;
    const int value = std::stoi(text.substr(at, end - at));
    at = end;
    return value;
}

bool skip(const std::string& text, std::size_t& at, const std::string& expected) {
    if (text.compare(at, expected.size(), expected) != 0)
        return false;
    at += expected.size();
    return true;
}

/// "0:12(5)", "0(12)" or "ERROR: 0:12" at the start of a line of the log.
std::optional<Position> position(const std::string& text) {
    std::size_t at = 0;
    if (!skip(text, at, "ERROR: "))
        skip(text, at, "WARNING: ");
    const auto source = number(text, at);
    if (!source)
        return std::nullopt;
    const bool colon = skip(text, at, ":");
    if (!colon && !skip(text, at, "("))
        return std::nullopt;
    const auto line = number(text, at);
    if (!line)
        return std::nullopt;
    if (!colon) {
        if (!skip(text, at, ")"))
            return std::nullopt;
    } else if (skip(text, at, "(")) { // Mesa's column
        number(text, at);
        if (!skip(text, at, ")"))
            return std::nullopt;
    }
    at = text.find_first_not_of(" :", at);
    return Position{static_cast<std::size_t>(*source), *line, std::min(at, text.size())};
}

} // namespace

std::string explainShaderLog(const std::string& log, const ExpandedShader& shader) {
    std::istringstream lines(log);
    std::string line, result;
    std::set<std::pair<std::size_t, int>> shown;
    while (std::getline(lines, line)) {
        line.erase(std::find(line.begin(), line.end(), '\0'), line.end());
        const std::optional<Position> found = position(line);
        if (!found || found->source >= shader.files.size()) {
            if (!line.empty())
                result += line + "\n";
            continue;
        }
        const ExpandedShader::File& file = shader.files[found->source];
        result += file.name + ":" + std::to_string(found->line) + ": " + line.substr(found->messageAt) + "\n";
        if (shown.size() < kMostExcerpts && shown.emplace(found->source, found->line).second)
            result += includeChain(shader, file) + excerpt(file, found->line);
    }
    return result;
}

} // namespace serosa::gpu
