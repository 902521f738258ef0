// See app/html_page.h.

#include "app/html_page.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace serosa::app {

namespace {

const char* verdictClass(Verdict verdict) {
    return verdict == Verdict::good ? "good" : verdict == Verdict::warning ? "warning" : "bad";
}

const char* verdictMark(Verdict verdict) {
    return verdict == Verdict::good ? "\u2713" : verdict == Verdict::warning ? "!" : "\u2717";
}

/// Width or height of a PNG file, from its header.
std::uint32_t pngSize(std::string_view png, std::size_t at) {
    std::uint32_t size = 0;
    for (std::size_t i = at; i < at + 4 && i < png.size(); ++i)
        size = size << 8 | std::uint8_t(png[i]);
    return size;
}

} // namespace

void beginPage(Markup& page, const PageHead& head) {
    page.raw("<!DOCTYPE html>");
    page.open("html", {{"lang", "en"}});
    page.open("head");
    page.empty("meta", {{"charset", "utf-8"}});
    // The page cannot load or run anything, even if something got past the escaping.
    page.empty("meta", {{"http-equiv", "Content-Security-Policy"},
                        {"content", "default-src 'none'; style-src 'unsafe-inline'; img-src data:"}});
    page.empty("meta", {{"name", "viewport"}, {"content", "width=device-width, initial-scale=1"}});
    page.empty("meta", {{"name", "color-scheme"}, {"content", "light dark"}});
    page.raw("\n").element("title", {}, head.title + ": " + head.kind);
    page.open("style").raw("\n").raw(reportStyle()).close().close();
    page.open("body");
    page.open("header");
    page.element("h1", {}, head.title);
    page.element("p", {{"class", "subtitle"}}, head.subtitle);
    page.open("div", {{"class", std::string("verdict ") + verdictClass(head.verdict)}, {"role", "status"}});
    page.element("span", {{"class", "mark"}, {"aria-hidden", "true"}}, verdictMark(head.verdict));
    page.open("p").element("strong", {}, head.summary);
    if (!head.detail.empty())
        page.text(" ").element("span", {}, head.detail);
    page.close().close().close();
    page.open("main");
}

std::string endPage(Markup&& page) {
    page.close().close().close();
    return std::move(page).finish();
}

void writeKeyFigures(Markup& page, const std::vector<KeyFigure>& figures) {
    page.open("dl", {{"class", "key"}});
    for (const KeyFigure& figure : figures) {
        page.open("div");
        page.element("dt", {}, figure.label);
        page.open("dd", {{"class", "value"}}).text(figure.value).close();
        if (!figure.note.empty())
            page.element("dd", {{"class", "note"}}, figure.note);
        page.close();
    }
    page.close();
}

void beginSection(Markup& page, const std::string& id, const std::string& title) {
    page.open("section", {{"id", id}});
    page.element("h2", {}, title);
}

void writeProperties(Markup& page, const PropertyTable& table) {
    if (table.rows.empty())
        return;
    const bool several = table.columns.size() > 1;
    const bool notes = std::any_of(table.rows.begin(), table.rows.end(),
                                   [](const PropertyTable::Row& row) { return !row.note.empty(); });
    page.open("div", {{"class", "scroll"}});
    page.open("table", {{"class", "properties"}});
    page.element("caption", {}, table.title);
    if (several) {
        page.open("thead").open("tr").element("td", {}, "");
        for (const std::string& column : table.columns)
            page.element("th", {{"scope", "col"}}, column);
        if (notes)
            page.element("td", {}, "");
        page.close().close();
    }
    page.open("tbody");
    for (const PropertyTable::Row& row : table.rows) {
        page.open("tr").element("th", {{"scope", "row"}}, row.label);
        for (const std::string& value : row.values)
            page.element("td", {{"class", "value"}}, value);
        if (notes)
            page.element("td", {{"class", "note"}}, row.note);
        page.close();
    }
    page.close().close().close();
}

void writePicture(Markup& page, std::string_view png, const std::string& caption,
                  const std::string& description) {
    page.open("figure", {{"class", "picture"}});
    page.empty("img", {{"alt", description},
                       {"width", std::to_string(pngSize(png, 16))},
                       {"height", std::to_string(pngSize(png, 20))},
                       {"src", "data:image/png;base64," + base64(png)}});
    page.element("figcaption", {}, caption);
    page.close();
}

std::string base64(std::string_view bytes) {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    out.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t at = 0; at < bytes.size(); at += 3) {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - at);
        std::uint32_t triple = 0;
        for (std::size_t i = 0; i < 3; ++i)
            triple = triple << 8 | (i < count ? std::uint8_t(bytes[at + i]) : 0U);
        for (std::size_t i = 0; i < 4; ++i)
            out += i <= count ? digits[triple >> (18 - 6 * i) & 63U] : '=';
    }
    return out;
}

} // namespace serosa::app
