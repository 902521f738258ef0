// Reads a PLY header line by line and assigns the roles of its properties.
#include "sim/mesh_reader_ply.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <optional>

namespace serosa::sim::detail {
namespace {

std::optional<PlyType> typeOf(std::string_view word) {
    struct Name {
        std::string_view old, sized;
        PlyType type;
    };
    static constexpr std::array<Name, 8> kNames{{{"char", "int8", PlyType::int8},
                                                 {"uchar", "uint8", PlyType::uint8},
                                                 {"short", "int16", PlyType::int16},
                                                 {"ushort", "uint16", PlyType::uint16},
                                                 {"int", "int32", PlyType::int32},
                                                 {"uint", "uint32", PlyType::uint32},
                                                 {"float", "float32", PlyType::float32},
                                                 {"double", "float64", PlyType::float64}}};
    for (const auto& name : kNames)
        if (word == name.old || word == name.sized)
            return name.type;
    return {};
}

bool isFloating(PlyType type) {
    return type == PlyType::float32 || type == PlyType::float64;
}

class HeaderReader {
public:
    explicit HeaderReader(const MeshSource& source) : source_(source), reader_(source) {}

    Result<PlyHeader> read() {
        reader_.next(); // the magic, seen by readMesh
        if (reader_.words().size() != 1)
            return error("expected ply alone on the first line; export the mesh again");
        bool formatSeen = false;
        while (true) {
            if (!reader_.nextWithWords())
                return error(
                    "the file ends within the header (no end_header); it is cut off, export it again");
            const auto& words = reader_.words();
            if (words[0] == "end_header" && words.size() == 1)
                break;
            if (words[0] == "comment" || words[0] == "obj_info")
                continue;
            if (words[0] == "format" && !formatSeen) {
                SEROSA_TRY(readFormat());
                formatSeen = true;
            } else if (words[0] == "element" && formatSeen) {
                SEROSA_TRY(readElement());
            } else if (words[0] == "property" && !header_.elements.empty()) {
                SEROSA_TRY(readProperty(header_.elements.back()));
            } else {
                return error("unexpected " + quotedWord(words[0]) +
                             " in the header (format, element, property, comment, end_header, in this "
                             "order); export the mesh again");
            }
        }
        if (!formatSeen)
            return error("the header has no format line; export the mesh again");
        header_.bodyOffset = reader_.offset();
        header_.bodyLine = reader_.line() + 1;
        SEROSA_TRY(assignRoles());
        SEROSA_TRY(compareWithSize());
        return std::move(header_);
    }

private:
    Error error(const std::string& text) const { return source_.atLine(reader_.line(), text); }

    Status readFormat() {
        const auto& words = reader_.words();
        if (words.size() != 3 || words[2] != "1.0")
            return error(
                "expected format ascii|binary_little_endian|binary_big_endian 1.0; export the mesh again");
        if (words[1] == "ascii")
            header_.encoding = PlyEncoding::text;
        else if (words[1] == "binary_little_endian")
            header_.encoding = PlyEncoding::littleEndian;
        else if (words[1] == "binary_big_endian")
            header_.encoding = PlyEncoding::bigEndian;
        else
            return error("unknown format " + quotedWord(words[1]) +
                         "; use ascii, binary_little_endian or binary_big_endian");
        return {};
    }

    Status readElement() {
        const auto& words = reader_.words();
        if (words.size() != 3)
            return error("expected element NAME COUNT; export the mesh again");
        std::string why;
        const auto count = parseInteger(words[2], 0, kMaxCount, why);
        if (!count)
            return error(why);
        for (const auto& element : header_.elements)
            if (element.name == words[1])
                return error("a second element " + quotedWord(words[1]) + "; export the mesh again");
        header_.elements.push_back({std::string(words[1]), static_cast<std::size_t>(*count), {}});
        return {};
    }

    Status readProperty(PlyElement& element) {
        const auto& words = reader_.words();
        PlyProperty property;
        property.isList = words.size() > 1 && words[1] == "list";
        if (words.size() != (property.isList ? 5u : 3u))
            return error(
                "expected property TYPE NAME or property list TYPE TYPE NAME; export the mesh again");
        const auto type = typeOf(words[words.size() - 2]);
        if (!type)
            return error("unknown type " + quotedWord(words[words.size() - 2]) +
                         "; use float, double, int, uchar and the like");
        property.type = *type;
        property.name = words.back();
        if (property.isList) {
            const auto lengthType = typeOf(words[2]);
            if (!lengthType || isFloating(*lengthType))
                return error("a list's length has the type " + quotedWord(words[2]) +
                             "; it takes a whole one such as uchar");
            property.lengthType = *lengthType;
        }
        for (const auto& other : element.properties)
            if (other.name == property.name)
                return error("a second property " + quotedWord(property.name) + " of " + element.name +
                             "; export the mesh again");
        element.properties.push_back(property);
        return {};
    }

    PlyElement* find(std::string_view name) {
        for (auto& element : header_.elements)
            if (element.name == name)
                return &element;
        return nullptr;
    }

