#pragma once
// Cases measured in turn, round after round, so that drift of the machine hits all alike. Only ratios within
// one round count; the median over the rounds is reported.

#include <functional>
#include <string>
#include <vector>

namespace serosa::app {

/// Of one ratio over the rounds.
struct Spread {
    double median = 0, min = 0, max = 0;
    int rounds = 0;
};
/// \param values not empty.
Spread spreadOf(std::vector<double> values);

class Rounds {
public:
    /// \param run does the work `repeats` times and waits until it is done (glFinish).
    void add(const std::string& name, std::function<void(int repeats)> run);
    /// Warms every case up once, chooses repeats so that a turn takes about `seconds`, then takes turns.
    void measure(int rounds, double seconds);

    /// Milliseconds a repeat, over the rounds. The case must exist and be measured.
    Spread milliseconds(const std::string& name) const;
    /// The same round by round.
    const std::vector<double>& all(const std::string& name) const { return find(name).milliseconds; }
    /// Of two cases, formed within each round.
    Spread ratio(const std::string& numerator, const std::string& denominator) const;

private:
    struct Case {
        std::string name;
        std::function<void(int)> run;
        int repeats = 1;
        std::vector<double> milliseconds; // a repeat, one a round
    };
    const Case& find(const std::string& name) const;
    std::vector<Case> cases_;
};

} // namespace serosa::app
