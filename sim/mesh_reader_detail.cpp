// Numbers are read by std::from_chars, which knows no locale: a decimal comma is an error on every machine.
#include "sim/mesh_reader_detail.h"

#include <charconv>
#include <cmath>
#include <cstring>

namespace serosa::sim::detail {

Error MeshSource::atLine(std::size_t line, const std::string& text) const {
    return {name + ":" + std::to_string(line) + ": " + text};
}

Error MeshSource::atByte(std::size_t offset, const std::string& text) const {
    return {name + ": byte " + std::to_string(offset) + ": " + text};
}

bool LineReader::next() {
    words_.clear();
    return cut();
}

bool LineReader::nextWithWords() {
    while (next())
        if (!words_.empty())
            return true;
    return false;
}

bool LineReader::appendNext() {
    return cut();
}

bool LineReader::cut() {
    if (offset_ >= bytes_.size())
        return false;
    const char* begin = bytes_.data() + offset_;
    const auto* newline = static_cast<const char*>(std::memchr(begin, '\n', bytes_.size() - offset_));
    const char* end = newline ? newline : bytes_.data() + bytes_.size();
    offset_ = static_cast<std::size_t>(end - bytes_.data()) + (newline ? 1 : 0);
    ++line_;
    const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
    while (begin != end) {
        if (blank(*begin)) {
            ++begin;
            continue;
        }
        if (*begin == '#')
            break;
        const char* last = begin;
        while (last != end && !blank(*last) && *last != '#')
            ++last;
        words_.emplace_back(begin, static_cast<std::size_t>(last - begin));
        begin = last;
    }
    return true;
}

std::string quotedWord(std::string_view word) {
    std::string text = "'";
    for (const char c : word.substr(0, 24))
        text += c >= ' ' && c <= '~' ? c : '.';
    return text + (word.size() > 24 ? "...'" : "'");
}

namespace {

std::string_view withoutPlus(std::string_view word) {
    return word.size() > 1 && word[0] == '+' && word[1] != '-' ? word.substr(1) : word;
}

} // namespace

std::optional<double> parseNumber(std::string_view word, std::string& why) {
    const std::string_view digits = withoutPlus(word);
    const char* end = digits.data() + digits.size();
    double value = 0;
    const auto [stop, code] = std::from_chars(digits.data(), end, value);
    if (code == std::errc::result_out_of_range) {
        why = quotedWord(word) + " is outside of what a 64-bit number holds; scale the mesh";
        return {};
    }
    if (code == std::errc() && stop == end && std::isfinite(value))
        return value;
    if (code == std::errc() && stop == end)
        why = quotedWord(word) + " is not a finite number; repair the mesh where it was made";
    else if (code == std::errc() && *stop == ',')
        why = quotedWord(word) +
              " has a comma in it; write decimal points (1.5, not 1,5) and part numbers by blanks";
    else
        why = quotedWord(word) + " is not a number; export the mesh again";
    return {};
}

std::optional<std::int64_t> parseInteger(std::string_view word, std::int64_t lowest, std::int64_t highest,
                                         std::string& why) {
    const std::string_view digits = withoutPlus(word);
    const char* end = digits.data() + digits.size();
    std::int64_t value = 0;
    const auto [stop, code] = std::from_chars(digits.data(), end, value);
    if (stop != end || code == std::errc::invalid_argument) {
        why = quotedWord(word) + " is not a whole number; export the mesh again";
        return {};
    }
    if (code == std::errc::result_out_of_range || value < lowest || value > highest) {
        why = quotedWord(word) + " is outside of " + std::to_string(lowest) + " .. " +
              std::to_string(highest) + "; export the mesh again";
        return {};
    }
    return value;
}

void appendFan(const std::vector<std::uint32_t>& corners, std::vector<glm::uvec3>& faces) {
    for (std::size_t i = 2; i < corners.size(); ++i)
        faces.push_back({corners[0], corners[i - 1], corners[i]});
}

} // namespace serosa::sim::detail
