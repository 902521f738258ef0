// Snapshots of the solvers on the CPU; files with any byte flipped, cut off anywhere, or of another scene.
#include "sim/byte_stream.h"
#include "sim/cpu_solver.h"
#include "tests/sim/implicit_bodies.h"
#include "tests/sim/snapshot_bodies.h"

#include <filesystem>
#include <fstream>
#include <limits>

using namespace serosa;
using sim::Lattice;
using sim::OrganSnapshot;
using sim::Snapshot;

namespace {

namespace fs = std::filesystem;

/// Small, with everything that the format has: cuts, layers, impulses, two organs, one of doubles and with
/// earlier increments.
Snapshot smallSnapshot(const Lattice& lattice) {
    sim::SolverSetup setup = test::handledBall(lattice);
    const auto solver = sim::makeReferenceSolver(setup);
    Snapshot snapshot;
    snapshot.program = "1.2.3";
    snapshot.machine = "a machine";
    snapshot.frame = 30;
    snapshot.frameRate = 60;
    for (const char* name : {"left", "right"}) {
        OrganSnapshot organ;
        organ.name = name;
        organ.traits = {{"young", "5000 Pa"}, {"poisson", "0.25"}};
        organ.lastCut = 1;
        organ.cutMask = std::string("mask\0of ", 8) + name;
        sim::CutList cuts;
        EXPECT_TRUE(cuts.cut(*solver, 0, test::fullCut(lattice, 0.3)).ok());
        sim::takeSnapshot(*solver, organ);
        organ.cuts = cuts.entries();
        snapshot.organs.push_back(organ);
        solver->advance(3);
    }
    snapshot.threads = {{0.005, 1.5, 2.5, false, 0, 0.25, 0.125}, {-1, 0, 0, true, 0.75, 0, 0}};
    auto& earlier = snapshot.organs.back().state.earlier;
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        earlier.emplace_back(0.125 * double(node), -0.5, 0.25, node % 2);
    return snapshot;
}

void expectEqual(const Snapshot& a, const Snapshot& b) {
    EXPECT_EQ(a.program, b.program);
    EXPECT_EQ(a.machine, b.machine);
    EXPECT_EQ(a.frame, b.frame);
    EXPECT_EQ(a.frameRate, b.frameRate);
    ASSERT_EQ(a.threads.size(), b.threads.size());
    for (std::size_t i = 0; i < a.threads.size(); ++i) {
        const sim::ThreadState &x = a.threads[i], &y = b.threads[i];
        EXPECT_EQ(x.broken, y.broken);
        for (const double sim::ThreadState::*value :
             {&sim::ThreadState::startLength, &sim::ThreadState::force, &sim::ThreadState::mostForce,
              &sim::ThreadState::brokenAfter, &sim::ThreadState::impulse, &sim::ThreadState::work})
            EXPECT_EQ(x.*value, y.*value);
    }
    ASSERT_EQ(a.organs.size(), b.organs.size());
    for (std::size_t i = 0; i < a.organs.size(); ++i) {
        const OrganSnapshot &x = a.organs[i], &y = b.organs[i];
        EXPECT_EQ(x.name, y.name);
        EXPECT_EQ(x.solver, y.solver);
        EXPECT_EQ(x.traits, y.traits);
        EXPECT_EQ(x.state.step, y.state.step);
        EXPECT_EQ(x.state.positions, y.state.positions);
        EXPECT_EQ(x.state.increments, y.state.increments);
        EXPECT_EQ(x.state.normals, y.state.normals);
        EXPECT_EQ(x.state.heldBy, y.state.heldBy);
        EXPECT_EQ(x.state.connections, y.state.connections);
        EXPECT_EQ(x.state.earlier, y.state.earlier);
        EXPECT_EQ(x.layers, y.layers);
        EXPECT_EQ(x.impulses, y.impulses);
        EXPECT_EQ(x.lastCut, y.lastCut);
        EXPECT_EQ(x.cutMask, y.cutMask);
        ASSERT_EQ(x.cuts.size(), y.cuts.size());
        for (std::size_t c = 0; c < x.cuts.size(); ++c) {
            EXPECT_EQ(x.cuts[c].step, y.cuts[c].step);
            EXPECT_EQ(x.cuts[c].stroke.from, y.cuts[c].stroke.from);
            EXPECT_EQ(x.cuts[c].stroke.to, y.cuts[c].stroke.to);
            EXPECT_EQ(x.cuts[c].stroke.kind, y.cuts[c].stroke.kind);
        }
    }
}

/// The error of bytes that must be refused: one line that begins with the file's name.
std::string refused(std::string_view bytes) {
    const auto read = sim::parseSnapshot(bytes, "file");
    if (read)
        return "was accepted";
    const std::string& text = read.error().message;
    EXPECT_EQ(text.rfind("file: ", 0), 0u) << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    return text;
}

/// The same bytes with a checksum that fits: what only the checks behind it can refuse.
std::string sealed(std::string bytes) {
    const sim::Checksum checksum = sim::checksumOf(std::string_view(bytes).substr(0, bytes.size() - 16));
    sim::ByteWriter trailer;
    trailer.u64(checksum.low);
    trailer.u64(checksum.high);
    return bytes.replace(bytes.size() - 16, 16, trailer.bytes());
}

} // namespace

