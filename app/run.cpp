// The loop of `serosa run`: step, draw, write. Nothing is read back from the state to draw; the energies'
// samples read it every ten frames.

#include "app/run.h"

#include "app/coupling_record.h"
#include "app/describe_setup.h"
#include "app/output_folder.h"
#include "app/progress.h"
#include "app/run_report.h"
#include "app/run_setup.h"
#include "app/scene_player.h"
#include "app/scene_snapshot.h"
#include "app/state_files.h"
#include "app/summary.h"
#include "base/atomic_file.h"
#include "gpu/gl.h"
#include "render/image.h"
#include "sim/cell_volumes.h"
#include "sim/mesh_writer.h"
#include "sim/quantity.h"

#define GLM_ENABLE_EXPERIMENTAL
#include <glm/gtx/rotate_vector.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <numbers>
#include <ostream>
#include <set>

namespace serosa::app {

namespace {

constexpr int kSampleEvery = 10; // frames between two samples of the energies
constexpr int kTileWidth = 320;  // pixels of a picture on the contact sheet, at most
constexpr int kExitInterrupted = 130;

/// Adds the wall time of its life to a sum of seconds.
class Stopwatch {
public:
    explicit Stopwatch(double& sum) : sum_(sum) {}
    ~Stopwatch() { sum_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }
    Stopwatch(const Stopwatch&) = delete;
    Stopwatch& operator=(const Stopwatch&) = delete;

private:
    double& sum_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

std::string numbered(const char* format, int frame) {
    char name[64];
    std::snprintf(name, sizeof name, format, frame);
    return name;
}

Result<std::string> bytesOf(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    if (!stream.is_open() || stream.bad() || bytes.empty())
        return Error{file.string() + ": was written, but cannot be read back for report.html"};
    return bytes;
}

class Run {
public:
    /// \param start a snapshot that belongs to the scene; null: from rest
    Run(RunParts& parts, OutputFolder& folder, const std::string& solver, const sim::Snapshot* start)
        : parts_(parts), player_(parts), folder_(folder), start_(start), files_(parts, player_, folder),
          frames_(parts.scene.frames()), frameTime_(1 / parts.scene.frameRate) {
        record_.scene = parts.scene;
        record_.gl = parts.context->info();
        record_.solver = "pose";
        for (const auto& organ : parts.organs) {
            record_.organs.push_back(organRecord(*organ, solver));
            if (organ->solver)
                record_.solver = solver;
        }
        beginCoupling(parts, record_);
        const sim::Output& output = parts.scene.output;
        for (const double time : output.surfacesAt)
            surfaceFrames_.insert(frameAt(time));
        for (const double time : output.snapshotsAt)
            files_.snapshotAt(frameAt(time));
        for (const double time : output.displacementsAt)
            files_.displacementAt(frameAt(time));
        for (const double time : output.sheetAt)
            sheetFrames_.insert(std::max(1, frameAt(time)));
        if (output.sheetAt.empty())
            for (int i = 0, tiles = output.sheetColumns * output.sheetRows; i < tiles; ++i)
                sheetFrames_.insert(std::max(1, int(std::lround((i + 1.0) * frames_ / tiles))));
        camera_ = render::makeCamera(parts.scene.camera, parts.lowest(), parts.highest(),
                                     double(output.width) / output.height);
    }

    /// All frames, until the end or an interruption (`record().end` says which). An organ that the watchdog
    /// stops stays as it was last good.
    Status frames(const InterruptGuard& interrupt) {
        if (!surfaceFrames_.empty())
            for (std::size_t i = 0; i < parts_.organs.size(); ++i)
                restSurfaces_.push_back(deformedPositions(i));
        if (start_)
            player_.restore(*start_);
        const int first = firstFrame_ = player_.frame();
        record_.framesDone = first;
        SEROSA_TRY(writeFiles(first));
        sample(first);
        Progress progress("frames", frames_);
        for (int frame = first + 1; frame <= frames_ && record_.end == "complete"; ++frame) {
            step(frame);
            const bool interrupted = interrupt.interrupted(); // once a frame: the last one is sampled
            const bool sampled = frame % kSampleEvery == 0 || frame == frames_ || interrupted;
            const bool written = sampled || surfaceFrames_.contains(frame) || files_.due(frame);
            if (written || drawn(frame))
                finishSteps();
            if (written)
                player_.check(); // nothing is written of a state that is wrong
            SEROSA_TRY(picture(frame));
            record_.framesDone = frame;
            if (sampled)
                sample(frame);
            SEROSA_TRY(writeFiles(frame));
            if (interrupted && frame < frames_)
                record_.end = "interrupted";
            progress.show(frame);
        }
        noteForces(true);
        noteAlarms();
        return {};
    }

