// See app/markup.h.

#include "app/markup.h"

#include "base/check.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace serosa::app {

namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD"; // U+FFFD
// A line break before one of these would show as a blank.
constexpr std::array<std::string_view, 8> kInline = {"a",      "code", "em",    "span",
                                                     "strong", "text", "title", "sup"};

struct Character {
    std::size_t bytes = 1;
    bool shown = false; // it is UTF-8 and allowed in XML
};

Character characterAt(std::string_view text, std::size_t at) {
    const auto byte = [&](std::size_t i) { return std::uint32_t(std::uint8_t(text[i])); };
    const std::uint32_t first = byte(at);
    if (first < 0x80)
        return {1, (first >= 0x20 && first != 0x7F) || first == '\t' || first == '\n'};
    const std::size_t bytes = first >= 0xC2 && first < 0xE0   ? 2
                              : first >= 0xE0 && first < 0xF0 ? 3
                              : first >= 0xF0 && first < 0xF5 ? 4
                                                              : 0;
    if (bytes == 0 || at + bytes > text.size())
        return {};
    std::uint32_t code = first & (0x7FU >> bytes);
    for (std::size_t i = 1; i < bytes; ++i) {
        if ((byte(at + i) & 0xC0) != 0x80)
            return {};
        code = code << 6 | (byte(at + i) & 0x3F);
    }
    const bool tooLong = (bytes == 3 && code < 0x800) || (bytes == 4 && code < 0x10000);
    if (tooLong || (code >= 0xD800 && code < 0xE000) || code > 0x10FFFF)
        return {};
    const bool control = (code >= 0x80 && code < 0xA0) || (code & 0xFFFE) == 0xFFFE;
    // Marks that turn the direction of the text around them: they could show a name as another.
    const bool turns = (code >= 0x202A && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069);
    return {bytes, !control && !turns};
}

} // namespace

std::string escapeMarkup(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    for (std::size_t at = 0; at < text.size();) {
        const auto [bytes, shown] = characterAt(text, at);
        switch (text[at]) {
        case '&':
            out += "&amp;";
            break;
        case '<':
            out += "&lt;";
            break;
        case '>':
            out += "&gt;";
            break;
        case '"':
            out += "&quot;";
            break;
        case '\'':
            out += "&#39;";
            break;
        default:
            out += shown ? text.substr(at, bytes) : kReplacement;
        }
        at += bytes;
    }
    return out;
}

void Markup::tag(std::string_view name, Attributes attributes, std::string_view end) {
    if (!out_.empty() && std::find(kInline.begin(), kInline.end(), name) == kInline.end())
        out_ += '\n';
    (out_ += '<') += name;
    for (const auto& [key, value] : attributes)
        (((out_ += ' ') += key) += "=\"") += escapeMarkup(value) + '"';
    out_ += end;
}

Markup& Markup::open(std::string_view name, Attributes attributes) {
    tag(name, attributes, ">");
    open_.emplace_back(name);
    return *this;
}

Markup& Markup::close() {
    SEROSA_CHECK(!open_.empty(), "an element is open");
    out_ += "</" + open_.back() + ">";
    open_.pop_back();
    return *this;
}

Markup& Markup::text(std::string_view text) {
    out_ += escapeMarkup(text);
    return *this;
}

Markup& Markup::element(std::string_view name, Attributes attributes, std::string_view content) {
    return open(name, attributes).text(content).close();
}

Markup& Markup::empty(std::string_view name, Attributes attributes) {
    tag(name, attributes, "/>");
    return *this;
}

Markup& Markup::raw(std::string_view markup) {
    out_ += markup;
    return *this;
}

std::string Markup::finish() && {
    SEROSA_CHECK(open_.empty(), "every element is closed");
    return std::move(out_) + "\n";
}

} // namespace serosa::app
