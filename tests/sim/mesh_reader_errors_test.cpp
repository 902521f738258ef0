// Bad files, one by one: each is refused in one line that names the file, the line or byte, what is wrong,
// and what to do.
#include "sim/mesh_reader.h"
#include "sim/mesh_reader_detail.h"
#include "tests/sim/mesh_files.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <limits>

namespace serosa::sim {
namespace {

class MeshReaderErrors : public MeshFiles {
protected:
    /// `where` follows the path at once: ":3: " or ": byte 84: ". The hint stands behind the last semicolon.
    void expectRefused(const std::filesystem::path& path, const std::string& where, const std::string& what) {
        const auto mesh = readMesh(path);
        ASSERT_FALSE(mesh.ok()) << path << " was read; expected: " << what;
        const std::string& message = mesh.error().message;
        EXPECT_EQ(mesh.error().exitCode, exitBadInput);
        EXPECT_EQ(message.find(path.string() + where), 0u) << message << "\nlacks " << where;
        EXPECT_NE(message.find(what), std::string::npos) << message << "\nlacks " << what;
        EXPECT_NE(message.find(';'), std::string::npos) << "no hint: " << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
    void refuse(const std::string& name, const std::string& bytes, const std::string& where,
                const std::string& what) {
        expectRefused(file(name, bytes), where, what);
    }
    static std::string replaced(std::string text, const std::string& from, const std::string& to) {
        const std::size_t at = text.find(from);
        EXPECT_NE(at, std::string::npos) << from;
        return text.replace(at, from.size(), to);
    }
    /// Every proper beginning of the file is refused.
    template <class Read>
    void refuseTruncations(const std::string& bytes, const Read& read) {
        for (std::size_t size = 0; size < bytes.size(); ++size) {
            const auto mesh = read(detail::MeshSource{"cut", std::string_view(bytes).substr(0, size)});
            ASSERT_FALSE(mesh.ok()) << "cut to " << size << " of " << bytes.size() << " bytes, it was read";
            EXPECT_EQ(mesh.error().message.find("cut:"), 0u) << mesh.error().message;
        }
    }
};

TEST_F(MeshReaderErrors, FilesThatCannotBeRead) {
    expectRefused(folder_ / "no_such.obj", ": ", "no such file");
    expectRefused(folder_ / "no_such_folder" / "a.obj", ": ", "no such file");
    expectRefused(folder_, ": ", "is a folder");
    refuse("empty.stl", "", ": ", "empty (0 bytes)");
    ASSERT_EQ(::mkfifo((folder_ / "pipe.obj").c_str(), 0600), 0);
    expectRefused(folder_ / "pipe.obj", ": ", "not a regular file");
    file("huge.obj", "v");
    std::error_code noRoom;
    std::filesystem::resize_file(folder_ / "huge.obj", std::uintmax_t(9) << 30, noRoom); // a hole, no bytes
    if (!noRoom)
        expectRefused(folder_ / "huge.obj", ": ", "larger than 8 GiB");
    file("plain", "x");
    expectRefused(folder_ / "plain" / "a.obj", ": ", "check the path");
}

TEST_F(MeshReaderErrors, WrongMagicOrExtension) {
    refuse("a.ply", "plx\nformat ascii 1.0\n",
           ": byte 0: ", "wrong magic: a PLY file starts with ply, this one with 'plx'");
    refuse("a.off", "4 4 6\n0 0 0\n", ": byte 0: ", "wrong magic: an OFF file starts with OFF");
    refuse("a.stl", "something else\n", ": byte 0: ", "wrong magic: a text STL starts with solid");
    refuse("a.obj", kPlyText, ": byte 0: ", "the content is PLY, the name says OBJ; rename");
    refuse("a.off", kStlText, ": byte 0: ", "the content is STL, the name says OFF");
    refuse("a.mesh", kObj, ": byte 0: ", "tell the format");
    refuse("a.obj", "\xef\xbb\xbf" + kObj, ": byte 0: ", "byte order mark");
    refuse("a.obj", "\x1f\x8b\x08 gzip", ":1: ", "unknown keyword '...'");
}

TEST_F(MeshReaderErrors, TruncatedFiles) {
    refuseTruncations(kPlyText.substr(0, kPlyText.size() - 1), detail::readPly); // all but the last line end
    refuseTruncations(plyBinary(true), detail::readPly);
    refuseTruncations(plyBinary(false), detail::readPly);
    refuseTruncations(plyBinaryWithExtras(true), detail::readPly);
    const std::string extras = plyBinaryWithExtras(true);
    refuse("a.ply", extras.substr(0, extras.size() - 1), ": byte " + std::to_string(extras.size() - 8) + ": ",
           "face 3: the list uv announces 1 values, 0 at most are left");
    refuseTruncations(kOff.substr(0, kOff.size() - 1), detail::readOff);
    refuseTruncations(stlBinary(), detail::readStl);
    refuseTruncations(kStlText.substr(0, kStlText.rfind("endsolid") + 8), detail::readStl);
    // OBJ announces nothing: a cut within a face, or before a vertex that a face names.
    refuse("a.obj", kObj.substr(0, kObj.size() - 3), ":8: ", "has 2 corners");
    refuse("a.obj", "f 1 2 4\nv 0 0 0\nv 1 0 0\nv 0 1 0\n",
           ":1: ", "a face names vertex 4, but the file has 3");
    refuse("a.obj", kObj.substr(0, 21), ":3: ", "has 2 values");
    refuse("a.obj", "v 0 0 0 \\", ":1: ", "announces another one");

    refuse("a.stl", stlBinary().substr(0, 200),
           ": byte 80: ", "announces 4 triangles (284 bytes), the file has 200 bytes");
    refuse("a.stl", stlBinary().substr(0, 83), ": byte 83: ", "within the 84 bytes");
    refuse("b.ply", plyBinary(true).substr(0, plyBinary(true).size() - 1),
           ":9: ", "but 51 bytes are left for them");
    refuse("a.ply", replaced(kPlyText, "3 1 2 3\n", "# a comment as long\n"),
           ":17: ", "after 3 of 4 face rows");
    refuse("a.off", replaced(kOff, "3 1 2 3\n", "# a comment as long\n"), ":10: ", "after 3 of 4 faces");
    refuse("b.stl", kStlText.substr(0, kStlText.find("endloop")), ":6: ", "where endloop should come");
}

TEST_F(MeshReaderErrors, CoordinatesThatAreNoFiniteNumbers) {
    for (const std::string bad : {"nan", "inf", "-inf", "NaN", "Infinity"}) {
        refuse("a.obj", replaced(kObj, "v 0 1 0", "v 0 " + bad + " 0"),
               ":3: ", "'" + bad + "' is not a finite number");
        refuse("a.off", replaced(kOff, "0 1 0", "0 1 " + bad), ":5: ", "is not a finite number");
        refuse("a.ply", replaced(kPlyText, "0 1 0", bad + " 1 0"), ":12: ", "is not a finite number");
        refuse("a.stl", replaced(kStlText, "vertex 1 0 0", "vertex 1 " + bad + " 0"),
               ":6: ", "is not a finite number");
    }
    for (const std::string bad : {"1e400", "-1e99999999999999999999"})
        refuse("a.obj", replaced(kObj, "v 0 1 0", "v 0 " + bad + " 0"),
               ":3: ", "outside of what a 64-bit number holds");
    for (const std::string bad : {"1.0.0", "0x10", "--1", "+-1", "one", "1e", "1f", "+"})
        refuse("a.obj", replaced(kObj, "v 0 1 0", "v 0 " + bad + " 0"), ":3: ", "is not a number");
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::infinity()}) {
        const char* what = bad < 0 ? "infinite" : "not a number";
        std::string value;
        append(value, std::bit_cast<std::uint32_t>(bad), 4, true);
        std::string stl = stlBinary();
        stl.replace(84 + 50 + 12 + 12 + 4, 4, value); // triangle 1, corner 1, y
        refuse("b.stl", stl, ": byte 162: ", "triangle 1 has a coordinate that is " + std::string(what));
        std::string ply = plyBinary(true);
        const std::size_t body = ply.find("end_header\n") + 11;
        ply.replace(body + 12 + 8, 4, value); // vertex 1, z
        refuse("b.ply", ply, ": byte " + std::to_string(body + 20) + ": ",
               "vertex 1 has a coordinate that is " + std::string(what));
    }
}

TEST_F(MeshReaderErrors, TextureCoordinates) {
    const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    refuse("a.obj", vertices + "vt 0 nan\nf 1/1 2/1 3/1\n", ":4: ", "nan");
    refuse("b.obj", vertices + "vt 0 inf\nf 1/1 2/1 3/1\n", ":4: ", "inf");
    refuse("c.obj", vertices + "vt\nf 1/1 2/1 3/1\n", ":4: ", "has 0 values");
    refuse("d.obj", vertices + "vt 0 0\nf 1/1 2/2 3/1\n", ":5: ", "texture coordinate 2, but the file has 1");
    refuse("e.obj", vertices + "vt 0 0\nf 1/1 2/-2 3/1\n", ":5: ", "before the first texture coordinate");
    refuse("a.ply",
           "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
           "property float u\nproperty float v\nelement face 1\nproperty list uchar int "
           "vertex_index\nend_header\n"
           "0 0 0 0 0\n1 0 0 nan 0\n0 1 0 0 0\n3 0 1 2\n",
           ":13: ", "nan");
}

TEST_F(MeshReaderErrors, DecimalCommas) {
    const std::string hint = "write decimal points (1.5, not 1,5)";
    refuse("a.obj", replaced(kObj, "v 0 1 0", "v 0 1,5 0"), ":3: '1,5' has a comma", hint);
    refuse("a.off", replaced(kOff, "0 1 0", "0 1,5 0"), ":5: ", hint);
    refuse("a.ply", replaced(kPlyText, "0 1 0", "0 1,5 0"), ":12: ", hint);
    refuse("a.stl", replaced(kStlText, "vertex 1 0 0", "vertex 1,5 0 0"), ":6: ", hint);
}

TEST_F(MeshReaderErrors, IndicesOutOfRange) {
    refuse("a.obj", replaced(kObj, "f 1 4 3", "f 1 5 3"),
           ":7: ", "a face names vertex 5, but the file has 4");
    refuse("a.obj", replaced(kObj, "f 1 4 3", "f 1 0 3"), ":7: ", "OBJ counts from 1");
    refuse("a.obj", replaced(kObj, "f 1 4 3", "f 1 -5 3"),
           ":7: ", "counts back before the first vertex (4 vertices");
    refuse("a.obj", replaced(kObj, "f 1 4 3", "f 1 4.0 3"), ":7: ", "'4.0' is not a whole number");
    refuse("a.obj", replaced(kObj, "f 1 4 3", "f 1 4/0 3"), ":7: ", "OBJ counts from 1");
    refuse("a.obj", replaced(kObj, "f 1 4 3", "f 1 4/1/1/1 3"), ":7: ", "too many slashes");
    refuse("a.obj", replaced(kObj, "f 1 4 3", "f 1 /4 3"), ":7: ", "is not a whole number");
    refuse("a.obj", replaced(kObj, "f 1 4 3", "f 1 99999999999999999999 3"), ":7: ", "outside of");
    refuse("a.off", replaced(kOff, "3 0 3 2", "3 0 4 2"),
           ":9: ", "face 2 names vertex 4, but they are counted from 0 to 3");
    refuse("a.off", replaced(kOff, "3 0 3 2", "3 0 -1 2"), ":9: ", "names vertex -1");
    refuse("a.ply", replaced(kPlyText, "3 0 3 2", "3 0 4 2"), ":16: ", "face 2 names vertex 4");
    refuse("a.ply", replaced(kPlyText, "3 0 3 2", "3 0 -1 2"), ":16: ", "names vertex -1");
    for (const bool little : {true, false}) {
        std::string ply = plyBinary(little);
        const std::size_t corner = ply.size() - 4;
        std::string value;
        append(value, 0x80000000u, 4, little);
        refuse("b.ply", ply.replace(corner, 4, value), ": byte " + std::to_string(corner) + ": ",
               "face 3 names vertex -2147483648");
    }
}

TEST_F(MeshReaderErrors, NoFacesOrNoVertices) {
    refuse("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", ":3: ", "no faces");
    refuse("a.obj", "# nothing\n", ":1: ", "no vertices");
    refuse("a.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n", ":2: ", "no faces");
    refuse("a.off", "OFF\n0 1 0\n3 0 1 2\n", ":2: ", "no vertices");
    refuse("a.ply", replaced(kPlyText, "element face 4", "element face 0"), ":9: ", "no faces");
    refuse("a.ply", replaced(kPlyText, "element vertex 4", "element vertex 0"), ":9: ", "no vertices");
    refuse("a.ply", replaced(kPlyText, "element face 4", "element tristrips 4"), ":9: ", "triangle strips");
    refuse("a.stl", "solid a\nendsolid a\n", ":2: ", "no facets");
    refuse("a.stl", std::string(84, '\0'), ": byte 80: ", "no triangles");
}

TEST_F(MeshReaderErrors, FacesOfFewerThanThreeCorners) {
    refuse("a.obj", replaced(kObj, "f 1 4 3", "f 1 4"), ":7: ", "has 2 corners");
    refuse("a.obj", replaced(kObj, "f 1 4 3", "f"), ":7: ", "has 0 corners");
    refuse("a.off", replaced(kOff, "3 0 3 2", "2 0 3 1"), ":9: ", "face 2 has 2 corners");
    refuse("a.off", replaced(kOff, "3 0 3 2", "5 0 3 2"), ":9: ", "announces 5 corners, but has 3");
    refuse("a.ply", replaced(kPlyText, "3 0 3 2", "2 0 3 1"), ":16: ", "face 2 has 2 corners");
    refuse("a.ply", replaced(kPlyText, "3 0 3 2", "9 0 3 2"),
           ":16: ", "announces 9 values, 3 at most are left");
    refuse("a.ply", replaced(kPlyText, "3 0 3 2", "-1 0 3 2"), ":16: ", "'-1' is outside of 0 .. 255");
    refuse("a.stl", replaced(kStlText, "vertex 0 1 0\n", ""), ":6: ", "expected vertex X Y Z");
    refuse("a.stl", replaced(kStlText, "endloop", "vertex 3 3 3\nendloop"), ":7: ", "a facet is a triangle");
}

// Nothing is reserved for a count before it is compared with the file's size: these return at once, in little
// memory.
TEST_F(MeshReaderErrors, HeadersThatClaimBillions) {
    const auto start = std::chrono::steady_clock::now();
    refuse("a.off", replaced(kOff, "4 4 6", "4000000000 4 6"), ":2: ", "announces 4000000000 vertices");
    refuse("a.off", replaced(kOff, "4 4 6", "4 4000000000 6"), ":2: ", "more than the");
    refuse("a.off", replaced(kOff, "4 4 6", "4 99999999999999 6"), ":2: ", "outside of");
    refuse("a.off", replaced(kOff, "4 4 6", "-4 4 6"), ":2: ", "outside of");
    for (const std::string& ply : {kPlyText, plyBinary(true), plyBinary(false)}) {
        refuse("a.ply", replaced(ply, "vertex 4", "vertex 4000000000"),
               ":9: ", "announces 4000000000 vertex rows");
        refuse("a.ply", replaced(ply, "face 4", "face 4000000000"), ":9: ", "announces 4000000000 face rows");
        refuse("a.ply", replaced(ply, "vertex 4", "vertex 18446744073709551615"), ":3: ", "outside of");
        refuse("a.ply", replaced(ply, "element face", "element ghost 4000000000\nelement face"),
               ":10: ", "rows but no properties");
    }
    std::string list = replaced(plyBinary(true), "list uchar int", "list uint int");
    const std::size_t body = list.find("end_header\n") + 11 + 4 * 12;
    list += std::string(16, '\0');
    list.insert(body, "\xff\xff\xff"); // the first face's length is 0x03ffffff
    refuse("a.ply", list, ": byte " + std::to_string(body) + ": ", "announces 67108863 values");
    std::string stl = stlBinary();
    stl.replace(80, 4, "\xff\xff\xff\xff");
    refuse("a.stl", stl, ": byte 80: ", "announces 4294967295 triangles");
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
}

TEST_F(MeshReaderErrors, TrailingData) {
    refuse("a.obj", kObj + "the end\n", ":9: ", "unknown keyword 'the'");
    refuse("a.off", kOff + "3 0 1 2\n", ":11: ", "after the last of 4 faces");
    refuse("a.ply", kPlyText + "3 0 1 2\n", ":18: ", "after the last row");
    refuse("b.ply", plyBinary(true) + "x", ": byte " + std::to_string(plyBinary(true).size()) + ": ",
           "after the last row");
    refuse("a.stl", kStlText + "more\n", ":31: ", "expected solid, found 'more'");
    refuse("b.stl", stlBinary() + "x", ": byte 80: ", "remove what follows");
    refuse("a.obj", replaced(kObj, "v 0 1 0", "v 0 1 0 0 0 0 0 0"), ":3: ", "has 8 values");
    refuse("a.off", replaced(kOff, "0 1 0", "0 1 0 0"), ":5: ", "vertex 2 has 4 values, not 3");
    refuse("a.off", replaced(kOff, "3 0 3 2", "3 0 3 2 1 1 1 1 1"), ":9: ", "text after its colour");
    refuse("a.off", replaced(kOff, "3 0 3 2", "3 0 3 2 red"), ":9: ", "'red' is not a number");
    refuse("a.ply", replaced(kPlyText, "0 1 0", "0 1 0 0"),
           ":12: ", "vertex 2 has 4 values where 3 are announced");
    refuse("a.ply", replaced(kPlyText, "0 1 0", "0 1  "), ":12: ", "vertex 2 has only 2 values");
}

TEST_F(MeshReaderErrors, ObjThatIsNotASurface) {
    refuse("a.obj", "cstype bezier\n" + kObj, ":1: ", "free-form");
    refuse("a.obj", replaced(kObj, "v 0 1 0", "v 0 1 0 0.5"), ":3: ", "weighted");
    refuse("a.obj", replaced(kObj, "v 0 1 0", "v 0 1 0 1 1 1"), ":3: ", "some vertices have colours");
    refuse("a.obj", "v 0 0 0 1 2 1\n", ":1: ", "outside of 0 .. 1");
    refuse("a.obj", std::string("v 0 0 0\n\x01\x02 binary waste that goes on and on\n"), ":2: ", "'..'");
}

TEST_F(MeshReaderErrors, OffHeaders) {
    refuse("a.off", "OFF\n", ":1: ", "before the counts");
    refuse("a.off", "OFF BINARY\n1 1 1\n", ":1: ", "binary OFF");
    refuse("a.off", "OFF\n4 4\n", ":2: ", "three counts");
    refuse("a.off", "OFF\n4 x 6\n", ":2: ", "'x' is not a whole number");
    refuse("a.off", "COFF\n3 1 0\n0 0 0 256 0 0\n1 0 0 0 0 0\n0 1 0 0 0 0\n3 0 1 2\n",
           ":3: ", "a colour is outside");
    refuse("a.off", "COFF\n3 1 0\n0 0 0\n1 0 0 0 0 0\n0 1 0 0 0 0\n3 0 1 2\n",
           ":3: ", "has 3 values, not 6 or 7");
}

TEST_F(MeshReaderErrors, PlyHeaders) {
    const auto header = [&](const std::string& from, const std::string& to, const std::string& where,
                            const std::string& what) {
        refuse("a.ply", replaced(kPlyText, from, to), where, what);
    };
    header("ply\n", "ply really\n", ":1: ", "expected ply alone");
    header("ascii 1.0", "ascii 2.0", ":2: ", "expected format");
    header("ascii 1.0", "latin 1.0", ":2: ", "unknown format 'latin'");
    header("format ascii 1.0\n", "", ":2: ", "unexpected 'element'");
    header("format ascii 1.0\n", "format ascii 1.0\nformat ascii 1.0\n", ":3: ", "unexpected 'format'");
    header("format ascii 1.0\n", "format ascii 1.0\nproperty float x\n", ":3: ", "unexpected 'property'");
    header("element vertex 4", "element vertex", ":3: ", "element NAME COUNT");
    header("element vertex 4", "element vertex four", ":3: ", "'four' is not a whole number");
    header("element face 4", "element vertex 4", ":7: ", "a second element 'vertex'");
    header("property float y", "property float x", ":5: ", "a second property 'x'");
    header("property float y", "property real y", ":5: ", "unknown type 'real'");
    header("property float y", "property float", ":5: ", "expected property");
    header("property float y", "property float w", ":9: ", "no property y");
    header("property float y", "property list uchar float y", ":9: ", "no property y");
    header("list uchar int", "list float int", ":8: ", "a list's length");
    header("list uchar int", "list uchar float", ":9: ", "no list vertex_indices of whole numbers");
    header("vertex_indices", "corners", ":9: ", "no list vertex_indices");
    header("end_header\n", "", ":9: ", "unexpected '0'");
    refuse("a.ply", "ply\nend_header\n", ":2: ", "no format");
    refuse("a.ply", "ply\nformat ascii 1.0\nelement vertex 4\n", ":3: ", "no end_header");
}

TEST_F(MeshReaderErrors, StlText) {
    refuse("a.stl", replaced(kStlText, "facet normal", "facet"), ":2: ", "expected facet normal X Y Z");
    refuse("a.stl", replaced(kStlText, "outer loop", "loop"), ":3: ", "expected outer loop");
    refuse("a.stl", replaced(kStlText, "endfacet", "facet"), ":8: ", "expected endfacet");
    refuse("a.stl", replaced(kStlText, "vertex 0 0 0", "vertex 0 0"), ":4: ", "expected vertex X Y Z");
    refuse("a.stl", replaced(kStlText, "vertex 0 0 0", "vertex 0 0 z"), ":4: ", "'z' is not a number");
}

} // namespace
} // namespace serosa::sim
