#include "engine/scene/comparators.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace helio {
namespace partition {
namespace {

using Ids = std::vector<std::uint32_t>;

constexpr std::uint32_t kFewTriangles = 6;

/** Levels below the root: a tree that would go deeper gains nothing any more (Havran 2000's rule). */
std::uint32_t depthLimit(std::size_t triangles) {
    return std::uint32_t(8 + 1.3 * std::log2(double(triangles)));
}

double surface(const Bounds& b) {
    const glm::dvec3 e = glm::dvec3(b.upper) - glm::dvec3(b.lower);
    return e.x * e.y + e.y * e.z + e.z * e.x;
}

Ids all(const Input& input) {
    Ids ids(input.boxes.size());
    std::iota(ids.begin(), ids.end(), 0u);
    return ids;
}

/** Splits nodes depth first; `divide` gives a node's children's triangles, or nothing for a leaf. */
template <typename Divide, typename Cell>
Tree grow(const Cell& root, Ids ids, const Divide& divide) {
    struct Open {
        std::uint32_t node, depth;
        Cell cell;
        Ids ids;
    };
    Tree tree;
    tree.nodes.emplace_back();
    std::vector<Open> open;
    open.push_back({0, 0, root, std::move(ids)});
    while (!open.empty()) {
        Open at = std::move(open.back());
        open.pop_back();
        tree.depth = std::max(tree.depth, at.depth);
        std::vector<std::pair<Cell, Ids>> children;
        if (!divide(at.cell, at.ids, at.depth, tree.nodes[at.node], children)) {
            tree.nodes[at.node].references = std::move(at.ids);
            continue;
        }
        const std::uint32_t first = std::uint32_t(tree.nodes.size());
        tree.nodes[at.node].firstChild = first;
        tree.nodes.resize(tree.nodes.size() + children.size());
        for (std::size_t k = 0; k < children.size(); ++k)
            open.push_back(
                {first + std::uint32_t(k), at.depth + 1, children[k].first, std::move(children[k].second)});
    }
    return tree;
}

/** The split of least cost among evenly spaced planes; cutting off emptiness is cheaper by a fifth. */
struct AxisSplit {
    int axis = -1;
    float at = 0;
};
AxisSplit bestAxisSplit(const Input& input, const Bounds& cell, const Ids& ids) {
    constexpr int bins = 24;
    constexpr double traversalCost = 0.8;
    AxisSplit best;
    const double area = surface(cell);
    double bestCost = double(ids.size()) * area;
    for (int axis = 0; axis < 3; ++axis) {
        const float low = cell.lower[axis], extent = cell.upper[axis] - low;
        if (!(extent > 4 * input.margin)) continue;
        std::array<std::uint32_t, bins> starts{}, ends{};
        const auto binOf = [&](float x) { return std::clamp(int((x - low) / extent * bins), 0, bins - 1); };
        for (std::uint32_t id : ids) {
            ++starts[std::size_t(binOf(input.boxes[id].lower[axis]))];
            ++ends[std::size_t(binOf(input.boxes[id].upper[axis]))];
        }
        std::size_t left = 0, right = ids.size();
        for (int b = 1; b < bins; ++b) {
            left += starts[std::size_t(b - 1)];
            right -= ends[std::size_t(b - 1)];
            Bounds a = cell, c = cell;
            a.upper[axis] = c.lower[axis] = low + extent * float(b) / bins;
            const double discount = left == 0 || right == 0 ? 0.8 : 1.0;
            const double cost =
                discount * (surface(a) * double(left) + surface(c) * double(right)) + traversalCost * area;
            if (cost < bestCost) {
                bestCost = cost;
                best = {axis, a.upper[axis]};
            }
        }
    }
    return best;
}

}  // namespace

Input::Input(std::span<const glm::vec3> corners) : positions(corners), boxes(corners.size() / 3) {
    root = {glm::vec3(std::numeric_limits<float>::infinity()),
            glm::vec3(-std::numeric_limits<float>::infinity())};
    float farthest = 0;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const glm::vec3* p = &positions[i * 3];
        boxes[i] = {glm::min(glm::min(p[0], p[1]), p[2]), glm::max(glm::max(p[0], p[1]), p[2])};
        root.lower = glm::min(root.lower, boxes[i].lower);
        root.upper = glm::max(root.upper, boxes[i].upper);
    }
    const glm::vec3 extent = root.upper - root.lower,
                    size = glm::max(glm::abs(root.lower), glm::abs(root.upper));
    for (int axis = 0; axis < 3; ++axis)
        farthest = std::max(farthest, std::max(extent[axis], 0.0625f * size[axis]));
    // 2^-17: a ray from 16 sizes away knows its place to 2^-20 of the size, a few times over.
    margin = std::max(farthest * 7.6e-6f, 1e-30f);
    for (Bounds& box : boxes) {
        box.lower -= margin;
        box.upper += margin;
    }
    root.lower -= 2.0f * margin;
    root.upper += 2.0f * margin;
}

