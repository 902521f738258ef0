#pragma once
// report.html of `serosa run`: what summary.json says, for people. It is made of that document and of the
// picture files' bytes alone, so that the page never disagrees with them. What differs between two runs
// stands in <section id="timing">, all else is the same bytes.

#include <nlohmann/json.hpp>

#include <string>
#include <utility>
#include <vector>

namespace serosa::app {

struct RunPictures {                                 // bytes of PNG files
    std::string contactSheet;                        // empty: none
    std::vector<std::pair<int, std::string>> frames; // number and file, ascending
};

/// `failure` is the error of a run with an organ that was stopped, empty otherwise. The figures of `summary`
/// may be null or not finite: plots have a gap there, tables say so.
std::string runReport(const nlohmann::ordered_json& summary, const RunPictures& pictures,
                      const std::string& failure);

/// Which of the pictures `written` (frame numbers, ascending) the report shows: the one nearest to the
/// largest displacement that was sampled, and the last.
std::vector<int> reportFrames(const nlohmann::ordered_json& summary, const std::vector<int>& written);

} // namespace serosa::app
