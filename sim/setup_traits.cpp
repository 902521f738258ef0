// See sim/setup_traits.h. Lists are hashed value by value, never as the memory of a struct, whose padding has
// no value.
#include "sim/setup_traits.h"

#include "sim/byte_stream.h"
#include "sim/distance_field.h"

#include <algorithm>
#include <charconv>

namespace serosa::sim {

namespace {

/// "1234, 128 bits of hash" of a list whose values were appended to `bytes`.
std::string hashed(std::size_t count, const ByteWriter& bytes) {
    return std::to_string(count) + " (" + checksumText(checksumOf(bytes.bytes())) + ")";
}

template <class List, class Append>
std::string hashedList(const List& list, const Append& append) {
    ByteWriter bytes;
    for (const auto& value : list)
        append(bytes, value);
    return hashed(list.size(), bytes);
}

void append(ByteWriter& bytes, const glm::ivec3& point) {
    for (int axis = 0; axis < 3; ++axis)
        bytes.u32(std::uint32_t(point[axis]));
}

void addLattice(const Lattice& lattice, std::vector<Trait>& traits) {
    traits.push_back({"lattice spacing", traitValue({lattice.spacing}, "m")});
    traits.push_back({"nodes", hashedList(lattice.nodes, append)});
    traits.push_back({"cells", hashedList(lattice.cells, [](ByteWriter& bytes, const LatticeCell& cell) {
                          append(bytes, cell.grid);
                          bytes.u8(cell.fill);
                          bytes.u8(cell.material);
                      })});
    traits.push_back(
        {"lattice origin", traitValue({lattice.origin.x, lattice.origin.y, lattice.origin.z}, "m")});
    traits.push_back(
        {"lattice centre",
         traitValue({double(lattice.centre.x), double(lattice.centre.y), double(lattice.centre.z)}, "")});
    traits.push_back(
        {"connections",
         hashedList(lattice.connections, [](ByteWriter& bytes, std::uint32_t bits) { bytes.u32(bits); })});
    traits.push_back({"fills", hashedList(lattice.fills, [](ByteWriter& bytes, const auto& fills) {
                          for (const std::uint8_t fill : fills)
                              bytes.u8(fill);
                      })});
    traits.push_back({"depths", hashedList(lattice.depthSteps,
                                           [](ByteWriter& bytes, std::uint8_t depth) { bytes.u8(depth); })});
}

/// \param of "" for the tissue, else the material's name and a blank
void addMaterial(const Material& material, const std::string& of, std::vector<Trait>& traits) {
    traits.push_back({of + "young", traitValue({material.young}, "Pa")});
    traits.push_back({of + "poisson", traitValue({material.poisson}, "")});
    traits.push_back({of + "density", traitValue({material.density}, "kg/m3")});
    traits.push_back({of + "damping_time", traitValue({material.dampingTime}, "s")});
    traits.push_back(
        {of + "curve", hashedList(material.curve, [](ByteWriter& bytes, const CurvePoint& point) {
             bytes.f64(point.strain);
             bytes.f64(point.stress);
         })});
    traits.push_back({of + "strain_limit", traitValue({material.strainLimit}, "")});
    traits.push_back({of + "fibre", traitValue({material.fibre.x, material.fibre.y, material.fibre.z}, "")});
    traits.push_back({of + "fibre_young", traitValue({material.fibreYoung}, "Pa")});
}

void addTissue(const Tissue& tissue, std::vector<Trait>& traits) {
    addMaterial(tissue, "", traits);
    traits.push_back({"air_drag", traitValue({tissue.airDrag}, "1/s")});
    traits.push_back({"recovery", tissue.recovery ? "true" : "false"});
    traits.push_back({"materials", std::to_string(tissue.materialCount())});
    for (std::size_t i = 0; i < tissue.others.size(); ++i)
        addMaterial(tissue.others[i], "material " + std::to_string(i + 1) + " ", traits);
}

void addShape(const RigidShape& shape, const std::string& name, std::vector<Trait>& traits) {
    static const char* const kKinds[] = {"sphere", "capsule", "box", "hook", "half-space", "mesh"};
    traits.push_back({name + " shape", kKinds[int(shape.kind)]});
    traits.push_back({name + " length", traitValue({shape.length}, "m")});
    traits.push_back({name + " bend", traitValue({shape.bend}, "m")});
    traits.push_back({name + " middle", traitValue({shape.middle.x, shape.middle.y, shape.middle.z}, "m")});
    traits.push_back(
        {name + " half size", traitValue({shape.halfSize.x, shape.halfSize.y, shape.halfSize.z}, "m")});
    if (!shape.field)
        return;
    const glm::dvec3& lowest = shape.field->lowest();
    traits.push_back({name + " mesh", traitValue({lowest.x, lowest.y, lowest.z, shape.field->step()}, "m")});
    traits.push_back(
        {name + " mesh field", hashedList(shape.field->values(),
                                          [](ByteWriter& bytes, float value) { bytes.f64(double(value)); })});
}

void addBody(const Body& body, const std::string& name, std::vector<Trait>& traits) {
    addShape(body.shape, name, traits);
    traits.push_back({name + " radius", traitValue({body.shape.radius}, "m")});
    traits.push_back({name + " at", traitValue({body.pose.at.x, body.pose.at.y, body.pose.at.z}, "m")});
    const glm::dquat& turn = body.pose.turn;
    traits.push_back({name + " turn", traitValue({turn.w, turn.x, turn.y, turn.z}, "")});
    traits.push_back({name + " friction", traitValue({body.friction}, "")});
}

void addTool(const Tool& tool, const std::string& name, std::vector<Trait>& traits) {
    traits.push_back({name + " name", tool.name});
    traits.push_back({name + " mode", tool.mode == ToolMode::push ? "push" : "grasp"});
    traits.push_back({name + " radius", traitValue({tool.radius}, "m")});
    traits.push_back({name + " keys", hashedList(tool.keys, [](ByteWriter& bytes, const ToolKey& key) {
                          bytes.f64(key.time);
                          for (int axis = 0; axis < 3; ++axis)
                              bytes.f64(key.at[axis]);
                          for (int i = 0; i < 4; ++i)
                              bytes.f64(key.turn[i]);
                      })});
    addShape(tool.shape, name, traits);
    traits.push_back({name + " friction", traitValue({tool.friction}, "")});
    traits.push_back({name + " grip_force", traitValue({tool.gripForce}, "N")});
}

} // namespace

std::string traitValue(const std::vector<double>& numbers, const std::string& unit) {
    std::string text;
    for (const double number : numbers) {
        char digits[32];
        text += text.empty() ? "" : " ";
        text.append(digits,
                    std::to_chars(digits, digits + sizeof digits, number, std::chars_format::general).ptr);
    }
    return text + (unit.empty() ? "" : " " + unit);
}

std::vector<Trait> setupTraits(const SolverSetup& setup) {
    std::vector<Trait> traits;
    addTissue(setup.tissue, traits);
    traits.push_back({"gravity", traitValue({setup.gravity.x, setup.gravity.y, setup.gravity.z}, "m/s2")});
    addLattice(*setup.lattice, traits);
    traits.push_back({"time step", traitValue({setup.timeStep}, "s")});
    std::vector<bool> fixed = setup.fixed;
    fixed.resize(setup.lattice->nodeCount(), false); // no list is a list of none
    ByteWriter bytes;
    for (const bool one : fixed)
        bytes.u8(one ? 1 : 0);
    traits.push_back(
        {"fixed nodes", hashed(std::size_t(std::count(fixed.begin(), fixed.end(), true)), bytes)});
    // A hand's tools are no part of a scene, and change nothing while they rest.
    traits.push_back({"tools", std::to_string(std::count_if(setup.tools.begin(), setup.tools.end(),
                                                            [](const Tool& tool) { return !tool.live; }))});
    for (std::size_t i = 0; i < setup.tools.size(); ++i)
        if (!setup.tools[i].live)
            addTool(setup.tools[i], "tool " + std::to_string(i + 1), traits);
    traits.push_back({"bodies", std::to_string(setup.bodies.size())});
    for (std::size_t i = 0; i < setup.bodies.size(); ++i)
        addBody(setup.bodies[i], "body " + std::to_string(i + 1), traits);
    traits.push_back({"method", setup.method == StepMethod::implicit ? "implicit" : "explicit"});
    return traits;
}

std::optional<std::string> firstDifference(const std::vector<Trait>& saved, const std::vector<Trait>& here) {
    const auto find = [](const std::vector<Trait>& traits, const std::string& name) {
        return std::find_if(traits.begin(), traits.end(),
                            [&name](const Trait& trait) { return trait.name == name; });
    };
    for (const Trait& trait : saved) {
        const auto same = find(here, trait.name);
        if (same == here.end())
            return trait.name + " is " + trait.value + " in the snapshot, nothing here";
        if (same->value != trait.value)
            return trait.name + " is " + trait.value + " in the snapshot, " + same->value + " here";
    }
    for (const Trait& trait : here)
        if (find(saved, trait.name) == saved.end())
            return trait.name + " is " + trait.value + " here, nothing in the snapshot";
    return std::nullopt;
}

} // namespace serosa::sim
