// Reads typed values out of one TOML table; see sim/scene_table.h.

#include "sim/scene_table.h"

#include "sim/suggest.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

namespace serosa::sim {

namespace {

const char* typeName(const toml::node& node) {
    switch (node.type()) {
    case toml::node_type::string:
        return "text";
    case toml::node_type::integer:
        return "an integer";
    case toml::node_type::floating_point:
        return "a number";
    case toml::node_type::boolean:
        return "true or false";
    case toml::node_type::array:
        return "an array";
    case toml::node_type::table:
        return "a table";
    default:
        return "a date or time";
    }
}

bool isQuantity(const SceneKey& key) {
    return key.kind == ValueKind::quantity || key.kind == ValueKind::quantity3 ||
           key.kind == ValueKind::quantityList;
}

std::string formatted(const SceneKey& key, double value) {
    return isQuantity(key) ? formatQuantity(value, key.dimension) : formatNumber(value);
}

std::string formatted(const SceneKey& key, const std::vector<double>& values) {
    std::string text = "[";
    for (std::size_t i = 0; i < values.size(); ++i)
        text += (i ? ", " : "") + formatted(key, values[i]);
    return text + "]";
}

/// toml++ writes 'x' and [ 1, 2 ]; scenes and this program write "x" and [1, 2].
std::string plainToml(std::string text) {
    std::replace(text.begin(), text.end(), '\'', '"');
    std::replace(text.begin(), text.end(), '\n', ' ');
    for (const auto& [from, to] : {std::pair{"[ ", "["}, std::pair{" ]", "]"}})
        for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from))
            text.replace(at, 2, to);
    return text;
}

std::vector<double> asList(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

} // namespace

Error sceneError(const std::string& file, const toml::source_position& position, const std::string& message) {
    return Error{file + ":" + std::to_string(position.line) + ":" + std::to_string(position.column) + ": " +
                 message};
}

SceneTable::SceneTable(const SceneSource& source, std::string table, std::string path,
                       const toml::table* content, bool inherits)
    : source_(source), table_(std::move(table)), path_(std::move(path)), content_(content),
      inherits_(inherits) {}

const SceneKey& SceneTable::spec(const char* key) const {
    const SceneKey* found = findSceneKey(table_, key);
    SEROSA_CHECK(found, "the scene reader asks for a key that scene_keys.cpp does not list: " + pathOf(key));
    return *found;
}

Error SceneTable::errorAt(const toml::source_region& region, const std::string& message) const {
    return sceneError(source_.name, region.begin, message);
}

Error SceneTable::errorAt(const char* key, const std::string& message) const {
    if (const toml::node* value = node(key))
        return errorAt(value->source(), pathOf(key) + ": " + message);
    if (content_)
        return errorAt(content_->source(), (path_.empty() ? "" : path_ + ": ") + message);
    return Error{source_.name + ": " + (path_.empty() ? "" : path_ + ": ") + message};
}

int SceneTable::lineOf(const char* key) const {
    return node(key) ? int(node(key)->source().begin.line) : 0;
}

Status SceneTable::checkKeys() const {
    if (!content_)
        return {};
    for (auto&& [key, value] : *content_)
        if (!findSceneKey(table_, std::string(key.str())))
            return errorAt(key.source(), "unknown key " + inQuotes(key.str()) +
                                             (path_.empty() ? "" : " in " + path_) +
                                             suggestion(key.str(), keyNames(table_)));
    for (const SceneKey& key : sceneKeys())
        if (table_ == key.table && key.required() && !content_->contains(key.name))
            return errorAt(content_->source(),
                           "required key '" + pathOf(key.name) + "' is missing: " + describeValue(key));
    return {};
}

Error SceneTable::wrongType(const SceneKey& key, const toml::node& value) const {
    return errorAt(value.source(),
                   pathOf(key.name) + " is " + typeName(value) + ", expected " + describeValue(key));
}

