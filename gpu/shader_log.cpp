// Compilers name a source by its number: "0:12(5): error" (Mesa), "0(12) : error" (NVIDIA), "ERROR: 0:12:"
// (AMD). Here they become "solver_step.frag:12", with the lines around and the includes that led there.

#include "gpu/program.h"

#include <algorithm>
#include <cstdio>
#include <regex>
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

} // namespace

std::string explainShaderLog(const std::string& log, const ExpandedShader& shader) {
    static const std::regex form(
        R"(^((?:ERROR|WARNING): )?(\d{1,4})(?::(\d{1,6})\(\d+\)|\((\d{1,6})\)|:(\d{1,6})(?=:))\s*:?\s*)");
    std::istringstream lines(log);
    std::string line, result;
    std::set<std::pair<std::size_t, int>> shown;
    while (std::getline(lines, line)) {
        line.erase(std::find(line.begin(), line.end(), '\0'), line.end());
        std::smatch match;
        if (!std::regex_search(line, match, form)) {
            if (!line.empty())
                result += line + "\n";
            continue;
        }
        const std::size_t source = std::stoul(match[2]);
        const int number = std::stoi(match[3].matched ? match[3] : match[4].matched ? match[4] : match[5]);
        if (source >= shader.files.size()) {
            result += line + "\n";
            continue;
        }
        const ExpandedShader::File& file = shader.files[source];
        result += file.name + ":" + std::to_string(number) + ": " + match.suffix().str() + "\n";
        if (shown.size() < kMostExcerpts && shown.emplace(source, number).second)
            result += includeChain(shader, file) + excerpt(file, number);
    }
    return result;
}

} // namespace serosa::gpu