    /// The first drawing compiles shaders and fills caches: a part of the set-up, not of a picture's time.
    Status warmUp() { return drawScene(0); }

    Status contactSheet() {
        if (tiles_.empty())
            return {};
        const render::Image sheet = render::contactSheet(tiles_, captions_, parts_.scene.output.sheetColumns);
        return render::writePng(sheet, folder_.file("contact_sheet.png"));
    }

    /// Views around the organs as they lie now, on a sheet of their own.
    Status turntable() {
        const int views = parts_.scene.output.turntable;
        if (views == 0)
            return {};
        std::vector<render::Image> tiles;
        std::vector<std::string> captions;
        const render::CameraView camera = camera_;
        const glm::dvec3 light = parts_.scene.light.direction;
        for (int i = 0; i < views; ++i) {
            const double share = double(i) / views;
            camera_ = render::carriedAround(camera, 0.5 * (parts_.lowest() + parts_.highest()),
                                            2 * std::numbers::pi * share);
            parts_.scene.light.direction =
                glm::rotate(light, 2 * std::numbers::pi * share, glm::dvec3(0, 1, 0));
            SEROSA_TRY(drawScene(player_.frame())); // the organs turn, not the room
            tiles.push_back(render::shrink(parts_.renderer->readImage(), kTileWidth));
            captions.push_back(std::to_string(std::lround(360 * share)) + " deg");
        }
        camera_ = camera;
        parts_.scene.light.direction = light;
        const render::Image sheet = render::contactSheet(tiles, captions, parts_.scene.output.sheetColumns);
        return render::writePng(sheet, folder_.file("turntable.png"));
    }

    /// report.html of `summary`, with pictures that were written before.
    Status report(const nlohmann::ordered_json& summary) {
        RunPictures pictures;
        if (!tiles_.empty()) {
            SEROSA_ASSIGN(pictures.contactSheet, bytesOf(folder_.path() / "contact_sheet.png"));
        }
        for (const int frame : reportFrames(summary, pictureFrames_)) {
            SEROSA_ASSIGN(std::string png, bytesOf(folder_.path() / numbered("frame_%06d.png", frame)));
            pictures.frames.emplace_back(frame, std::move(png));
        }
        return writeFileAtomically(folder_.file("report.html"),
                                   std::string_view(runReport(summary, pictures, failure_)));
    }

    RunRecord& record() { return record_; }
    const std::string& failure() const { return failure_; }

private:
    static OrganRecord organRecord(const OrganParts& parts, const std::string& solver) {
        OrganRecord record;
        record.solver = parts.solver ? solver : "pose";
        record.vertices = parts.surface.file.positions.size();
        record.faces = parts.surface.file.faces.size();
        record.repair = parts.surface.repair;
        record.lattice = &parts.lattice;
        record.layout = &parts.textures().layout();
        record.fixedNodes = std::size_t(std::count(parts.setup.fixed.begin(), parts.setup.fixed.end(), true));
        record.step = parts.step;
        record.binding = &parts.binding;
        return record;
    }

    int frameAt(double time) const { return std::clamp(int(std::lround(time / frameTime_)), 0, frames_); }

    void step(int frame) {
        Stopwatch watch(record_.times.steps);
        player_.advance();
        if (record_.solver != "pose") {
            const std::size_t colliders = parts_.scene.tools.size() + parts_.scene.bodies.size();
            record_.forces.push_back({frame * frameTime_, std::vector<sim::ToolLoad>(colliders)});
            noteForces(false);
        }
    }

    /// Steps are done before anything else is timed.
    void finishSteps() {
        Stopwatch watch(record_.times.steps);
        glFinish();
    }

    /// Loads come frames later; `all`: those that are still to come, too.
    void noteForces(bool all) {
        for (std::size_t i = 0; i < parts_.organs.size(); ++i)
            for (const FrameLoads& given : player_.takeLoads(i, all)) {
                std::vector<sim::ToolLoad>& sums =
                    record_.forces.at(std::size_t(given.frame - firstFrame_ - 1)).means;
                for (std::size_t c = 0; c < sums.size(); ++c) {
                    sums[c].impulse += given.loads[c].impulse / frameTime_;
                    sums[c].angular += given.loads[c].angular / frameTime_;
                }
            }
    }