TEST(Snapshot, referenceGivesTheSameBytesAfterARestore) {
    test::expectSameBytesAfterARestore(sim::makeReferenceSolver);
}

TEST(Snapshot, referenceWithTheVolumetricTermToo) {
    test::expectSameBytesAfterARestore(sim::makeReferenceSolver, 0.45);
}

TEST(Snapshot, cpuGivesTheSameBytesAfterARestore) {
    test::expectSameBytesAfterARestore(
        [](const sim::SolverSetup& setup) { return sim::makeCpuSolver(setup); });
}

// The increments before the last are a part of where implicit steps go on.
TEST(Snapshot, implicitStepsGoOnWithTheSameBytes) {
    const Lattice lattice = test::capsuleLattice(8);
    const sim::SolverSetup setup = test::capsuleSetup(lattice);
    for (const bool exact : {true, false}) {
        const auto made = [&] { return exact ? sim::makeReferenceSolver(setup) : sim::makeCpuSolver(setup); };
        const auto whole = made(), rest = made();
        whole->setState(sim::startState(setup));
        whole->advance(6);
        Snapshot taken;
        taken.frameRate = 60;
        taken.organs.resize(1);
        taken.organs[0].traits = sim::setupTraits(setup);
        sim::takeSnapshot(*whole, taken.organs[0]);
        const auto read = sim::parseSnapshot(sim::snapshotBytes(taken), "file");
        ASSERT_TRUE(read) << read.error().message;
        ASSERT_TRUE(
            sim::checkSnapshot(read->organs[0], "", rest->name(), sim::setupTraits(setup), lattice).ok());
        rest->advance(2); // what it did before must not matter
        ASSERT_TRUE(sim::restoreSnapshot(read->organs[0], *rest).ok());
        whole->advance(5);
        rest->advance(5);
        EXPECT_EQ(whole->state().hash(), rest->state().hash());
        EXPECT_EQ(whole->state().positions, rest->state().positions); // of the reference all 64 bits
        // An organ of explicit steps is another.
        sim::SolverSetup other = setup;
        other.method = sim::StepMethod::explicitSteps;
        const Status refused =
            sim::checkSnapshot(read->organs[0], "", rest->name(), sim::setupTraits(other), lattice);
        ASSERT_FALSE(refused.ok());
        EXPECT_NE(refused.error().message.find("method is implicit in the snapshot, explicit here"),
                  std::string::npos);
    }
}

TEST(Snapshot, fileKeepsEverything) {
    const Lattice lattice = test::blockLattice(2, 2, 2);
    const Snapshot snapshot = smallSnapshot(lattice);
    ASSERT_GT(snapshot.organs[0].layers.size(), 0u);
    ASSERT_EQ(snapshot.organs[1].impulses.size(), 2u);
    const std::string bytes = sim::snapshotBytes(snapshot);
    EXPECT_EQ(bytes, sim::snapshotBytes(snapshot));
    const auto read = sim::parseSnapshot(bytes, "file");
    ASSERT_TRUE(read) << read.error().message;
    expectEqual(snapshot, *read);
    EXPECT_EQ(sim::snapshotBytes(*read), bytes);

    const fs::path file = fs::path(::testing::TempDir()) / "serosa-snapshot-test.serosa";
    ASSERT_TRUE(sim::writeSnapshot(snapshot, file).ok());
    const auto again = sim::readSnapshot(file);
    fs::remove(file);
    ASSERT_TRUE(again) << again.error().message;
    expectEqual(snapshot, *again);
}

