#pragma once
/** @file Shapes in the world, and as triangles for what knows no shapes. */
#include <heliograph/scene.hpp>

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace helio {

/** A shape as kernels know it: a point p of a flat one is centre + x a + y b, where x and y run from -1 to 1
 * (a plane's without end); a sphere has the radius |a|, a along its X and b along its Y (the poles), and Z =
 * cross(a, b) / |a|; a torus has a ring of radius |a| and a tube of radius |b|, a along its X and b along its
 * Y. Where a transform mirrors, b of flat shapes and a of round ones are turned over, so that what was the
 * front stays the front. */
struct PlacedShape {
    Shape::Kind kind = Shape::Kind::Sphere;
    glm::dvec3 centre{0.0}, a{0.0}, b{0.0};
    bool isMirrored = false;
};

/** Throws InputError that names the node where a transform makes what is round no longer so, or a shape has
 * no finite size. */
PlacedShape placeShape(const Scene& scene, const Instance& instance, const Shape& shape);

/** Of what is finite: of a plane its centre. */
Scene::Bounds shapeBounds(const PlacedShape& shape);

/** Texture coordinates at the centre, at centre + a and at centre + b of a flat shape, from which those of
 * all points follow; of a round one those that (u, v) = (0, 0), (1, 0) and (0, 1) stand for. */
std::array<glm::vec2, 3> shapeTexcoords(const PlacedShape& shape);

/** X and Y in the space of its mesh of a flat shape's centre, and of centre + a and centre + b. */
std::array<glm::vec2, 3> shapePoints(const Shape& shape, bool isMirrored);

/** Triangles on a shape, three corners each: for estimates of where it is. A plane is cut off at `reach` from
 * its centre. */
std::vector<glm::vec3> trianglesOn(const PlacedShape& shape, double reach);

/** The scene with triangles in place of shapes: a sphere or torus has 64 x 32 faces, a disc 64 sides, and a
 * plane ends at 32 times the extent of all else. */
Scene withoutShapes(const Scene& scene);

}  // namespace helio
