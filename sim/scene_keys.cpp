// The list of scene keys. A default stands here as text for the reader and in sim/scene.h as a value for the
// program; a test holds the two equal.

#include "sim/scene_keys.h"

#include "shaders/shared_constants.h"
#include "sim/lod.h"
#include "sim/scene.h"
#include "sim/scene_key_makers.h"

#include <iterator>

namespace serosa::sim {

namespace {

void add(std::vector<SceneKey>& keys, std::vector<SceneKey> more) {
    keys.insert(keys.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

/// What a material is: of `[organ.tissue]`, with defaults, and of `[[organ.material]]`, without: there the
/// tissue is the default.
std::vector<SceneKey> lawKeys(const char* table, bool defaults) {
    const auto fallback = [defaults](const char* text) { return defaults ? text : ""; };
    return {
        quantity(table, "young", Dim::pressure, {0, 1e12, true}, fallback("\"5 kPa\""),
                 "Young's modulus (with fibres: across them); not beside `curve`"),
        plain(table, "curve", Kind::tables, kAny, "",
              "nominal stress over strain under tension, from (0, 0) through these points; the first gives "
              "Young's modulus; both rise; 9 points at most, 8 beside a strain limit"),
        plain(table, "strain_limit", Kind::number, kNotNegative, fallback("0"),
              "from this strain on ten times as stiff as just before; beyond the curve's last point but one; "
              "0: none"),
        plain(table, "poisson", Kind::number, {-1, 0.5}, fallback("0.25"),
              "Poisson's ratio, 0.25 to 0.495; above 0.25 a step costs more and is shorter (0.49: a "
              "quarter)"),
        quantity(table, "density", Dim::density, {0, 1e6, true}, fallback("\"1000 kg/m3\""),
                 "mass of a volume"),
        quantity(table, "damping_time", Dim::time, kNotNegative, fallback("\"0.5 ms\""),
                 "damping along springs: c = damping_time * k"),
        plain(table, "fibre", Kind::number3, kAny, "",
              "direction of fibres, any length; needs `fibre_young`"),
        quantity(table, "fibre_young", Dim::pressure, {0, 1e12, true}, "",
                 "Young's modulus along the fibres, not below the one across; equal: no fibres"),
    };
}

/// Where a region lies.
std::vector<SceneKey> placeKeys(const char* table) {
    return {
        word(table, "axis", {"x", "y", "z"}, "\"y\"", "half-space: the axis that it cuts"),
        quantity(table, "below", Dim::length, kAny, "", "half-space: where the coordinate is less"),
        quantity(table, "above", Dim::length, kAny, "", "half-space: where the coordinate is greater"),
        quantity(table, "min", Dim::length, kAny, "", "box: lowest corner", Kind::quantity3),
        quantity(table, "max", Dim::length, kAny, "", "box: highest corner", Kind::quantity3),
        quantity(table, "centre", Dim::length, kAny, "", "sphere: centre", Kind::quantity3),
        quantity(table, "radius", Dim::length, kPositive, "", "sphere: radius"),
    };
}

std::vector<SceneKey> generalKeys() {
    return {
        plain("", "schema", Kind::integer, {1, 1}, nullptr, "version of this format"),
        quantity("", "frame_rate", Dim::frequency, {0.001, 1e6}, "\"60 Hz\"",
                 "pictures a second of simulated time"),
        quantity("", "duration", Dim::time, kPositive, "\"2 s\"",
                 "simulated time; rounded to whole frames, at least one"),
        quantity("", "gravity", Dim::acceleration, kAny, "[\"0 m/s2\", \"-9.81 m/s2\", \"0 m/s2\"]",
                 "acceleration of gravity, y is up", Kind::quantity3),
        plain("", "organs_touch", Kind::boolean, kAny, "false",
              "organs push each other where they meet (see Organs that touch above); else they pass through "
              "each other"),
        plain("", "organ_friction", Kind::number, kNotNegative, "0",
              "Coulomb's coefficient where organs touch each other or themselves"),
        plain("", "organ", Kind::tables, kAny, nullptr, "the organs, one to eight"),
        plain("", "tool", Kind::tables, kAny, "", "the scripted tools, at most seven"),
        plain("", "body", Kind::tables, kAny, "",
              "what is rigid and does not move: floors, tables, bones; with the tools at most twelve"),
        plain("", "thread", Kind::tables, kAny, "",
              "threads and clips, each between two places of organs; at most 64"),
        plain("", "cut", Kind::tables, kAny, "", "the scripted cuts; they cut every organ that they meet"),
        plain("", "camera", Kind::table, kAny, "", "how it is looked at"),
        plain("", "light", Kind::table, kAny, "", "how it is lit"),
        plain("", "look", Kind::table, kAny, "", "what is drawn"),
        plain("", "deformation", Kind::tables, kAny, "",
              "deformations of what is ray-cast, one after the other; needs look.show = \"implicit\""),
        plain("", "output", Kind::table, kAny, "", "what is written"),

        plain("organ", "name", Kind::text, kAny, "\"organ\"",
              "what messages and files call it; several organs need a name each"),
        plain("organ", "model", Kind::text, kAny, nullptr,
              "closed surface: OBJ, PLY, OFF, STL, VTK or TetGen (docs/import.md); the path is relative to "
              "the scene file"),
        word("organ", "length_unit", unitNames(Dim::length), nullptr, "unit of the model's coordinates"),
        quantity("organ", "at", Dim::length, kAny, "[\"0 mm\", \"0 mm\", \"0 mm\"]",
                 "where the model's origin lies in the world", Kind::quantity3),
        word("organ", "up_axis", {"y", "x", "z", "-y", "-x", "-z"}, "\"y\"",
             "axis of the model that points up; the model is turned, and deformed surfaces turned back"),
        plain("organ", "repair", Kind::boolean, kAny, "false",
              "mend winding, small holes, duplicate faces, stray vertices (docs/import.md)"),
        plain("organ", "nodes", Kind::integer, {8, 1e9}, "20000",
              "lattice nodes aimed at; not beside `spacing`"),
        quantity("organ", "spacing", Dim::length, kPositive, "", "lattice spacing, instead of `nodes`"),
        plain(
            "organ", "tear_strain", Kind::number, kPositive, "",
            "springs longer than (1 + this) times their rest length tear, frame by frame; not beside a pose"),
        plain("organ", "self_contact", Kind::boolean, kAny, "false",
              "parts of it that meet push each other: steps take some 25 times as long; not beside a pose"),
        plain("organ", "tissue", Kind::table, kAny, "", "what it is made of"),
        plain("organ", "material", Kind::tables, kAny, "",
              "further materials, at most 15 (see Materials above); not beside a pose"),
        plain("organ", "region", Kind::tables, kAny, "", "cells of these materials; a later region wins"),
        plain("organ", "fixed", Kind::tables, kAny, "", "regions whose nodes do not move"),
        plain("organ", "pose", Kind::table, kAny, "", "a given motion instead of a simulated one"),
        plain("organ", "look", Kind::table, kAny, "", "what its surface looks like from near"),
        word("organ", "method", {"explicit", "implicit"}, "\"explicit\"",
             "how it steps: as many steps a frame as are stable, or one a frame whatever the stiffness "
             "(see Stiff organs above); not beside a pose"),
        plain(
            "organ", "levels", Kind::integer, {1, kMostLevels}, "1",
            "levels of detail: lattices of the spacing, twice and four times it, one of which is simulated; "
            "not beside a pose"),
        word("organ", "level_of_detail", {"scripted", "auto"}, "\"scripted\"",
             "which: as `[[organ.level]]` says, 1 without; or by what happens to the organ "
             "(docs/methods/lod.md)"),
        plain("organ", "level", Kind::tables, kAny, "",
              "changes of level; a cut organ stays on its level, and a tool that holds tissue lets go first"),
    };
}

/// Below an organ's own keys.
std::vector<SceneKey> organKeys() {
    std::vector<SceneKey> keys = lawKeys("organ.tissue", true);
    add(keys,
        {
            quantity("organ.tissue", "air_drag", Dim::rate, kNotNegative, "\"0 1/s\"",
                     "drag on a node's velocity"),
            plain("organ.tissue", "recovery", Kind::boolean, kAny, "false",
                  "cells that are pressed below 40% of their volume, or turned inside out, push back: a "
                  "deep push leaves no folds behind; costs a pass"),
        });
    add(keys, {plain("organ.material", "name", Kind::text, kAny, nullptr,
                     "what regions and reports call it; \"tissue\" is the name of `[organ.tissue]`")});
    add(keys, lawKeys("organ.material", false));
    add(keys, {plain("curve", "strain", Kind::number, kPositive, nullptr, "extension over length at rest"),
               quantity("curve", "stress", Dim::pressure, {0, 1e12, true}, nullptr,
                        "force over the area at rest")});
    add(keys, {plain("organ.region", "material", Kind::text, kAny, nullptr,
                     "name of an `[[organ.material]]`, or \"tissue\""),
               word("organ.region", "shape", {"half-space", "box", "sphere", "layer", "painted"}, nullptr,
                    "kind of region; the first three hold a cell by its centre")});
    add(keys, placeKeys("organ.region"));
    add(keys,
        {quantity("organ.region", "depth", Dim::length, kPositive, "",
                  "layer: cells whose centre lies at most so deep below the surface, cavities' walls "
                  "included; painted: how deep the paint reaches, without it to the middle"),
         quantity("organ.region", "from", Dim::length, kNotNegative, "\"0 mm\"",
                  "layer, painted: only deeper than this; at 0 the outermost cells always belong"),
         plain("organ.region", "colour", Kind::integer3, {0, 255}, "",
               "painted: sRGB of the model's vertices; cells whose nearest point of the surface has it"),
         plain("organ.region", "tolerance", Kind::integer, {0, 255}, "8",
               "painted: each channel of the colour may differ by so much")});
    add(keys,
        {word("organ.fixed", "shape", {"half-space", "box", "sphere", "lowest"}, nullptr, "kind of region")});
    add(keys, placeKeys("organ.fixed"));
    add(keys,
        {
            plain("organ.fixed", "share", Kind::number, kShare, "",
                  "lowest: this share of the organ's height, from below"),

            quantity(
                "organ.pose", "bend_radius", Dim::length, kPositive, nullptr,
                "all nodes follow a bend about the z axis, from straight to this radius over the run; the "
                "ends go down"),

            word("organ.look", "texture", {"none", "heart-muscle", "fat", "liver-capsule", "kidney"},
                 "\"none\"",
                 "a texture made by the program, in rest space; of a model with colours of its own it gives "
                 "the pattern alone"),
            plain("organ.look", "albedo", Kind::text, kAny, "",
                  "instead: a picture (PNG) of the colour; the path is relative to the scene file; sides are "
                  "powers "
                  "of two, 4 to 4096; not beside `texture`"),
            plain("organ.look", "normal", Kind::text, kAny, "",
                  "a normal map (PNG, blue away from the surface) of the same size"),
            plain(
                "organ.look", "height", Kind::text, kAny, "",
                "a height map (PNG, white highest) of the same size; without it the relief is flat, without "
                "`normal` it gives the normals"),
            quantity(
                "organ.look", "tile", Dim::length, kPositive, "\"24 mm\"",
                "how far the texture goes before it repeats, where the model has no texture coordinates"),
            quantity("organ.look", "relief", Dim::length, kNotNegative, "\"0.4 mm\"",
                     "from the lowest to the highest of the height"),

            quantity("organ.level", "t", Dim::time, kNotNegative, nullptr, "from when on"),
            plain("organ.level", "level", Kind::integer, {1, kMostLevels}, nullptr,
                  "1: the lattice of `spacing` or `nodes`; 2, 3: coarser ones"),
        });
    return keys;
}

/// Where a shape stands: of a tool's key and of a body.
std::vector<SceneKey> turnKeys(const char* table) {
    return {
        plain(table, "along", Kind::number3, kAny, "",
              "direction of its own z axis, from its tip along its shaft: it is turned there the shortest "
              "way from [0, 0, 1]"),
        plain(table, "axis", Kind::number3, kAny, "",
              "then it is turned about this direction of the world, by `angle`"),
        quantity(table, "angle", Dim::angle, {-360, 360}, "", "right-handed about `axis`"),
    };
}

std::vector<SceneKey> meshKeys(const char* table) {
    return {
        plain(table, "model", Kind::text, kAny, "",
              "mesh: a closed surface (docs/import.md), in its own frame; at most 50,000 faces"),
        word(table, "length_unit", unitNames(Dim::length), "", "mesh: unit of its coordinates"),
    };
}

std::vector<SceneKey> toolKeys() {
    std::vector<SceneKey> keys{
        plain("tool", "name", Kind::text, kAny, "", "what messages call it"),
        word("tool", "kind", {"sphere", "capsule", "box", "blade", "hook", "jaws", "mesh"}, "\"sphere\"",
             "its shape (see Tools and bodies above)"),
        quantity("tool", "radius", Dim::length, kPositive, "\"5 mm\"",
                 "sphere, capsule, hook: of the ball, rod or wire; box: of its rounded edges, by default a "
                 "tenth of its least side"),
        quantity("tool", "length", Dim::length, kPositive, "",
                 "capsule: between the middles of its round ends; blade, jaws: from the tip on; hook: of its "
                 "straight shank, by default four times `bend`"),
        quantity("tool", "bend", Dim::length, kPositive, "",
                 "hook: radius of its half circle, to the wire's middle"),
        quantity("tool", "size", Dim::length, kPositive, "", "box: its three sides", Kind::quantity3),
        quantity("tool", "width", Dim::length, kPositive, "", "blade, jaws: along its own x axis"),
        quantity("tool", "thickness", Dim::length, kPositive, "\"1 mm\"",
                 "blade: along its own y axis; its edges are round"),
        quantity("tool", "opening", Dim::length, kPositive, "",
                 "jaws: between the pads, along its own y axis"),
    };
    add(keys, meshKeys("tool"));
    add(keys,
        {word("tool", "mode", {"push", "grasp"}, "\"push\"",
              "push: the organ stays outside; grasp: holds the nodes inside it from its first key to its "
              "last; jaws always grasp"),
         plain("tool", "friction", Kind::number, kNotNegative, "0",
               "push: Coulomb's coefficient against tissue"),
         quantity("tool", "grip_force", Dim::force, kPositive, "",
                  "grasp: pulled harder than this it slips; without it, it never does"),
         plain("tool", "keys", Kind::tables, kAny, nullptr,
               "poses with strictly increasing times; grasp needs two"),
         quantity("tool.keys", "t", Dim::time, kNotNegative, nullptr, "time of the pose"),
         quantity("tool.keys", "at", Dim::length, kAny, nullptr,
                  "where its reference point is then: a sphere's or box's centre, a tip's middle",
                  Kind::quantity3)});
    add(keys, turnKeys("tool.keys"));
    return keys;
}

std::vector<SceneKey> bodyKeys() {
    std::vector<SceneKey> keys{
        plain("body", "name", Kind::text, kAny, "", "what messages call it"),
        word("body", "kind", {"floor", "box", "sphere", "capsule", "mesh"}, nullptr, "its shape"),
        quantity("body", "height", Dim::length, kAny, "",
                 "floor: all below this height is solid; not beside `at` or `normal`"),
        quantity("body", "at", Dim::length, kAny, "",
                 "its reference point: a sphere's or box's centre, a capsule's tip, any point of a floor",
                 Kind::quantity3),
        plain("body", "normal", Kind::number3, kAny, "[0, 1, 0]", "floor: points out of it"),
        quantity(
            "body", "radius", Dim::length, kPositive, "",
            "sphere, capsule: required; box: of its rounded edges, by default a tenth of its least side"),
        quantity("body", "length", Dim::length, kPositive, "",
                 "capsule: between the middles of its round ends"),
        quantity("body", "size", Dim::length, kPositive, "", "box: its three sides", Kind::quantity3),
    };
    add(keys, meshKeys("body"));
    add(keys, turnKeys("body"));
    add(keys,
        {plain("body", "friction", Kind::number, kNotNegative, "0", "Coulomb's coefficient against tissue")});
    return keys;
}

std::vector<SceneKey> threadKeys() {
    return {
        plain("thread", "name", Kind::text, kAny, "", "what messages call it"),
        word("thread", "kind", {"thread", "clip"}, "\"thread\"",
             "thread: keeps its ends at most `length` apart; clip: exactly so"),
        quantity("thread", "t", Dim::time, kNotNegative, "\"0 s\"", "tied then"),
        quantity("thread", "length", Dim::length, kPositive, "",
                 "between its ends; without it, as far as the two places lie apart at rest"),
        quantity("thread", "tightening", Dim::time, kNotNegative, "\"0 s\"",
                 "time in which it is drawn in to its length; by at most 0.05 spacings a step in any case"),
        quantity("thread", "strength", Dim::force, kPositive, "",
                 "force that it carries: above, it breaks; without it, it never does"),
        plain("thread", "ends", Kind::tables, kAny, nullptr, "its two ends"),
        plain("thread.ends", "organ", Kind::text, kAny, "",
              "name of the organ that it is tied to; a scene of one organ needs none"),
        quantity("thread.ends", "at", Dim::length, kAny, nullptr,
                 "place in the world, as the organ rests: in it, or at most a spacing outside",
                 Kind::quantity3),
    };
}

std::vector<SceneKey> otherKeys() {
    return {
        word(
            "cut", "kind", {"blade", "cauterize"}, "\"blade\"",
            "blade: an edge that cuts what it sweeps over from key to key; cauterize: burns a ball of tissue "
            "away at each key"),
        quantity("cut", "radius", Dim::length, kPositive, "\"3 mm\"", "cauterize: radius of the ball"),
        plain("cut", "keys", Kind::tables, kAny, nullptr,
              "poses with strictly increasing times; a blade needs two"),
        quantity("cut.keys", "t", Dim::time, kNotNegative, nullptr, "time of the pose"),
        quantity("cut.keys", "at", Dim::length, kAny, nullptr,
                 "one end of the blade's edge then; cauterize: the ball's centre", Kind::quantity3),
        quantity("cut.keys", "end", Dim::length, kAny, "", "blade: the other end of its edge",
                 Kind::quantity3),

        word("camera", "projection", {"perspective", "orthographic"}, "\"perspective\"", "kind of camera"),
        quantity("camera", "eye", Dim::length, kAny, "",
                 "where it stands; without it, it is framed on all organs", Kind::quantity3),
        quantity("camera", "target", Dim::length, kAny, "",
                 "what it looks at; without it, the middle of all organs", Kind::quantity3),
        plain("camera", "direction", Kind::number3, kAny, "[-0.25, -0.15, -1]",
              "where it looks to; not beside `eye`"),
        plain("camera", "up", Kind::number3, kAny, "[0, 1, 0]", "up in the picture"),
        quantity("camera", "fov", Dim::angle, {1, 170}, "\"0.5 rad\"", "perspective: vertical field of view"),
        quantity("camera", "height", Dim::length, kPositive, "",
                 "orthographic: vertical extent of the picture"),
        plain("camera", "zoom", Kind::number, {0.001, 1000}, "1",
              "enlarges the framing; not beside `eye` or `height`"),

        plain("light", "direction", Kind::number3, kAny, "[-0.4, -0.8, -0.6]", "where it shines to"),
        plain("light", "intensity", Kind::number, {0, 100}, "1", "of the direct light"),
        plain("light", "ambient", Kind::number, {0, 100}, "1", "of the light from all around"),

        word("look", "mapping",
             {"one-to-one", "triangle", "curvature", "chosen", "normal-offset", "trilinear", "node-frames"},
             "\"curvature\"", "how the surface follows the lattice (docs/methods/mappings.md)"),
        word("look", "colour", {"tissue", "dynamic-normal", "material", "plain"}, "\"tissue\"",
             "what the surface is coloured by; material: by the material of the cell at each vertex; plain: "
             "its own "
             "colour, evenly lit by the key light alone"),
        word("look", "show", {"surface", "implicit", "both"}, "\"surface\"",
             "what is drawn of organs: the surface; its distance field, ray-cast; or both: the surface, as "
             "`trilinear` maps it, and what is ray-cast closes its cuts (docs/methods/raycast.md)"),
        word("look", "stage", {"whole", "mesh", "box", "composite"}, "\"whole\"",
             "implicit: all is ray-cast, or only what lies in the deformation's box: the surface without it, "
             "the box alone, both together"),
        word("look", "interior", {"hollow", "solid", "shell", "combined"}, "\"solid\"",
             "implicit: what is seen where it is cut open; combined: hollow, by one implicit of organ and "
             "cut, which misses what is thin beside a sharp cut: for comparison"),
        quantity("look", "shell", Dim::length, kPositive, "\"8 mm\"", "implicit: thickness of a shell"),
        word("look", "field", {"distance", "depth", "depth-cube"}, "\"distance\"",
             "implicit: what the organ at rest is taken from: its distance field; depth maps from both ends "
             "of "
             "an axis, or from all six sides, which take less memory and fill what they do not see into"),
        word("look", "depth_axis", {"x", "y", "z"}, "\"z\"", "field \"depth\": the axis of its maps"),
        plain("look", "field_samples", Kind::integer, {16, 512}, "96",
              "implicit: samples of the field along the organ's longest side"),
        word("look", "search", {"linear", "threshold", "jacobian"}, "\"jacobian\"",
             "implicit: how far a ray's samples lie apart: evenly, nearer within 0.04 of the organ's longest "
             "side of its surface, or evenly at rest"),
        plain("look", "search_step", Kind::number, {0.05, 8}, "0.5",
              "implicit: between samples, of a sample of the field"),
        plain(
            "look", "skip_empty", Kind::boolean, kAny, "true",
            "implicit: skip space in which a ray meets nothing; with depth maps, only what a cut takes away"),
        plain(
            "look", "coarse_sampling", Kind::boolean, kAny, "true",
            "implicit: samples lie no nearer than the picture shows: half a pixel, and of what moves fast on "
            "the screen half of its way in a frame; nothing changes where search_step is longer than that"),
        plain(
            "look", "proxy_cells", Kind::integer, {2, 96}, "16",
            "implicit: cells of what deformations by vertices move, along an organ's longest side, each cut "
            "into six tetrahedra"),
        word("look", "normals", {"warped", "gradient"}, "\"warped\"",
             "implicit: the normal at rest, carried by the map's Jacobian; or the gradient of the deformed "
             "field, for comparison"),
        plain("look", "antialias", Kind::boolean, kAny, "false",
              "implicit: a ray for each sample of a pixel, not for its middle: smooth outlines, for as many "
              "times the work"),
        plain("look", "cut_volume", Kind::table, kAny, "",
              "implicit, both: a volume that colours the faces of cuts"),
        plain("look", "surface", Kind::boolean, kAny, "true", "draw the surface"),
        plain("look", "lattice", Kind::boolean, kAny, "false", "draw the springs"),
        plain("look", "tools", Kind::boolean, kAny, "true", "draw tools, bodies and threads"),
        quantity("look", "section_at", Dim::length, kAny, "",
                 "a point of a plane that shows the inside: the surface beyond it is not drawn",
                 Kind::quantity3),
        plain("look", "section_normal", Kind::number3, kAny, "[0, 0, 1]",
              "points from the plane to what is not drawn"),
        plain("look", "shadows", Kind::boolean, kAny, "false",
              "organs and tools throw shadows under the light"),
        plain("look", "occlusion", Kind::boolean, kAny, "false",
              "what lies close together is darker, found anew in each picture"),
        plain("look", "blood", Kind::boolean, kAny, "true", "a film of blood beside cuts"),

        plain("output", "size", Kind::integer2, {16, 16384}, "[960, 960]",
              "width and height of pictures in pixels"),
        quantity("output", "surfaces_at", Dim::time, kNotNegative, "[]",
                 "times at which deformed surfaces are written", Kind::quantityList),
        quantity("output", "snapshots_at", Dim::time, kNotNegative, "[]",
                 "times at which the whole state is written, to go on from (docs/snapshots.md)",
                 Kind::quantityList),
        quantity("output", "displacements_at", Dim::time, kNotNegative, "[]",
                 "times at which each node's displacement is written, as a vector image and as points "
                 "(docs/snapshots.md)",
                 Kind::quantityList),
        word("output", "displacement_format", {"nrrd", "mha"}, "\"nrrd\"",
             "of the vector images: NRRD or MetaImage"),
        plain("output", "frame_every", Kind::integer, {1, 1e6}, "1", "a picture every so many frames"),
        plain("output", "sheet_columns", Kind::integer, {1, 16}, "4", "columns of the contact sheet"),
        plain("output", "sheet_rows", Kind::integer, {1, 16}, "3", "rows of the contact sheet"),
        quantity("output", "sheet_at", Dim::time, kNotNegative, "[]",
                 "times on the contact sheet; empty: evenly spread", Kind::quantityList),
        plain("output", "turntable", Kind::integer, {0, 64}, "0",
              "so many views around the organs at the end, on `turntable.png`"),
    };
}

std::vector<SceneKey> makeKeys() {
    std::vector<SceneKey> keys = generalKeys();
    add(keys, organKeys());
    add(keys, toolKeys());
    add(keys, bodyKeys());
    add(keys, threadKeys());
    add(keys, otherKeys());
    add(keys, cutVolumeKeys());
    add(keys, deformationKeys());
    return keys;
}

} // namespace

const std::vector<SceneKey>& sceneKeys() {
    static const std::vector<SceneKey> keys = makeKeys();
    return keys;
}

const SceneKey* findSceneKey(const std::string& table, const std::string& name) {
    for (const SceneKey& key : sceneKeys())
        if (table == key.table && name == key.name)
            return &key;
    return nullptr;
}

std::vector<std::string> keyNames(const std::string& table) {
    std::vector<std::string> names;
    for (const SceneKey& key : sceneKeys())
        if (table == key.table)
            names.emplace_back(key.name);
    return names;
}

static_assert(SRS_MAX_TOOLS == 7, "the meaning of [[tool]] names the limit");
static_assert(SRS_MAX_COLLIDERS == 12, "the meaning of [[body]] names the limit");
static_assert(SRS_MAX_MATERIALS == 16, "the meaning of [[organ.material]] names the limit");
static_assert(SRS_CURVE_BREAKS == 8 && SRS_LIMIT_STIFFENING == 10.0,
              "the meanings of curve and strain_limit name the limits");
static_assert(SRS_MAX_THREADS == 64 && SRS_THREAD_PULL == 0.05, "the meanings of [[thread]] name the limits");
static_assert(kMostOrgans == 8, "the meaning of [[organ]] names the limit");

} // namespace serosa::sim
