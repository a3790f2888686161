// Normals of vertices from those of the triangles around.
#include <heliograph/surfaces.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace helio {
namespace {

Scene sceneOf(Primitive primitive) {
    Scene scene;
    scene.meshes.push_back({"", {std::move(primitive)}});
    Node node;
    node.mesh = 0;
    scene.nodes.push_back(node);
    scene.roots = {0};
    return scene;
}

/** A cube of side 2 about the origin, each side cut into two triangles along a diagonal that `choice` picks.
 */
Primitive cube(unsigned choice) {
    Primitive p;
    for (int axis = 0; axis < 3; ++axis)
        for (float sign : {-1.0f, 1.0f}) {
            const auto corner = [&](float u, float v) {
                glm::vec3 c;
                c[axis] = sign;
                c[(axis + 1) % 3] = u;
                c[(axis + 2) % 3] = v * sign;
                return c;
            };
            const auto first = std::uint32_t(p.positions.size());
            for (const auto& [u, v] : {std::pair{-1.f, -1.f}, {1.f, -1.f}, {1.f, 1.f}, {-1.f, 1.f}})
                p.positions.push_back(corner(u, v));
            const std::uint32_t turn = choice & 1;
            choice >>= 1;
            for (std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) p.indices.push_back(first + (i + turn) % 4);
        }
    return p;
}

TEST(Normals, ACubesCornersByAngleHoweverItsSidesAreCut) {
    for (unsigned choice = 0; choice < 64; ++choice) {
        Scene scene = sceneOf(cube(choice));
        smoothNormals(scene, NormalWeight::Angle);
        const Primitive& p = scene.meshes[0].primitives[0];
        for (std::size_t i = 0; i < p.positions.size(); ++i)
            for (int c = 0; c < 3; ++c) {
                ASSERT_NEAR(p.normals[i][c], p.positions[i][c] / std::sqrt(3.0), 1e-6)
                    << "cut " << choice << " vertex " << i;
            }
    }
}

TEST(Normals, ByFaceAndAreaDependOnTheCut) {
    // At the corner (1, 1, 1) a side counts once or twice: n = (a, b, c) / |(a, b, c)| by how many of its
    // triangles meet there. Areas of the triangles are alike.
    for (NormalWeight weight : {NormalWeight::Equal, NormalWeight::Area}) {
        bool differs = false;
        for (unsigned choice = 0; choice < 64; ++choice) {
            Scene scene = sceneOf(cube(choice));
            const Primitive& p = scene.meshes[0].primitives[0];
            glm::dvec3 expected(0);
            for (std::size_t t = 0; t < p.indices.size(); t += 3)
                for (std::size_t k = 0; k < 3; ++k)
                    if (p.positions[p.indices[t + k]] == glm::vec3(1)) {
                        const glm::dvec3 a = p.positions[p.indices[t]], b = p.positions[p.indices[t + 1]],
                                         c = p.positions[p.indices[t + 2]];
                        expected += glm::normalize(glm::cross(b - a, c - a));
                    }
            expected = glm::normalize(expected);
            smoothNormals(scene, weight);
            for (std::size_t i = 0; i < p.positions.size(); ++i)
                if (p.positions[i] == glm::vec3(1)) {
                    ASSERT_LT(glm::length(glm::dvec3(p.normals[i]) - expected), 1e-6);
                }
            differs = differs || glm::length(expected - glm::dvec3(1 / std::sqrt(3.0))) > 0.1;
        }
        EXPECT_TRUE(differs);
    }
}

TEST(Normals, AreaCountsByArea) {
    // Three faces of one corner with areas 1, 2 and 3.
    Primitive p;
    p.positions = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}};
    p.indices = {0, 1, 2, 0, 2, 3, 0, 3, 1};
    Scene scene = sceneOf(p);
    smoothNormals(scene, NormalWeight::Area);
    const glm::dvec3 expected = glm::normalize(glm::dvec3(6, 3, 2));  // twice the areas: y z, x z, x y
    EXPECT_LT(glm::length(glm::dvec3(scene.meshes[0].primitives[0].normals[0]) - expected), 1e-6);
}

/** The octahedron's faces cut into 4^level, vertices on the unit sphere, moved along it by up to `jitter` of
 * a side, so that no symmetry cancels errors. */
