// See app/run_tables.h.

#include "app/run_tables.h"

#include "app/html_page.h"
#include "app/organ_setup.h"
#include "app/si_text.h"

#include <cmath>
#include <functional>

namespace serosa::app {

namespace {

using Json = nlohmann::ordered_json;
using Format = std::function<std::string(const Json&)>;

Format count() {
    return [](const Json& value) { return grouped(value.get<std::size_t>()); };
}
Format word() {
    return [](const Json& value) { return value.get<std::string>(); };
}
/// With the prefix that suits the size, after `factor` turned the value into `unit`.
Format quantity(const std::string& unit, double factor = 1) {
    return [unit, factor](const Json& value) {
        return value.is_number() ? siText(factor * value.get<double>(), unit) : "not finite";
    };
}
/// Units that take no prefix.
Format plain(const std::string& unit, double factor = 1) {
    return [unit, factor](const Json& value) {
        return value.is_number()
                   ? numberText(factor * value.get<double>()) + (unit.empty() ? "" : "\u00A0" + unit)
                   : "not finite";
    };
}
Format size(const std::string& unit = "") {
    return [unit](const Json& value) {
        std::string text;
        for (const Json& side : value)
            text += (text.empty() ? "" : " \u00D7 ") + grouped(side.get<std::size_t>());
        return text + unit;
    };
}

/// Adds rows to a table of properties; a row whose key no column has is left out.
class Rows {
public:
    Rows(PropertyTable& table, const std::vector<Json>& columns, const char* part)
        : table_(table), columns_(columns), part_(part) {}
    Rows& add(const char* key, const std::string& label, const Format& format, const std::string& note = "") {
        PropertyTable::Row row{label, {}, note};
        bool any = false;
        for (const Json& column : columns_) {
            const Json* source = *part_ ? &column.at(part_) : &column;
            const bool has = source->contains(key);
            row.values.push_back(has ? format(source->at(key)) : "\u2013");
            any = any || has;
        }
        if (any)
            table_.rows.push_back(std::move(row));
        return *this;
    }

private:
    PropertyTable& table_;
    const std::vector<Json>& columns_;
    const char* part_;
};

constexpr double kCubicCentimetre = 1e6; // in a cubic metre

PropertyTable organTable(const std::vector<Json>& organs) {
    PropertyTable table{"Organ and tissue", {}, {}};
    Rows(table, organs, "")
        .add("model", "Model", word())
        .add("metres_per_unit", "Unit of the model", quantity("m"))
        .add("up_axis", "Axis that points up", word())
        .add("vertices", "Vertices", count())
        .add("faces", "Faces", count())
        .add("young_Pa", "Young\u2019s modulus", quantity("Pa"))
        .add("poisson", "Poisson\u2019s ratio", plain(""))
        .add("density_kg_m3", "Density", plain("kg/m\u00B3"))
        .add("damping_time_s", "Damping time", quantity("s"))
        .add("air_drag_1_s", "Air drag", plain("1/s"))
        .add("solver", "Solver", word())
        .add("largest_displacement_m", "Largest displacement", quantity("m"))
        .add("inverted_cells", "Cells turned inside out, at most", count())
        .add("state_hash", "Last state\u2019s hash", word());
    return table;
}

PropertyTable repairTable(const std::vector<Json>& organs) {
    PropertyTable table{"Repair of the model", {}, {}};
    std::vector<Json> repaired = organs;
    bool any = false;
    for (Json& organ : repaired) {
        any = any || organ.contains("repair");
        if (!organ.contains("repair"))
            organ["repair"] = Json::object();
    }
    if (!any)
        return table;
    Rows(table, repaired, "repair")
        .add("repeated_corner_faces_removed", "Degenerate faces removed", count())
        .add("duplicate_faces_removed", "Duplicate faces removed", count())
        .add("faces_flipped", "Faces turned over", count())
        .add("shells_turned", "Whole shells turned", count())
        .add("holes_filled", "Holes filled", count())
        .add("faces_added", "Faces added", count())
        .add("vertices_added", "Vertices added", count())
        .add("stray_vertices_removed", "Stray vertices removed", count());
    return table;
}

PropertyTable latticeTable(const std::vector<Json>& organs) {
    PropertyTable table{"Lattice", {}, {}};
    Rows(table, organs, "lattice")
        .add("nodes", "Nodes", count())
        .add("fixed_nodes", "Nodes held fixed", count())
        .add("cells", "Cells", count())
        .add("spacing_m", "Spacing", quantity("m"))
        .add("node_dims", "Whole grid", size(" nodes"))
        .add("volume_m3", "Volume of the surface", plain("cm\u00B3", kCubicCentimetre))
        .add("filled_volume_m3", "Volume of the cells\u2019 fills", plain("cm\u00B3", kCubicCentimetre))
        .add("layout", "Layout in textures", word())
        .add("texture_size", "Texture", size(" texels"));
    return table;
}

/// A given motion has no step: its figures are zero.
PropertyTable stepTable(const std::vector<Json>& organs) {
    PropertyTable table{"Time step", {}, {}};
    Rows(table, organs, "step")
        .add("method", "Method", word())
        .add("time_step_s", "Step", quantity("s"))
        .add("steps_per_frame", "Steps a frame", count())
        .add("bound_s", "Explicit steps are stable below", quantity("s"))
        .add("margin", "Share of the bound that may be used", plain("%", 100))
        .add("stiffest_rate2_1_s2", "Stiffest mode, \u03C9\u00B2", plain("1/s\u00B2"))
        .add("formula_rate2_1_s2", "Formula 12 k/m", plain("1/s\u00B2"));
    return table;
}

PropertyTable bindingTable(const std::vector<Json>& organs) {
    PropertyTable table{"Binding of the surface to the lattice", {}, {}};
    Rows(table, organs, "binding")
        .add("vertices", "Vertices", count())
        .add("torn_edges_found", "Torn edges found", count())
        .add("torn_edges_left", "Torn edges left", count())
        .add("constant_basis_vertices", "Vertices with a constant basis", count())
        .add("bytes_per_vertex", "Bytes a vertex", plain(""));
    return table;
}

std::string vector3(const Json& value, const std::string& unit) {
    std::string text;
    for (const Json& side : value)
        text += (text.empty() ? "" : ", ") +
                (side.is_number() ? numberText(side.get<double>()) : std::string("not finite"));
    return "(" + text + ")\u00A0" + unit;
}

/// How a material departs from a linear, isotropic one.
std::string lawText(const Json& material) {
    std::string text;
    const auto add = [&text](const std::string& more) { text += (text.empty() ? "" : "; ") + more; };
    if (material.contains("curve")) {
        std::string points;
        for (const Json& point : material.at("curve"))
            points += (points.empty() ? "" : ", ") + siText(figureOf(point, "stress_Pa"), "Pa") + " at " +
                      numberText(100 * figureOf(point, "strain")) + "\u00A0%";
        add("tension " + points);
    }
    if (material.contains("strain_limit"))
        add("limit at " + numberText(100 * figureOf(material, "strain_limit")) + "\u00A0%");
    if (material.contains("fibre_young_Pa"))
        add(siText(figureOf(material, "fibre_young_Pa"), "Pa") + " along " +
            vector3(material.at("fibre"), ""));
    return text.empty() ? "linear" : text;
}

} // namespace

std::vector<Json> organsOf(const Json& summary) {
    if (summary.contains("organs"))
        return summary["organs"];
    Json organ = summary.at("organ");
    for (const char* key : {"solver", "lattice", "step", "binding"})
        organ[key] = summary.at(key);
    return {organ};
}

double forceSize(const Json& sample) {
    const auto part = [&sample](std::size_t i) {
        const Json& value = sample.at("N").at(i);
        return value.is_number() ? value.get<double>() : std::nan("");
    };
    return std::hypot(part(0), part(1), part(2));
}

double timeOfLargestForce(const Json& tool) {
    double largest = -1, time = std::numeric_limits<double>::quiet_NaN();
    for (const Json& sample : tool.at("force"))
        if (const double size = forceSize(sample); size > largest) {
            largest = size;
            time = figureOf(sample, "t_s");
        }
    return time;
}

void writeOrganTables(Markup& page, const Json& summary) {
    const std::vector<Json> organs = organsOf(summary);
    std::vector<std::string> names;
    if (organs.size() > 1)
        for (const Json& organ : organs)
            names.push_back(organ.at("name").get<std::string>());
    // Side by side where each is narrow.
    page.open("div", {{"class", organs.size() > 1 ? "stack" : "tables"}});
    for (PropertyTable table : {organTable(organs), latticeTable(organs), stepTable(organs),
                                bindingTable(organs), repairTable(organs)}) {
        table.columns = names;
        writeProperties(page, table);
    }
    page.close();
    page.element(
        "p", {{"class", "note"}},
        "The step is computed: " + organs.front().at("step").at("how").get<std::string>() +
            ". A torn edge has ends that bind to lattice triangles without a common node; a constant "
            "basis stands where node normals are not well defined.");
}

void writeMaterialTable(Markup& page, const Json& summary) {
    const std::vector<Json> organs = organsOf(summary);
    page.open("div", {{"class", "scroll"}}).open("table", {{"class", "tools"}}).open("thead").open("tr");
    page.element("th", {{"scope", "col"}}, "Material");
    for (const char* heading :
         {"Young\u2019s modulus", "Poisson\u2019s ratio", "Density", "Cells", "Volume", "Mass"})
        page.element("th", {{"scope", "col"}, {"class", "number"}}, heading);
    page.element("th", {{"scope", "col"}}, "Law").close().close().open("tbody");
    for (const Json& organ : organs)
        for (const Json& material : organ.value("materials", Json::array())) {
            const std::string name = material.at("name").get<std::string>();
            page.open("tr").element("th", {{"scope", "row"}},
                                    organs.size() == 1 ? name
                                                       : organ.at("name").get<std::string>() + ", " + name);
            for (const std::string& value :
                 {siText(figureOf(material, "young_Pa"), "Pa"), numberText(figureOf(material, "poisson")),
                  numberText(figureOf(material, "density_kg_m3")) + "\u00A0kg/m\u00B3",
                  grouped(material.at("cells").get<std::size_t>()),
                  numberText(kCubicCentimetre * figureOf(material, "volume_m3")) + "\u00A0cm\u00B3",
                  siText(1e3 * figureOf(material, "mass_kg"), "g")})
                page.element("td", {{"class", "number"}}, value);
            page.element("td", {}, lawText(material)).close();
        }
    page.close().close().close();
}

std::vector<Json> collidersOf(const Json& summary) {
    std::vector<Json> colliders = summary.at("tools");
    for (const Json& body : summary.value("bodies", Json::array()))
        colliders.push_back(body);
    return colliders;
}

void writeToolTable(Markup& page, const Json& summary) {
    const auto orDash = [](double value, const char* unit) {
        return std::isfinite(value) ? siText(value, unit) : std::string("\u2013");
    };
    page.open("div", {{"class", "scroll"}}).open("table", {{"class", "tools"}}).open("thead").open("tr");
    for (const char* heading : {"Tool", "Shape", "Mode"})
        page.element("th", {{"scope", "col"}}, heading);
    for (const char* heading : {"Radius", "Largest force", "At", "Largest torque"})
        page.element("th", {{"scope", "col"}, {"class", "number"}}, heading);
    page.close().close().open("tbody");
    for (const Json& tool : collidersOf(summary)) {
        page.open("tr").element("th", {{"scope", "row"}}, tool.at("name").get<std::string>());
        page.element("td", {}, tool.value("kind", "sphere"));
        page.element("td", {}, tool.value("mode", "fixed"));
        const double time = timeOfLargestForce(tool), largest = figureOf(tool, "largest_force_N");
        for (const std::string& value : {orDash(figureOf(tool, "radius_m"), "m"), siText(largest, "N"),
                                         orDash(largest > 0 ? time : std::nan(""), "s"),
                                         orDash(figureOf(tool, "largest_torque_Nm"), "N\u00A0m")})
            page.element("td", {{"class", "number"}}, value);
        page.close();
    }
    page.close().close().close();
}

void writeProgramTable(Markup& page, const Json& summary) {
    PropertyTable scene{"Scene", {}, {}};
    scene.rows.push_back({"Gravity", {vector3(summary.at("gravity_m_s2"), "m/s\u00B2")}, ""});
    Rows(scene, {summary}, "")
        .add("frame_rate_Hz", "Frame rate", plain("Hz"))
        .add("frames_asked", "Frames asked for", count())
        .add("frames", "Frames done", count())
        .add("mapping", "Mapping of the surface", word())
        .add("picture_size", "Pictures", size(" pixels"))
        .add("pictures", "Pictures written", count())
        .add("surfaces", "Surfaces written", count())
        .add("state_hash", "Last state\u2019s hash", word());
    PropertyTable machine{"Program and machine", {}, {}};
    Rows(machine, {summary}, "").add("serosa", "Serosa", word()).add("solver", "Solver", word());
    Rows(machine, {summary}, "gl")
        .add("context", "OpenGL context", word())
        .add("vendor", "Vendor", word())
        .add("renderer", "Renderer", word())
        .add("version", "Version", word())
        .add("software", "Drawn by",
             [](const Json& value) { return value.get<bool>() ? "the CPU" : "a GPU"; });
    for (const auto& [name, version] : summary.at("parts").items())
        machine.rows.push_back({name, {version.get<std::string>()}, ""});
    page.open("div", {{"class", "tables"}});
    writeProperties(page, scene);
    writeProperties(page, machine);
    page.close();
}

void writeTimingTable(Markup& page, const Json& summary) {
    PropertyTable table{"Wall time and memory", {}, {}};
    Rows(table, {summary}, "timing")
        .add("real_time_factor", "Real-time factor", plain("\u00D7"),
             "simulated time over stepping and drawing every frame")
        .add("ms_per_step", "A step", quantity("s", 1e-3))
        .add("ms_steps_per_frame", "Steps of a frame", quantity("s", 1e-3))
        .add("ms_draw_per_picture", "Drawing a picture", quantity("s", 1e-3))
        .add("ms_per_frame", "A frame", quantity("s", 1e-3), "steps and drawing")
        .add("setup_s", "Setting up", quantity("s"))
        .add("files_s", "Files", quantity("s"), "reading back and writing")
        .add("total_s", "Total", quantity("s"))
        .add("peak_memory_B", "Peak memory", quantity("B"), "the most that the process held");
    writeProperties(page, table);
}

} // namespace serosa::app
