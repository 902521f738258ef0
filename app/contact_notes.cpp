// See app/contact_notes.h. Depths are those that contact counts with (sim/contact_point.h), at rest.
#include "app/contact_notes.h"

#include "app/organ_setup.h"
#include "app/tool_entry.h"
#include "sim/quantity.h"
#include "sim/shape_distance.h"

#include <algorithm>

namespace serosa::app {

namespace {

constexpr double kTouching = 0.1; // spacings: less deep counts as touching

/// Nodes of an organ at rest that `first` holds when `second` closes, and that it wants, too.
std::size_t sharedNodes(const sim::Tool& first, const sim::Tool& second, const PlacedOrgan& placed) {
    const sim::RigidShape firstShape = first.wholeShape(), secondShape = second.wholeShape();
    const double closed = first.keys.front().time, closes = second.keys.front().time;
    const sim::RigidPose held = first.poseAt(closed), carried = first.poseAt(closes),
                         wants = second.poseAt(closes);
    std::size_t shared = 0;
    for (std::size_t node = 0; node < placed.lattice->nodeCount(); ++node) {
        if ((*placed.fixed)[node])
            continue;
        const glm::dvec3 own = held.toOwn(placed.lattice->toWorld(placed.lattice->restPosition(node)));
        if (sim::shapeDistance(firstShape, own) < 0 &&
            sim::shapeDistance(secondShape, wants.toOwn(carried.toWorld(own))) < 0)
            ++shared;
    }
    return shared;
}

/// Another organ or a thread may hold it.
bool isCoupled(const sim::Scene& scene, const sim::Organ& organ) {
    for (std::size_t i = 0; i < scene.organs.size(); ++i)
        if (const sim::OrganCoupling coupling = sim::couplingOf(scene, i); scene.organs[i].name == organ.name)
            return coupling.touches || coupling.tied;
    return false;
}

/// Nodes that a grasp finds where it closes, were the organs at rest; with those that are fixed.
std::size_t nodesInside(const sim::Tool& tool, const std::vector<PlacedOrgan>& organs, std::size_t& fixed) {
    const sim::RigidShape shape = tool.wholeShape();
    const sim::RigidPose pose = tool.poseAt(tool.keys.front().time);
    std::size_t inside = 0;
    fixed = 0;
    for (const PlacedOrgan& placed : organs)
        for (std::size_t node = 0; node < placed.lattice->nodeCount(); ++node)
            if (sim::shapeDistance(
                    shape, pose.toOwn(placed.lattice->toWorld(placed.lattice->restPosition(node)))) < 0) {
                ++inside;
                fixed += (*placed.fixed)[node];
            }
    return inside;
}

} // namespace

Status checkGrasps(const sim::Scene& scene, const std::vector<PlacedOrgan>& organs) {
    const auto grasps = [](const sim::Tool& tool) { return tool.mode == sim::ToolMode::grasp && !tool.live; };
    for (std::size_t i = 0; i < scene.tools.size(); ++i)
        for (std::size_t j = 0; j < scene.tools.size(); ++j) {
            const sim::Tool &first = scene.tools[i], &second = scene.tools[j];
            if (i == j || !grasps(first) || !grasps(second))
                continue;
            const double closed = first.keys.front().time, closes = second.keys.front().time;
            if (closes < closed || (closes == closed && j < i) || closes >= first.keys.back().time)
                continue;
            for (const PlacedOrgan& placed : organs)
                if (const std::size_t shared = sharedNodes(first, second, placed); shared > 0)
                    return Error{(scene.file.empty()
                                      ? ""
                                      : scene.file.string() + ":" + std::to_string(second.line) + ": ") +
                                 second.name + " closes at " +
                                 sim::formatQuantity(closes, sim::Dimension::time) + " on " +
                                 grouped(shared) + " nodes of " + placed.organ->name + " that " + first.name +
                                 " holds: a node has one holder; let " + first.name +
                                 " let go before, or hold elsewhere"};
        }
    return {};
}

std::vector<std::string> contactNotes(const sim::Scene& scene, const std::vector<PlacedOrgan>& organs) {
    std::vector<std::string> notes;
    for (const sim::Tool& tool : scene.tools) {
        if (const auto entry = toolEntry(tool, organs))
            notes.push_back(entryNote(tool, *entry));
        if (tool.mode != sim::ToolMode::grasp || tool.live)
            continue;
        std::size_t fixed = 0;
        const std::size_t inside = nodesInside(tool, organs, fixed);
        if (inside == fixed)
            notes.push_back(
                tool.name + " closes at " +
                sim::formatQuantity(tool.keys.front().time, sim::Dimension::time) +
                (inside == 0 ? " where no node rests" : " on fixed nodes alone") +
                ": it holds nothing, unless tissue has come there by then; move its first key, or take a "
                "larger shape");
        if (tool.keys.front().time > scene.duration)
            notes.push_back(tool.name + " closes after the end of the scene");
    }
    for (const PlacedOrgan& placed : organs) {
        const sim::Lattice& lattice = *placed.lattice;
        const std::string& organ = placed.organ->name;
        for (const sim::Body& body : scene.bodies)
            if (const double deep = depthInside(body.shape, body.pose, lattice);
                deep > kTouching * lattice.spacing)
                notes.push_back(body.name + " begins inside of " + organ + ", " + shortNumber(1e3 * deep) +
                                " mm deep: it pushes the tissue out; put the organ beside it");
        const bool free = std::find(placed.fixed->begin(), placed.fixed->end(), true) == placed.fixed->end();
        if (free && !isCoupled(scene, *placed.organ) && scene.gravity != glm::dvec3(0) &&
            scene.bodies.empty())
            notes.push_back("no node of " + organ + " is fixed, and there is no floor: it falls");
    }
    return notes;
}

} // namespace serosa::app
