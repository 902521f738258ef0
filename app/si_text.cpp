// See app/si_text.h.

#include "app/si_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace serosa::app {

namespace {

constexpr const char* kMinus = "\u2212";

struct Prefix {
    int exponent;
    const char* name;
};
constexpr std::array<Prefix, 8> kPrefixes = {
    {{-12, "p"}, {-9, "n"}, {-6, "\u00B5"}, {-3, "m"}, {0, ""}, {3, "k"}, {6, "M"}, {9, "G"}}};

std::string superscript(int number) {
    static const std::array<const char*, 10> digits = {"\u2070", "\u00B9", "\u00B2", "\u00B3", "\u2074",
                                                       "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
    std::string out = number < 0 ? "\u207B" : "";
    for (const char digit : std::to_string(std::abs(number)))
        out += digits[std::size_t(digit - '0')];
    return out;
}

std::string withMinus(const std::string& digits) {
    return digits.starts_with('-') ? kMinus + digits.substr(1) : digits;
}

void dropTrailingZeros(std::string& digits) {
    if (digits.find('.') == std::string::npos)
        return;
    digits.erase(digits.find_last_not_of('0') + 1);
    if (digits.ends_with('.'))
        digits.pop_back();
}

} // namespace

SiScale siScale(double largest, const std::string& unit) {
    const double size = std::abs(largest);
    if (!std::isfinite(size) || size == 0)
        return {1, unit};
    // Four digits of it: 999.96 mm reads as 1 m.
    char text[32];
    std::snprintf(text, sizeof text, "%.3e", size);
    const int decade = std::atoi(std::string(text).substr(std::string(text).find('e') + 1).c_str());
    int exponent = std::clamp(int(std::floor(decade / 3.0)) * 3, -300, 300);
    if (unit == "s" && exponent > 0)
        exponent = 0;
    for (const Prefix& prefix : kPrefixes)
        if (prefix.exponent == exponent)
            return {std::pow(10.0, -exponent), prefix.name + unit};
    return {std::pow(10.0, -exponent), "10" + superscript(exponent) + "\u00A0" + unit};
}

std::string numberText(double value, int digits) {
    if (!std::isfinite(value))
        return "not finite";
    if (value == 0)
        return "0";
    char text[64];
    std::snprintf(text, sizeof text, "%.*e", digits - 1, value);
    std::string mantissa(text);
    const std::size_t at = mantissa.find('e');
    const int exponent = std::atoi(mantissa.c_str() + at + 1);
    if (exponent >= -4 && exponent < 5) {
        std::snprintf(text, sizeof text, "%.*f", std::max(0, digits - 1 - exponent), value);
        std::string fixed(text);
        dropTrailingZeros(fixed);
        return withMinus(fixed);
    }
    mantissa.erase(at);
    dropTrailingZeros(mantissa);
    return withMinus(mantissa) + "\u00A0\u00D7\u00A010" + superscript(exponent);
}

std::string siText(double value, const std::string& unit, int digits) {
    if (!std::isfinite(value))
        return numberText(value);
    const SiScale scale = siScale(value, unit);
    const bool power = scale.name.starts_with("10");
    return numberText(value * scale.factor, digits) + (power ? "\u00A0\u00D7" : "") +
           (scale.name.empty() ? "" : "\u00A0" + scale.name);
}

} // namespace serosa::app
