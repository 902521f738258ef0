// See app/rounds.h.

#include "app/rounds.h"

#include "base/check.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace serosa::app {

namespace {

double millisecondsOf(const std::function<void(int)>& run, int repeats) {
    const auto start = std::chrono::steady_clock::now();
    run(repeats);
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

} // namespace

Spread spreadOf(std::vector<double> values) {
    SEROSA_CHECK(!values.empty(), "at least one value");
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    const double median = values.size() % 2 ? values[half] : (values[half - 1] + values[half]) / 2;
    return {median, values.front(), values.back(), int(values.size())};
}

void Rounds::add(const std::string& name, std::function<void(int)> run) {
    cases_.push_back({name, std::move(run), 1, {}});
}

void Rounds::measure(int rounds, double seconds) {
    for (Case& item : cases_) {
        item.run(2); // shaders compile at their first draw, and a last step may have one of its own
        const double once = millisecondsOf(item.run, 1);
        item.repeats = int(std::clamp(std::round(1e3 * seconds / std::max(once, 1e-3)), 1.0, 1e5));
    }
    for (int round = 0; round < rounds; ++round)
        for (Case& item : cases_)
            item.milliseconds.push_back(millisecondsOf(item.run, item.repeats) / item.repeats);
}

Spread Rounds::milliseconds(const std::string& name) const {
    return spreadOf(find(name).milliseconds);
}

Spread Rounds::ratio(const std::string& numerator, const std::string& denominator) const {
    const std::vector<double>&above = find(numerator).milliseconds, &below = find(denominator).milliseconds;
    std::vector<double> ratios(above.size());
    for (std::size_t i = 0; i < ratios.size(); ++i)
        ratios[i] = above[i] / below[i];
    return spreadOf(ratios);
}

const Rounds::Case& Rounds::find(const std::string& name) const {
    const auto found =
        std::find_if(cases_.begin(), cases_.end(), [&name](const Case& item) { return item.name == name; });
    SEROSA_CHECK(found != cases_.end(), "a case of these rounds");
    return *found;
}

} // namespace serosa::app