Grid buildGrid(const Input& input) {
    constexpr double cellsPerTriangle = 4;
    constexpr int mostCells = 512;
    const glm::dvec3 extent = glm::dvec3(input.root.upper) - glm::dvec3(input.root.lower);
    const double side =
        std::cbrt(extent.x * extent.y * extent.z / (cellsPerTriangle * double(input.boxes.size())));
    Grid grid;
    for (int axis = 0; axis < 3; ++axis) {
        grid.cells[axis] = int(std::clamp(extent[axis] / side, 1.0, double(mostCells)));
        grid.cellSize[axis] = float(extent[axis] / grid.cells[axis]);
    }
    const auto cellsOf = [&](const Bounds& box, const auto& visit) {
        const auto place = [&](const glm::vec3& p) {
            const glm::vec3 cell = glm::floor((p - input.root.lower) / grid.cellSize);
            return glm::clamp(glm::ivec3(cell), glm::ivec3(0), grid.cells - 1);
        };
        const glm::ivec3 low = place(box.lower), high = place(box.upper);
        for (int z = low.z; z <= high.z; ++z)
            for (int y = low.y; y <= high.y; ++y)
                for (int x = low.x; x <= high.x; ++x)
                    visit((std::size_t(z) * std::size_t(grid.cells.y) + std::size_t(y)) *
                              std::size_t(grid.cells.x) +
                          std::size_t(x));
    };
    grid.first.assign(std::size_t(grid.cells.x) * std::size_t(grid.cells.y) * std::size_t(grid.cells.z) + 1,
                      0);
    for (const Bounds& box : input.boxes) cellsOf(box, [&](std::size_t cell) { ++grid.first[cell + 1]; });
    std::partial_sum(grid.first.begin(), grid.first.end(), grid.first.begin());
    grid.references.resize(grid.first.back());
    std::vector<std::uint32_t> next = grid.first;
    for (std::uint32_t id = 0; id < input.boxes.size(); ++id)
        cellsOf(input.boxes[id], [&](std::size_t cell) { grid.references[next[cell]++] = id; });
    return grid;
}

Tree buildOctree(const Input& input) {
    const std::uint32_t levels = std::min(depthLimit(input.boxes.size()) / 2, 12u);
    const auto divide = [&](const Bounds& cell, const Ids& ids, std::uint32_t depth, Node& node,
                            std::vector<std::pair<Bounds, Ids>>& children) {
        if (ids.size() <= kFewTriangles || depth >= levels) return false;
        const glm::vec3 middle = 0.5f * (cell.lower + cell.upper);
        node.split = middle;
        std::size_t references = 0;
        for (int octant = 0; octant < 8; ++octant) {
            Bounds child = cell;
            for (int axis = 0; axis < 3; ++axis)
                ((octant >> axis & 1) != 0 ? child.lower : child.upper)[axis] = middle[axis];
            Ids held;
            for (std::uint32_t id : ids)
                if (glm::all(glm::lessThanEqual(input.boxes[id].lower, child.upper)) &&
                    glm::all(glm::greaterThanEqual(input.boxes[id].upper, child.lower)))
                    held.push_back(id);
            references += held.size();
            children.emplace_back(child, std::move(held));
        }
        return references < 5 * ids.size();  // else all overlap: no cut separates them
    };
    return grow(input.root, all(input), divide);
}

