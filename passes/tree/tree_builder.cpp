#include "passes/tree/tree_builder.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>
#include <heliograph_kernels/tree.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>

namespace helio {
namespace {

// As passes/tree/tree.glsl has them.
constexpr std::uint32_t kRun = 256, kDigits = 64, kDigitBits = 6, kCodeBits = 30;
/** A dispatch has at most 65,535 workgroups of 64. */
constexpr std::uint32_t kInvocations = 1u << 21;
/** Differences of coordinates are floats. */
constexpr float kFarthestCorner = 1.7e38f;

std::uint64_t runsOf(std::uint64_t values) {
    return (values + kRun - 1) / kRun;
}

/** Places of nodes at most: a node with nodes below has eight children, of which each further one of those is
 * a leaf, so that blocks of eight are at most a seventh of the triangles, and the root besides. */
std::uint64_t placesFor(std::uint64_t triangles) {
    return 8 * (triangles / 7 + 1) + 1;
}

/** Triangles that there is room for: two at least. */
std::uint64_t checked(const Device& device, std::size_t capacity) {
    const std::uint64_t most = TreeBuilder::mostTriangles(device);
    if (capacity > most)
        throw InputError("", "tree",
                         fmt::format("{} triangles are more than this device builds a tree of", capacity),
                         fmt::format("take another accelerator than lbvh above {}", most));
    return std::max<std::size_t>(capacity, 2);
}

}  // namespace

std::uint64_t TreeBuilder::mostTriangles(const Device& device) {
    const std::uint64_t places =
        std::min<std::uint64_t>(device.info().maxStorageBufferRange / sizeof(BvhNode), 1u << 24);
    return (places - 9) / 8 * 7;
}

TreeBuilder::TreeBuilder(Device& device, std::size_t capacity)
    : capacity_(checked(device, capacity)),
      corners_(device, "tree.corners", capacity_ * 36),
      codes_(device, "tree.codes", capacity_ * 8),
      sorted_(device, "tree.sorted", capacity_ * 8),
      table_(device, "tree.table", kDigits * runsOf(capacity_) * 4),
      runs_(device, "tree.runs",
            (1 + runsOf(std::max(kDigits * runsOf(capacity_), placesFor(capacity_)))) * 4),
      boxes_(device, "tree.boxes", (3 * capacity_ + 32) * 24),
      children_(device, "tree.children", (capacity_ - 1) * 8),
      ranges_(device, "tree.ranges", (capacity_ - 1) * 8),
      items_(device, "tree.items", placesFor(capacity_) * 8),
      opened_(device, "tree.opened", placesFor(capacity_) * 32),
      values_(device, "tree.values", placesFor(capacity_) * 4),
      nodes_(device, "tree.nodes", placesFor(capacity_) * sizeof(BvhNode)),
      order_(device, "tree.order", capacity_ * 4) {
    declareSort(device);
    declareLevel(device);
}

namespace {

/** A pass over as many invocations as `count` says when it runs. */
auto over(auto count, auto push) {
    return [count, push](Commands& commands) {
        const std::uint64_t all = count();
        for (std::uint64_t first = 0; first < all; first += kInvocations) {
            auto at = push();
            at.first = std::uint32_t(first);
            commands.push(at).dispatchInvocations(std::min<std::uint64_t>(kInvocations, all - first));
        }
    };
}

/** Sums before each of a buffer's values, in place. */
void declareSums(Graph& graph, const char* name, Buffer values, Buffer runs, auto count, auto push) {
    for (std::int32_t step = 0; step < 3; ++step)
        graph.compute(fmt::format("{}{}", name, step), shaders::treeSum, {.spec = {{"STEP", step}}})
            .modifies({{"uValues", values}, {"uRuns", runs}})
            .record(over([count, step] { return step == 1 ? std::uint64_t(1) : runsOf(count()); },
                         [count, push] {
                             auto summed = push();
                             summed.count = std::uint32_t(count());
                             return summed;
                         }));
}

}  // namespace

void TreeBuilder::declareSort(Device& device) {
    Graph graph(device);
    const Buffer corners = graph.import(corners_), table = graph.import(table_), runs = graph.import(runs_);
    std::array<Buffer, 2> codes = {graph.import(codes_), graph.import(sorted_)};
    const auto triangles = [this] { return std::uint64_t(push_.triangles); };
    const auto push = [this] { return push_; };
    graph.compute("tree.codes", shaders::treeCodes)
        .reads({{"uCorners", corners}})
        .writes({{"uCodes", codes[0]}})
        .record(over(triangles, push));
    static_assert(kCodeBits / kDigitBits % 2 == 1, "the last sort leaves codes in sorted_");
    for (std::uint32_t shift = 0; shift < kCodeBits; shift += kDigitBits) {
        const auto shifted = [this, shift] {
            Push at = push_;
            at.shift = shift;
            return at;
        };
        const auto ofRuns = [this] { return runsOf(push_.triangles); };
        graph.compute(fmt::format("tree.count{}", shift), shaders::treeCount)
            .reads({{"uCodes", codes[0]}})
            .modifies({{"uTable", table}})
            .record(over(ofRuns, shifted));
        declareSums(
            graph, "tree.sum", table, runs, [this] { return kDigits * runsOf(push_.triangles); }, push);
        graph.compute(fmt::format("tree.scatter{}", shift), shaders::treeScatter)
            .reads({{"uCodes", codes[0]}})
            .modifies({{"uTable", table}})
            .writes({{"uSorted", codes[1]}})
            .record(over(ofRuns, shifted));
        std::swap(codes[0], codes[1]);
    }
    const Buffer ranges = graph.import(ranges_), boxes = graph.import(boxes_);
    graph.compute("tree.link", shaders::treeLink)
        .reads({{"uSorted", codes[0]}})
        .writes({{"uChildren", graph.import(children_)}, {"uRanges", ranges}})
        .record(over([this] { return std::uint64_t(push_.triangles - 1); }, push));
    const auto declareBoxes = [&](std::int32_t step, auto count, auto pushed) {
        graph.compute(fmt::format("tree.boxes{}", step), shaders::treeBoxes, {.spec = {{"STEP", step}}})
            .reads({{"uCorners", corners}, {"uSorted", codes[0]}, {"uRanges", ranges}})
            .modifies({{"uBoxes", boxes}})
            .record(over(count, pushed));
    };
    declareBoxes(0, triangles, push);
    for (int level = 0; level < int(std::bit_width(capacity_ - 1)); ++level) {
        const auto below = [this, level] {
            Push at = push_;
            at.begin = push_.triangles - 1;
            at.count = push_.triangles;
            for (int k = 0; k < level; ++k) {
                at.begin += at.count;
                at.count = (at.count + 1) / 2;
            }
            return at;
        };
        declareBoxes(
            1, [below] { return below().count > 1 ? (below().count + 1) / 2 : 0; }, below);
    }
    declareBoxes(
        2, [this] { return std::uint64_t(push_.triangles - 1); }, push);
    sort_ = graph.compile({.executionsInFlight = 1});
}

void TreeBuilder::declareLevel(Device& device) {
    Graph graph(device);
    const Buffer boxes = graph.import(boxes_), ranges = graph.import(ranges_), items = graph.import(items_),
                 opened = graph.import(opened_), values = graph.import(values_);
    const auto places = [this] { return std::uint64_t(push_.count - push_.begin); };
    const auto push = [this] { return push_; };
    graph.compute("tree.open", shaders::treeOpen)
        .reads({{"uBoxes", boxes},
                {"uChildren", graph.import(children_)},
                {"uRanges", ranges},
                {"uItems", items}})
        .writes({{"uOpened", opened}, {"uValues", values}})
        .record(over(places, push));
    declareSums(graph, "tree.blocks", values, graph.import(runs_), places, push);
    graph.compute("tree.write", shaders::treeWrite)
        .reads({{"uBoxes", boxes},
                {"uSorted", graph.import(sorted_)},
                {"uRanges", ranges},
                {"uOpened", opened},
                {"uValues", values}})
        .modifies({{"uItems", items}})
        .writes({{"uNodesOut", graph.import(nodes_)}, {"uOrder", graph.import(order_)}})
        .record(over(places, push));
    level_ = graph.compile({.executionsInFlight = 1});
}

Bvh TreeBuilder::build(std::span<const glm::vec3> positions) {
    assert(positions.size() % 3 == 0 && positions.size() / 3 <= capacity_);
    glm::vec3 lower(kFarthestCorner), upper(-kFarthestCorner);
    for (const glm::vec3& p : positions) {
        // Fails for NaN.
        if (!(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= kFarthestCorner) || p.x != p.x ||
            p.y != p.y || p.z != p.z)
            throw InputError("", fmt::format("triangle {}", (&p - positions.data()) / 3),
                             "a corner is not finite or farther than 1.7e38 from the origin",
                             "correct the positions");
        lower = glm::min(lower, p);
        upper = glm::max(upper, p);
    }
    const std::uint32_t n = std::uint32_t(positions.size() / 3);
    if (n < 2) return buildBvh(positions);
    const glm::vec3 size = upper - lower;
    const float extent = std::max({size.x, size.y, size.z});
    const auto range = [&](std::uint32_t begin, std::uint32_t end) {
        push_ = {0, end, begin, 0, lower, extent > 1e-37f ? 1.0f / extent : 0.0f, n};
    };
    corners_.upload(positions.data(), positions.size_bytes());
    range(0, 0);
    sort_.wait(sort_.execute());
    const std::array<std::uint32_t, 2> first = {0, 0};  // the root's reference
    items_.upload(first.data(), sizeof first);

    Bvh tree;
    for (std::uint32_t begin = 0, end = 1; begin < end; ++tree.depth) {
        range(begin, end);
        level_.wait(level_.execute());
        std::uint32_t blocks = 0;
        runs_.download(&blocks, sizeof blocks);
        begin = end;
        end += 8 * blocks;
        assert(end <= placesFor(n));
    }
    const std::uint32_t places = push_.count;
    tree.nodes.resize(places);
    nodes_.download(tree.nodes.data(), places * sizeof(BvhNode));
    tree.order.resize(n);
    order_.download(tree.order.data(), n * sizeof(std::uint32_t));
    tree.usedNodes = 1;
    for (const BvhNode& node : tree.nodes) tree.usedNodes += std::uint32_t(std::popcount(node.slots & 0xffu));
    return tree;
}

}  // namespace helio
