// Wavefront OBJ: v (with colours, as MeshLab writes them), vt (where every face's corners name them) and f;
// normals, groups, materials, points and lines are passed over; free-form surfaces and unknown keywords are
// errors. Material files are never opened.
#include "sim/mesh_reader_detail.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace serosa::sim::detail {
namespace {

constexpr std::array kPassedOver{"vn",     "vp",         "g",         "o",      "s",        "usemtl",
                                 "mtllib", "l",          "p",         "maplib", "usemap",   "bevel",
                                 "lod",    "shadow_obj", "trace_obj", "mg",     "c_interp", "d_interp"};
constexpr std::array kFreeForm{"cstype", "deg",  "bmat", "step", "curv", "curv2", "surf", "parm",  "trim",
                               "hole",   "scrv", "sp",   "end",  "con",  "call",  "csh",  "ctech", "stech"};

class ObjReader {
public:
    explicit ObjReader(const MeshSource& source) : source_(source), reader_(source) {}

    Result<TriangleMesh> read() {
        while (reader_.nextWithWords()) {
            firstLine_ = reader_.line();
            SEROSA_TRY(joinContinued());
            const auto keyword = reader_.words()[0];
            const auto isKeyword = [&](const char* known) { return keyword == known; };
            if (keyword == "v") {
                SEROSA_TRY(readVertex());
            } else if (keyword == "vt") {
                SEROSA_TRY(readTextureVertex());
            } else if (keyword == "f") {
                SEROSA_TRY(readFace());
            } else if (std::any_of(kFreeForm.begin(), kFreeForm.end(), isKeyword)) {
                return error("free-form geometry (" + quotedWord(keyword) +
                             ") is not read; export triangles");
            } else if (std::none_of(kPassedOver.begin(), kPassedOver.end(), isKeyword)) {
                return error("unknown keyword " + quotedWord(keyword) +
                             "; remove the line, or export the mesh again");
            }
        }
        if (mesh_.positions.empty())
            return source_.atLine(reader_.line(),
                                  "no vertices (v) up to the end of the file; export the mesh again");
        if (mesh_.faces.empty())
            return source_.atLine(reader_.line(),
                                  "no faces (f) up to the end of the file; export a surface, not points");
        if (highestCorner_ > mesh_.positions.size())
            return source_.atLine(highestLine_, "a face names vertex " + std::to_string(highestCorner_) +
                                                    ", but the file has " +
                                                    std::to_string(mesh_.positions.size()) +
                                                    "; the file may be cut off, export it again");
        SEROSA_TRY(giveUvs());
        return std::move(mesh_);
    }

private:
    Error error(const std::string& text) const { return source_.atLine(firstLine_, text); }

    Status joinContinued() {
        words_ = reader_.words();
        while (reader_.words().back() == "\\") {
            if (!reader_.appendNext())
                return error("the file ends after a line that announces another one (\\); export it again");
        }
        words_.clear();
        for (const auto word : reader_.words())
            if (word != "\\")
                words_.push_back(word);
        return {};
    }

    Status readVertex() {
        const std::size_t count = words_.size() - 1;
        if (count != 3 && count != 4 && count != 6)
            return error("a vertex (v) has " + std::to_string(count) +
                         " values; it takes x y z, or x y z and red green blue");
        std::array<double, 6> values{};
        std::string why;
        for (std::size_t i = 0; i < count; ++i) {
            const auto value = parseNumber(words_[i + 1], why);
            if (!value)
                return error(why);
            values[i] = *value;
        }
        if (count == 4 && values[3] != 1)
            return error("a weighted vertex (w = " + quotedWord(words_[4]) +
                         ") is not read; export without weights");
        if (!mesh_.positions.empty() && (count == 6) != !mesh_.colours.empty())
            return error("some vertices have colours and others have none; export all of them alike");
        mesh_.positions.push_back({values[0], values[1], values[2]});
        if (count == 6) {
            glm::u8vec3 colour;
            for (int i = 0; i < 3; ++i) {
                const double channel = values[static_cast<std::size_t>(3 + i)];
                if (channel < 0 || channel > 1)
                    return error("the colour value " + quotedWord(words_[static_cast<std::size_t>(4 + i)]) +
                                 " is outside of 0 .. 1; scale the colours");
                colour[i] = static_cast<std::uint8_t>(std::lround(channel * 255));
            }
            mesh_.colours.push_back(colour);
        }
        return {};
    }

