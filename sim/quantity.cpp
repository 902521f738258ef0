// One table of units; a quantity is its number times the unit's SI value.

#include "sim/quantity.h"

#include "sim/scene.h"
#include "sim/suggest.h"

#include <charconv>
#include <cmath>
#include <numbers>

namespace serosa::sim {

namespace {

struct Unit {
    const char* name;
    Dimension dimension;
    double si;
};

constexpr double kDegree = std::numbers::pi / 180; // rad

const Unit kUnits[] = {
    {"mm", Dimension::length, 1e-3},
    {"cm", Dimension::length, 1e-2},
    {"m", Dimension::length, 1},
    {"um", Dimension::length, 1e-6},
    {"in", Dimension::length, 0.0254},
    {"s", Dimension::time, 1},
    {"ms", Dimension::time, 1e-3},
    {"us", Dimension::time, 1e-6},
    {"Hz", Dimension::frequency, 1},
    {"kHz", Dimension::frequency, 1e3},
    {"kPa", Dimension::pressure, 1e3},
    {"Pa", Dimension::pressure, 1},
    {"MPa", Dimension::pressure, 1e6},
    {"GPa", Dimension::pressure, 1e9},
    {"kg/m3", Dimension::density, 1},
    {"g/cm3", Dimension::density, 1e3},
    {"m/s2", Dimension::acceleration, 1},
    {"mm/s2", Dimension::acceleration, 1e-3},
    {"cm/s2", Dimension::acceleration, 1e-2},
    {"deg", Dimension::angle, kDegree},
    {"rad", Dimension::angle, 1},
    {"1/s", Dimension::rate, 1},
    {"N", Dimension::force, 1},
    {"mN", Dimension::force, 1e-3},
    {"kN", Dimension::force, 1e3},
};

std::string_view trimmed(std::string_view text) {
    const auto first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos)
        return {};
    return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::string example(Dimension dimension) {
    return std::string("\"2.5 ") + unitNames(dimension).front() + "\"";
}

} // namespace

const char* dimensionName(Dimension dimension) {
    switch (dimension) {
    case Dimension::length:
        return "length";
    case Dimension::time:
        return "time";
    case Dimension::frequency:
        return "frequency";
    case Dimension::pressure:
        return "pressure";
    case Dimension::density:
        return "density";
    case Dimension::acceleration:
        return "acceleration";
    case Dimension::angle:
        return "angle";
    case Dimension::rate:
        return "rate";
    case Dimension::force:
        return "force";
    }
    return "";
}

const char* siUnit(Dimension dimension) {
    for (const Unit& unit : kUnits)
        if (unit.dimension == dimension && unit.si == 1)
            return unit.name;
    SEROSA_CHECK(false, "every dimension has an SI unit");
}

std::vector<std::string> unitNames(Dimension dimension) {
    std::vector<std::string> names;
    for (const Unit& unit : kUnits)
        if (unit.dimension == dimension)
            names.emplace_back(unit.name);
    return names;
}

std::string inQuotes(std::string_view text) {
    constexpr std::size_t kShown = 40;
    std::string out = "\"";
    for (const char c : text.substr(0, kShown))
        out += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
    return out + (text.size() > kShown ? "...\"" : "\"");
}

Result<double> parseQuantity(std::string_view text, Dimension dimension) {
    std::string_view rest = trimmed(text);
    if (rest.size() > 1 && rest[0] == '+' && rest[1] != '-')
        rest.remove_prefix(1); // from_chars takes no plus
    double number = 0;
    const auto [end, code] = std::from_chars(rest.data(), rest.data() + rest.size(), number);
    if (code == std::errc::invalid_argument)
        return Error{inQuotes(text) + " is no " + dimensionName(dimension) +
                     ": write a number and a unit, such as " + example(dimension)};
    if (code == std::errc::result_out_of_range || !std::isfinite(number))
        return Error{inQuotes(text) + " is not a finite number"};
    rest.remove_prefix(std::size_t(end - rest.data()));
    if (rest.size() > 1 && rest[0] == ',' && std::isdigit(static_cast<unsigned char>(rest[1])))
        return Error{inQuotes(text) + " has a decimal comma: write a point, such as " + example(dimension)};

    const std::string unitText(trimmed(rest));
    if (unitText.empty())
        return Error{inQuotes(text) + " has no unit: write a " + dimensionName(dimension) + " such as " +
                     example(dimension)};
    for (const Unit& unit : kUnits) {
        if (unitText != unit.name)
            continue;
        if (unit.dimension != dimension)
            return Error{inQuotes(text) + " is a " + dimensionName(unit.dimension) + ", but a " +
                         dimensionName(dimension) + " belongs here, such as " + example(dimension)};
        const double value = number * unit.si;
        if (!std::isfinite(value))
            return Error{inQuotes(text) + " is not a finite number in " + siUnit(dimension)};
        return value;
    }
    return Error{"unknown unit " + inQuotes(unitText) + " of a " + dimensionName(dimension) +
                 suggestion(unitText, unitNames(dimension))};
}

Result<double> parseLengthUnit(const std::string& text) {
    for (const Unit& unit : kUnits)
        if (unit.dimension == Dimension::length && text == unit.name)
            return unit.si;
    return Error{"unknown length unit " + inQuotes(text) + suggestion(text, unitNames(Dimension::length))};
}

std::string formatNumber(double value) {
    char buffer[32];
    const auto [end, code] = std::to_chars(buffer, buffer + sizeof buffer, value);
    return std::string(buffer, end);
}

std::string formatQuantity(double si, Dimension dimension) {
    return formatNumber(si) + " " + siUnit(dimension);
}

} // namespace serosa::sim
