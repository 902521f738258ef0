// See app/coupling_tables.h.
#include "app/coupling_tables.h"

#include "app/run_tables.h"
#include "app/si_text.h"

#include <cmath>

namespace serosa::app {

namespace {

using Json = nlohmann::ordered_json;

void beginTable(Markup& page, std::initializer_list<const char*> words,
                std::initializer_list<const char*> numbers) {
    page.open("div", {{"class", "scroll"}}).open("table", {{"class", "tools"}}).open("thead").open("tr");
    for (const char* heading : words)
        page.element("th", {{"scope", "col"}}, heading);
    for (const char* heading : numbers)
        page.element("th", {{"scope", "col"}, {"class", "number"}}, heading);
    page.close().close().open("tbody");
}

void endTable(Markup& page) {
    page.close().close().close();
}

std::string orDash(double value, const char* unit) {
    return std::isfinite(value) ? siText(value, unit) : std::string("\u2013");
}

/// What became of a thread.
std::string stateOf(const Json& thread) {
    if (thread.at("broken").get<bool>())
        return "broke at " + siText(figureOf(thread, "broken_t_s"), "s");
    return thread.at("tied").get<bool>() ? "holds" : "not tied yet";
}

} // namespace

bool hasCoupling(const Json& summary) {
    return summary.contains("contacts") || summary.contains("threads");
}

std::string contactName(const Json& contact) {
    const Json& organs = contact.at("organs");
    const std::string first = organs.at(0).get<std::string>();
    return organs.size() == 1 ? first + " on itself" : first + " and " + organs.at(1).get<std::string>();
}

Plot couplingPlot(const Json& summary, double end) {
    Plot plot{"plot-coupling",
              "Forces between organs",
              "N",
              "threads: averaged over 5 ms; contact: what presses, mean since the sample before",
              {},
              end};
    for (const char* key : {"contacts", "threads"})
        for (const Json& entry : summary.value(key, Json::array())) {
            const bool thread = key == std::string("threads");
            PlotSeries series{thread ? entry.at("name").get<std::string>() : contactName(entry), {}, {}};
            for (const Json& sample : entry.at("force")) {
                series.times.push_back(figureOf(sample, "t_s"));
                series.values.push_back(figureOf(sample, thread ? "N" : "pressed_N"));
            }
            if (!series.values.empty())
                plot.series.push_back(std::move(series));
        }
    return plot;
}

void writeCouplingTables(Markup& page, const Json& summary) {
    if (summary.contains("contacts")) {
        beginTable(page, {"Contact"}, {"Friction", "Largest force", "Pressed by at most"});
        for (const Json& contact : summary.at("contacts")) {
            page.open("tr").element("th", {{"scope", "row"}}, contactName(contact));
            for (const std::string& value : {numberText(figureOf(contact, "friction")),
                                             orDash(figureOf(contact, "largest_force_N"), "N"),
                                             orDash(figureOf(contact, "largest_pressed_N"), "N")})
                page.element("td", {{"class", "number"}}, value);
            page.close();
        }
        endTable(page);
    }
    if (!summary.contains("threads"))
        return;
    beginTable(page, {"Thread", "Kind", "Between", "At the end"}, {"Length", "Strength", "Largest force"});
    for (const Json& thread : summary.at("threads")) {
        const Json& ends = thread.at("ends");
        page.open("tr").element("th", {{"scope", "row"}}, thread.at("name").get<std::string>());
        page.element("td", {}, thread.at("kind").get<std::string>());
        page.element("td", {},
                     ends.at(0).at("organ").get<std::string>() + " and " +
                         ends.at(1).at("organ").get<std::string>());
        page.element("td", {}, stateOf(thread));
        for (const std::string& value :
             {orDash(figureOf(thread, "length_m"), "m"), orDash(figureOf(thread, "strength_N"), "N"),
              orDash(figureOf(thread, "largest_force_N"), "N")})
            page.element("td", {{"class", "number"}}, value);
        page.close();
    }
    endTable(page);
}

} // namespace serosa::app
