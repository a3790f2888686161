// Grid, octree, kd-tree and binary space partition: their cells fill the root's box once, and refer to every
// triangle that has a point in them.
#include "engine/scene/comparators.hpp"

#include "tests/support/meshes.hpp"
#include "tests/support/sanitized.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>

namespace helio {
namespace {

using partition::Input;
using partition::Tree;

using Tetrahedron = std::array<glm::dvec3, 4>;

double volume(const Tetrahedron& t) {
    return std::abs(glm::dot(t[1] - t[0], glm::cross(t[2] - t[0], t[3] - t[0]))) / 6;
}

/** The parts of a tetrahedron on both sides of the plane dot(n, p) = d: [0] below. */
std::array<std::vector<Tetrahedron>, 2> cut(const Tetrahedron& t, const glm::dvec3& n, double d) {
    std::array<std::vector<glm::dvec3>, 2> side;
    for (const glm::dvec3& p : t) side[glm::dot(n, p) < d ? 0 : 1].push_back(p);
    std::array<std::vector<Tetrahedron>, 2> parts;
    const auto crossing = [&](const glm::dvec3& a, const glm::dvec3& b) {
        const double da = glm::dot(n, a) - d, db = glm::dot(n, b) - d;
        return a + (b - a) * (da / (da - db));
    };
    /** A wedge of two triangles with corners in the same order. */
    const auto wedge = [](const std::array<glm::dvec3, 3>& a, const std::array<glm::dvec3, 3>& b) {
        return std::vector<Tetrahedron>{
            {a[0], a[1], a[2], b[0]}, {a[1], a[2], b[0], b[1]}, {a[2], b[0], b[1], b[2]}};
    };
    for (std::size_t s = 0; s < 2; ++s) {
        const auto &here = side[s], &there = side[1 - s];
        if (here.size() == 4) parts[s] = {t};
        if (here.size() == 1)
            parts[s] = {{here[0], crossing(here[0], there[0]), crossing(here[0], there[1]),
                         crossing(here[0], there[2])}};
        if (here.size() == 3)
            parts[s] = wedge(
                {here[0], here[1], here[2]},
                {crossing(here[0], there[0]), crossing(here[1], there[0]), crossing(here[2], there[0])});
        if (here.size() == 2)
            parts[s] = wedge({here[0], crossing(here[0], there[0]), crossing(here[0], there[1])},
                             {here[1], crossing(here[1], there[0]), crossing(here[1], there[1])});
    }
    return parts;
}

/** Volume of all leaves below a node that holds these tetrahedra. */
double leafVolume(const Tree& tree, std::uint32_t index, const std::vector<Tetrahedron>& cell, bool octree) {
    const partition::Node& node = tree.nodes[index];
    if (node.firstChild == 0) {
        double sum = 0;
        for (const Tetrahedron& t : cell) sum += volume(t);
        return sum;
    }
    std::vector<std::vector<Tetrahedron>> children = {cell};
    for (int axis = 0; axis < (octree ? 3 : 1); ++axis) {
        glm::dvec3 n(node.split);
        double d = double(node.distance);
        if (octree) {
            n = glm::dvec3(0);
            n[axis] = 1;
            d = double(node.split[axis]);
        }
        std::vector<std::vector<Tetrahedron>> halves(children.size() * 2);
        for (std::size_t k = 0; k < children.size(); ++k)
            for (const Tetrahedron& t : children[k]) {
                const auto parts = cut(t, n, d);
                for (std::size_t s = 0; s < 2; ++s) {
                    auto& into = halves[k + s * children.size()];
                    into.insert(into.end(), parts[s].begin(), parts[s].end());
                }
            }
        children = std::move(halves);
    }
    double sum = 0;
    for (std::size_t k = 0; k < children.size(); ++k)
        sum += leafVolume(tree, node.firstChild + std::uint32_t(k), children[k], octree);
    return sum;
}

std::vector<Tetrahedron> tetrahedra(const partition::Bounds& box) {
    const glm::dvec3 low(box.lower), high(box.upper);
    std::vector<Tetrahedron> result;
    std::array<int, 3> axes = {0, 1, 2};
    do {  // Kuhn's six: along the axes in every order
        Tetrahedron t{low, low, low, high};
        t[1][axes[0]] = high[axes[0]];
        t[2] = t[1];
        t[2][axes[1]] = high[axes[1]];
        result.push_back(t);
    } while (std::ranges::next_permutation(axes).found);
    return result;
}

const partition::Node& leafAt(const Tree& tree, const glm::vec3& p, bool octree) {
    const partition::Node* node = &tree.nodes[0];
    while (node->firstChild != 0) {
        std::uint32_t child = 0;
        if (octree)
            for (int axis = 0; axis < 3; ++axis) child |= p[axis] < node->split[axis] ? 0u : 1u << axis;
        else
            child = glm::dot(node->split, p) < node->distance ? 0 : 1;
        node = &tree.nodes[node->firstChild + child];
    }
    return *node;
}

/** Calls with points of triangles, and the triangle. */
void forPoints(const test::Corners& corners,
               const std::function<void(const glm::vec3&, std::uint32_t)>& check) {
    std::mt19937 random(4);
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    for (int i = 0; i < 50000; ++i) {
        const std::uint32_t triangle = std::uint32_t(random() % (corners.size() / 3));
        float u = uniform(random), v = uniform(random);
        if (u + v > 1) u = 1 - u, v = 1 - v;
        const glm::vec3* c = &corners[std::size_t(triangle) * 3];
        check(i % 3 == 0 ? c[i / 3 % 3] : c[0] + u * (c[1] - c[0]) + v * (c[2] - c[0]), triangle);
    }
}

TEST(Comparators, CellsFillTheRootAndReferToAllTrianglesInThem) {
    for (const test::Corners& corners :
         {test::octasphere(test::kSanitized ? 3 : 4), test::cloud(test::kSanitized ? 600 : 3000)}) {
        const Input input(corners);
        const double root = [&] {
            const glm::dvec3 e = glm::dvec3(input.root.upper) - glm::dvec3(input.root.lower);
            return e.x * e.y * e.z;
        }();
        struct Named {
            const char* name;
            Tree tree;
            bool octree;
        };
        for (const Named& built : {Named{"octree", partition::buildOctree(input), true},
                                   Named{"kd-tree", partition::buildKdTree(input), false},
                                   Named{"bsp", partition::buildBsp(input), false}}) {
            SCOPED_TRACE(built.name);
            std::size_t leaves = 0, references = 0, largest = 0;
            for (const partition::Node& node : built.tree.nodes) {
                if (node.firstChild != 0) continue;
                ++leaves;
                references += node.references.size();
                largest = std::max(largest, node.references.size());
            }
            EXPECT_NEAR(leafVolume(built.tree, 0, tetrahedra(input.root), built.octree), root, 1e-6 * root);
            std::size_t missing = 0;
            forPoints(corners, [&](const glm::vec3& p, std::uint32_t triangle) {
                const auto& held = leafAt(built.tree, p, built.octree).references;
                missing += std::ranges::count(held, triangle) == 1 ? 0u : 1u;
            });
            EXPECT_EQ(missing, 0u);
            fmt::print("{}: {} triangles, {} leaves, {} references, {} in the largest, {} levels\n",
                       built.name, corners.size() / 3, leaves, references, largest, built.tree.depth);
            EXPECT_GT(leaves, corners.size() / 3 / 16);
            EXPECT_LT(references, 12 * corners.size());
        }
        const partition::Grid grid = partition::buildGrid(input);
        const glm::dvec3 filled = glm::dvec3(grid.cellSize) * glm::dvec3(grid.cells);
        EXPECT_NEAR(filled.x * filled.y * filled.z, root, 1e-6 * root);
        std::size_t missing = 0;
        forPoints(corners, [&](const glm::vec3& p, std::uint32_t triangle) {
            const glm::ivec3 cell(glm::floor((p - input.root.lower) / grid.cellSize));
            const std::size_t index =
                (std::size_t(cell.z) * std::size_t(grid.cells.y) + std::size_t(cell.y)) *
                    std::size_t(grid.cells.x) +
                std::size_t(cell.x);
            const std::span<const std::uint32_t> all(grid.references);
            const auto held = all.subspan(grid.first[index], grid.first[index + 1] - grid.first[index]);
            missing += std::ranges::count(held, triangle) == 1 ? 0u : 1u;
        });
        EXPECT_EQ(missing, 0u);
        fmt::print("grid: {} x {} x {} cells, {} references\n", grid.cells.x, grid.cells.y, grid.cells.z,
                   grid.references.size());
    }
}

TEST(Comparators, DegenerateInputIsKept) {
    for (const test::Corners& corners :
         {test::Corners(30, glm::vec3(1, 2, 3)), test::Corners(3, glm::vec3(0)),
          test::Corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}})
        for (AcceleratorKind kind :
             {AcceleratorKind::BruteForce, AcceleratorKind::Grid, AcceleratorKind::Octree,
              AcceleratorKind::KdTree, AcceleratorKind::Bsp}) {
            const Comparator built = buildComparator(kind, corners);
            EXPECT_FALSE(built.words.empty()) << acceleratorName(kind);
            EXPECT_LE(built.depth, 40u);
        }
}

}  // namespace
}  // namespace helio
