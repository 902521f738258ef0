#pragma once
// Scene files in a folder of their own, with a model beside them, for the tests of the scene reader.

#include "sim/scene.h"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace serosa::sim {

inline std::string readWholeFile(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

class SceneFiles {
public:
    SceneFiles() {
        std::string name = (std::filesystem::temp_directory_path() / "serosa-scene-XXXXXX").string();
        folder_ = mkdtemp(name.data());
        std::ofstream(folder_ / "ball.ply") << "ply\n"; // only its existence counts here
    }
    ~SceneFiles() { std::filesystem::remove_all(folder_); }
    SceneFiles(const SceneFiles&) = delete;
    SceneFiles& operator=(const SceneFiles&) = delete;

    const std::filesystem::path& folder() const { return folder_; }
    std::filesystem::path write(const std::string& text) const {
        std::ofstream(folder_ / "scene.toml", std::ios::binary) << text;
        return folder_ / "scene.toml";
    }
    Result<Scene> read(const std::string& text, std::vector<SceneValue>* values = nullptr) const {
        return readScene(write(text), values);
    }
    /// The shortest scene: the next line is number 5.
    static std::string minimal() {
        return "schema = 1\n[[organ]]\nmodel = \"ball.ply\"\nlength_unit = \"mm\"\n";
    }

private:
    std::filesystem::path folder_;
};

} // namespace serosa::sim
