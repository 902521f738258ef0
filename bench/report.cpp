// See bench/report.h.

#include "bench/report.h"

#include "base/atomic_file.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <ostream>

namespace serosa::bench {

namespace {

struct Target {
    const char* name;
    bool atLeast; // else at most
    double must, goal;
};
// docs/performance.md says what each one is.
constexpr Target kTargets[] = {{"fragment_over_cpu_dense20k", false, 4, 2},
                               {"fragment_over_cpu_sparse20k", false, 5.5, 2.5},
                               {"fragment_over_cpu_dense1m", false, 5.5, 3},
                               {"cpu_share_of_fma_peak", true, 0.20, 0.35},
                               {"bullet_over_cpu", true, 30, 60},
                               {"bullet_over_fragment", true, 10, 20},
                               {"scalar_over_fragment_dense20k", true, 2.5, 4},
                               {"mapping_over_static", false, 2.5, 1.5},
                               {"corrected_over_constant", false, 1.4, 1.1},
                               {"corrected_over_constant_frame", false, 1.2, 1.03},
                               {"raycast_linear_over_adaptive", true, 3.5, 5},
                               {"raycast_displaced_over_plain", false, 2.5, 1.8},
                               {"raycast_cuts_over_continuous", false, 1.2, 1.0}};

const Target* targetOf(const std::string& name) {
    for (const Target& target : kTargets)
        if (name == target.name)
            return &target;
    return nullptr;
}

bool meets(const Target& target, double limit, double value) {
    return target.atLeast ? value >= limit : value <= limit;
}

} // namespace

std::string figure(double value) {
    const int digits = value == 0 ? 2 : std::max(0, 2 - int(std::floor(std::log10(std::abs(value)))));
    char text[32];
    std::snprintf(text, sizeof text, "%.*f", digits, value);
    return text;
}

std::string figure(const Spread& spread) {
    return figure(spread.median) + " (" + figure(spread.min) + "-" + figure(spread.max) + ")";
}

void Report::line(const std::string& text) {
    text_ += text + "\n";
    out_ << text << std::endl;
}

void Report::heading(const std::string& text) {
    line("");
    line("## " + text);
    line("");
}

void Report::table(const std::vector<std::string>& columns,
                   const std::vector<std::vector<std::string>>& rows) {
    std::vector<std::size_t> widths(columns.size(), 3);
    for (std::size_t i = 0; i < columns.size(); ++i) {
        widths[i] = std::max(widths[i], columns[i].size());
        for (const auto& row : rows)
            widths[i] = std::max(widths[i], row[i].size());
    }
    const auto write = [&](const std::vector<std::string>& row) {
        std::string text = "|";
        for (std::size_t i = 0; i < row.size(); ++i)
            text += " " + row[i] + std::string(widths[i] - row[i].size(), ' ') + " |";
        line(text);
    };
    write(columns);
    std::vector<std::string> rule;
    for (const std::size_t width : widths)
        rule.push_back(std::string(width, '-'));
    write(rule);
    for (const auto& row : rows)
        write(row);
}

void Report::ratio(const std::string& name, const Spread& spread) {
    ratios_.push_back({name, spread});
}

void Report::ratioTable() {
    if (ratios_.empty())
        return;
    std::vector<std::vector<std::string>> rows;
    for (const Ratio& item : ratios_) {
        const Target* target = targetOf(item.name);
        std::string must = "-", goal = "-", verdict = "-";
        if (target) {
            const std::string side = target->atLeast ? "at least " : "at most ";
            must = side + figure(target->must);
            goal = side + figure(target->goal);
            verdict = !meets(*target, target->must, item.spread.median)   ? "MISSED"
                      : !meets(*target, target->goal, item.spread.median) ? "met"
                                                                          : "met, goal too";
        }
        rows.push_back({item.name, figure(item.spread.median), figure(item.spread.min),
                        figure(item.spread.max), std::to_string(item.spread.rounds), must, goal, verdict});
    }
    heading("Ratios");
    table({"name", "median", "min", "max", "rounds", "must", "goal", "target"}, rows);
}

int Report::missedTargets() const {
    return int(std::count_if(ratios_.begin(), ratios_.end(), [](const Ratio& item) {
        const Target* target = targetOf(item.name);
        return target && !meets(*target, target->must, item.spread.median);
    }));
}

Status Report::write(const std::filesystem::path& folder) const {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
        return Error{folder.string() + ": cannot make this folder (" + error.message() +
                     "): name another with --out"};
    nlohmann::ordered_json json = nlohmann::ordered_json::object();
    for (const Ratio& item : ratios_)
        json[item.name] = {{"median", item.spread.median},
                           {"min", item.spread.min},
                           {"max", item.spread.max},
                           {"rounds", item.spread.rounds}};
    SEROSA_TRY(writeFileAtomically(folder / "ratios.json", std::string_view(json.dump(1) + "\n")));
    return writeFileAtomically(folder / "bench.md", std::string_view(text_));
}

} // namespace serosa::bench
