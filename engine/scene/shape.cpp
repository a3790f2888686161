#include "engine/scene/shape.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>

namespace helio {
namespace {

using Kind = Shape::Kind;

/** Steps round a sphere's equator and a disc's rim. */
constexpr int kSteps = 64;

/** Half the sides of a flat shape along X and Y; the radius of a sphere. */
glm::dvec2 halfSides(const Shape& shape) {
    switch (shape.kind) {
        case Kind::Sphere:
        case Kind::Disc:
            return glm::dvec2(double(shape.radius));
        case Kind::Torus:
            return {double(shape.radius), double(shape.tubeRadius)};
        case Kind::Quad:
            return {0.5 * double(shape.width), 0.5 * double(shape.height)};
        case Kind::Plane:
            break;
    }
    return glm::dvec2(1.0);
}

/** The shape's triangles in the space of its mesh; a plane's half side is `reach`. */
Primitive tessellate(const Shape& shape, double reach) {
    Primitive to;
    to.texcoords.emplace_back();
    const auto add = [&](const glm::dvec3& position, const glm::dvec3& normal, const glm::dvec2& uv) {
        to.positions.emplace_back(position);
        to.normals.emplace_back(normal);
        to.texcoords[0].emplace_back(uv);
        return std::uint32_t(to.positions.size()) - 1;
    };
    const glm::dvec2 half = halfSides(shape);
    const glm::dvec3 forward(0, 0, 1);
    const double turn = 2 * glm::pi<double>();
    if (shape.kind == Kind::Sphere) {
        constexpr int rows = kSteps / 2;
        for (int i = 0; i <= rows; ++i)
            for (int k = 0; k <= kSteps; ++k) {
                const double u = double(k) / kSteps, v = double(i) / rows;
                // The seam's two sides are the same to the last bit, and so are all points of a pole.
                const double across = i == 0 || i == rows ? 0.0 : std::sin(0.5 * turn * v);
                const double angle = turn * (double(k % kSteps) / kSteps - 0.5);
                const glm::dvec3 n(across * std::sin(angle), std::cos(0.5 * turn * v),
                                   across * std::cos(angle));
                add(half.x * n, n, {u, v});
            }
        for (int i = 0; i < rows; ++i)
            for (int k = 0; k < kSteps; ++k) {
                const auto at = std::uint32_t(i * (kSteps + 1) + k), below = at + kSteps + 1;
                if (i > 0) to.indices.insert(to.indices.end(), {at, below, at + 1});
                if (i + 1 < rows) to.indices.insert(to.indices.end(), {at + 1, below, below + 1});
            }
    } else if (shape.kind == Kind::Torus) {
        constexpr int rows = kSteps / 2;
        for (int i = 0; i <= rows; ++i)
            for (int k = 0; k <= kSteps; ++k) {
                const double round = turn * (double(k % kSteps) / kSteps - 0.5);
                const double tube = turn * (double(i % rows) / rows - 0.5);
                const glm::dvec3 onRing(std::cos(round), std::sin(round), 0);
                const glm::dvec3 n = std::cos(tube) * onRing + std::sin(tube) * forward;
                add(half.x * onRing + half.y * n, n, {double(k) / kSteps, double(i) / rows});
            }
        for (int i = 0; i < rows; ++i)
            for (int k = 0; k < kSteps; ++k) {
                const auto at = std::uint32_t(i * (kSteps + 1) + k), above = at + kSteps + 1;
                to.indices.insert(to.indices.end(), {at, at + 1, above, at + 1, above + 1, above});
            }
    } else if (shape.kind == Kind::Disc) {
        const std::uint32_t middle = add(glm::dvec3(0.0), forward, glm::dvec2(0.5));
        for (int k = 0; k < kSteps; ++k) {
            const glm::dvec2 n(std::cos(turn * k / kSteps), std::sin(turn * k / kSteps));
            add(glm::dvec3(half * n, 0.0), forward, {0.5 + 0.5 * n.x, 0.5 - 0.5 * n.y});
        }
        for (std::uint32_t k = 0; k < kSteps; ++k)
            to.indices.insert(to.indices.end(), {middle, 1 + k, 1 + (k + 1) % kSteps});
    } else {
        const double scale = shape.kind == Kind::Plane ? reach : 1.0;
        const glm::dvec2 corner = scale * half;
        for (const glm::dvec2& s : {glm::dvec2(-1, -1), {1, -1}, {1, 1}, {-1, 1}})
            add(glm::dvec3(corner * s, 0.0), forward,
                shape.kind == Kind::Plane ? glm::dvec2(scale * s.x, -scale * s.y)
                                          : glm::dvec2(0.5 + 0.5 * s.x, 0.5 - 0.5 * s.y));
        to.indices = {0, 1, 2, 0, 2, 3};
    }
    return to;
}

}  // namespace

PlacedShape placeShape(const Scene& scene, const Instance& instance, const Shape& shape) {
    const auto refuse = [&](const char* fault, const char* remedy) {
        const std::string& name = scene.nodes[std::size_t(instance.node)].name;
        throw InputError(scene.name,
                         fmt::format("node {}{}", instance.node, name.empty() ? "" : " '" + name + "'"),
                         fault, remedy);
    };
    const glm::dmat3 linear(instance.transform);
    const glm::dvec2 half = halfSides(shape);
    PlacedShape to{shape.kind, glm::dvec3(instance.transform[3]), half.x * linear[0], half.y * linear[1],
                   glm::determinant(linear) < 0.0};
    const double a = glm::length(to.a), b = glm::length(to.b);
    constexpr double least = 1e-15, most = 1e15;  // squares of which are normal floats
    if (!(a >= least && a <= most && b >= least && b <= most))
        refuse("scales its shape to a size that is 0 or not to be computed with",
               "give scales that are not 0 and sizes from 1e-15 to 1e15");
    const bool isRound = shape.kind == Kind::Sphere || shape.kind == Kind::Torus;
    if (isRound) {
        constexpr double unlike = 1e-5;  // what products of float matrices leave
        const double scale = a / half.x;
        bool isEven = true;
        for (int i = 0; i < 3; ++i)
            for (int k = 0; k <= i; ++k)
                isEven = isEven && std::abs(glm::dot(linear[i], linear[k]) / (scale * scale) -
                                            (i == k ? 1.0 : 0.0)) <= unlike;
        if (!isEven)
            refuse("scales a sphere or torus unevenly",
                   "scale x, y and z alike, or give a mesh in its place");
    } else if (!(glm::length(glm::cross(to.a, to.b)) > 1e-6 * a * b)) {
        refuse("turns its flat shape into a line", "give axes that are not parallel");
    }
    if (to.isMirrored) (isRound ? to.a : to.b) *= -1.0;
    return to;
}

Scene::Bounds shapeBounds(const PlacedShape& shape) {
    glm::dvec3 reach(0.0);
    switch (shape.kind) {
        case Kind::Sphere:
            reach = glm::dvec3(glm::length(shape.a));
            break;
        case Kind::Disc:
            reach = glm::sqrt(shape.a * shape.a + shape.b * shape.b);
            break;
        case Kind::Torus: {
            // A disc about its ring, and its tube beyond.
            const double tube = glm::length(shape.b);
            const glm::dvec3 across = shape.b * (glm::length(shape.a) / tube);
            reach = glm::sqrt(shape.a * shape.a + across * across) + glm::dvec3(tube);
            break;
        }
        case Kind::Quad:
            reach = glm::abs(shape.a) + glm::abs(shape.b);
            break;
        case Kind::Plane:
            break;
    }
    return {shape.centre - reach, shape.centre + reach};
}

std::array<glm::vec2, 3> shapeTexcoords(const PlacedShape& shape) {
    const float up = shape.isMirrored ? 1.0f : -1.0f;
    switch (shape.kind) {
        case Kind::Torus:
        case Kind::Sphere:
            if (shape.isMirrored) return {{{1, 0}, {0, 0}, {1, 1}}};
            return {{{0, 0}, {1, 0}, {0, 1}}};
        case Kind::Plane:
            return {{{0, 0}, {1, 0}, {0, up}}};
        case Kind::Disc:
        case Kind::Quad:
            break;
    }
    return {{{0.5f, 0.5f}, {1, 0.5f}, {0.5f, 0.5f + 0.5f * up}}};
}

std::array<glm::vec2, 3> shapePoints(const Shape& shape, bool isMirrored) {
    if (shape.kind == Kind::Sphere || shape.kind == Kind::Torus) return {};
    const glm::vec2 half(halfSides(shape));
    return {{{0, 0}, {half.x, 0}, {0, isMirrored ? -half.y : half.y}}};
}

std::vector<glm::vec3> trianglesOn(const PlacedShape& shape, double reach) {
    const double a = glm::length(shape.a), b = glm::length(shape.b);
    const bool isTorus = shape.kind == Kind::Torus;
    const Shape unit{.kind = shape.kind, .radius = 1, .tubeRadius = float(b / a), .width = 2, .height = 2};
    const Primitive triangles = tessellate(unit, reach / std::max(a, b));
    const glm::dvec3 y = isTorus ? shape.b * (a / b) : shape.b, z = glm::cross(shape.a, y) / a;
    std::vector<glm::vec3> corners;
    for (const std::uint32_t index : triangles.indices) {
        const glm::dvec3 p(triangles.positions[index]);
        corners.emplace_back(shape.centre + p.x * shape.a + p.y * y + p.z * z);
    }
    return corners;
}

Scene withoutShapes(const Scene& scene) {
    Scene to = scene;
    const Scene::Bounds bounds = scene.bounds();
    const double extent = bounds.empty() ? 0.0 : glm::length(bounds.upper - bounds.lower);
    // A plane's size in the world is that of its mesh times its node's scale: it ends beyond the reach.
    double smallest = 1.0;
    for (const Instance& instance : scene.instances())
        for (int axis = 0; axis < 2; ++axis)
            smallest = std::min(smallest, glm::length(glm::dvec3(instance.transform[axis])));
    const double reach = 32.0 * (extent > 0.0 ? extent : 1.0) / std::max(smallest, 1e-6);
    for (Mesh& mesh : to.meshes)
        for (Primitive& primitive : mesh.primitives) {
            if (!primitive.shape) continue;
            Primitive triangles = tessellate(*primitive.shape, reach);
            triangles.material = primitive.material;
            triangles.variantMaterials = std::move(primitive.variantMaterials);
            primitive = std::move(triangles);
        }
    return to;
}

}  // namespace helio
