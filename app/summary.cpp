// See app/summary.h. Key names carry the unit where there is one.

#include "app/summary.h"

#include "app/coupling_json.h"
#include "app/material_lines.h"
#include "app/organ_setup.h"
#include "app/version.h"
#include "shaders/shared_constants.h"
#include "sim/assign_materials.h"
#include "sim/scene_keys.h"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace serosa::app {

namespace {

using Json = nlohmann::ordered_json;

Json vec(const glm::dvec3& v) {
    return Json::array({v.x, v.y, v.z});
}

std::string wordOf(const char* table, const char* key, int index) {
    return sim::findSceneKey(table, key)->words.at(std::size_t(index));
}

Json repairJson(const sim::RepairReport& repair) {
    return {{"repeated_corner_faces_removed", repair.repeatedCornerFaces},
            {"duplicate_faces_removed", repair.duplicateFaces},
            {"faces_flipped", repair.flippedFaces},
            {"shells_turned", repair.turnedShells},
            {"holes_filled", repair.filledHoles},
            {"faces_added", repair.addedFaces},
            {"vertices_added", repair.addedVertices},
            {"stray_vertices_removed", repair.strayVertices}};
}

Json materialsJson(const sim::Organ& organ, const sim::Lattice& lattice) {
    const std::vector<sim::MaterialAmount> amounts = sim::materialAmounts(lattice, organ.tissue);
    Json materials = Json::array();
    for (std::size_t i = 0; i < amounts.size(); ++i) {
        const sim::Material& material = organ.tissue.material(i);
        Json json = {{"name", materialName(organ, i)},
                     {"young_Pa", material.young},
                     {"poisson", material.poisson},
                     {"density_kg_m3", material.density},
                     {"damping_time_s", material.dampingTime}};
        for (const sim::CurvePoint& point : material.curve)
            json["curve"].push_back({{"strain", point.strain}, {"stress_Pa", point.stress}});
        if (material.strainLimit > 0)
            json["strain_limit"] = material.strainLimit;
        if (material.fibrous()) {
            json["fibre"] = vec(material.fibre);
            json["fibre_young_Pa"] = material.fibreYoung;
        }
        json["cells"] = amounts[i].cells;
        json["volume_m3"] = amounts[i].volume;
        json["mass_kg"] = amounts[i].mass;
        materials.push_back(std::move(json));
    }
    return materials;
}

Json organJson(const sim::Organ& organ, const OrganRecord& record) {
    const sim::Tissue& tissue = organ.tissue;
    Json json = {{"name", organ.name},
                 {"model", organ.model.filename().string()},
                 {"metres_per_unit", organ.lengthUnit},
                 {"vertices", record.vertices},
                 {"faces", record.faces},
                 {"young_Pa", tissue.young},
                 {"poisson", tissue.poisson},
                 {"density_kg_m3", tissue.density},
                 {"damping_time_s", tissue.dampingTime},
                 {"air_drag_1_s", tissue.airDrag},
                 {"materials", materialsJson(organ, *record.lattice)}};
    if (organ.upAxis != sim::UpAxis::y)
        json["up_axis"] = wordOf("organ", "up_axis", int(organ.upAxis));
    for (const LevelChange& change : record.levels)
        json["levels"].push_back({{"frame", change.frame}, {"level", change.level}});
    if (record.repair)
        json["repair"] = repairJson(*record.repair);
    return json;
}

Json latticeJson(const OrganRecord& record) {
    const sim::Lattice& lattice = *record.lattice;
    const double fillSum =
        std::accumulate(lattice.cells.begin(), lattice.cells.end(), 0.0,
                        [](double sum, const sim::LatticeCell& cell) { return sum + cell.fill; });
    const double cellVolume = lattice.spacing * lattice.spacing * lattice.spacing;
    return {{"nodes", lattice.nodeCount()},
            {"fixed_nodes", record.fixedNodes},
            {"cells", lattice.cells.size()},
            {"spacing_m", lattice.spacing},
            {"node_dims", {lattice.nodeDims.x, lattice.nodeDims.y, lattice.nodeDims.z}},
            {"volume_m3", lattice.exactVolume},
            {"filled_volume_m3", fillSum / 255 * cellVolume},
            {"layout", record.layout->kind == SRS_LAYOUT_GRID ? "grid" : "rows"},
            {"texture_size", {record.layout->width, record.layout->height}}};
}

Json stepJson(const sim::StableStep& step, sim::StepMethod method) {
    const bool implicit = method == sim::StepMethod::implicit;
    return {{"method", methodName(method)},
            {"time_step_s", step.timeStep},
            {"steps_per_frame", step.stepsPerFrame},
            {"bound_s", step.bound},
            {"margin", step.margin},
            {"stiffest_rate2_1_s2", step.stiffestRate2},
            {"formula_rate2_1_s2", step.formulaRate2},
            {"how", std::string("Lanczos iteration on the rest lattice, never below 12 k/m; ") +
                        (implicit ? "bound and margin are those of explicit steps; implicit steps are taken"
                                  : "explicit step below the bound, damping included")}};
}

Json bindingJson(const render::SurfaceBinding& binding) {
    return {{"vertices", binding.vertices.size()},
            {"torn_edges_found", binding.tornEdgesFound},
            {"torn_edges_left", binding.tornEdgesLeft},
            {"constant_basis_vertices", binding.constantVertices},
            {"bytes_per_vertex", binding.bytesPerVertex}};
}

Json cutsJson(const OrganRecord& record) {
    return {{"strokes", record.strokes},
            {"springs_cut", record.springsCut},
            {"pieces", record.pieces.pieces},
            {"loose_nodes", record.pieces.loose}};
}

Json stoppedJson(const sim::Alarm& alarm) {
    return {{"node", alarm.node},
            {"position_m", vec(alarm.position)},
            {"t_s", alarm.time},
            {"step", alarm.step},
            {"reason", sim::alarmName(alarm.kind)},
            {"measured", alarm.measured},
            {"allowed", alarm.allowed},
            {"text", alarm.text()}};
}

/// What a scene of one organ says at the top of the summary, together.
Json organsJson(const RunRecord& record) {
    Json organs = Json::array();
    for (std::size_t i = 0; i < record.organs.size(); ++i) {
        const OrganRecord& organ = record.organs[i];
        Json json = organJson(record.scene.organs[i], organ);
        json["solver"] = organ.solver;
        json["lattice"] = latticeJson(organ);
        json["step"] = stepJson(organ.step, record.scene.organs[i].method);
        json["binding"] = bindingJson(*organ.binding);
        if (organ.strokes > 0)
            json["cuts"] = cutsJson(organ);
        if (organ.alarm)
            json["stopped"] = stoppedJson(*organ.alarm);
        json["largest_displacement_m"] = organ.largestDisplacement;
        json["inverted_cells"] = organ.invertedCells;
        json["state_hash"] = organ.stateHash;
        organs.push_back(std::move(json));
    }
    return organs;
}

const char* kindName(const sim::RigidShape& shape, bool jaws) {
    static const char* const kNames[] = {"sphere", "capsule", "box", "hook", "floor", "mesh"};
    return jaws ? "jaws" : kNames[int(shape.kind)];
}

/// What a collider gave, into `json`.
void addForces(const RunRecord& record, std::size_t collider, Json& json) {
    double force = 0, torque = 0;
    Json samples = Json::array();
    for (const ForceSample& sample : record.forces) {
        const sim::ToolLoad& mean = sample.means[collider];
        force = std::max(force, glm::length(mean.impulse));
        torque = std::max(torque, glm::length(mean.angular));
        samples.push_back({{"t_s", sample.time}, {"N", vec(mean.impulse)}, {"Nm", vec(mean.angular)}});
    }
    json["largest_force_N"] = force;
    json["largest_torque_Nm"] = torque;
    json["force"] = std::move(samples);
}

Json toolsJson(const RunRecord& record) {
    Json tools = Json::array();
    for (std::size_t i = 0; i < record.scene.tools.size(); ++i) {
        const sim::Tool& tool = record.scene.tools[i];
        Json json = {{"name", tool.name},
                     {"kind", kindName(tool.shape, tool.jaws)},
                     {"mode", wordOf("tool", "mode", int(tool.mode))},
                     {"radius_m", tool.radius}};
        if (tool.mode == sim::ToolMode::push)
            json["friction"] = tool.friction;
        else if (std::isfinite(tool.gripForce))
            json["grip_force_N"] = tool.gripForce;
        addForces(record, i, json);
        tools.push_back(std::move(json));
    }
    return tools;
}

Json bodiesJson(const RunRecord& record) {
    Json bodies = Json::array();
    for (std::size_t i = 0; i < record.scene.bodies.size(); ++i) {
        const sim::Body& body = record.scene.bodies[i];
        Json json = {{"name", body.name},
                     {"kind", kindName(body.shape, false)},
                     {"at_m", vec(body.pose.at)},
                     {"friction", body.friction}};
        addForces(record, record.scene.tools.size() + i, json);
        bodies.push_back(std::move(json));
    }
    return bodies;
}

/// Largest resident memory of the process so far, bytes (Linux counts in KiB).
std::int64_t peakMemory() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return std::int64_t(usage.ru_maxrss) * 1024;
}

