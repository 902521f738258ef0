#pragma once
// The page of a report: one file that needs nothing else. Its style and pictures stand in it, it runs no
// script, and its content policy forbids the browser to load anything. Readable in light and dark mode,
// on paper, and 360 pixels wide.

#include "app/markup.h"

#include <string>
#include <string_view>
#include <vector>

namespace serosa::app {

enum class Verdict { good, warning, bad };

struct PageHead {
    std::string title;    // of the page
    std::string kind;     // of report: "run"; the window's title has both
    std::string subtitle; // what made it: program, version, machine's renderer
    Verdict verdict = Verdict::good;
    std::string summary; // the verdict in a line
    std::string detail;  // what follows from it, or empty
};
/// Opens the page up to <main>; endPage closes it.
void beginPage(Markup& page, const PageHead& head);
/// Closes the page and gives its bytes.
std::string endPage(Markup&& page);

/// A row of large figures under the verdict.
struct KeyFigure {
    std::string label, value, note;
};
void writeKeyFigures(Markup& page, const std::vector<KeyFigure>& figures);

/// <section id="id"><h2>title</h2>, to be closed by the caller.
void beginSection(Markup& page, const std::string& id, const std::string& title);

/// A table of properties: a row each, a column for each thing that has them.
struct PropertyTable {
    std::string title;
    std::vector<std::string> columns; // their headings; empty: one column without
    struct Row {
        std::string label;
        std::vector<std::string> values;
        std::string note; // a remark behind the values, or empty
    };
    std::vector<Row> rows;
};
void writeProperties(Markup& page, const PropertyTable& table);

/// The PNG file's bytes as <figure><img src="data:...">, with its width and height.
void writePicture(Markup& page, std::string_view png, const std::string& caption,
                  const std::string& description);

std::string base64(std::string_view bytes);

/// The style sheet of all reports (app/report_style.cpp).
std::string_view reportStyle();

} // namespace serosa::app
