// Scene keys of deformations of what is ray-cast.
#include "sim/scene_key_makers.h"

namespace serosa::sim {

std::vector<SceneKey> deformationKeys() {
    return {
        word("deformation", "kind",
             {"twist", "bend", "pull", "peel", "wave", "knife", "seam", "incision", "sphere", "box", "points",
              "image", "texture"},
             nullptr, "which map (docs/methods/raycast.md)"),
        word("deformation", "by", {"pixels", "vertices"}, "\"pixels\"",
             "which stage does it: ray by ray; or twist, bend, pull, wave: forward, at the corners of "
             "tetrahedra (look.proxy_cells), after all that pixels do"),
        plain("deformation", "organs", Kind::texts, kAny, "",
              "names of the organs that it is of; all of them where absent"),
        quantity("deformation", "at", Dim::length, kAny, nullptr, "middle of its box", Kind::quantity3),
        quantity("deformation", "size", Dim::length, kPositive, "",
                 "lengths of its box along its own axes; a file has its own, else it is needed",
                 Kind::quantity3),
        plain("deformation", "up", Kind::number3, kAny, "[0, 1, 0]", "its own y axis, any length"),
        plain("deformation", "along", Kind::number3, kAny, "[1, 0, 0]",
              "its own x axis, as far as `up` leaves it"),
        quantity("deformation", "angle", Dim::angle, {-5000, 5000}, "", "twist, bend: how far"),
        quantity("deformation", "amount", Dim::length, kAny, "",
                 "pull, wave: how high, along y; knife, seam, incision: half of the opening; peel: x of the "
                 "line to which it is peeled"),
        quantity("deformation", "radius", Dim::length, kPositive, "",
                 "pull: of the bump; peel: of the roll; sphere: its own"),
        quantity("deformation", "extent", Dim::length, kPositive, "",
                 "bend: the range that turns; wave: its length; knife, seam: the cut's, along z; box: along "
                 "its x axis"),
        quantity("deformation", "depth", Dim::length, kPositive, "",
                 "knife, seam, incision: of the cut, from the top face of its box; peel: of the ground above "
                 "the box's bottom; box: along y"),
        quantity("deformation", "width", Dim::length, kPositive, "",
                 "peel: of the flap; incision: of the tissue that gives way; box: along z"),
        plain("deformation", "narrow", Kind::boolean, kAny, "false", "pull: ends at its radius"),
        quantity("deformation", "wound", Dim::length, kPositive, "",
                 "the box is wound around a cylinder of this radius about its y axis: round cuts"),
        plain("deformation", "texels", Kind::integer3, {1, 512}, "[64, 64, 64]", "of its texture"),
        word("deformation", "format", {"bytes", "half", "single"}, "\"half\"", "4, 8 or 16 bytes a texel"),
        plain("deformation", "path", Kind::tables, kAny, "",
              "incision: { x, z } along which it runs, in the box's own axes from its middle"),
        plain("deformation", "points", Kind::tables, kAny, "",
              "points: { from, to } in the box's own axes, from its middle"),
        quantity("deformation", "reach", Dim::length, kPositive, "", "points: how far each of them counts"),
        plain("deformation", "file", Kind::text, kAny, "",
              "image: a forward displacement of millimetres in a vector NRRD or MetaImage; texture: what "
              "`serosa scene deformation` wrote; relative to the scene file"),
        plain(
            "deformation", "keys", Kind::tables, kAny, "",
            "where it goes: { t, at, turn, scale }; times increase, and between two of them it moves evenly"),
        quantity("deformation.path", "x", Dim::length, kAny, nullptr, "along its own x axis"),
        quantity("deformation.path", "z", Dim::length, kAny, nullptr, "along its own z axis"),
        quantity("deformation.points", "from", Dim::length, kAny, nullptr, "where it rests", Kind::quantity3),
        quantity("deformation.points", "to", Dim::length, kAny, nullptr, "where it is moved to",
                 Kind::quantity3),
        quantity("deformation.keys", "t", Dim::time, kNotNegative, nullptr, "when"),
        quantity("deformation.keys", "at", Dim::length, kAny, "",
                 "middle of its box; the table's where absent", Kind::quantity3),
        quantity("deformation.keys", "turn", Dim::angle, {-5000, 5000}, "\"0 deg\"", "about its own y axis"),
        plain("deformation.keys", "scale", Kind::number, kPositive, "1",
              "of its box, and of all that it does"),
    };
}

std::vector<SceneKey> cutVolumeKeys() {
    const char* const table = "look.cut_volume";
    return {
        plain(table, "file", Kind::text, kAny, nullptr,
              "a volume of one number a voxel, or of three that are colours (.nrrd, .mha, .nii, .nii.gz) in "
              "millimetres, with its own "
              "origin, spacing and direction; the path is relative to the scene file"),
        quantity(table, "at", Dim::length, kAny, "[\"0 mm\", \"0 mm\", \"0 mm\"]",
                 "where the zero of its coordinates lies in the world", Kind::quantity3),
        word(table, "up_axis", {"y", "x", "z", "-y", "-x", "-z"}, "\"y\"",
             "axis of its coordinates that points up, as of `[[organ]]`; ITK's z leads to the head"),
        plain(table, "level", Kind::number, kAny, "40", "grey values: middle of the window (CT: HU)"),
        plain(table, "width", Kind::number, kPositive, "400",
              "grey values: from the darkest to the lightest"),
        plain(table, "label", Kind::tables, kAny, "",
              "of a map of labels: colours of its values; others have the colours of cut muscle"),
        plain("look.cut_volume.label", "value", Kind::integer, {0, 65535}, nullptr, "in the volume"),
        plain("look.cut_volume.label", "colour", Kind::integer3, {0, 255}, nullptr, "sRGB"),
    };
}

} // namespace serosa::sim
