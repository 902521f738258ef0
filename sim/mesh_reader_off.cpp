// Geomview OFF, text: one vertex a line, one face a line. The magic's prefixes say what stands behind x y z:
// N a normal, C a colour, ST a texture coordinate. Face colours are passed over.
#include "sim/mesh_reader_detail.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace serosa::sim::detail {
namespace {

class OffReader {
public:
    explicit OffReader(const MeshSource& source) : source_(source), reader_(source) {}

    Result<TriangleMesh> read() {
        SEROSA_TRY(readHeader());
        mesh_.positions.reserve(vertices_);
        for (std::size_t i = 0; i < vertices_; ++i)
            SEROSA_TRY(readVertex(i));
        mesh_.faces.reserve(faces_);
        for (std::size_t i = 0; i < faces_; ++i)
            SEROSA_TRY(readFace(i));
        if (reader_.nextWithWords())
            return error("text after the last of " + std::to_string(faces_) +
                         " faces; correct the counts in the header or remove the rest");
        return std::move(mesh_);
    }

private:
    Error error(const std::string& text) const { return source_.atLine(reader_.line(), text); }

    Status readHeader() {
        std::string why;
        if (!reader_.nextWithWords())
            return error("no header; export the mesh again");
        std::string_view magic = reader_.words()[0];
        if (magic.starts_with("ST")) {
            textured_ = true;
            magic.remove_prefix(2);
        }
        coloured_ = magic.starts_with('C');
        if (coloured_)
            magic.remove_prefix(1);
        normals_ = magic.starts_with('N');
        std::vector<std::string_view> counts(reader_.words().begin() + 1, reader_.words().end());
        if (!counts.empty() && counts[0] == "BINARY")
            return error("binary OFF is not read; export text OFF, or PLY");
        if (counts.empty()) {
            if (!reader_.nextWithWords())
                return error("the file ends before the counts of vertices, faces and edges; export it again");
            counts = reader_.words();
        }
        if (counts.size() != 3)
            return error("expected three counts (vertices faces edges), found " +
                         std::to_string(counts.size()) + " words; export the mesh again");
        std::array<std::size_t, 3> values{};
        for (std::size_t i = 0; i < 3; ++i) {
            const auto value = parseInteger(counts[i], 0, kMaxCount, why);
            if (!value)
                return error(why);
            values[i] = static_cast<std::size_t>(*value);
        }
        vertices_ = values[0];
        faces_ = values[1];
        if (vertices_ == 0)
            return error("the header announces no vertices; export the mesh again");
        if (faces_ == 0)
            return error("the header announces no faces; export a surface, not points");
        // The shortest vertex line is "0 0 0\n", the shortest face line "3 0 1 2\n"; the last may lack its
        // end.
        if (vertices_ * 6 + faces_ * 8 > reader_.bytesLeft() + 1)
            return error(
                "the header announces " + std::to_string(vertices_) + " vertices and " +
                std::to_string(faces_) + " faces, more than the " + std::to_string(reader_.bytesLeft()) +
                " bytes that follow can hold; the file is cut off or its header wrong, export it again");
        return {};
    }

    Status readVertex(std::size_t index) {
        if (!reader_.nextWithWords())
            return error("the file ends after " + std::to_string(index) + " of " + std::to_string(vertices_) +
                         " vertices; it is cut off, export it again");
        const auto& words = reader_.words();
        const std::size_t beforeColour = normals_ ? 6 : 3;
        const std::size_t others = beforeColour + (textured_ ? 2 : 0);
        const std::size_t least = others + (coloured_ ? 3 : 0), most = others + (coloured_ ? 4 : 0);
        if (words.size() < least || words.size() > most)
            return error("vertex " + std::to_string(index) + " has " + std::to_string(words.size()) +
                         " values, not " + std::to_string(least) +
                         (most > least ? " or " + std::to_string(most) : "") +
                         "; one vertex stands on each line, export the mesh again");
        std::string why;
        std::array<double, 12> values{};
        for (std::size_t i = 0; i < words.size(); ++i) {
            const auto value = parseNumber(words[i], why);
            if (!value)
                return error(why);
            values[i] = *value;
        }
        mesh_.positions.push_back({values[0], values[1], values[2]});
        return coloured_ ? readColour(values.data() + beforeColour, beforeColour) : Status();
    }

    /// Whole numbers are 0 .. 255, numbers with a point 0 .. 1.
    Status readColour(const double* channels, std::size_t firstWord) {
        bool whole = true;
        for (std::size_t i = 0; i < 3; ++i)
            whole = whole && reader_.words()[firstWord + i].find_first_of(".eE") == std::string_view::npos;
        glm::u8vec3 colour;
        for (int i = 0; i < 3; ++i) {
            if (channels[i] < 0 || channels[i] > (whole ? 255 : 1))
                return error("a colour is outside of 0 .. 255 (whole numbers) or 0 .. 1; scale the colours");
            colour[i] = static_cast<std::uint8_t>(std::lround(whole ? channels[i] : channels[i] * 255));
        }
        mesh_.colours.push_back(colour);
        return {};
    }

    Status readFace(std::size_t index) {
        if (!reader_.nextWithWords())
            return error("the file ends after " + std::to_string(index) + " of " + std::to_string(faces_) +
                         " faces; it is cut off, export it again");
        const auto& words = reader_.words();
        std::string why;
        const auto count = parseInteger(words[0], 0, kMaxCount, why);
        if (!count)
            return error(why);
        if (*count < 3)
            return error("face " + std::to_string(index) + " has " + std::to_string(*count) +
                         " corners; remove points and lines, a face has three or more");
        const auto corners = static_cast<std::size_t>(*count);
        if (words.size() < corners + 1)
            return error("face " + std::to_string(index) + " announces " + std::to_string(corners) +
                         " corners, but has " + std::to_string(words.size() - 1) +
                         "; the file may be cut off here, export it again");
        if (words.size() > corners + 5)
            return error("face " + std::to_string(index) +
                         " has text after its colour; export the mesh again");
        corners_.clear();
        for (std::size_t i = 1; i <= corners; ++i) {
            const auto corner = parseInteger(words[i], -kMaxCount, kMaxCount, why);
            if (!corner)
                return error(why);
            if (*corner < 0 || static_cast<std::size_t>(*corner) >= vertices_)
                return error("face " + std::to_string(index) + " names vertex " + std::to_string(*corner) +
                             ", but they are counted from 0 to " + std::to_string(vertices_ - 1) +
                             "; export the mesh again");
            corners_.push_back(static_cast<std::uint32_t>(*corner));
        }
        for (std::size_t i = corners + 1; i < words.size(); ++i)
            if (!parseNumber(words[i], why))
                return error(why);
        appendFan(corners_, mesh_.faces);
        return {};
    }

    const MeshSource& source_;
    LineReader reader_;
    TriangleMesh mesh_;
    bool normals_ = false, coloured_ = false, textured_ = false;
    std::size_t vertices_ = 0, faces_ = 0;
    std::vector<std::uint32_t> corners_;
};

} // namespace

Result<TriangleMesh> readOff(const MeshSource& source) {
    return OffReader(source).read();
}

} // namespace serosa::sim::detail
