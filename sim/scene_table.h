#pragma once
// One table of a scene file: typed reading of its keys as sim/scene_keys.h lists them, with errors that carry
// file:line:column, and a trace of every value for `serosa scene explain`. Private to sim/scene*.cpp.

#include "base/result.h"
#include "sim/scene.h"
#include "sim/scene_keys.h"

#include <glm/glm.hpp>
#include <toml++/toml.h>

#include <optional>
#include <string>
#include <vector>

namespace serosa::sim {

/// What all tables of one file share.
struct SceneSource {
    std::string name;                             // as messages call the file
    std::vector<SceneValue>* explained = nullptr; // may be null
};

class SceneTable {
public:
    /// \param table its name in scene_keys.h. \param path its name in messages: "tool[1]".
    /// \param content null: the file has no such table, and every key takes its default.
    /// \param inherits what is absent is another table's value, not a default.
    SceneTable(const SceneSource& source, std::string table, std::string path, const toml::table* content,
               bool inherits = false);

    /// Unknown keys and missing required ones.
    Status checkKeys() const;

    bool has(const char* key) const { return content_ && content_->contains(key); }
    /// An error at a key's value, or at the table where the key is absent.
    Error errorAt(const char* key, const std::string& message) const;
    int lineOf(const char* key) const;

    // Each leaves `value` as it is where the key is absent, and notes value or default for `explain`.
    Status read(const char* key, double& value) const;
    Status read(const char* key, std::optional<double>& value) const;
    Status read(const char* key, std::size_t& value) const;
    Status read(const char* key, int& value) const;
    Status read(const char* key, bool& value) const;
    Status read(const char* key, std::string& value) const;
    Status read(const char* key, glm::dvec3& value) const;
    Status read(const char* key, std::optional<glm::dvec3>& value) const;
    Status read(const char* key, glm::ivec2& value) const;
    Status read(const char* key, glm::ivec3& value) const;
    Status read(const char* key, std::vector<double>& value) const;
    Status read(const char* key, std::vector<std::string>& value) const;
    /// One of the key's words; Enum counts them from 0 in the same order.
    template <class Enum>
    Status readWord(const char* key, Enum& value) const {
        int index = int(value);
        SEROSA_TRY(readWordIndex(key, index));
        value = Enum(index);
        return {};
    }
    /// A sub-table; null where absent.
    Result<const toml::table*> table(const char* key) const;
    /// An array of tables; empty where absent.
    Result<std::vector<const toml::table*>> tables(const char* key) const;
    /// The same, or one that is written [key].
    Result<std::vector<const toml::table*>> tableOrTables(const char* key) const;

private:
    const SceneKey& spec(const char* key) const;
    const toml::node* node(const char* key) const { return content_ ? content_->get(key) : nullptr; }
    std::string pathOf(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }
    Error errorAt(const toml::source_region& region, const std::string& message) const;
    Error wrongType(const SceneKey& key, const toml::node& node) const;
    /// One number of a key: a quantity string or a plain number, finite and in range.
    Result<double> numberOf(const SceneKey& key, const toml::node& node) const;
    Result<std::vector<double>> numbersOf(const SceneKey& key, const toml::node& node,
                                          std::optional<std::size_t> count) const;
    Result<std::int64_t> integerOf(const SceneKey& key, const toml::node& node) const;
    Status readWordIndex(const char* key, int& index) const;
    template <class Vector>
    Status readIntegers(const char* key, Vector& value) const;
    void note(const char* key, const std::string& value) const;

    const SceneSource& source_;
    std::string table_, path_;
    const toml::table* content_;
    bool inherits_;
};

/// "file:line:column: message"
Error sceneError(const std::string& file, const toml::source_position& position, const std::string& message);

} // namespace serosa::sim