Json timingJson(const RunRecord& record) {
    const RunTimes& times = record.times;
    const double frames = std::max(1, record.framesDone);
    int stepsPerFrame = 0;
    for (const OrganRecord& organ : record.organs)
        stepsPerFrame += organ.step.stepsPerFrame;
    const double steps = std::max(1.0, frames * stepsPerFrame);
    const double simulated = record.framesDone / record.scene.frameRate;
    const double pictures = std::max(1, record.picturesWritten);
    return {{"ms_per_step", 1e3 * times.steps / steps},
            {"ms_steps_per_frame", 1e3 * times.steps / frames},
            {"ms_draw_per_picture", 1e3 * times.draw / pictures},
            {"ms_per_frame", 1e3 * (times.steps / frames + times.draw / pictures)},
            {"real_time_factor",
             times.steps > 0 ? simulated / (times.steps + times.draw * frames / pictures) : 0},
            {"setup_s", times.setup},
            {"files_s", times.files},
            {"total_s", times.total},
            {"peak_memory_B", peakMemory()}};
}

} // namespace

std::string RunRecord::stateHash() const {
    if (organs.size() == 1)
        return organs.front().stateHash;
    std::string all;
    for (const OrganRecord& organ : organs)
        all += (all.empty() ? "" : "-") + organ.stateHash;
    return all;
}

