#include "passes/intersect/ray_intersector.hpp"

#include "passes/intersect/tree_access.hpp"

#include <heliograph_kernels/intersect.hpp>

#include <cassert>
#include <map>
#include <string>

namespace helio {
namespace {

constexpr std::uint32_t kGroupSize = 64;
/** Rays of a workgroup: enough that lanes seldom wait for a run's last rays, few enough for even halves. */
constexpr std::uint32_t kRaysPerGroup = 32 * kGroupSize;

/** The kernel that walks the accelerator the scene is packed with. */
Kernel kernelFor(const PackedScene& packed, std::map<std::string, std::string> defines) {
    if (packed.accelerator != AcceleratorKind::Bvh)
        return compileVariant(shaders::intersectEach, acceleratorVariant(packed.accelerator));
    if (!packed.placed.empty()) defines["INSTANCES"] = "1";
    if (defines.empty()) return shaders::intersect;
    return compileVariant(shaders::intersect, {.defines = defines, .generated = {}});
}

/** Loop turns a subgroup may start with, of the 65,535 that lavapipe runs; a ray may take 16,000. */
constexpr std::uint32_t kBudget = 30000;

}  // namespace

RayIntersector::RayIntersector(Device& device, const PackedScene& packed, RayQuestion question,
                               std::size_t capacity, const std::optional<TreeAccess>& access)
    : triangles_(makeBuffer(device, "intersect.triangles", packed.triangles)),
      nodes_(makeBuffer(device, "intersect.nodes", packed.nodes)),
      rays_(device, "intersect.rays", capacity * sizeof(Ray)),
      hits_(device, "intersect.hits", capacity * sizeof(RayHit)),
      cursors_(device, "intersect.cursors",
               (capacity + kRaysPerGroup - 1) / kRaysPerGroup * kGroupSize * sizeof(std::uint32_t)),
      counters_(device, "intersect.counters", sizeof(Counters)),
      capacity_(capacity) {
    assert(packed.nodeCount > 0 && capacity > 0 && capacity <= (1u << 23));
    Graph graph(device);
    const Buffer counters = graph.import(counters_);
    SpecConstants spec = {{"ANY", question == RayQuestion::Any},
                          {"STACK_SIZE", std::int32_t(packed.treeDepth + 1)}};
    if (packed.accelerator == AcceleratorKind::Bvh) spec["SUBGROUP_SIZE"] = device.info().subgroupSize;
    const TreeAccess reading = access.value_or(keptTreeAccess(device));
    if (packed.accelerator == AcceleratorKind::Bvh) spec.merge(accessConstants(reading));
    if (packed.splitTree) spec["SPLIT_TREE"] = true;
    std::vector<Binding> placed;
    if (!packed.placed.empty()) {
        placed_ = makeBuffer(device, "intersect.placed", packed.placed);
        placed.push_back({"uPlaced", graph.import(*placed_)});
    }
    graph.compute("intersect", kernelFor(packed, accessDefines(reading, device, packed)), {.spec = spec})
        .reads(placed)
        .reads({{"uTriangles", graph.import(triangles_)},
                {"uNodes", graph.import(nodes_)},
                {"uRays", graph.import(rays_)}})
        .writes({{"uHits", graph.import(hits_)}})
        .modifies({{"uCursors", graph.import(cursors_)}, {"uCounters", counters}})
        .record([this](Commands& commands) {
            commands.push(parameters_)
                .dispatch((parameters_.count + parameters_.raysPerGroup - 1) / parameters_.raysPerGroup);
        });
    counted_ = graph.readback<Counters>(counters);
    plan_ = graph.compile();
}

void RayIntersector::upload(std::span<const Ray> rays) {
    assert(rays.size() <= capacity_);
    rays_.upload(rays.data(), rays.size_bytes());
    parameters_ = {std::uint32_t(rays.size()), kRaysPerGroup, kBudget, 1};
}

void RayIntersector::run() {
    abandoned_ = 0;
    parameters_.begin = 1;
    for (Counters counters{1, 0}; counters.open > 0; parameters_.begin = 0) {
        constexpr Counters zero{0, 0};
        counters_.upload(&zero, sizeof zero);
        counters = counted_.wait(plan_.execute()).at(0);
        abandoned_ += counters.abandoned;
    }
}

std::vector<RayHit> RayIntersector::hits() const {
    std::vector<RayHit> result(parameters_.count);
    hits_.download(result.data(), result.size() * sizeof(RayHit));
    return result;
}

}  // namespace helio