    void sample(int frame) {
        const double time = frame * frameTime_;
        EnergySample sum{time, {}, 0};
        for (std::size_t i = 0; i < parts_.organs.size(); ++i) {
            const OrganParts& organ = *parts_.organs[i];
            const sim::LatticeState now = player_.state(i);
            const Displacement moved = largestDisplacement(organ.lattice, now);
            OrganRecord& record = record_.organs[i];
            record.stateHash = now.hash();
            record.levels = player_.levelChanges(i);
            record.invertedCells = std::max(record.invertedCells, sim::invertedCells(organ.lattice, now));
            countCuts(i, now);
            sum.largestDisplacement = std::max(sum.largestDisplacement, moved.largest);
            record.largestDisplacement = std::max(record.largestDisplacement, moved.largest);
            if (!organ.solver)
                continue;
            const sim::Energies energies = sim::energies(organ.setup, now);
            if (i == 0) {
                sum.energies = energies;
                continue;
            }
            sum.energies.kinetic += energies.kinetic;
            sum.energies.elastic += energies.elastic;
            sum.energies.gravitational += energies.gravitational;
        }
        record_.largestDisplacement = std::max(record_.largestDisplacement, sum.largestDisplacement);
        record_.samples.push_back(sum);
        sampleCoupling(parts_, player_, time, record_);
    }

    Status drawScene(int frame) {
        const double time = frame * frameTime_;
        render::View view{camera_, parts_.scene.light, parts_.scene.look,
                          render::drawnShapes(parts_.scene, time, parts_.lowest(), parts_.highest()),
                          drawnThreads(parts_, player_.threads(), time)};
        SEROSA_TRY(parts_.implicit.moveTo(time, *parts_.renderer));
        view.casters = parts_.implicit.casters(parts_.textures(), *parts_.renderer);
        parts_.renderer->draw(parts_.textures(), view);
        glFinish();
        return {};
    }

    /// Strokes, springs and pieces of an organ that was cut.
    void countCuts(std::size_t i, const sim::LatticeState& now) {
        OrganRecord& record = record_.organs[i];
        record.strokes = player_.cuts(i).strokes();
        if (record.strokes == 0)
            return;
        const sim::Lattice& lattice = parts_.organs[i]->lattice;
        const auto& connections = now.connections.empty() ? lattice.connections : now.connections;
        record.springsCut = sim::springsCut(lattice, connections);
        record.pieces = sim::countPieces(sim::pieceLabels(lattice, connections));
    }

    bool isPicture(int frame) const {
        return frame % parts_.scene.output.frameEvery == 0 || frame == frames_;
    }
    bool drawn(int frame) const { return isPicture(frame) || sheetFrames_.contains(frame); }

    Status picture(int frame) {
        if (!drawn(frame))
            return {};
        const bool tile = sheetFrames_.contains(frame);
        {
            Stopwatch watch(record_.times.draw);
            SEROSA_TRY(drawScene(frame));
        }
        Stopwatch watch(record_.times.files);
        const render::Image image = parts_.renderer->readImage();
        if (tile) {
            char caption[32];
            std::snprintf(caption, sizeof caption, "t = %.2f s", frame * frameTime_);
            tiles_.push_back(render::shrink(image, kTileWidth));
            captions_.emplace_back(caption);
        }
        if (!isPicture(frame))
            return {};
        ++record_.picturesWritten;
        pictureFrames_.push_back(frame);
        return render::writePng(image, folder_.file(numbered("frame_%06d.png", frame)));
    }

    void noteAlarms() {
        for (std::size_t i = 0; i < parts_.organs.size(); ++i)
            record_.organs[i].alarm = player_.alarm(i);
        if (const std::vector<std::string> lines = player_.alarmLines(); !lines.empty()) {
            failure_ = "stopped by the watchdog: " + lines.front();
            if (lines.size() > 1)
                failure_ += " (and " + std::to_string(lines.size() - 1) + " more: see summary.json)";
            if (record_.end == "complete")
                record_.end = "organ stopped";
        }
    }

    std::vector<glm::dvec3> deformedPositions(std::size_t organ) {
        return parts_.renderer->readDeformedPositions(parts_.organs[organ]->textures(),
                                                      parts_.surfaceMapping(), organ);
    }

    /// All that is written of the state but pictures.
    Status writeFiles(int frame) {
        Stopwatch watch(record_.times.files);
        SEROSA_TRY(writeSurfaces(frame));
        SEROSA_TRY(files_.write());
        record_.snapshotsWritten = files_.snapshots();
        record_.displacementsWritten = files_.displacements();
        return {};
    }

