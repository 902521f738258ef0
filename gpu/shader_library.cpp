// Includes and defines. Every file that enters a stage gets a source number, and #line directives keep the
// compiler's line numbers true, so that its log can be translated back (gpu/shader_log.cpp).

#include "gpu/embedded_shaders.h"
#include "gpu/program.h"

#include <fstream>
#include <sstream>

namespace serosa::gpu {

namespace {

/// The name in `#include "name"`, if the line is one. Errors: an include that names no file.
Result<std::optional<std::string>> includedName(const std::string& line, const std::string& where) {
    const std::size_t hash = line.find_first_not_of(" \t");
    if (hash == std::string::npos || line[hash] != '#')
        return std::optional<std::string>();
    const std::size_t word = line.find_first_not_of(" \t", hash + 1);
    if (word == std::string::npos || line.compare(word, 7, "include") != 0)
        return std::optional<std::string>();
    const std::size_t open = line.find('"', word + 7);
    const std::size_t close = open == std::string::npos ? open : line.find('"', open + 1);
    if (close == std::string::npos || close == open + 1)
        return Error{where + ": write #include \"file\""};
    return std::optional(line.substr(open + 1, close - open - 1));
}

bool isVersion(const std::string& line) {
    const std::size_t hash = line.find_first_not_of(" \t");
    return hash != std::string::npos && line.compare(hash, 8, "#version") == 0;
}

class Expander {
public:
    Expander(const ShaderLibrary& library, const std::vector<ShaderDefine>& defines)
        : library_(library), defines_(defines) {}

    Status add(const std::string& name, int from, int fromLine) {
        const std::string where = from < 0 ? ""
                                           : shader.files[static_cast<std::size_t>(from)].name + ":" +
                                                 std::to_string(fromLine) + ": ";
        for (int file = from; file >= 0; file = shader.files[static_cast<std::size_t>(file)].includedFrom)
            if (shader.files[static_cast<std::size_t>(file)].name == name)
                return Error{where + "include cycle: \"" + name + "\" is being included already"};
        std::size_t index = 0;
        while (index < shader.files.size() && shader.files[index].name != name)
            ++index;
        if (index == shader.files.size()) {
            const auto text = library_.text(name);
            if (!text.ok())
                return Error{where + text.error().message};
            shader.files.push_back({name, text.value(), from, fromLine});
        }
        if (from < 0)
            return addLines(0);
        // A guard instead of leaving the second copy out: the first one may stand in an inactive #if.
        const std::string guard = "SRS_INCLUDED_" + std::to_string(index);
        shader.source += "#ifndef " + guard + "\n#define " + guard + "\n";
        directive(1, static_cast<int>(index));
        SEROSA_TRY(addLines(static_cast<int>(index)));
        shader.source += "#endif\n";
        return {};
    }

    ExpandedShader shader;

private:
    Status addLines(int index) {
        const std::string name = shader.files[static_cast<std::size_t>(index)].name;
        std::istringstream lines(shader.files[static_cast<std::size_t>(index)].text);
        std::string line;
        bool versionSeen = index > 0;
        for (int number = 1; std::getline(lines, line); ++number) {
            const std::string here = name + ":" + std::to_string(number);
            const auto included = includedName(line, here);
            if (!included.ok())
                return included.error();
            if (included.value()) {
                if (!versionSeen)
                    return Error{here + ": an include before #version"};
                SEROSA_TRY(add(*included.value(), index, number));
                directive(number + 1, index);
                continue;
            }
            shader.source += line + "\n";
            if (!versionSeen && isVersion(line)) {
                versionSeen = true;
                for (const ShaderDefine& define : defines_)
                    shader.source += "#define " + define.name + " " + define.value + "\n";
                directive(number + 1, index);
            }
        }
        if (!versionSeen)
            return Error{name + ": no #version line; a stage begins with \"#version 450 core\""};
        return {};
    }

    /// The next line is line `number` of file `index`.
    void directive(int number, int index) {
        shader.source += "#line " + std::to_string(number) + " " + std::to_string(index) + "\n";
    }

    const ShaderLibrary& library_;
    const std::vector<ShaderDefine>& defines_;
};

} // namespace

ShaderLibrary::ShaderLibrary(std::filesystem::path folder) : folder_(std::move(folder)) {}

Result<std::string> ShaderLibrary::text(const std::string& name) const {
    if (folder_) {
        std::ifstream file(*folder_ / name, std::ios::binary);
        std::ostringstream content;
        if (!std::filesystem::is_regular_file(*folder_ / name) || !(content << file.rdbuf()))
            return Error{"no shader \"" + name + "\" in the folder " + folder_->string() +
                         " (missing, empty or unreadable)"};
        return content.str();
    }
    for (const EmbeddedShader* shader = embeddedShaders(); shader->name; ++shader)
        if (name == shader->name)
            return std::string(shader->source);
    return Error{"no shader \"" + name +
                 "\" in the program; new files in shaders/ are embedded when it is configured anew"};
}

Result<ExpandedShader> ShaderLibrary::expand(const std::string& name,
                                             const std::vector<ShaderDefine>& defines) const {
    Expander expander(*this, defines);
    SEROSA_TRY(expander.add(name, -1, 0));
    return std::move(expander.shader);
}

} // namespace serosa::gpu
