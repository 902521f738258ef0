#pragma once
// Numbers with a unit, as scene files and the command line write them: "3 kPa", "2.5 mm", "-9.81 m/s2".

#include "base/result.h"

#include <string>
#include <string_view>
#include <vector>

namespace serosa::sim {

enum class Dimension { length, time, frequency, pressure, density, acceleration, angle, rate, force };

/// "length", "time", ...
const char* dimensionName(Dimension dimension);
/// The unit that values have inside the program: "m", "s", "Hz", "Pa", "kg/m3", "m/s2", "rad", "1/s",
/// "N".
const char* siUnit(Dimension dimension);
/// Names of all units of a dimension, the most usual one first.
std::vector<std::string> unitNames(Dimension dimension);

/// A number, optional blanks, a unit of `dimension`; gives the value in SI units, always finite.
/// Errors (without a file position): no number, decimal comma, NaN or infinite, no unit, unit unknown (with
/// the nearest known one) or of another dimension.
Result<double> parseQuantity(std::string_view text, Dimension dimension);

/// Shortest decimal that reads back as the same double, with a unit: "0.0025 m".
std::string formatNumber(double value);
std::string formatQuantity(double si, Dimension dimension);

/// `text` in quotes, at most 40 characters of it, control characters as '?': for one-line messages.
std::string inQuotes(std::string_view text);

} // namespace serosa::sim
