// See app/tool_entry.h.
#include "app/tool_entry.h"

#include "app/organ_setup.h"
#include "sim/contact_point.h"
#include "sim/shape_distance.h"

#include <algorithm>
#include <limits>

namespace serosa::app {

namespace {

constexpr double kTouching = 0.1; // spacings: less deep counts as touching
constexpr double kSpeed = 6;      // spacings a second
constexpr double kStep = 0.5;     // spacings, between the places that are tried
constexpr int kMostSteps = 400;

/// m: of the tool moved by this, in whichever organ; negative: clear of all.
double deepestInside(const sim::RigidShape& shape, const sim::RigidPose& pose, const glm::dvec3& offset,
                     const std::vector<PlacedOrgan>& organs) {
    sim::RigidPose moved = pose;
    moved.at += offset;
    double deepest = -std::numeric_limits<double>::infinity();
    for (const PlacedOrgan& placed : organs)
        deepest = std::max(deepest, depthInside(shape, moved, *placed.lattice));
    return deepest;
}

} // namespace

double depthInside(const sim::RigidShape& metres, const sim::RigidPose& pose, const sim::Lattice& lattice) {
    const sim::RigidShape shape = sim::scaledShape(metres, 1 / lattice.spacing);
    const double thin = sim::thinnestHalfWidth(shape);
    double deepest = -1;
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
        const glm::dvec3 own = pose.toOwn(lattice.toWorld(lattice.restPosition(node))) / lattice.spacing;
        deepest = std::max(deepest, sim::contactDepthFor(lattice.restDepth(node), thin) -
                                        sim::shapeDistance(shape, own));
    }
    return deepest * lattice.spacing;
}

std::optional<ToolEntry> toolEntry(const sim::Tool& tool, const std::vector<PlacedOrgan>& organs) {
    if (tool.mode != sim::ToolMode::push || tool.live)
        return std::nullopt;
    const sim::RigidShape shape = tool.wholeShape();
    const sim::RigidPose pose = tool.poseAt(0);
    ToolEntry entry;
    double finest = std::numeric_limits<double>::infinity();
    for (const PlacedOrgan& placed : organs) {
        finest = std::min(finest, placed.lattice->spacing);
        const double deep = depthInside(shape, pose, *placed.lattice);
        if (deep > kTouching * placed.lattice->spacing && deep > entry.deep) {
            entry.deep = deep;
            entry.organ = placed.organ->name;
        }
    }
    if (entry.deep == 0)
        return std::nullopt;
    double least = kMostSteps * kStep * finest;
    for (int z = -1; z <= 1; ++z)
        for (int y = -1; y <= 1; ++y)
            for (int x = -1; x <= 1; ++x) {
                if (x == 0 && y == 0 && z == 0)
                    continue;
                const glm::dvec3 along = glm::normalize(glm::dvec3(x, y, z));
                for (double far = kStep * finest; far < least; far += kStep * finest)
                    if (deepestInside(shape, pose, far * along, organs) < 0) {
                        least = far;
                        entry.offset = far * along;
                    }
            }
    entry.time = glm::length(entry.offset) / (kSpeed * finest);
    return entry;
}

std::string entryNote(const sim::Tool& tool, const ToolEntry& entry) {
    return tool.name + " begins inside of " + entry.organ + ", " + shortNumber(1e3 * entry.deep) +
           " mm deep: " +
           (entry.time > 0 ? "it comes in from outside, until " + shortNumber(entry.time) + " s"
                           : std::string("it pushes the tissue out")) +
           "; let it begin outside";
}

std::vector<std::string> bringToolsIn(sim::Scene& scene, const std::vector<PlacedOrgan>& organs) {
    std::vector<std::string> notes;
    for (sim::Tool& tool : scene.tools) {
        const std::optional<ToolEntry> entry = toolEntry(tool, organs);
        if (!entry)
            continue;
        notes.push_back(entryNote(tool, *entry));
        if (!(entry->time > 0))
            continue;
        // Straight from key to key, also with what is added: exact.
        std::vector<sim::ToolKey> keys;
        const auto add = [&](double time) {
            const sim::RigidPose pose = tool.poseAt(time);
            sim::ToolKey key;
            key.time = time;
            key.at = pose.at + entry->offset * std::max(0.0, 1 - time / entry->time);
            key.turn = pose.turn;
            keys.push_back(key);
        };
        add(0);
        for (const sim::ToolKey& key : tool.keys)
            if (key.time > 0 && key.time < entry->time)
                add(key.time);
        add(entry->time);
        for (const sim::ToolKey& key : tool.keys)
            if (key.time > entry->time)
                keys.push_back(key);
        tool.keys = std::move(keys);
    }
    return notes;
}

} // namespace serosa::app