Tree buildKdTree(const Input& input) {
    const std::uint32_t levels = depthLimit(input.boxes.size());
    const auto divide = [&](const Bounds& cell, const Ids& ids, std::uint32_t depth, Node& node,
                            std::vector<std::pair<Bounds, Ids>>& children) {
        if (ids.size() <= 2 || depth >= levels) return false;
        const AxisSplit split = bestAxisSplit(input, cell, ids);
        if (split.axis < 0) return false;
        node.split[split.axis] = 1.0f;
        node.distance = split.at;
        children.resize(2, {cell, {}});
        children[0].first.upper[split.axis] = children[1].first.lower[split.axis] = split.at;
        for (std::uint32_t id : ids) {
            if (input.boxes[id].lower[split.axis] <= split.at) children[0].second.push_back(id);
            if (input.boxes[id].upper[split.axis] >= split.at) children[1].second.push_back(id);
        }
        return true;
    };
    return grow(input.root, all(input), divide);
}

Tree buildBsp(const Input& input) {
    struct Region {};
    const std::uint32_t levels = depthLimit(input.boxes.size());
    /** Distances of a triangle's corners from a plane: least and greatest. */
    const auto extentOf = [&](std::uint32_t id, const glm::dvec3& normal, double distance) {
        std::pair<double, double> extent(std::numeric_limits<double>::infinity(),
                                         -std::numeric_limits<double>::infinity());
        for (std::size_t c = 0; c < 3; ++c) {
            const double d =
                glm::dot(normal, glm::dvec3(input.positions[std::size_t(id) * 3 + c])) - distance;
            extent = {std::min(extent.first, d), std::max(extent.second, d)};
        }
        return extent;
    };
    const auto divide = [&](const Region&, const Ids& ids, std::uint32_t depth, Node& node,
                            std::vector<std::pair<Region, Ids>>& children) {
        if (ids.size() <= kFewTriangles || depth >= levels) return false;
        // Planes of some triangles, and planes across the axes through their middles.
        constexpr std::size_t tried = 8;
        const std::size_t sampled = std::min<std::size_t>(ids.size(), 256), stride = ids.size() / sampled;
        double best = 0.9;
        bool found = false;
        for (std::size_t k = 0; k < 4 * tried; ++k) {
            const std::uint32_t id = ids[(2 * (k / 4) + 1) * ids.size() / (2 * tried)];
            const glm::vec3* p = &input.positions[std::size_t(id) * 3];
            glm::dvec3 normal(0.0);
            if (k % 4 == 3) {
                normal = glm::cross(glm::dvec3(p[1]) - glm::dvec3(p[0]), glm::dvec3(p[2]) - glm::dvec3(p[0]));
                const double length = glm::length(normal);
                if (!(length > 0)) continue;
                normal /= length;
            } else {
                normal[int(k % 4)] = 1;
            }
            const glm::vec3 rounded(normal);
            const float distance = glm::dot(rounded, p[0] / 3.0f + p[1] / 3.0f + p[2] / 3.0f);
            std::size_t below = 0, above = 0;
            for (std::size_t i = 0; i < sampled; ++i) {
                const auto [low, high] = extentOf(ids[i * stride], glm::dvec3(rounded), double(distance));
                below += low <= double(input.margin) ? 1 : 0;
                above += high >= -double(input.margin) ? 1 : 0;
            }
            // Share of the triangles that the larger side holds, and what both hold too many.
            const double cost =
                (double(std::max(below, above)) + 0.5 * (double(below + above) - double(sampled))) /
                double(sampled);
            if (cost >= best) continue;
            best = cost;
            found = true;
            node.split = rounded;
            node.distance = distance;
        }
        if (!found) return false;
        children.resize(2);
        for (std::uint32_t id : ids) {
            const auto [low, high] = extentOf(id, glm::dvec3(node.split), double(node.distance));
            if (low <= double(input.margin)) children[0].second.push_back(id);
            if (high >= -double(input.margin)) children[1].second.push_back(id);
        }
        return std::max(children[0].second.size(), children[1].second.size()) < ids.size();
    };
    return grow(Region{}, all(input), divide);
}

}  // namespace partition

