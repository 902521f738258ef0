#pragma once
// Closed-form deformations for the deformation shader (CS07 section 4): inverse displacements D on a box of
// texture space, which take a shown point p' to rest, p = p' + D(p'), and what a map's own mask keeps.
//
// Texture space has the box's own axes, its origin in the box's middle, and the unit of the object (m): the
// box is |q| <= half. Each map says on which faces of the box nothing moves: there, and only there, the box
// may cross the object.
//
//   twist  y is the axis: turns by amount s(y) w(r), s from 0 at the lowest face to 1 at the top. CS07 takes
//          -D_F for the inverse, which is wrong by 27% of the radius at 30 degrees; the angle depends on y
//          and r only, which a turn keeps, so that the exact inverse is the turn back.
//   bend   Barr 1984, Global and local deformations of solid primitives, section 3.5: the range of y between
//          -extent/2 and extent/2 turns by amount about z, towards +x (negative: -x); what is above it turns
//          as a whole.
//   pull   y = y' - amount g(r) s(y'): a bump or a spike of the given radius, g Gaussian or narrow.
//   wave   y = y' - amount sin(2 pi x' / extent) w(x', z') s(y').
//   peel   the layer above y = -half.y + depth, where |z| < width/2 and x > amount (the line to which it is
//          peeled), rolls off its ground upwards on a cylinder of `radius`, by 1.25 pi, and runs straight on.
//          The layer is at most 0.95 radius thick; above it the box has room for the roll.
//          The same as Barr's bend; the mask tells the flap, the bared ground and the empty place of the
//          layer apart.
//   knife  opens a cut in the plane x = 0 from the top down to `depth`, of length `extent` along z, by
//          +-amount o(y, z), a lens along z and a wedge along y: |x| = (|x'| - o) w / (w - o), w = half.x.
//   seam   the same, zipped open from the +z face to z = half.z - extent.
//   incision  the same along a path in x and z, from its first place to its last: tissue gives way over
//          `width`, half of it to either side, to where the nearest place of the path is. Where that jumps
//          (inside of a bend narrower than that), so does D.
//   sphere, box  cut away what lies in a ball of `radius`, or in a box of extent x depth x width, in the
//          middle; nothing moves (CSG).
//
// The papers give no formula for peel, wave, knife, seam and incision: these are ours. In the gap of a cut D
// leads to its middle, so that it stays continuous, and the mask says that nothing is there.

#include "sim/scene.h"

#include <glm/glm.hpp>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace serosa::render {

using MapKind = sim::DeformationKind;

enum class PullProfile { gaussian, narrow };

struct DeformationMap {
    MapKind kind = MapKind::twist;
    glm::dvec3 half{0.5}; // of the box, m
    double amount = 0;    // radians (twist, bend) or m
    double radius = 0.1;  // m: pull (standard deviation, or where a narrow one ends), peel, sphere
    double extent = 0.5;  // m: bend, wave, knife, seam, box
    double depth = 0.1;   // m: peel, knife, seam, incision, box
    double width = 0.5;   // m: peel, incision, box
    std::vector<glm::dvec2> path = {}; // of an incision: x and z, m
    PullProfile profile = PullProfile::gaussian;
};

/// "twist", ...
const char* nameOf(MapKind kind);
/// Of those that are maps: not of points and files.
std::optional<MapKind> parseMapKind(std::string_view name);

/// What is wrong with the numbers: a map that folds (its inverse would not be one), or does not fit its box.
/// Empty: nothing.
std::string problemOf(const DeformationMap& map);

/// D(p'), m.
glm::dvec3 inverseDisplacement(const DeformationMap& map, const glm::dvec3& shown);
/// d(p' + D(p')) / dp', by automatic differentiation of the same formulas: row i, column j in [j][i].
glm::dmat3 inverseJacobian(const DeformationMap& map, const glm::dvec3& shown);
/// p' of a point at rest, m: its inverse. Of a point on a cut (x = 0): one of its two places.
glm::dvec3 forward(const DeformationMap& map, const glm::dvec3& rest);
/// How far inside of what the mask keeps, m; negative: cut away. Continuous, 0 on the faces of a cut, with a
/// slope of at most about 1. Where D jumps though both sides are kept (a flap that lies on its ground), the
/// distance to the jump less `gap`: samples on either side must not be mixed.
double kept(const DeformationMap& map, const glm::dvec3& shown, double gap = 0);

/// Longest displacement in the box, m, from samples of a grid.
double largestDisplacement(const DeformationMap& map, int samples = 24);

/// Faces on which D is zero and nothing is cut: -x, +x, -y, +y, -z, +z.
struct BoxFaces {
    bool zero[6] = {};
};
BoxFaces zeroFaces(const DeformationMap& map);

} // namespace serosa::render