TEST(Snapshot, fileIsAsTheDocumentSays) {
    // docs/snapshots.md by hand: a snapshot without organs, and the first bytes of one with.
    Snapshot snapshot;
    snapshot.program = "0.1";
    snapshot.machine = "m";
    snapshot.frame = 258;
    snapshot.frameRate = 60;
    std::string bytes = sim::snapshotBytes(snapshot);
    const char expected[] = "\x89SRS\r\n\x1a\n"
                            "\x04\0\0\0"
                            "\x48\0\0\0\0\0\0\0"
                            "\x03\0\0\0"
                            "0.1"
                            "\x01\0\0\0m"
                            "\x02\x01\0\0\0\0\0\0"
                            "\0\0\0\0\0\0\x4e\x40"
                            "\0\0\0\0"
                            "\0\0\0\0";
    EXPECT_EQ(bytes.size(), 0x48u);
    EXPECT_EQ(bytes.substr(0, bytes.size() - 16), std::string(expected, sizeof expected - 1));
}

TEST(Snapshot, singlePrecisionIsStoredAsSuchAndDoubleIsNotRounded) {
    const Lattice lattice = test::blockLattice(2, 2, 2);
    Snapshot snapshot = smallSnapshot(lattice);
    const std::size_t asDouble = sim::snapshotBytes(snapshot).size();
    for (auto* list : {&snapshot.organs[1].state.positions, &snapshot.organs[1].state.increments})
        for (glm::dvec3& v : *list)
            v = glm::dvec3(glm::vec3(v));
    EXPECT_EQ(asDouble - sim::snapshotBytes(snapshot).size(), 27u * (3 + 3 + 4) * 4);
    snapshot.organs[1].state.earlier[5].y = 0.1; // of one kind, all of them are
    EXPECT_EQ(sim::snapshotBytes(snapshot).size(), asDouble);
    snapshot.organs[1].state.positions[5].y = std::numeric_limits<double>::denorm_min();
    const auto read = sim::parseSnapshot(sim::snapshotBytes(snapshot), "file");
    ASSERT_TRUE(read);
    expectEqual(snapshot, *read);
}

TEST(Snapshot, everyFlippedByteIsAnError) {
    const std::string bytes = sim::snapshotBytes(smallSnapshot(test::blockLattice(2, 2, 2)));
    for (std::size_t at = 0; at < bytes.size(); ++at)
        for (const int flip : {1, 0x80, 0xff}) {
            std::string damaged = bytes;
            damaged[at] = char(damaged[at] ^ flip);
            const std::string error = refused(damaged);
            EXPECT_NE(error.find(at < 8    ? "is not a snapshot"
                                 : at < 12 ? "is damaged"
                                 : at < 20 ? "byte " + std::to_string(bytes.size())
                                           : "is damaged: its checksum"),
                      std::string::npos)
                << "byte " << at << ": " << error;
        }
}

TEST(Snapshot, everyLengthIsAnError) {
    const std::string bytes = sim::snapshotBytes(smallSnapshot(test::blockLattice(2, 2, 2)));
    EXPECT_NE(refused("").find("is empty"), std::string::npos);
    for (std::size_t length = 1; length < bytes.size(); ++length) {
        const std::string error = refused(std::string_view(bytes).substr(0, length));
        EXPECT_NE(error.find("is cut off: it ends at byte " + std::to_string(length)), std::string::npos)
            << error;
    }
    EXPECT_NE(refused(bytes + "x").find("bytes after its end"), std::string::npos);
}