namespace {

glm::uvec4 texel(const glm::vec3& v, std::uint32_t w) {
    return {glm::floatBitsToUint(v), w};
}

/** Appends words, four a texel; returns the index of the first as a word. */
std::uint32_t appendWords(std::vector<glm::uvec4>& texels, std::span<const std::uint32_t> words) {
    const std::size_t first = texels.size();
    texels.resize(first + (words.size() + 3) / 4, glm::uvec4(0));
    for (std::size_t i = 0; i < words.size(); ++i) texels[first + i / 4][int(i % 4)] = words[i];
    return std::uint32_t(first * 4);
}

/** Texels: lower | 0, upper | 0, then two a node: split | distance; first child, first reference as a word,
 * number of references, 0. */
Comparator packed(const partition::Input& input, const partition::Tree& tree) {
    Comparator result;
    result.depth = tree.depth;
    result.words = {texel(input.root.lower, 0), texel(input.root.upper, 0)};
    result.words.resize(2 + tree.nodes.size() * 2);
    std::vector<std::uint32_t> references;
    const std::uint32_t base = std::uint32_t(result.words.size() * 4);
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        const partition::Node& node = tree.nodes[i];
        result.words[2 + 2 * i] = texel(node.split, glm::floatBitsToUint(node.distance));
        result.words[3 + 2 * i] = {node.firstChild, base + std::uint32_t(references.size()),
                                   std::uint32_t(node.references.size()), 0};
        references.insert(references.end(), node.references.begin(), node.references.end());
    }
    appendWords(result.words, references);
    result.references = references.size();
    return result;
}

/** Texels: lower | cells in x, upper | in y, size of a cell | in z, word of the cells' first references, 0,
 * 0, 0. */
Comparator packed(const partition::Input& input, const partition::Grid& grid) {
    Comparator result;
    result.words = {texel(input.root.lower, std::uint32_t(grid.cells.x)),
                    texel(input.root.upper, std::uint32_t(grid.cells.y)),
                    texel(grid.cellSize, std::uint32_t(grid.cells.z)), glm::uvec4(0)};
    const std::uint32_t references = appendWords(result.words, grid.references);
    std::vector<std::uint32_t> first = grid.first;
    for (std::uint32_t& f : first) f += references;
    result.words[3].x = appendWords(result.words, first);
    result.references = grid.references.size();
    return result;
}

}  // namespace

std::string_view acceleratorName(AcceleratorKind kind) {
    constexpr std::array<std::string_view, 9> names = {"auto",    "bvh", "brute-force", "grid", "octree",
                                                       "kd-tree", "bsp", "sbvh",        "lbvh"};
    return names[std::size_t(kind)];
}

Comparator buildComparator(AcceleratorKind kind, std::span<const glm::vec3> positions) {
    const std::size_t triangles = positions.size() / 3;
    if (kind == AcceleratorKind::BruteForce) {
        if (triangles > kMaxBruteForce)
            throw InputError(
                "", "accelerator",
                fmt::format("{} triangles are more than a ray may test one by one", triangles),
                fmt::format("take another accelerator than brute-force above {}", kMaxBruteForce));
        return {.words = {glm::uvec4(std::uint32_t(triangles), 0, 0, 0)}};
    }
    const partition::Input input(positions);
    switch (kind) {
        case AcceleratorKind::Grid:
            return packed(input, buildGrid(input));
        case AcceleratorKind::Octree:
            return packed(input, buildOctree(input));
        case AcceleratorKind::KdTree:
            return packed(input, buildKdTree(input));
        default:
            return packed(input, buildBsp(input));
    }
}

}  // namespace helio
