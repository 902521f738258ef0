// What sim/scene_keys.h says of keys in words: of their values, and the tables of docs/scene.md.

#include "sim/scene_keys.h"

#include <iomanip>
#include <limits>
#include <set>
#include <sstream>

namespace serosa::sim {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
using Kind = ValueKind;

std::string quantityName(Dimension dimension) {
    std::string units;
    for (const std::string& unit : unitNames(dimension))
        units += (units.empty() ? "" : ", ") + unit;
    return std::string(dimensionName(dimension)) + " (" + units + ")";
}

std::string tableTitle(const std::string& table) {
    if (table.empty())
        return "At the top";
    const std::set<std::string> repeated{
        "organ", "organ.material", "organ.region", "organ.fixed", "organ.level",          "tool",
        "body",  "thread",         "cut",          "deformation", "look.cut_volume.label"};
    if (table == "tool.keys")
        return "`keys` of `[[tool]]`, each `{ t = ..., at = ... }`";
    if (table == "thread.ends")
        return "`ends` of `[[thread]]`, each `{ organ = ..., at = ... }`";
    if (table == "cut.keys")
        return "`keys` of `[[cut]]`, each `{ t = ..., at = ..., end = ... }`";
    if (table == "deformation.keys")
        return "`keys` of `[[deformation]]`, each `{ t = ..., at = ..., turn = ..., scale = ... }`";
    if (table == "deformation.path")
        return "`path` of `[[deformation]]`, each `{ x = ..., z = ... }`";
    if (table == "deformation.points")
        return "`points` of `[[deformation]]`, each `{ from = ..., to = ... }`";
    if (table == "curve")
        return "`curve` of `[organ.tissue]` and `[[organ.material]]`, each `{ strain = ..., stress = ... }`";
    return repeated.contains(table) ? "`[[" + table + "]]`" : "`[" + table + "]`";
}

} // namespace

std::string ValueRange::text() const {
    const auto formatNumber = [](double value) { // limits are short numbers: 1000000, not 1e+06
        std::ostringstream out;
        out << std::setprecision(12) << value;
        return out.str();
    };
    const bool bounded = high < kInfinity;
    if (low == high)
        return formatNumber(low);
    if (low == -kInfinity)
        return bounded ? "at most " + formatNumber(high) : "";
    const std::string least = (lowOpen   ? "greater than "
                               : bounded ? "from "
                                         : "at least ") +
                              formatNumber(low);
    if (!bounded)
        return least;
    return least + (lowOpen ? ", at most " : " to ") + formatNumber(high);
}

std::string describeValue(const SceneKey& key) {
    std::string text;
    switch (key.kind) {
    case Kind::integer:
        text = "integer";
        break;
    case Kind::number:
        text = "number";
        break;
    case Kind::boolean:
        return "true or false";
    case Kind::text:
        return "text";
    case Kind::texts:
        return "array of texts";
    case Kind::word:
        for (std::size_t i = 0; i < key.words.size(); ++i)
            text += (i == 0 ? "\"" : i + 1 == key.words.size() ? " or \"" : ", \"") + key.words[i] + "\"";
        return text;
    case Kind::quantity:
        text = quantityName(key.dimension);
        break;
    case Kind::quantity3:
        text = "array of 3: " + quantityName(key.dimension);
        break;
    case Kind::quantityList:
        text = "array: " + quantityName(key.dimension);
        break;
    case Kind::number3:
        text = "array of 3 numbers";
        break;
    case Kind::integer2:
        text = "array of 2 integers";
        break;
    case Kind::integer3:
        text = "array of 3 integers";
        break;
    case Kind::table:
        return "table";
    case Kind::tables:
        return "tables";
    }
    const std::string limits = key.range.text();
    const bool degrees = key.kind == Kind::quantity && key.dimension == Dimension::angle;
    return text + (limits.empty() ? "" : ", " + limits + (degrees ? " deg" : ""));
}

std::string sceneReference() {
    std::ostringstream out;
    std::string table = "?";
    for (const SceneKey& key : sceneKeys()) {
        if (table != key.table) {
            out << (table == "?" ? "" : "\n") << "### " << tableTitle(key.table) << "\n\n"
                << "| key | value | default | meaning |\n| --- | --- | --- | --- |\n";
            table = key.table;
        }
        out << "| `" << key.name << "` | " << describeValue(key) << " | ";
        if (key.required())
            out << "**required**";
        else if (*key.fallback == '\0')
            out << "-";
        else
            out << "`" << key.fallback << "`";
        out << " | " << key.meaning << " |\n";
    }
    return out.str();
}

} // namespace serosa::sim