    Status assignRoles() {
        PlyElement *vertices = find("vertex"), *faces = find("face");
        if (!vertices || vertices->count == 0)
            return error("the header announces no vertices; export the mesh again");
        if (!faces || faces->count == 0)
            return error(find("tristrips") ? "triangle strips are not read; export triangles"
                                           : "the header announces no faces; export a surface, not points");
        header_.vertexElement = static_cast<std::size_t>(vertices - header_.elements.data());
        for (const auto& [name, role] :
             {std::pair{"x", PlyRole::x}, std::pair{"y", PlyRole::y}, std::pair{"z", PlyRole::z}}) {
            PlyProperty* property = findProperty(*vertices, name);
            if (!property || property->isList)
                return error(std::string("the vertices have no property ") + name +
                             "; export the mesh again");
            property->role = role;
        }
        std::array<PlyProperty*, 3> channels{findProperty(*vertices, "red"), findProperty(*vertices, "green"),
                                             findProperty(*vertices, "blue")};
        header_.coloured = std::all_of(channels.begin(), channels.end(), [](const PlyProperty* channel) {
            return channel && !channel->isList && channel->type == PlyType::uint8;
        });
        if (header_.coloured)
            for (std::size_t i = 0; i < 3; ++i)
                channels[i]->role = static_cast<PlyRole>(static_cast<std::size_t>(PlyRole::red) + i);
        for (const auto& [u, v] :
             {std::pair{"u", "v"}, std::pair{"s", "t"}, std::pair{"texture_u", "texture_v"}}) {
            PlyProperty *first = findProperty(*vertices, u), *second = findProperty(*vertices, v);
            if (header_.textured || !first || !second || first->isList || second->isList)
                continue;
            header_.textured = true;
            first->role = PlyRole::u;
            second->role = PlyRole::v;
        }
        PlyProperty* corners = findProperty(*faces, "vertex_indices");
        if (!corners)
            corners = findProperty(*faces, "vertex_index");
        if (!corners || !corners->isList || isFloating(corners->type))
            return error("the faces have no list vertex_indices of whole numbers; export the mesh again");
        corners->role = PlyRole::corners;
        return {};
    }

    static PlyProperty* findProperty(PlyElement& element, std::string_view name) {
        for (auto& property : element.properties)
            if (property.name == name)
                return &property;
        return nullptr;
    }

    /// A count that the rest of the file cannot hold is refused here, before anything is reserved for it.
    Status compareWithSize() const {
        const bool text = header_.encoding == PlyEncoding::text;
        std::size_t left =
            source_.bytes.size() - header_.bodyOffset + (text ? 1 : 0); // the last line end may be missing
        for (const auto& element : header_.elements) {
            std::size_t rowBytes = 0; // at least
            for (const auto& property : element.properties) {
                if (text)
                    rowBytes += 2; // a digit and a blank or line end
                else
                    rowBytes += plySize(property.isList ? property.lengthType : property.type);
                if (property.role == PlyRole::corners)
                    rowBytes += text ? 6 : 3 * plySize(property.type);
            }
            if (rowBytes == 0 && element.count > 0)
                return error("the element " + quotedWord(element.name) +
                             " has rows but no properties; remove it");
            if (element.count > 0 && element.count > left / rowBytes)
                return error(
                    "the header announces " + std::to_string(element.count) + " " + element.name +
                    " rows of at least " + std::to_string(rowBytes) + " bytes, but " + std::to_string(left) +
                    " bytes are left for them; the file is cut off or its header wrong, export it again");
            left -= element.count * rowBytes;
        }
        return {};
    }

    const MeshSource& source_;
    LineReader reader_;
    PlyHeader header_;
};

} // namespace

std::size_t plySize(PlyType type) {
    static constexpr std::array<std::size_t, 8> kSizes{1, 1, 2, 2, 4, 4, 4, 8};
    return kSizes[static_cast<std::size_t>(type)];
}

std::pair<std::int64_t, std::int64_t> plyRange(PlyType type) {
    static constexpr std::array<std::pair<std::int64_t, std::int64_t>, 6> kRanges{
        {{-128, 127},
         {0, 255},
         {-32768, 32767},
         {0, 65535},
         {-2147483648ll, 2147483647ll},
         {0, 4294967295ll}}};
    SEROSA_CHECK(!isFloating(type), "floating types have no range of whole numbers");
    return kRanges[static_cast<std::size_t>(type)];
}

double plyValue(PlyType type, std::uint64_t bits) {
    switch (type) {
    case PlyType::int8:
        return static_cast<std::int8_t>(bits);
    case PlyType::uint8:
        return static_cast<std::uint8_t>(bits);
    case PlyType::int16:
        return static_cast<std::int16_t>(bits);
    case PlyType::uint16:
        return static_cast<std::uint16_t>(bits);
    case PlyType::int32:
        return static_cast<std::int32_t>(bits);
    case PlyType::uint32:
        return static_cast<std::uint32_t>(bits);
    case PlyType::float32:
        return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
    case PlyType::float64:
        break;
    }
    return std::bit_cast<double>(bits);
}

Result<PlyHeader> readPlyHeader(const MeshSource& source) {
    return HeaderReader(source).read();
}

} // namespace serosa::sim::detail
