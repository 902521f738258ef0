#pragma once
// Writes markup that is HTML and well-formed XML at once: every element is closed, every text and attribute
// escaped, whatever the names of organs and files hold.

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace serosa::app {

/// `text` for use between tags and in quoted attributes: & < > " ' become entities; bytes that are no UTF-8
/// and characters that XML forbids become U+FFFD.
std::string escapeMarkup(std::string_view text);

/// Name and value; the value is escaped when written.
using Attribute = std::pair<std::string_view, std::string>;
using Attributes = std::initializer_list<Attribute>;

class Markup {
public:
    Markup& open(std::string_view name, Attributes attributes = {});
    /// Closes the innermost element.
    Markup& close();
    Markup& text(std::string_view text);
    /// An element with a text.
    Markup& element(std::string_view name, Attributes attributes, std::string_view text);
    /// An element without content that HTML knows as such (img, meta, circle ...).
    Markup& empty(std::string_view name, Attributes attributes = {});
    /// As it stands: a style sheet or a comment of our own, never anything from a file.
    Markup& raw(std::string_view markup);
    /// All that was written. Everything must be closed.
    std::string finish() &&;

private:
    void tag(std::string_view name, Attributes attributes, std::string_view end);

    std::string out_;
    std::vector<std::string> open_;
};

} // namespace serosa::app
