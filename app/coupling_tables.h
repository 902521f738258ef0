#pragma once
// The part of a run's report about organs that touch and about threads, from summary.json.

#include "app/markup.h"
#include "app/svg_plot.h"

#include <nlohmann/json.hpp>

namespace serosa::app {

/// Does the summary have any of it?
bool hasCoupling(const nlohmann::ordered_json& summary);
/// "liver and kidney", "liver on itself": of an entry of `contacts`.
std::string contactName(const nlohmann::ordered_json& contact);
/// Forces over time, a line a thread and a pair of organs. \param end of the time axis, s
Plot couplingPlot(const nlohmann::ordered_json& summary, double end);
/// A row a pair of organs, then a row a thread.
void writeCouplingTables(Markup& page, const nlohmann::ordered_json& summary);

} // namespace serosa::app