TEST(Snapshot, valuesBehindAFittingChecksumAreNotBelieved) {
    // Whoever makes such a file gets an error or a snapshot of finite size, never a crash: every byte, and
    // every word as the largest count.
    const Lattice lattice = test::blockLattice(2, 2, 2);
    const std::string bytes = sim::snapshotBytes(smallSnapshot(lattice));
    std::size_t refusals = 0;
    for (std::size_t at = 20; at + 16 < bytes.size(); ++at)
        for (const std::string& put :
             {std::string(1, '\xff'), std::string(4, '\xff'), std::string(8, '\x7f'), std::string(8, '\0')}) {
            if (at + put.size() + 16 > bytes.size())
                continue;
            std::string damaged = bytes;
            damaged.replace(at, put.size(), put);
            const auto read = sim::parseSnapshot(sealed(damaged), "file");
            refusals += !read;
            if (!read)
                continue;
            for (const OrganSnapshot& organ : read->organs) {
                const Status fits = sim::checkSnapshot(organ, organ.name, "reference", organ.traits, lattice);
                if (!fits.ok())
                    continue;
                sim::SolverSetup setup = test::plainSetup(lattice);
                const auto solver = sim::makeReferenceSolver(setup);
                EXPECT_TRUE(sim::restoreSnapshot(organ, *solver).ok());
            }
        }
    EXPECT_GT(refusals, 300u);
    // Cut off at every place, and sealed anew.
    for (std::size_t length = 36; length < bytes.size(); ++length) {
        std::string damaged = bytes.substr(0, length);
        sim::ByteWriter size;
        size.u64(length);
        damaged.replace(12, 8, size.bytes());
        EXPECT_NE(refused(sealed(damaged)), "was accepted") << length;
    }
}

TEST(Snapshot, theFormatBeforeIsRead) {
    const Lattice lattice = test::blockLattice(2, 2, 2);
    Snapshot snapshot = smallSnapshot(lattice);
    snapshot.threads.clear(); // version 2 had none, and no count of them,
    for (OrganSnapshot& organ : snapshot.organs)
        organ.cutMask.clear(); // nor masks
    const auto withoutThreads = [&] {
        std::string bytes = sim::snapshotBytes(snapshot).erase(sim::snapshotBytes(snapshot).size() - 28, 12);
        bytes[12] = char(bytes.size() & 0xff);
        bytes[13] = char(bytes.size() >> 8 & 0xff);
        bytes[14] = char(bytes.size() >> 16 & 0xff);
        return bytes;
    };
    std::string newer = withoutThreads();
    snapshot.organs.back().state.earlier.clear(); // which it did not have either
    std::string bytes = withoutThreads();
    bytes[8] = newer[8] = 2;
    const auto read = sim::parseSnapshot(sealed(bytes), "file");
    ASSERT_TRUE(read) << read.error().message;
    expectEqual(snapshot, *read);
    EXPECT_NE(refused(sealed(newer)).find("no snapshot has such a value here"), std::string::npos);
}

TEST(Snapshot, otherFormatIsNamed) {
    std::string bytes = sim::snapshotBytes(smallSnapshot(test::blockLattice(2, 2, 2)));
    bytes[8] = 1;
    EXPECT_NE(refused(sealed(bytes)).find("is a snapshot of format 1, and this program reads 2 to 4"),
              std::string::npos);
    EXPECT_NE(refused(bytes).find("is damaged"), std::string::npos) << "a flipped bit is no other version";
    EXPECT_NE(refused("ply\nformat ascii 1.0\n").find("is not a snapshot"), std::string::npos);
}

TEST(Snapshot, filesThatAreNone) {
    const fs::path folder = ::testing::TempDir();
    const auto error = [](const fs::path& file) {
        const auto read = sim::readSnapshot(file);
        return read ? "was accepted" : read.error().message;
    };
    EXPECT_NE(error(folder / "no-such.serosa").find("no such file"), std::string::npos);
    EXPECT_NE(error(folder).find("is not a regular file"), std::string::npos);
    EXPECT_NE(error("/dev/zero").find("is not a regular file"), std::string::npos);
    const fs::path text = folder / "serosa-snapshot-text.serosa";
    std::ofstream(text) << "schema = 1\n";
    EXPECT_NE(error(text).find("is not a snapshot"), std::string::npos);
    fs::remove(text);
}