    /// The surfaces in their files' unit, axes and vertex order: the file's own positions plus the
    /// displacement, so that rest comes out as it went in.
    Status writeSurfaces(int frame) {
        if (!surfaceFrames_.contains(frame))
            return {};
        for (std::size_t i = 0; i < parts_.organs.size(); ++i) {
            const sim::Organ& organ = parts_.scene.organs[i];
            const std::string name =
                parts_.organs.size() > 1 ? "surface_" + sim::organFileName(organ) + "_" : "surface_";
            const sim::TriangleMesh mesh =
                deformedFile(organ, parts_.organs[i]->surface, deformedPositions(i), restSurfaces_[i]);
            ++record_.surfacesWritten;
            SEROSA_TRY(sim::writeMesh(mesh, folder_.file(name + numbered("%06d.ply", frame))));
        }
        return {};
    }

    RunParts& parts_;
    ScenePlayer player_;
    OutputFolder& folder_;
    const sim::Snapshot* start_;
    StateFiles files_;
    int frames_, firstFrame_ = 0; // the last one, and the one that it begins after
    double frameTime_;            // s
    render::CameraView camera_;
    RunRecord record_;
    std::set<int> surfaceFrames_, sheetFrames_;
    std::vector<int> pictureFrames_;                    // written
    std::vector<std::vector<glm::dvec3>> restSurfaces_; // m: the mapped surfaces at rest
    std::vector<render::Image> tiles_;
    std::vector<std::string> captions_;
    std::string failure_;
};

} // namespace

Result<int> runScene(const RunOptions& given, std::ostream& out) {
    RunOptions options = given;
    RunTimes times;
    std::optional<Stopwatch> setupWatch(times.setup), totalWatch(times.total);
    SEROSA_ASSIGN(
        OutputFolder folder,
        OutputFolder::check(options.out.empty() ? defaultOutputFolder(options) : options.out, options.force));
    SEROSA_ASSIGN(const std::optional<sim::Snapshot> start, readStart(options, folder.path()));
    RunParts parts;
    SEROSA_TRY(prepareRun(options, parts));
    if (start)
        SEROSA_TRY(checkStart(*start, options, parts));
    std::vector<std::string> notes = describeSetup(parts, out);
    if (start)
        describeStart(*start, options, parts, out);
    SEROSA_TRY(folder.create());

    Run run(parts, folder, options.solver, start ? &*start : nullptr);
    if (start)
        run.record().from = {options.from.filename().string(), int(start->frame),
                             start->organs.front().solver};
    run.record().notes = std::move(notes);
    SEROSA_TRY(run.warmUp());
    setupWatch.reset();
    const InterruptGuard interrupt;
    SEROSA_TRY(run.frames(interrupt));
    SEROSA_TRY(run.contactSheet());
    SEROSA_TRY(run.turntable());
    totalWatch.reset();
    RunRecord& record = run.record();
    record.times.setup = times.setup;
    record.times.total = times.total;
    const nlohmann::ordered_json summary = summaryJson(record);
    // JSON is UTF-8; a file name need not be.
    const std::string text =
        summary.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
    SEROSA_TRY(writeFileAtomically(folder.file("summary.json"), std::string_view(text)));
    SEROSA_TRY(run.report(summary));
    folder.keep();

    for (std::size_t i = 0; i < record.organs.size(); ++i)
        if (record.organs[i].invertedCells > 0)
            out << "note: " << grouped(record.organs[i].invertedCells) << " cells of "
                << parts.scene.organs[i].name
                << " were turned inside out at a time; pictures are not to be trusted there: press less "
                   "deep"
                << (parts.scene.organs[i].tissue.recovery
                        ? " or take a finer lattice\n"
                        : ", take a finer lattice, or say recovery = true of the tissue, which turns them "
                          "right again\n");
    for (std::size_t i = 0; i < record.organs.size(); ++i)
        if (record.organs[i].alarm)
            out << "stopped: " << parts.scene.organs[i].name
                << " at its last good state: " << record.organs[i].alarm->text() << "\n";
    if (record.end == "interrupted")
        out << "interrupted after frame " << record.framesDone << " of " << parts.scene.frames() << "\n";
    out << "wrote " << record.picturesWritten << " pictures, " << record.surfacesWritten << " surfaces, "
        << (record.snapshotsWritten > 0 ? std::to_string(record.snapshotsWritten) + " snapshots, " : "")
        << (record.displacementsWritten > 0 ? std::to_string(record.displacementsWritten) + " displacements, "
                                            : "")
        << "summary.json and report.html to " << folder.path().string() << "; largest displacement "
        << shortNumber(1e3 * record.largestDisplacement) << " mm, "
        << shortNumber(summary["timing"]["real_time_factor"].get<double>()) << " x real time\n";
    if (!run.failure().empty())
        return Error{run.failure(), exitCheckFailed};
    return record.end == "interrupted" ? kExitInterrupted : int(exitOk);
}

} // namespace serosa::app
