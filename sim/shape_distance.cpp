// See sim/shape_distance.h.
#include "sim/shape_distance.h"

#include "base/check.h"
#include "sim/distance_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace serosa::sim {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kOnCore = 1e-9; // nearer to a core no direction leads away from it

/// Rounded: by the vector from the nearest point of the core.
ShapeSample around(const glm::dvec3& fromCore, double radius) {
    const double apart = glm::length(fromCore);
    return {apart - radius, apart > kOnCore ? fromCore / apart : glm::dvec3(0, 1, 0)};
}

glm::dvec3 fromShank(const glm::dvec3& p, double side, double length) {
    return p - glm::dvec3(0, side, std::clamp(p.z, 0.0, length));
}

/// From the nearest point of half a circle in the plane x = 0, z <= 0, and of the shank.
glm::dvec3 fromHook(const glm::dvec3& p, double bend, double length) {
    const double across = std::hypot(p.y, p.z);
    glm::dvec3 nearest(0, p.y < 0 ? -bend : bend, 0); // beyond the half: its ends
    if (p.z <= 0)
        nearest = across > kOnCore ? glm::dvec3(0, p.y, p.z) * (bend / across) : glm::dvec3(0, 0, -bend);
    const glm::dvec3 arc = p - nearest, shank = fromShank(p, -bend, length);
    return glm::dot(shank, shank) < glm::dot(arc, arc) ? shank : arc;
}

ShapeSample aroundBox(const glm::dvec3& p, const glm::dvec3& half, double radius) {
    const glm::dvec3 out = glm::abs(p) - half;
    const glm::dvec3 side(p.x < 0 ? -1 : 1, p.y < 0 ? -1 : 1, p.z < 0 ? -1 : 1);
    const glm::dvec3 beyond = glm::max(out, glm::dvec3(0));
    const double apart = glm::length(beyond);
    if (apart > kOnCore)
        return {apart - radius, side * beyond / apart};
    const int axis = out.x >= out.y && out.x >= out.z ? 0 : out.y >= out.z ? 1 : 2; // the nearest face
    glm::dvec3 normal(0);
    normal[axis] = side[axis];
    return {out[axis] - radius, normal};
}

} // namespace

ShapeSample sampleShape(const RigidShape& shape, const glm::dvec3& own) {
    switch (shape.kind) {
    case ShapeKind::sphere:
        return around(own, shape.radius);
    case ShapeKind::capsule:
        return around(fromShank(own, 0, shape.length), shape.radius);
    case ShapeKind::box:
        return aroundBox(own - shape.middle, shape.halfSize, shape.radius);
    case ShapeKind::hook:
        return around(fromHook(own, shape.bend, shape.length), shape.radius);
    case ShapeKind::halfSpace:
        return {own.y - shape.radius, {0, 1, 0}};
    case ShapeKind::mesh:
        break;
    }
    SEROSA_CHECK(shape.field, "a mesh has a distance field");
    ShapeSample sample = shape.field->sample(own / shape.fieldScale);
    sample.distance = sample.distance * shape.fieldScale - shape.radius;
    return sample;
}

double shapeDistance(const RigidShape& shape, const glm::dvec3& own) {
    return sampleShape(shape, own).distance;
}

double shapeLowerBound(const RigidShape& shape, const glm::dvec3& own) {
    return shape.kind == ShapeKind::mesh
               ? shape.field->lowerBound(own / shape.fieldScale) * shape.fieldScale - shape.radius
               : sampleShape(shape, own).distance;
}

double thinnestHalfWidth(const RigidShape& shape) {
    switch (shape.kind) {
    case ShapeKind::sphere:
    case ShapeKind::capsule:
    case ShapeKind::hook:
        return shape.radius;
    case ShapeKind::box:
        return shape.radius + std::min({shape.halfSize.x, shape.halfSize.y, shape.halfSize.z});
    case ShapeKind::halfSpace:
        return kInfinity;
    case ShapeKind::mesh:
        break;
    }
    SEROSA_CHECK(shape.field, "a mesh has a distance field");
    return shape.radius + shape.field->thinnestHalfWidth() * shape.fieldScale;
}

double boundingRadius(const RigidShape& shape) {
    switch (shape.kind) {
    case ShapeKind::sphere:
        return shape.radius;
    case ShapeKind::capsule:
        return shape.radius + shape.length;
    case ShapeKind::box:
        return shape.radius + glm::length(glm::abs(shape.middle) + shape.halfSize);
    case ShapeKind::hook:
        return shape.radius + std::hypot(shape.bend, shape.length);
    case ShapeKind::halfSpace:
        return kInfinity;
    case ShapeKind::mesh:
        break;
    }
    SEROSA_CHECK(shape.field, "a mesh has a distance field");
    const glm::dvec3 corner =
        glm::max(glm::abs(shape.field->meshLowest()), glm::abs(shape.field->meshHighest()));
    return shape.radius + glm::length(corner) * shape.fieldScale;
}

RigidShape scaledShape(RigidShape shape, double scale) {
    shape.radius *= scale;
    shape.length *= scale;
    shape.bend *= scale;
    shape.middle *= scale;
    shape.halfSize *= scale;
    shape.fieldScale *= scale;
    return shape;
}

} // namespace serosa::sim