Displacement largestDisplacement(const sim::Lattice& lattice, const sim::LatticeState& state) {
    Displacement result;
    double largest2 = 0;
    for (std::size_t node = 0; node < state.positions.size(); ++node) {
        const glm::dvec3 moved = state.positions[node] - lattice.restPosition(node);
        const double moved2 = glm::dot(moved, moved);
        if (!std::isfinite(moved2))
            return {0, node, false};
        if (moved2 > largest2) {
            largest2 = moved2;
            result.node = node;
        }
    }
    result.largest = std::sqrt(largest2) * lattice.spacing;
    return result;
}

nlohmann::ordered_json summaryJson(const RunRecord& record) {
    Json parts;
    for (const auto& [name, version] : partVersions())
        parts[name] = version;
    Json energies = Json::array();
    for (const EnergySample& sample : record.samples)
        energies.push_back({{"t_s", sample.time},
                            {"kinetic_J", sample.energies.kinetic},
                            {"elastic_J", sample.energies.elastic},
                            {"gravitational_J", sample.energies.gravitational},
                            {"largest_displacement_m", sample.largestDisplacement}});
    const sim::Scene& scene = record.scene;
    Json json = {{"schema", 1},
                 {"serosa", programVersion()},
                 {"parts", std::move(parts)},
                 {"gl",
                  {{"context", gpu::contextKindName(record.gl.kind)},
                   {"vendor", record.gl.vendor},
                   {"renderer", record.gl.renderer},
                   {"version", record.gl.version},
                   {"software", record.gl.software}}},
                 {"solver", record.solver},
                 {"mapping", wordOf("look", "mapping", int(scene.look.mapping))}};
    const bool single = record.organs.size() == 1;
    if (single) {
        json["organ"] = organJson(scene.organs.front(), record.organs.front());
        json["lattice"] = latticeJson(record.organs.front());
        json["step"] = stepJson(record.organs.front().step, scene.organs.front().method);
    } else {
        json["organs"] = organsJson(record);
    }
    json["gravity_m_s2"] = vec(scene.gravity);
    json["frame_rate_Hz"] = scene.frameRate;
    json["frames_asked"] = scene.frames();
    json["frames"] = record.framesDone;
    if (record.from)
        json["from"] = {{"snapshot", record.from->snapshot},
                        {"frame", record.from->frame},
                        {"t_s", record.from->frame / scene.frameRate},
                        {"solver", record.from->solver}};
    json["end"] = record.end;
    if (single && record.organs.front().alarm)
        json["stopped"] = stoppedJson(*record.organs.front().alarm);
    json["picture_size"] = {scene.output.width, scene.output.height};
    json["pictures"] = record.picturesWritten;
    json["surfaces"] = record.surfacesWritten;
    json["snapshots"] = record.snapshotsWritten;
    json["displacements"] = record.displacementsWritten;
    if (single)
        json["binding"] = bindingJson(*record.organs.front().binding);
    if (single && record.organs.front().strokes > 0)
        json["cuts"] = cutsJson(record.organs.front());
    json["largest_displacement_m"] = record.largestDisplacement;
    if (single)
        json["inverted_cells"] = record.organs.front().invertedCells;
    json["energies"] = std::move(energies);
    json["tools"] = toolsJson(record);
    if (!scene.bodies.empty())
        json["bodies"] = bodiesJson(record);
    if (!record.contacts.empty())
        json["contacts"] = contactsJson(record);
    if (!record.threads.empty())
        json["threads"] = threadsJson(record);
    if (!record.notes.empty())
        json["notes"] = record.notes;
    json["state_hash"] = record.stateHash();
    json["timing"] = timingJson(record);
    return json;
}

} // namespace serosa::app
