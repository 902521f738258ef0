// TetGen surfaces: nodes in FILE.node, triangles over them in FILE.face, both text with '#' comments. Indices
// count from 0 or 1, as the first node says. Attributes, boundary markers and the tetrahedra on either side
// of a face (written by -nn) are checked to be numbers and passed over. Nodes that no face uses stay: they
// are the inner ones of a tetrahedral mesh.
#include "sim/mesh_reader_detail.h"

namespace serosa::sim::detail {
namespace {

/// Lines of one of the two files, with its header's counts.
class TetgenLines {
public:
    explicit TetgenLines(const MeshSource& source) : source_(source), reader_(source) {}

    Error error(const std::string& text) const { return source_.atLine(reader_.line(), text); }
    const std::vector<std::string_view>& words() const { return reader_.words(); }
    bool next() { return reader_.nextWithWords(); }
    std::size_t bytesLeft() const { return reader_.bytesLeft(); }

    Result<std::size_t> integer(std::size_t word, std::int64_t lowest, std::int64_t highest) const {
        std::string why;
        const auto value = parseInteger(words()[word], lowest, highest, why);
        if (!value)
            return error(why);
        return static_cast<std::size_t>(*value);
    }
    Result<double> number(std::size_t word) const {
        std::string why;
        const auto value = parseNumber(words()[word], why);
        if (!value)
            return error(why);
        return *value;
    }
    /// The words from `first` on are whole numbers of any sign.
    Status integersFrom(std::size_t first) const {
        std::string why;
        for (std::size_t word = first; word < words().size(); ++word)
            if (!parseInteger(words()[word], INT64_MIN, INT64_MAX, why))
                return error(why);
        return {};
    }

private:
    const MeshSource& source_;
    LineReader reader_;
};

std::string beyond(std::size_t count, const char* what, std::size_t bytes) {
    return "the header announces " + std::to_string(count) + " " + what + ", more than the " +
           std::to_string(bytes) +
           " bytes that follow can hold; the file is cut off or its header wrong, export it again";
}

struct Nodes {
    std::vector<glm::dvec3> positions;
    std::size_t base = 0; // index of the first
};

Result<Nodes> readNodes(const MeshSource& source) {
    TetgenLines lines(source);
    if (!lines.next())
        return lines.error("no header; export the mesh again");
    if (lines.words().size() != 4)
        return lines.error("the header has " + std::to_string(lines.words().size()) +
                           " values, not four (nodes, dimension 3, attributes, markers); export the mesh "
                           "again");
    SEROSA_ASSIGN(const std::size_t count, lines.integer(0, 0, kMaxCount));
    SEROSA_TRY(lines.integer(1, 3, 3));
    SEROSA_ASSIGN(const std::size_t attributes, lines.integer(2, 0, 1000));
    SEROSA_ASSIGN(const std::size_t markers, lines.integer(3, 0, 1));
    if (count == 0)
        return lines.error("the header announces no nodes; export the mesh again");
    if (count * (8 + 2 * (attributes + markers)) > lines.bytesLeft() + 1) // "0 0 0 0\n"
        return lines.error(beyond(count, "nodes", lines.bytesLeft()));
    Nodes nodes;
    nodes.positions.reserve(count);
    const std::size_t columns = 4 + attributes + markers;
    for (std::size_t i = 0; i < count; ++i) {
        if (!lines.next())
            return lines.error("the file ends after " + std::to_string(i) + " of " + std::to_string(count) +
                               " nodes; it is cut off, export it again");
        if (lines.words().size() != columns)
            return lines.error("node " + std::to_string(i) + " has " + std::to_string(lines.words().size()) +
                               " values, not " + std::to_string(columns) + "; export the mesh again");
        SEROSA_ASSIGN(const std::size_t index, lines.integer(0, 0, kMaxCount));
        if (i == 0 && index <= 1)
            nodes.base = index;
        if (index != nodes.base + i)
            return lines.error("node index " + std::to_string(index) + " where " +
                               std::to_string(nodes.base + i) +
                               " should come; they are counted from 0 or 1 without gaps, export the mesh "
                               "again");
        glm::dvec3 position;
        for (int axis = 0; axis < 3; ++axis) {
            SEROSA_ASSIGN(position[axis], lines.number(std::size_t(axis) + 1));
        }
        nodes.positions.push_back(position);
        for (std::size_t word = 4; word < 4 + attributes; ++word)
            SEROSA_TRY(lines.number(word));
        SEROSA_TRY(lines.integersFrom(4 + attributes));
    }
    if (lines.next())
        return lines.error("text after the last of " + std::to_string(count) +
                           " nodes; correct the count in the header or remove the rest");
    return nodes;
}

} // namespace

Result<TriangleMesh> readTetgen(const MeshSource& nodeSource, const MeshSource& faceSource) {
    SEROSA_ASSIGN(Nodes nodes, readNodes(nodeSource));
    TetgenLines lines(faceSource);
    if (!lines.next())
        return lines.error("no header; export the mesh again");
    if (lines.words().size() != 2)
        return lines.error("the header has " + std::to_string(lines.words().size()) +
                           " values, not two (faces, markers); export the mesh again");
    SEROSA_ASSIGN(const std::size_t count, lines.integer(0, 0, kMaxCount));
    SEROSA_ASSIGN(const std::size_t markers, lines.integer(1, 0, 1));
    if (count == 0)
        return lines.error("the header announces no faces; write the surface with tetgen -f");
    if (count * (8 + 2 * markers) > lines.bytesLeft() + 1)
        return lines.error(beyond(count, "faces", lines.bytesLeft()));
    TriangleMesh mesh;
    mesh.positions = std::move(nodes.positions);
    mesh.faces.reserve(count);
    const std::size_t columns = 4 + markers, last = nodes.base + mesh.positions.size() - 1;
    std::size_t base = 0;
    for (std::size_t i = 0; i < count; ++i) {
        if (!lines.next())
            return lines.error("the file ends after " + std::to_string(i) + " of " + std::to_string(count) +
                               " faces; it is cut off, export it again");
        if (lines.words().size() != columns && lines.words().size() != columns + 2)
            return lines.error("face " + std::to_string(i) + " has " + std::to_string(lines.words().size()) +
                               " values, not " + std::to_string(columns) +
                               "; faces of second order are not read, export the mesh again");
        SEROSA_ASSIGN(const std::size_t index, lines.integer(0, 0, kMaxCount));
        if (i == 0 && index <= 1)
            base = index;
        if (index != base + i)
            return lines.error("face index " + std::to_string(index) + " where " + std::to_string(base + i) +
                               " should come; they are counted from 0 or 1 without gaps, export the mesh "
                               "again");
        glm::uvec3 face;
        for (int corner = 0; corner < 3; ++corner) {
            SEROSA_ASSIGN(const std::size_t node, lines.integer(std::size_t(corner) + 1, 0, kMaxCount));
            if (node < nodes.base || node > last)
                return lines.error("face " + std::to_string(i) + " names node " + std::to_string(node) +
                                   ", but they are counted from " + std::to_string(nodes.base) + " to " +
                                   std::to_string(last) + "; export both files again");
            face[corner] = static_cast<std::uint32_t>(node - nodes.base);
        }
        SEROSA_TRY(lines.integersFrom(4));
        mesh.faces.push_back(face);
    }
    if (lines.next())
        return lines.error("text after the last of " + std::to_string(count) +
                           " faces; correct the count in the header or remove the rest");
    return mesh;
}

} // namespace serosa::sim::detail
