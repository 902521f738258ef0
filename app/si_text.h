#pragma once
// Numbers for people: four digits, a true minus sign, units with the prefix that suits the size. The same
// value always gives the same text.

#include <string>

namespace serosa::app {

/// A value of `unit` times `factor` reads in `name`: {1e3, "mJ"}.
struct SiScale {
    double factor = 1;
    std::string name;
};

/// The scale in which `largest` (its sign does not count) lies in [1, 1000), from pico to giga; beyond, a
/// power of ten stands before the unit. Seconds have no prefix above 1; 0 and what is not finite keep the
/// unit.
SiScale siScale(double largest, const std::string& unit);

/// At most `digits` significant digits without trailing zeros: "0.02504", "-1.5", "3.645 x 10^6" below 1e-4
/// and from 1e5 on (with the signs of print), "not finite".
std::string numberText(double value, int digits = 4);

/// numberText in the scale of the value itself: "25.04 mm".
std::string siText(double value, const std::string& unit, int digits = 4);

} // namespace serosa::app