TEST(Snapshot, anotherSceneIsRefusedWithWhatDiffers) {
    const Lattice lattice = test::hollowBall(5);
    const sim::SolverSetup setup = test::handledBall(lattice);
    const auto solver = sim::makeReferenceSolver(setup);
    OrganSnapshot organ;
    organ.name = "ball";
    organ.traits = sim::setupTraits(setup);
    sim::takeSnapshot(*solver, organ);
    const auto says = [&organ](const std::string& name, const std::string& solverName,
                               const sim::SolverSetup& other) {
        const Status fits =
            sim::checkSnapshot(organ, name, solverName, sim::setupTraits(other), *other.lattice);
        return fits.ok() ? "fits" : fits.error().message;
    };
    EXPECT_EQ(says("ball", "reference", setup), "fits");
    EXPECT_EQ(says("ball", "", setup), "fits");
    EXPECT_EQ(says("liver", "reference", setup),
              "belongs to another scene: the organ is \"ball\" in the snapshot, \"liver\" here");
    EXPECT_EQ(
        says("ball", "fragment", setup),
        "belongs to another solver: ball was stepped by reference, here by fragment: the bytes would not "
        "be those of a run that never stopped");

    struct Change {
        const char* says;
        std::function<void(sim::SolverSetup&)> make;
    };
    const Lattice moved = sim::latticeFromCells(lattice.cells, lattice.spacing, {0.05, 1.2, -0.31});
    const Lattice finer = sim::latticeFromCells(lattice.cells, 0.0029, lattice.origin);
    const Lattice larger = test::hollowBall(7);
    std::vector<sim::LatticeCell> cells = lattice.cells;
    cells[3].fill ^= 1;
    const Lattice fuller = sim::latticeFromCells(cells, lattice.spacing, lattice.origin);
    const Change changes[] = {
        {"young is 5000 Pa in the snapshot, 4000 Pa here", [](auto& s) { s.tissue.young = 4000; }},
        {"poisson is 0.25 in the snapshot, 0.3 here", [](auto& s) { s.tissue.poisson = 0.3; }},
        {"density is 1000 kg/m3", [](auto& s) { s.tissue.density = 1001; }},
        {"damping_time is 0.0005 s", [](auto& s) { s.tissue.dampingTime = 0; }},
        {"air_drag is 0 1/s in the snapshot, 1e-09 1/s", [](auto& s) { s.tissue.airDrag = 1e-9; }},
        {"recovery is false in the snapshot, true here", [](auto& s) { s.tissue.recovery = true; }},
        {"gravity is 0 -9.81 0 m/s2", [](auto& s) { s.gravity.x = 1; }},
        {"time step is ", [](auto& s) { s.timeStep = std::nextafter(s.timeStep, 1); }},
        {"fixed nodes is ", [](auto& s) { s.fixed[0] = !s.fixed[0]; }},
        {"fixed nodes is ", [](auto& s) { s.fixed.clear(); }},
        {"tools is 2 in the snapshot, 1 here", [](auto& s) { s.tools.pop_back(); }},
        {"tool 2 mode is grasp", [](auto& s) { s.tools[1].mode = sim::ToolMode::push; }},
        {"tool 1 radius is ", [](auto& s) { s.tools[0].radius *= 2; }},
        {"tool 1 name is probe", [](auto& s) { s.tools[0].name = "finger"; }},
        {"tool 1 keys is 2 (", [](auto& s) { s.tools[0].keys[1].at.z += 1e-9; }},
        {"lattice origin is ", [&moved](auto& s) { s.lattice = &moved; }},
        {"lattice spacing is 0.003 m in the snapshot, 0.0029 m here",
         [&finer](auto& s) { s.lattice = &finer; }},
        {"nodes is ", [&larger](auto& s) { s.lattice = &larger; }},
        {"cells is ", [&fuller](auto& s) { s.lattice = &fuller; }},
    };
    for (const Change& change : changes) {
        sim::SolverSetup other = setup;
        change.make(other);
        EXPECT_EQ(says("ball", "reference", other).rfind("belongs to another scene: ball: ", 0), 0u)
            << change.says;
        EXPECT_NE(says("ball", "reference", other).find(change.says), std::string::npos)
            << change.says << " / " << says("ball", "reference", other);
    }
}
