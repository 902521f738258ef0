#pragma once
// What a benchmark run found: ratios with their targets (ratios.json) and tables in Markdown (bench.md).

#include "base/result.h"
#include "bench/rounds.h"

#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

namespace serosa::bench {

class Report {
public:
    /// \param out receives everything as it comes.
    explicit Report(std::ostream& out) : out_(out) {}

    void heading(const std::string& text);
    void line(const std::string& text);
    void table(const std::vector<std::string>& columns, const std::vector<std::vector<std::string>>& rows);
    /// A ratio with a name of its own; its target follows from the list in report.cpp, if it has one there.
    void ratio(const std::string& name, const Spread& spread);
    /// The table of all ratios against their targets.
    void ratioTable();
    int missedTargets() const;
    /// Writes ratios.json and bench.md. Errors: of the file system.
    Status write(const std::filesystem::path& folder) const;

private:
    struct Ratio {
        std::string name;
        Spread spread;
    };
    std::ostream& out_;
    std::string text_;
    std::vector<Ratio> ratios_;
};

/// Three significant digits.
std::string figure(double value);
/// "1.23 (1.10-1.50)"
std::string figure(const Spread& spread);

} // namespace serosa::bench