Result<double> SceneTable::numberOf(const SceneKey& key, const toml::node& value) const {
    double number = 0;
    if (isQuantity(key)) {
        if (const auto text = value.value_exact<std::string>()) {
            Result<double> parsed = parseQuantity(*text, key.dimension);
            if (!parsed)
                return errorAt(value.source(), pathOf(key.name) + ": " + parsed.error().message);
            number = *parsed;
        } else if (value.is_number()) {
            const double bare = *value.value<double>();
            return errorAt(value.source(), pathOf(key.name) + " has no unit: write \"" + formatNumber(bare) +
                                               " " + unitNames(key.dimension).front() + "\" (units of a " +
                                               dimensionName(key.dimension) + ": " + describeValue(key) +
                                               ")");
        } else {
            return wrongType(key, value);
        }
    } else {
        if (!value.is_number())
            return wrongType(key, value);
        number = *value.value<double>();
    }
    if (!std::isfinite(number))
        return errorAt(value.source(), pathOf(key.name) + " is not a finite number");
    const bool degrees = isQuantity(key) && key.dimension == Dimension::angle;
    const double compared = degrees ? number * (180 / std::numbers::pi) : number;
    if (!key.range.holds(compared))
        return errorAt(value.source(), pathOf(key.name) + " is " + formatted(key, number) + ", expected " +
                                           (key.range.low == key.range.high ? "" : "a value ") +
                                           key.range.text() + (degrees ? " deg" : ""));
    return number;
}

Result<std::vector<double>> SceneTable::numbersOf(const SceneKey& key, const toml::node& value,
                                                  std::optional<std::size_t> count) const {
    const toml::array* array = value.as_array();
    if (!array)
        return wrongType(key, value);
    if (count && array->size() != *count)
        return errorAt(value.source(), pathOf(key.name) + " has " + std::to_string(array->size()) +
                                           " items, expected " + describeValue(key));
    std::vector<double> numbers;
    for (const toml::node& item : *array) {
        SEROSA_ASSIGN(const double number, numberOf(key, item));
        numbers.push_back(number);
    }
    return numbers;
}

Result<std::int64_t> SceneTable::integerOf(const SceneKey& key, const toml::node& value) const {
    if (!value.is_integer())
        return wrongType(key, value);
    SEROSA_TRY(numberOf(key, value)); // the range
    return *value.value_exact<std::int64_t>();
}

void SceneTable::note(const char* key, const std::string& value) const {
    if (!source_.explained)
        return;
    std::string written;
    if (const toml::node* given = node(key)) {
        std::ostringstream text;
        given->visit([&text](const auto& n) { text << toml::toml_formatter{toml::table{{"v", n}}}; });
        written = plainToml(text.str().substr(4)); // after "v = "
    }
    source_.explained->push_back({pathOf(key), written, value, lineOf(key), inherits_ && !node(key)});
}

Status SceneTable::read(const char* key, double& value) const {
    if (const toml::node* given = node(key)) {
        SEROSA_ASSIGN(value, numberOf(spec(key), *given));
    }
    note(key, formatted(spec(key), value));
    return {};
}

Status SceneTable::read(const char* key, std::optional<double>& value) const {
    if (const toml::node* given = node(key)) {
        SEROSA_ASSIGN(value, numberOf(spec(key), *given));
        note(key, formatted(spec(key), *value));
    }
    return {};
}

Status SceneTable::read(const char* key, std::size_t& value) const {
    if (const toml::node* given = node(key)) {
        SEROSA_ASSIGN(const std::int64_t integer, integerOf(spec(key), *given));
        value = std::size_t(integer);
    }
    note(key, std::to_string(value));
    return {};
}

Status SceneTable::read(const char* key, int& value) const {
    std::size_t wide = std::size_t(value);
    SEROSA_TRY(read(key, wide));
    value = int(wide);
    return {};
}

Status SceneTable::read(const char* key, bool& value) const {
    if (const toml::node* given = node(key)) {
        if (!given->is_boolean())
            return wrongType(spec(key), *given);
        value = *given->value_exact<bool>();
    }
    note(key, value ? "true" : "false");
    return {};
}

Status SceneTable::read(const char* key, std::string& value) const {
    if (const toml::node* given = node(key)) {
        if (!given->is_string())
            return wrongType(spec(key), *given);
        value = *given->value_exact<std::string>();
        if (value.empty())
            return errorAt(key, "is empty");
        for (const char c : value)
            if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
                return errorAt(key, inQuotes(value) + " holds a control character");
    }
    note(key, inQuotes(value));
    return {};
}

