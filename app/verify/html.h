#pragma once
// report.html of `serosa verify`: what verify.json says, for people; failures first. Made of that document,
// so that the page never disagrees with it. Wall times stand in <section id="timing">.

#include <nlohmann/json.hpp>

#include <string>
#include <utility>
#include <vector>

namespace serosa::app {

struct VerifyPagePicture {
    std::string group, png, caption; // png: the file's bytes
};

/// What the page says beside the checks.
struct VerifyPageFacts {
    std::string version;  // of the program: "0.1.0"
    std::string renderer; // of the context; empty without one
    std::string injected; // a fault that was put in on purpose, as --inject has it; empty: none
    bool full = false;    // --full
    std::vector<std::pair<std::string, double>> seconds; // wall time of each group
    std::vector<VerifyPagePicture> pictures = {};        // each stands below its group's checks
};

std::string verifyReport(const nlohmann::ordered_json& checks, const VerifyPageFacts& facts);

/// Share of what the check allows that the measured value uses, 1 at the limit: of the tolerance, of an upper
/// limit, of a lower limit's inverse. NaN where there is none (a limit of 0, a figure that is null).
double shareOfLimit(const nlohmann::ordered_json& check);

} // namespace serosa::app
