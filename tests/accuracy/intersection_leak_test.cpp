// No ray slips through: closed meshes seen from inside, aimed at edges and corners, at all scales and far
// from the origin; flat boxes met by rays along the axes. The long run:
//   HELIOGRAPH_RAYS=1e9 build/tests/accuracy/accuracy_intersection --gtest_filter='*Leaks*'
#include "tests/accuracy/intersection_support.hpp"
#include "tests/support/meshes.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <utility>

namespace helio::test {
namespace {

/** Whether every edge is run through once in each direction. */
bool isClosed(const Corners& corners) {
    const auto key = [](const glm::vec3& p) { return std::array<float, 3>{p.x, p.y, p.z}; };
    std::map<std::pair<std::array<float, 3>, std::array<float, 3>>, int> edges;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const auto a = key(corners[i]), b = key(corners[i - i % 3 + (i + 1) % 3]);
        ++edges[{a, b}];
        --edges[{b, a}];
    }
    return std::ranges::all_of(edges, [](const auto& edge) { return edge.second == 0; });
}

struct Mesh {
    const char* name;
    Corners corners;
    glm::vec3 inside;
};

/** Rays from near `mesh.inside` to corners and to points on edges, after scaling and moving the mesh. */
void expectNoLeaks(const Mesh& mesh, float scale, float offset, double count) {
    const glm::dvec3 move = double(offset) * glm::dvec3(1.0, -0.75, 0.6);
    const auto placed = [&](const glm::vec3& p) { return glm::vec3((glm::dvec3(p) + move) * double(scale)); };
    Corners corners = mesh.corners;
    for (glm::vec3& p : corners) p = placed(p);
    const PackedScene packed = packScene(sceneOf(corners));
    std::mt19937 random(std::uint32_t(corners.size()) + std::uint32_t(offset));
    const auto uniform = [&] { return float(random() >> 8) * 0x1p-24f; };
    const auto next = [&] {
        const std::size_t i = random() % corners.size();
        const glm::vec3 a = corners[i], b = corners[i - i % 3 + (i + 1) % 3];
        const std::uint32_t kind = random();
        const glm::vec3 target = (kind & 1) != 0 ? a : a + uniform() * (b - a);
        const glm::vec3 jitter(uniform() - 0.5f, uniform() - 0.5f, uniform() - 0.5f);
        const glm::vec3 origin = (kind & 2) != 0 ? placed(mesh.inside) : placed(mesh.inside + 0.1f * jitter);
        glm::vec3 direction = target - origin;
        if ((kind & 4) != 0) direction = glm::normalize(direction);
        return Ray{.origin = origin, .direction = direction};
    };
    for (RayQuestion question : {RayQuestion::Closest, RayQuestion::Any}) {
        double leaks = 0;
        Ray first{};
        sendRays(packed, question, count / 2, next, [&](const auto& rays, const auto& hits) {
            for (std::size_t i = 0; i < hits.size(); ++i)
                if (hits[i].slot < 0 && leaks++ == 0) first = rays[i];
        });
        EXPECT_EQ(leaks, 0) << fmt::format(
            "{} at scale {}, offset {}: first from ({:a}, {:a}, {:a}) along ({:a}, {:a}, {:a})", mesh.name,
            scale, offset, first.origin.x, first.origin.y, first.origin.z, first.direction.x,
            first.direction.y, first.direction.z);
    }
}

TEST(Intersection, NoLeaksAtEdgesAndCorners) {
    std::vector<Mesh> meshes = {{"octahedron", octasphere(0), {0, 0, 0}},
                                {"sphere", octasphere(6), {0, 0, 0}},
                                {"knot", knot(), {3, 0, 0}}};
    const std::vector<std::pair<float, float>> places = {{1, 0},    {1e-6f, 0},    {1e6f, 0},   {1, 1e2f},
                                                         {1, 1e5f}, {1e-6f, 1e5f}, {1e6f, 1e5f}};
    const double each = rayCount(2e6) / double(meshes.size() * places.size());
    for (const Mesh& mesh : meshes) {
        ASSERT_TRUE(isClosed(mesh.corners)) << mesh.name;
        for (const auto& [scale, offset] : places) expectNoLeaks(mesh, scale, offset, each);
    }
    fmt::print("{:.0f} rays\n", each * double(meshes.size() * places.size()));
}

/** Sheets in the planes of the axes: boxes without thickness, rays along an axis, through corners and edges,
 * with zeros of both signs: no 0 times infinity decides. */
TEST(Intersection, RaysAlongAxesMeetFlatBoxes) {
    constexpr int cells = 24;
    for (int axis = 0; axis < 3; ++axis) {
        const auto turned = [&](float a, float b, float c) {
            glm::vec3 p;
            p[axis] = c;
            p[(axis + 1) % 3] = a;
            p[(axis + 2) % 3] = b;
            return p;
        };
        Corners corners;
        for (int i = 0; i < cells; ++i)
            for (int j = 0; j < cells; ++j)
                for (const auto& [a, b] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}})
                    corners.push_back(turned(float(i + a), float(j + b), 5.0f));
        const PackedScene packed = packScene(sceneOf(corners));
        std::vector<Ray> rays;
        for (float zero : {0.0f, -0.0f})
            for (float towards : {1.0f, -1.0f})
                for (int i = 0; i <= 4 * cells; ++i)
                    for (int j = 0; j <= 4 * cells; ++j)
                        rays.push_back(
                            {.origin = turned(0.25f * float(i), 0.25f * float(j), 5.0f - 2.0f * towards),
                             .direction = turned(zero, -zero, towards)});
        std::size_t next = 0;
        sendRays(
            packed, RayQuestion::Closest, double(rays.size()), [&] { return rays[next++]; },
            [&](const auto&, const auto& hits) {
                for (const RayHit& hit : hits) {
                    ASSERT_GE(hit.slot, 0);
                    ASSERT_EQ(hit.distance, 2.0f);
                }
            });
        // And along the sheet: in its plane nothing is met, beside it neither.
        for (Ray& ray : rays) {
            ray.origin =
                turned(-1.0f, ray.origin[(axis + 2) % 3], ray.origin[axis] < 5.0f ? 5.0f : 5.0000005f);
            ray.direction = turned(1.0f, 0.0f, 0.0f);
        }
        next = 0;
        sendRays(
            packed, RayQuestion::Closest, double(rays.size()), [&] { return rays[next++]; },
            [&](const auto&, const auto& hits) {
                for (const RayHit& hit : hits) ASSERT_LT(hit.slot, 0);
            });
    }
}

