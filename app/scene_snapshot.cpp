// See app/scene_snapshot.h; and how the player takes a snapshot and goes on from one.
#include "app/scene_snapshot.h"

#include "app/scene_player.h"
#include "app/version.h"
#include "base/check.h"
#include "sim/byte_stream.h"
#include "sim/cpu_solver.h"
#include "sim/quantity.h"

#include <algorithm>
#include <ostream>

namespace serosa::app {

namespace {

const char kPose[] = "pose";

std::string cutsTrait(const std::vector<sim::Cut>& cuts) {
    sim::ByteWriter bytes;
    for (const sim::Cut& cut : cuts) {
        bytes.u8(std::uint8_t(cut.kind));
        bytes.f64(cut.radius);
        bytes.u64(cut.keys.size());
        for (const sim::CutKey& key : cut.keys)
            for (const double value :
                 {key.time, key.at.x, key.at.y, key.at.z, key.end.x, key.end.y, key.end.z})
                bytes.f64(value);
    }
    return std::to_string(cuts.size()) + " (" + sim::checksumText(sim::checksumOf(bytes.bytes())) + ")";
}

std::string levelsTrait(const sim::Organ& organ) {
    std::string text = std::to_string(organ.levels) + (organ.levelsByRule ? ", auto" : "");
    for (const sim::LevelKey& key : organ.levelKeys)
        text += ", " + sim::traitValue({key.time}, "s") + ": " + std::to_string(key.level);
    return text;
}

/// The solver that stepped the organs of a snapshot; "pose" where none was simulated.
std::string solverOf(const sim::Snapshot& snapshot) {
    for (const sim::OrganSnapshot& organ : snapshot.organs)
        if (organ.solver != kPose)
            return organ.solver;
    return kPose;
}

/// A file may hold any text.
std::string printable(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
    return text;
}

} // namespace

std::vector<sim::Trait> sceneTraits(const sim::Scene& scene, std::size_t index, const OrganParts& parts) {
    const sim::Organ& organ = scene.organs[index];
    std::vector<sim::Trait> traits{{"frame_rate", sim::traitValue({scene.frameRate}, "Hz")}};
    if (organ.pose) {
        traits.push_back({"bend_radius", sim::traitValue({organ.pose->bendRadius}, "m")});
        traits.push_back({"frames of the pose", std::to_string(scene.frames())});
    }
    const std::vector<sim::Trait> ofSetup = sim::setupTraits(parts.setup);
    traits.insert(traits.end(), ofSetup.begin(), ofSetup.end());
    traits.push_back({"cuts", cutsTrait(scene.cuts)});
    if (organ.levels > 1)
        traits.push_back({"levels", levelsTrait(organ)});
    const std::vector<sim::Trait> ofCoupling = couplingTraits(scene, index);
    traits.insert(traits.end(), ofCoupling.begin(), ofCoupling.end());
    traits.push_back({"tear_strain", sim::traitValue({organ.tearStrain}, "")});
    return traits;
}

std::string machineOf(const RunParts& parts) {
    const bool cpu = std::any_of(parts.organs.begin(), parts.organs.end(), [](const auto& organ) {
        return organ->solver && std::string(organ->solver->name()) == "cpu";
    });
    const gpu::ContextInfo& gl = parts.context->info();
    return cpu ? sim::cpuSolverTarget() : gl.renderer + ", OpenGL " + gl.version;
}

Result<std::optional<sim::Snapshot>> readStart(RunOptions& options,
                                               const std::filesystem::path& outputFolder) {
    if (options.from.empty())
        return std::optional<sim::Snapshot>();
    SEROSA_ASSIGN(sim::Snapshot snapshot, sim::readSnapshot(options.from));
    const std::string name = options.from.string();
    if (snapshot.program != programVersion())
        return Error{name + ": was written by serosa " + snapshot.program + ", this is " + programVersion() +
                     ", whose bytes may be others: go on with that version"};
    std::error_code code;
    const std::filesystem::path folder =
        options.from.has_parent_path() ? options.from.parent_path() : std::filesystem::path(".");
    if (std::filesystem::equivalent(folder, outputFolder, code))
        return Error{name + ": lies in the output folder, whose results are replaced: choose another with "
                            "--out"};
    if (options.solver.empty())
        options.solver = solverOf(snapshot) == kPose ? "fragment" : solverOf(snapshot);
    return std::optional(std::move(snapshot));
}

Status checkStart(const sim::Snapshot& snapshot, const RunOptions& options, RunParts& parts) {
    const std::string name = options.from.string() + ": ";
    if (snapshot.organs.size() != parts.organs.size())
        return Error{name + "belongs to another scene: it has " + std::to_string(snapshot.organs.size()) +
                     " organs, this scene " + std::to_string(parts.organs.size())};
    for (std::size_t i = 0; i < parts.organs.size(); ++i) {
        const sim::OrganSnapshot& saved = snapshot.organs[i];
        if (saved.level < 1 || saved.level > std::uint32_t(parts.levels[i].count()))
            return Error{name + "belongs to another scene: " + saved.name + " is on level " +
                         std::to_string(saved.level) + " of detail in the snapshot, here it has " +
                         std::to_string(parts.levels[i].count())};
        parts.levels[i].select(parts, i, int(saved.level));
        const OrganParts& organ = *parts.organs[i];
        const std::string solver = !organ.solver       ? kPose
                                   : options.anySolver ? ""
                                                       : std::string(organ.solver->name());
        const Status fits = sim::checkSnapshot(snapshot.organs[i], parts.scene.organs[i].name, solver,
                                               sceneTraits(parts.scene, i, organ), organ.lattice);
        if (!fits.ok())
            return Error{name + fits.error().message};
        if (!LevelState::parse(saved.levelState, parts, i, int(snapshot.frame)))
            return Error{name + saved.name +
                         ": what it says of levels of detail makes no sense: write the snapshot again"};
        if (!parts.renderer->restoreCuts(i, organ.lattice, organ.textures(), saved.cutMask).ok())
            return Error{name + saved.name +
                         ": its mask of what was cut makes no sense: write the snapshot again"};
    }
    if (snapshot.threads.size() != parts.coupled.threads.size())
        return Error{name + "belongs to another scene: it has " + std::to_string(snapshot.threads.size()) +
                     " threads, this scene " + std::to_string(parts.coupled.threads.size())};
    if (snapshot.frame >= parts.scene.frames())
        return Error{name + "is of frame " + std::to_string(snapshot.frame) + ", and the run ends at frame " +
                     std::to_string(parts.scene.frames()) + ": give more with duration or --frames"};
    return {};
}

void describeStart(const sim::Snapshot& snapshot, const RunOptions& options, const RunParts& parts,
                   std::ostream& out) {
    out << "goes on from " << options.from.string() << ", frame " << snapshot.frame << ", "
        << shortNumber(snapshot.time()) << " s\n";
    const std::string made = solverOf(snapshot), machine = machineOf(parts);
    if (made != kPose && made != options.solver)
        out << "note: " << made << " made the snapshot, " << options.solver
            << " goes on: the bytes are not those of a run that never stopped\n";
    else if (snapshot.machine != machine)
        out << "note: the snapshot was made on " << snapshot.machine << ", this is " << machine
            << ": the bytes may not be those of a run that never stopped\n";
}

Result<int> inspectSnapshot(const std::filesystem::path& file, std::ostream& out) {
    SEROSA_ASSIGN(const sim::Snapshot snapshot, sim::readSnapshot(file));
    const auto line = [&out](std::string name, const std::string& text) {
        name.resize(std::max<std::size_t>(name.size() + 1, 20), ' ');
        out << printable(name + text) << "\n";
    };
    line("snapshot", "of serosa " + snapshot.program + ", made on " + snapshot.machine);
    line("frame", std::to_string(snapshot.frame) + ", " + shortNumber(snapshot.time()) + " s at " +
                      shortNumber(snapshot.frameRate) + " Hz");
    for (const sim::OrganSnapshot& organ : snapshot.organs) {
        sim::CutList cuts;
        cuts.assign(organ.cuts);
        line("organ", organ.name + ": " + grouped(organ.state.positions.size()) + " nodes, step " +
                          std::to_string(organ.state.step) + " of " + organ.solver + ", " +
                          std::to_string(cuts.strokes()) + " strokes");
        line("state hash", organ.state.hash());
        for (const sim::Trait& trait : organ.traits)
            line("  " + trait.name, trait.value);
    }
    for (std::size_t i = 0; i < snapshot.threads.size(); ++i)
        line("thread",
             std::to_string(i + 1) + ": " +
                 (snapshot.threads[i].broken ? "broken" : shortNumber(snapshot.threads[i].force) + " N"));
    return int(exitOk);
}

sim::Snapshot ScenePlayer::snapshot() {
    sim::Snapshot snapshot;
    snapshot.program = programVersion();
    snapshot.machine = machineOf(parts_);
    snapshot.frame = frame_;
    snapshot.frameRate = parts_.scene.frameRate;
    for (std::size_t i = 0; i < parts_.organs.size(); ++i) {
        const OrganParts& parts = *parts_.organs[i];
        sim::OrganSnapshot organ;
        organ.name = parts_.scene.organs[i].name;
        organ.traits = sceneTraits(parts_.scene, i, parts);
        organ.cuts = cuts_[i].entries();
        organ.lastCut = lastCut_[i];
        organ.level = std::uint32_t(parts_.levels[i].active());
        organ.levelState = levelState(i).bytes();
        organ.cutMask = parts_.renderer->saveCuts(i);
        if (parts.solver) {
            sim::takeSnapshot(*parts.solver, organ);
        } else {
            organ.solver = kPose;
            organ.state = state(i);
        }
        snapshot.organs.push_back(std::move(organ));
    }
    snapshot.threads = threads();
    return snapshot;
}

void ScenePlayer::restore(const sim::Snapshot& snapshot) {
    SEROSA_CHECK(snapshot.organs.size() == parts_.organs.size(), "a snapshot of this scene");
    frame_ = int(snapshot.frame);
    for (std::size_t i = 0; i < parts_.organs.size(); ++i) {
        const sim::OrganSnapshot& organ = snapshot.organs[i];
        const auto levels = LevelState::parse(organ.levelState, parts_, i, frame_);
        SEROSA_CHECK(levels, "a snapshot of this scene");
        restoreLevel(i, int(organ.level), *levels);
        OrganParts& parts = *parts_.organs[i];
        cuts_[i].assign(organ.cuts);
        lastCut_[i] = std::size_t(organ.lastCut);
        if (parts.solver) {
            const Status done = sim::restoreSnapshot(organ, *parts.solver);
            SEROSA_CHECK(done.ok(), "a context of GL 4.5 has double precision in shaders");
            setCutMask(i, organ.cutMask);
            showCuts(i);
            restoreBlend(i, *levels);
            if (guards_[i])
                guards_[i]->restart(frame_);
        } else {
            posed_[i] = organ.state;
        }
        if (parts.uploaded)
            parts.uploaded->upload(organ.state);
    }
    if (group_)
        group_->restart(frame_, snapshot.threads);
}

} // namespace serosa::app