Status SceneTable::read(const char* key, glm::dvec3& value) const {
    if (const toml::node* given = node(key)) {
        SEROSA_ASSIGN(const std::vector<double> list, numbersOf(spec(key), *given, 3));
        value = {list[0], list[1], list[2]};
    }
    note(key, formatted(spec(key), asList(value)));
    return {};
}

Status SceneTable::read(const char* key, std::optional<glm::dvec3>& value) const {
    if (!has(key))
        return {};
    glm::dvec3 given{0};
    SEROSA_TRY(read(key, given));
    value = given;
    return {};
}

template <class Vector>
Status SceneTable::readIntegers(const char* key, Vector& value) const {
    constexpr int count = Vector::length();
    if (const toml::node* given = node(key)) {
        SEROSA_TRY(numbersOf(spec(key), *given, count));
        for (int i = 0; i < count; ++i) {
            SEROSA_ASSIGN(const std::int64_t integer,
                          integerOf(spec(key), *given->as_array()->get(std::size_t(i))));
            value[i] = int(integer);
        }
    }
    std::vector<double> list;
    for (int i = 0; i < count; ++i)
        list.push_back(value[i]);
    note(key, formatted(spec(key), list));
    return {};
}

Status SceneTable::read(const char* key, glm::ivec2& value) const {
    return readIntegers(key, value);
}

Status SceneTable::read(const char* key, glm::ivec3& value) const {
    return readIntegers(key, value);
}

Status SceneTable::read(const char* key, std::vector<double>& value) const {
    if (const toml::node* given = node(key)) {
        SEROSA_ASSIGN(value, numbersOf(spec(key), *given, std::nullopt));
    }
    note(key, formatted(spec(key), value));
    return {};
}

Status SceneTable::read(const char* key, std::vector<std::string>& value) const {
    if (const toml::node* given = node(key)) {
        if (!given->is_array())
            return wrongType(spec(key), *given);
        value.clear();
        for (const toml::node& item : *given->as_array()) {
            const auto text = item.value_exact<std::string>();
            if (!text)
                return wrongType(spec(key), item);
            value.push_back(*text);
        }
        if (value.empty())
            return errorAt(key, "is empty");
    }
    std::string list;
    for (const std::string& text : value)
        list += (list.empty() ? "" : ", ") + inQuotes(text);
    note(key, "[" + list + "]");
    return {};
}

Status SceneTable::readWordIndex(const char* key, int& index) const {
    const SceneKey& known = spec(key);
    if (const toml::node* given = node(key)) {
        const auto text = given->value_exact<std::string>();
        if (!text)
            return wrongType(known, *given);
        index = -1;
        for (std::size_t i = 0; i < known.words.size(); ++i)
            if (*text == known.words[i])
                index = int(i);
        if (index < 0)
            return errorAt(key, "unknown value " + inQuotes(*text) + suggestion(*text, known.words));
    }
    note(key, inQuotes(known.words.at(std::size_t(index))));
    return {};
}

Result<const toml::table*> SceneTable::table(const char* key) const {
    const toml::node* given = node(key);
    if (given && !given->is_table())
        return errorAt(key, std::string("is ") + typeName(*given) + ", expected a table: write [" +
                                (table_.empty() ? key : table_ + "." + key) + "]");
    return given ? given->as_table() : nullptr;
}

Result<std::vector<const toml::table*>> SceneTable::tables(const char* key) const {
    std::vector<const toml::table*> list;
    const toml::node* given = node(key);
    if (!given)
        return list;
    const std::string expected =
        std::string(key) == "curve" ? "an array of { strain = ..., stress = ... }"
        : table_ == "tool"
            ? "an array of { t = ..., at = ... }"
            : "tables: write [[" + (table_.empty() ? key : table_ + "." + key) + "]], once for each";
    if (!given->is_array())
        return errorAt(key, std::string("is ") + typeName(*given) + ", expected " + expected);
    for (const toml::node& item : *given->as_array()) {
        if (!item.is_table())
            return errorAt(item.source(),
                           pathOf(key) + " holds " + typeName(item) + ", expected " + expected);
        list.push_back(item.as_table());
    }
    return list;
}

Result<std::vector<const toml::table*>> SceneTable::tableOrTables(const char* key) const {
    const toml::node* given = node(key);
    if (given && given->is_table())
        return std::vector<const toml::table*>{given->as_table()};
    return tables(key);
}

} // namespace serosa::sim
