#pragma once
// The tables of a run's report: organ, lattice, step, binding, materials, tools, program and timing, from
// summary.json.

#include "app/markup.h"

#include <nlohmann/json.hpp>

#include <limits>
#include <string>
#include <vector>

namespace serosa::app {

/// The figure under `key`; NaN where it is null or absent.
inline double figureOf(const nlohmann::ordered_json& json, const char* key) {
    const auto found = json.find(key);
    return found != json.end() && found->is_number() ? found->get<double>()
                                                     : std::numeric_limits<double>::quiet_NaN();
}

/// The organs of a summary, one or several, each with its own lattice, step, binding, solver.
std::vector<nlohmann::ordered_json> organsOf(const nlohmann::ordered_json& summary);

/// Size of the force of a sample {t_s, N: [x, y, z]}, N; NaN where a part is null.
double forceSize(const nlohmann::ordered_json& sample);

/// Time at which the force on a tool is largest, s; NaN where there is none.
double timeOfLargestForce(const nlohmann::ordered_json& tool);

void writeOrganTables(Markup& page, const nlohmann::ordered_json& summary);
/// A row for each material of each organ.
void writeMaterialTable(Markup& page, const nlohmann::ordered_json& summary);
/// Tools, then bodies.
std::vector<nlohmann::ordered_json> collidersOf(const nlohmann::ordered_json& summary);
void writeToolTable(Markup& page, const nlohmann::ordered_json& summary);
void writeProgramTable(Markup& page, const nlohmann::ordered_json& summary);
void writeTimingTable(Markup& page, const nlohmann::ordered_json& summary);

} // namespace serosa::app