Primitive sphere(int level, double jitter) {
    const int n = 1 << level;
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(-1, 1);
    Primitive p;
    // The map of the octahedron onto the sphere over a square grid: rows by longitude, columns by latitude.
    const int rows = 2 * n, columns = 4 * n;
    const double pi = 3.14159265358979323846;
    std::vector<std::uint32_t> at(std::size_t((rows + 1) * columns));
    for (int i = 0; i <= rows; ++i)
        for (int j = 0; j < columns; ++j) {
            const bool pole = i == 0 || i == rows;
            const double theta = pi * (i + (pole ? 0 : jitter * unit(random))) / rows,
                         phi = 2 * pi * (j + (pole ? 0 : jitter * unit(random))) / columns;
            at[std::size_t(i * columns + j)] = std::uint32_t(p.positions.size());
            p.positions.push_back(pole
                                      ? glm::vec3(0, i == 0 ? 1 : -1, 0)
                                      : glm::vec3(glm::dvec3(std::sin(theta) * std::sin(phi), std::cos(theta),
                                                             std::sin(theta) * std::cos(phi))));
        }
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) {
            const int next = (j + 1) % columns;
            const std::uint32_t a = at[std::size_t(i * columns + j)],
                                b = at[std::size_t((i + 1) * columns + j)],
                                c = at[std::size_t((i + 1) * columns + next)],
                                d = at[std::size_t(i * columns + next)];
            if (i + 1 < rows) p.indices.insert(p.indices.end(), {a, b, c});
            if (i > 0) p.indices.insert(p.indices.end(), {a, c, d});
        }
    return p;
}

/** Mean error of the normals of a sphere of so many cuts. */
double sphereError(int level, double jitter, NormalWeight weight) {
    Scene scene = sceneOf(sphere(level, jitter));
    smoothNormals(scene, weight);
    const Primitive& p = scene.meshes[0].primitives[0];
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < p.positions.size(); ++i) {
        if (std::abs(p.positions[i].y) > 0.8f) continue;  // away from the poles, where triangles are slivers
        sum += glm::length(glm::dvec3(p.normals[i]) - glm::normalize(glm::dvec3(p.positions[i])));
        ++count;
    }
    return sum / double(count);
}

TEST(Normals, OfASphereTendToItsOwnWithTheSquareOfTheSide) {
    for (NormalWeight weight : {NormalWeight::Equal, NormalWeight::Area, NormalWeight::Angle}) {
        const double coarse = sphereError(3, 0, weight), fine = sphereError(5, 0, weight);
        const double slope = std::log2(coarse / fine) / 2;
        std::printf("             weight %d: error %.2e, %.2e; order %.2f\n", int(weight), coarse, fine,
                    slope);
        EXPECT_NEAR(slope, 2, 0.15);
    }
    // On uneven triangles none is exact, and the angle's mean is better than the plain one.
    EXPECT_LT(sphereError(4, 0.3, NormalWeight::Angle), sphereError(4, 0.3, NormalWeight::Equal));
}

TEST(Normals, CornersAtOnePlaceShareThemOverPrimitivesAndSeams) {
    const Primitive whole = cube(5);
    Scene scene = sceneOf(whole);
    Scene parts = sceneOf(whole);
    std::vector<Primitive>& list = parts.meshes[0].primitives;
    list.assign(2, whole);
    list[0].indices.resize(18);
    list[1].indices.erase(list[1].indices.begin(), list[1].indices.begin() + 18);
    smoothNormals(scene, NormalWeight::Angle);
    smoothNormals(parts, NormalWeight::Angle);
    for (const Primitive& p : list) EXPECT_EQ(p.normals, scene.meshes[0].primitives[0].normals);
}

TEST(Normals, WithoutAreaOrCancelling) {
    Primitive p;
    // A triangle and its back, one without area, and a vertex of none.
    p.positions = {{0, 0, 0},     {1, 0, 0},         {0, 1, 0},    {5, 5, 5},
                   {1e30f, 0, 0}, {1e30f, 1e25f, 0}, {0, 0, 1e30f}};
    p.indices = {0, 1, 2, 0, 2, 1, 3, 3, 3, 4, 5, 6};
    Scene scene = sceneOf(p);
    for (NormalWeight weight : {NormalWeight::Equal, NormalWeight::Area, NormalWeight::Angle}) {
        smoothNormals(scene, weight);
        for (const glm::vec3& n : scene.meshes[0].primitives[0].normals) EXPECT_NEAR(glm::length(n), 1, 1e-6);
    }
    flatNormals(scene);
    EXPECT_TRUE(scene.meshes[0].primitives[0].normals.empty());
}

TEST(Normals, WhatRoundingLeavesOfCancelledNormalsIsNone) {
    Primitive p;
    // A triangle, and its back in two halves: around the first corner their areas cancel, but for rounding.
    p.positions = {{1, 2, 3}, {5, -3, 7}, {-7, 9, 1}, {-1, 3, 4}};
    p.indices = {0, 1, 2, 0, 2, 3, 0, 3, 1};
    Scene scene = sceneOf(p);
    smoothNormals(scene, NormalWeight::Area);
    const glm::dvec3 plane = glm::normalize(glm::cross(glm::dvec3(4, -5, 4), glm::dvec3(-8, 7, -2)));
    EXPECT_NEAR(std::abs(glm::dot(glm::dvec3(scene.meshes[0].primitives[0].normals[0]), plane)), 1, 1e-6);
}

}  // namespace
}  // namespace helio