    Status readTextureVertex() {
        const std::size_t count = words_.size() - 1;
        if (count < 1 || count > 3)
            return error("a texture coordinate (vt) has " + std::to_string(count) +
                         " values; it takes u, u v or u v w");
        glm::vec2 uv(0);
        std::string why;
        for (std::size_t i = 0; i < count; ++i) {
            const auto value = parseNumber(words_[i + 1], why);
            if (!value)
                return error(why);
            if (i < 2)
                uv[int(i)] = float(*value);
        }
        textureVertices_.push_back(uv);
        return {};
    }

    /// A face's texture corner, 0 where it names none. As addCorner.
    Status addTextureCorner(std::int64_t index) {
        if (index < 0) {
            index += std::int64_t(textureVertices_.size()) + 1;
            if (index < 1)
                return error("a face counts back before the first texture coordinate; export the mesh again");
        }
        if (std::size_t(index) > highestTexture_) {
            highestTexture_ = std::size_t(index);
            highestTextureLine_ = firstLine_;
        }
        textureCorners_.push_back(std::uint32_t(index));
        return {};
    }

    /// Texture coordinates, if all corners of all faces have them.
    Status giveUvs() {
        if (highestTexture_ > textureVertices_.size())
            return source_.atLine(highestTextureLine_,
                                  "a face names texture coordinate " + std::to_string(highestTexture_) +
                                      ", but the file has " + std::to_string(textureVertices_.size()) +
                                      "; export the mesh again");
        if (textureVertices_.empty() || bareCorner_)
            return {};
        for (const glm::uvec3& face : textureFaces_)
            for (int i = 0; i < 3; ++i)
                mesh_.uvs.push_back(textureVertices_[face[i] - 1]);
        return {};
    }

    Status readFace() {
        if (words_.size() < 4)
            return error("a face (f) has " + std::to_string(words_.size() - 1) +
                         " corners; it takes three or more, the file may be cut off here");
        corners_.clear();
        textureCorners_.clear();
        std::string why;
        for (std::size_t i = 1; i < words_.size(); ++i) {
            std::string_view rest = words_[i];
            for (int part = 0; part < 3;
                 ++part) { // vertex, vertex/texture, vertex//normal, vertex/texture/normal
                const std::size_t slash = rest.find('/');
                const std::string_view index = rest.substr(0, slash);
                if (part == 0 || !index.empty()) {
                    const auto value = parseInteger(index, -kMaxCount, kMaxCount, why);
                    if (!value)
                        return error(why);
                    if (*value == 0)
                        return error("a face has the index 0 in " + quotedWord(words_[i]) +
                                     "; OBJ counts from 1, export the mesh again");
                    if (part == 0)
                        SEROSA_TRY(addCorner(*value));
                    if (part == 1)
                        SEROSA_TRY(addTextureCorner(*value));
                }
                if (slash == std::string_view::npos)
                    break;
                if (part == 2)
                    return error("the corner " + quotedWord(words_[i]) +
                                 " has too many slashes; write vertex/texture/normal");
                rest.remove_prefix(slash + 1);
            }
        }
        appendFan(corners_, mesh_.faces);
        bareCorner_ = bareCorner_ || textureCorners_.size() != corners_.size();
        if (!bareCorner_)
            appendFan(textureCorners_, textureFaces_);
        return {};
    }

    /// Negative indices count back from the last vertex; positive ones may name a vertex that comes later.
    Status addCorner(std::int64_t index) {
        if (index < 0) {
            index += static_cast<std::int64_t>(mesh_.positions.size()) + 1;
            if (index < 1)
                return error("a face counts back before the first vertex (" +
                             std::to_string(mesh_.positions.size()) +
                             " vertices up to here); export the mesh again");
        }
        const auto corner = static_cast<std::size_t>(index);
        if (corner > highestCorner_) {
            highestCorner_ = corner;
            highestLine_ = firstLine_;
        }
        corners_.push_back(static_cast<std::uint32_t>(corner - 1));
        return {};
    }

    const MeshSource& source_;
    LineReader reader_;
    TriangleMesh mesh_;
    std::vector<std::string_view> words_;
    std::vector<std::uint32_t> corners_, textureCorners_; // of the face being read; texture: counted from 1
    std::vector<glm::vec2> textureVertices_;
    std::vector<glm::uvec3> textureFaces_; // as mesh_.faces, while every corner names a texture coordinate
    bool bareCorner_ = false;
    std::size_t highestTexture_ = 0, highestTextureLine_ = 0;
    std::size_t firstLine_ = 0;
    std::size_t highestCorner_ = 0, highestLine_ = 0;
};

} // namespace

Result<TriangleMesh> readObj(const MeshSource& source) {
    return ObjReader(source).read();
}

} // namespace serosa::sim::detail