/** Of triangles at the same distance the first in scene order is the hit, wherever the tree puts it. */
TEST(Intersection, CoincidentTrianglesGiveTheFirst) {
    Corners corners = octasphere(4);
    const std::size_t once = corners.size() / 3;
    for (int copy = 0; copy < 5; ++copy)
        corners.insert(corners.end(), corners.begin(), corners.begin() + std::ptrdiff_t(once * 3));
    const PackedScene packed = packScene(sceneOf(corners));
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    const auto next = [&] {
        return Ray{.origin = {}, .direction = {normal(random), normal(random), normal(random)}};
    };
    sendRays(packed, RayQuestion::Closest, 2e5, next, [&](const auto&, const auto& hits) {
        for (const RayHit& hit : hits) {
            ASSERT_GE(hit.slot, 0);
            ASSERT_LT(glm::floatBitsToUint(packed.triangles[std::size_t(hit.slot) * 3].w), once);
        }
    });
}

/** Hits lie within (0, limit): a ray that starts in a triangle's plane does not meet it there. */
TEST(Intersection, WhatARayStartsInIsNotMet) {
    // A second triangle, far off, so that there is a tree.
    const PackedScene packed =
        packScene(sceneOf({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 5}, {1, 0, 5}, {0, 1, 5}}));
    std::mt19937 random(4);
    std::uniform_real_distribution<float> unit(0.05f, 0.45f);
    for (const RayQuestion question : {RayQuestion::Closest, RayQuestion::Any}) {
        const auto next = [&] {
            return Ray{
                .origin = {unit(random), unit(random), 0}, .limit = 4, .direction = {0.25f, 0.125f, 1}};
        };
        sendRays(packed, question, 1e4, next, [&](const auto&, const auto& hits) {
            for (const RayHit& hit : hits) ASSERT_EQ(hit.slot, -1) << "at " << hit.distance;
        });
    }
}

/** Nor does it meet the triangle that it is told to leave, wherever it starts. */
TEST(Intersection, TheTriangleARayLeavesIsPassed) {
    const PackedScene packed =
        packScene(sceneOf({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 5}, {1, 0, 5}, {0, 1, 5}}));
    std::int32_t source = -1;
    for (const float expected : {1.0f, 6.0f}) {
        const auto next = [&] {
            return Ray{.origin = {0.25f, 0.25f, -1}, .direction = {0, 0, 1}, .source = source};
        };
        sendRays(packed, RayQuestion::Closest, 64, next, [&](const auto&, const auto& hits) {
            for (const RayHit& hit : hits) ASSERT_EQ(hit.distance, expected);
            source = hits[0].slot;
        });
    }
}

}  // namespace
}  // namespace helio::test
