// The bytes of a snapshot: docs/snapshots.md has the same as tables. Magic, version, length and the checksum
// at the end are for good; what lies between belongs to the version. Nothing of it is looked at before the
// checksum fits, and even then no count is believed that the bytes left could not fill.
#include "base/atomic_file.h"
#include "base/check.h"
#include "sim/byte_stream.h"
#include "sim/snapshot.h"

#include <algorithm>
#include <bit>
#include <fstream>
#include <iterator>

namespace serosa::sim {

namespace {

// As PNG's: not text, and damaged by whatever changes line ends.
constexpr std::string_view kMagic("\x89SRS\r\n\x1a\n", 8);
constexpr std::uint32_t kVersion = 4, kOldestVersion = 2;
// What a state has beside what every one has. Version 2 knew the first alone; version 3 had no masks.
constexpr std::uint8_t kHasConnections = 1, kHasEarlier = 2;
constexpr std::size_t kHeaderBytes = 20;   // magic, version, length of the file
constexpr std::size_t kChecksumBytes = 16; // of all bytes before it
constexpr std::size_t kStrokeBytes = 8 + 1 + 1 + 14 * 8;
constexpr std::size_t kLeastOrganBytes = 58;
constexpr std::size_t kThreadBytes = 6 * 8 + 1;

bool isFloat32(double value) {
    return std::bit_cast<std::uint64_t>(double(float(value))) == std::bit_cast<std::uint64_t>(value);
}

template <int N>
using Vectors = std::vector<glm::vec<N, double>>;

template <int N>
bool isFloat32(const std::vector<glm::vec<N, double>>& vectors) {
    for (const glm::vec<N, double>& v : vectors)
        for (int axis = 0; axis < N; ++axis)
            if (!isFloat32(v[axis]))
                return false;
    return true;
}

template <int N>
void writeVectors(ByteWriter& out, const std::vector<glm::vec<N, double>>& vectors, bool single) {
    for (const glm::vec<N, double>& v : vectors)
        for (int axis = 0; axis < N; ++axis)
            single ? out.f32(float(v[axis])) : out.f64(v[axis]);
}

void writeWords(ByteWriter& out, const std::vector<std::uint32_t>& words) {
    for (const std::uint32_t word : words)
        out.u32(word);
}

void writeState(ByteWriter& out, const LatticeState& state) {
    const std::size_t nodes = state.positions.size();
    SEROSA_CHECK(state.increments.size() == nodes && state.normals.size() == nodes &&
                     state.heldBy.size() == nodes &&
                     (state.connections.empty() || state.connections.size() == nodes) &&
                     (state.earlier.empty() || state.earlier.size() == nodes),
                 "a value of each kind for every node");
    const bool single = isFloat32(state.positions) && isFloat32(state.increments) && isFloat32(state.earlier);
    out.u64(nodes);
    out.u8(single ? 4 : 8);
    out.u8(std::uint8_t((state.connections.empty() ? 0 : kHasConnections) |
                        (state.earlier.empty() ? 0 : kHasEarlier)));
    out.i64(state.step);
    writeVectors(out, state.positions, single);
    writeVectors(out, state.increments, single);
    writeWords(out, state.normals);
    writeWords(out, state.heldBy);
    writeWords(out, state.connections);
    writeVectors(out, state.earlier, single);
}

void writeOrgan(ByteWriter& out, const OrganSnapshot& organ) {
    out.text(organ.name);
    out.text(organ.solver);
    out.u32(std::uint32_t(organ.traits.size()));
    for (const Trait& trait : organ.traits) {
        out.text(trait.name);
        out.text(trait.value);
    }
    writeState(out, organ.state);
    out.u32(std::uint32_t(organ.cuts.size()));
    for (const CutList::Entry& entry : organ.cuts) {
        out.i64(entry.step);
        out.u8(std::uint8_t(entry.stroke.kind));
        out.u8(entry.stroke.continues ? 1 : 0);
        for (const auto& ends : {entry.stroke.from, entry.stroke.to})
            writeVectors(out, Vectors<3>{ends[0], ends[1]}, false);
        out.f64(entry.stroke.radius);
        out.f64(entry.stroke.strain);
    }
    out.u32(std::uint32_t(organ.layers.size()));
    for (const CutLayer& layer : organ.layers) {
        out.u64(layer.size());
        for (const ClearedBits& cleared : layer) {
            out.u32(cleared.node);
            out.u32(cleared.bits);
        }
    }
    out.u32(std::uint32_t(organ.impulses.size()));
    writeVectors(out, organ.impulses, false);
    out.u64(organ.lastCut);
    out.u32(organ.level);
    out.text(organ.levelState);
}

template <int N>
Vectors<N> readVectors(ByteReader& in, std::size_t count, bool single) {
    Vectors<N> vectors(count);
    for (glm::vec<N, double>& v : vectors)
        for (int axis = 0; axis < N; ++axis)
            v[axis] = single ? double(in.f32()) : in.f64();
    return vectors;
}

std::vector<std::uint32_t> readWords(ByteReader& in, std::size_t count) {
    std::vector<std::uint32_t> words(count);
    for (std::uint32_t& word : words)
        word = in.u32();
    return words;
}

/// False: a value that no writer writes.
bool readState(ByteReader& in, std::uint32_t version, LatticeState& state) {
    const std::uint64_t wanted = in.u64();
    const std::uint8_t size = in.u8(), has = in.u8();
    if ((size != 4 && size != 8) || has > (version == 2 ? kHasConnections : kHasConnections + kHasEarlier))
        return false;
    const bool cut = has & kHasConnections, earlier = has & kHasEarlier;
    state.step = in.i64();
    const std::size_t nodes = in.count(wanted, (earlier ? 10 : 6) * std::size_t(size) + (cut ? 12 : 8));
    state.positions = readVectors<3>(in, nodes, size == 4);
    state.increments = readVectors<3>(in, nodes, size == 4);
    state.normals = readWords(in, nodes);
    state.heldBy = readWords(in, nodes);
    state.connections = readWords(in, cut ? nodes : 0);
    state.earlier = readVectors<4>(in, earlier ? nodes : 0, size == 4);
    return true;
}

bool readCuts(ByteReader& in, std::vector<CutList::Entry>& cuts) {
    cuts.resize(in.count(in.u32(), kStrokeBytes));
    for (CutList::Entry& entry : cuts) {
        entry.step = in.i64();
        const std::uint8_t kind = in.u8(), continues = in.u8();
        if (kind > std::uint8_t(StrokeKind::tear) || continues > 1)
            return false;
        entry.stroke.kind = StrokeKind(kind);
        entry.stroke.continues = continues == 1;
        for (auto* ends : {&entry.stroke.from, &entry.stroke.to}) {
            const Vectors<3> two = readVectors<3>(in, 2, false);
            *ends = {two[0], two[1]};
        }
        entry.stroke.radius = in.f64();
        entry.stroke.strain = in.f64();
    }
    return true;
}

bool readLayers(ByteReader& in, std::vector<CutLayer>& layers) {
    layers.resize(in.count(in.u32(), 8));
    for (CutLayer& layer : layers) {
        layer.resize(in.count(in.u64(), 8));
        for (std::size_t i = 0; i < layer.size(); ++i) {
            layer[i].node = in.u32();
            layer[i].bits = in.u32();
            if (i > 0 && layer[i].node <= layer[i - 1].node)
                return false;
        }
    }
    return true;
}

bool readOrgan(ByteReader& in, std::uint32_t version, OrganSnapshot& organ) {
    organ.name = in.text();
    organ.solver = in.text();
    organ.traits.resize(in.count(in.u32(), 8));
    for (Trait& trait : organ.traits) {
        trait.name = in.text();
        trait.value = in.text();
    }
    if (!readState(in, version, organ.state) || !readCuts(in, organ.cuts) || !readLayers(in, organ.layers))
        return false;
    organ.impulses = readVectors<3>(in, in.count(in.u32(), 24), false);
    organ.lastCut = in.u64();
    organ.level = in.u32();
    organ.levelState = in.text();
    return true;
}

void writeThread(ByteWriter& out, const ThreadState& thread) {
    for (const double value : {thread.startLength, thread.force, thread.mostForce, thread.brokenAfter,
                               thread.impulse, thread.work})
        out.f64(value);
    out.u8(thread.broken ? 1 : 0);
}

/// False: a value that no writer writes.
bool readThread(ByteReader& in, ThreadState& thread) {
    for (double* value : {&thread.startLength, &thread.force, &thread.mostForce, &thread.brokenAfter,
                          &thread.impulse, &thread.work})
        *value = in.f64();
    const std::uint8_t broken = in.u8();
    thread.broken = broken == 1;
    return broken <= 1;
}

/// False: it makes no sense, at in.at() or just before.
bool readBody(ByteReader& in, std::uint32_t version, Snapshot& snapshot) {
    snapshot.program = in.text();
    snapshot.machine = in.text();
    snapshot.frame = in.i64();
    snapshot.frameRate = in.f64();
    if (in.failed() || snapshot.frame < 0 || !(snapshot.frameRate > 0 && snapshot.frameRate < 1e9))
        return false;
    snapshot.organs.resize(in.count(in.u32(), kLeastOrganBytes));
    for (OrganSnapshot& organ : snapshot.organs)
        if (!readOrgan(in, version, organ))
            return false;
    if (version >= 3)
        snapshot.threads.resize(in.count(in.u32(), kThreadBytes));
    for (ThreadState& thread : snapshot.threads)
        if (!readThread(in, thread))
            return false;
    for (OrganSnapshot& organ : snapshot.organs)
        if (version >= 4)
            organ.cutMask = in.text();
    return !in.failed() && in.left() == 0;
}

} // namespace

std::string snapshotBytes(const Snapshot& snapshot) {
    ByteWriter body;
    body.text(snapshot.program);
    body.text(snapshot.machine);
    body.i64(snapshot.frame);
    body.f64(snapshot.frameRate);
    body.u32(std::uint32_t(snapshot.organs.size()));
    for (const OrganSnapshot& organ : snapshot.organs)
        writeOrgan(body, organ);
    body.u32(std::uint32_t(snapshot.threads.size()));
    for (const ThreadState& thread : snapshot.threads)
        writeThread(body, thread);
    for (const OrganSnapshot& organ : snapshot.organs)
        body.text(organ.cutMask);

    ByteWriter file;
    file.raw(kMagic);
    file.u32(kVersion);
    file.u64(kHeaderBytes + body.bytes().size() + kChecksumBytes);
    file.raw(body.bytes());
    const Checksum checksum = checksumOf(file.bytes());
    file.u64(checksum.low);
    file.u64(checksum.high);
    return file.take();
}

Result<Snapshot> parseSnapshot(std::string_view bytes, const std::string& name) {
    const auto wrong = [&name](const std::string& what) { return Error{name + ": " + what}; };
    const std::string again = ": copy it or write it again";
    const std::string_view first = bytes.substr(0, kMagic.size());
    if (first.empty() || first != kMagic.substr(0, first.size()))
        return wrong(first.empty() ? "is empty, not a snapshot" + again
                                   : "is not a snapshot: it does not begin as one (docs/snapshots.md)");
    const std::string end = "ends at byte " + std::to_string(bytes.size());
    if (bytes.size() < kHeaderBytes + kChecksumBytes)
        return wrong("is cut off: it " + end + ", and no snapshot is so short" + again);
    ByteReader header(bytes, kMagic.size());
    const std::uint32_t version = header.u32();
    const std::uint64_t length = header.u64();
    if (length != bytes.size())
        return wrong((length > bytes.size() ? "is cut off: it " + end + " of "
                                            : "has bytes after its end: it " + end + ", and should at ") +
                     std::to_string(length) + again);
    const std::size_t bodyEnd = bytes.size() - kChecksumBytes;
    ByteReader trailer(bytes, bodyEnd);
    const std::uint64_t low = trailer.u64(), high = trailer.u64();
    if (checksumOf(bytes.substr(0, bodyEnd)) != Checksum{low, high})
        return wrong("is damaged: its checksum does not fit its bytes" + again);
    if (version < kOldestVersion || version > kVersion)
        return wrong("is a snapshot of format " + std::to_string(version) + ", and this program reads " +
                     std::to_string(kOldestVersion) + " to " + std::to_string(kVersion) +
                     ": go on with the version that wrote it");
    Snapshot snapshot;
    ByteReader in(bytes.substr(0, bodyEnd), kHeaderBytes);
    if (!readBody(in, version, snapshot))
        return wrong("byte " + std::to_string(in.at()) +
                     ": no snapshot has such a value here: write it again");
    return snapshot;
}

Status writeSnapshot(const Snapshot& snapshot, const std::filesystem::path& file) {
    return writeFileAtomically(file, std::string_view(snapshotBytes(snapshot)));
}

Result<Snapshot> readSnapshot(const std::filesystem::path& file) {
    const std::string name = file.string();
    std::error_code code;
    const std::filesystem::file_status status = std::filesystem::status(file, code);
    if (!std::filesystem::exists(status))
        return Error{name + ": no such file: name a snapshot that a run wrote (snapshots_at)"};
    if (!std::filesystem::is_regular_file(status))
        return Error{name + ": is not a regular file, so it is not a snapshot"};
    std::ifstream stream(file, std::ios::binary);
    std::string bytes(kMagic.size(), '\0');
    stream.read(bytes.data(), std::streamsize(bytes.size()));
    bytes.resize(std::size_t(stream.gcount()));
    if (bytes == kMagic) // another file, however large, is not read
        bytes.append(std::istreambuf_iterator<char>(stream), {});
    if (!stream.is_open() || stream.bad())
        return Error{name + ": cannot be read: look at its permissions"};
    return parseSnapshot(bytes, name);
}

} // namespace serosa::sim
