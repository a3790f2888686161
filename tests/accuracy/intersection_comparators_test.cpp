// Every accelerator gives the same hits as testing all triangles, bit by bit.
#include "passes/tree/tree_builder.hpp"
#include "tests/accuracy/intersection_support.hpp"
#include "tests/support/meshes.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>

namespace helio::test {
namespace {

constexpr std::array kKinds = {AcceleratorKind::Bvh,      AcceleratorKind::Grid, AcceleratorKind::Octree,
                               AcceleratorKind::KdTree,   AcceleratorKind::Bsp,  AcceleratorKind::SplitBvh,
                               AcceleratorKind::DeviceBvh};

/** Random triangles of very uneven size and slenderness, some flat in a plane of the axes, some coincident.
 */
Corners mixture() {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
    const auto point = [&] { return glm::vec3(uniform(random), uniform(random), uniform(random)); };
    Corners corners;
    for (int i = 0; i < 1500; ++i) {
        const glm::vec3 centre = point();
        const float size = std::exp(1.5f * uniform(random) - 2.5f);
        for (int k = 0; k < 3; ++k)
            corners.push_back(centre + size * point() * glm::vec3(1, 1, i % 3 == 0 ? 0 : 1));
    }
    for (int i = 0; i < 90; ++i) corners.push_back(corners[std::size_t(i)]);
    return corners;
}

PackOptions packingFor(AcceleratorKind kind) {
    PackOptions options;
    if (kind == AcceleratorKind::SplitBvh)
        options.spatialSplits = true;
    else if (kind != AcceleratorKind::DeviceBvh)
        options.accelerator = kind;
    return options;
}

/** `sources`: g of the triangle that a ray leaves, -1 for none. */
std::vector<RayHit> hitsOf(AcceleratorKind kind, const Scene& scene, RayQuestion question,
                           std::span<const Ray> rays, std::span<const std::int32_t> sources,
                           std::vector<std::uint32_t>& g) {
    BuildTree build;
    if (kind == AcceleratorKind::DeviceBvh)
        build = [](std::span<const glm::vec3> all) {
            return TreeBuilder(device(), all.size() / 3).build(all);
        };
    const PackedScene packed = packScene(scene, {}, packingFor(kind), build);
    EXPECT_TRUE(!packed.splitTree || kind == AcceleratorKind::SplitBvh);
    EXPECT_EQ(packed.triangles.size(), packed.triangleCount * 3u);
    std::vector<std::int32_t> slotOf(scene.triangleCount(), -1);  // the last of several
    for (std::uint32_t slot = 0; slot < packed.triangleCount; ++slot)
        slotOf[glm::floatBitsToUint(packed.triangles[slot * 3].w)] = std::int32_t(slot);
    std::vector<Ray> leaving(rays.begin(), rays.end());
    for (std::size_t i = 0; i < rays.size(); ++i)
        leaving[i].source = sources[i] < 0 ? -1 : slotOf[std::size_t(sources[i])];
    RayIntersector intersector(device(), packed, question, rays.size());
    intersector.upload(leaving);
    intersector.run();
    EXPECT_EQ(intersector.abandoned(), 0u);
    const std::vector<RayHit> hits = intersector.hits();
    g.clear();
    for (const RayHit& hit : hits)
        g.push_back(hit.slot < 0 ? ~0u : glm::floatBitsToUint(packed.triangles[std::size_t(hit.slot) * 3].w));
    return hits;
}

void expectSameHits(const char* name, const Corners& corners, float reach) {
    SCOPED_TRACE(name);
    const Scene scene = sceneOf(corners);
    std::mt19937 random(2);
    std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
    std::vector<Ray> rays;
    std::vector<std::int32_t> sources;
    for (int i = 0; i < 60000; ++i) {
        glm::vec3 origin = reach * glm::vec3(uniform(random), uniform(random), uniform(random));
        // At corners, so that edges and cells' borders are met; along axes; anywhere.
        glm::vec3 direction = corners[random() % corners.size()] - origin;
        if (i % 4 == 1) direction = {uniform(random), uniform(random), uniform(random)};
        if (i % 8 == 2) direction = glm::vec3(0), direction[i / 8 % 3] = i % 16 == 2 ? 1.0f : -1.0f;
        sources.push_back(-1);
        if (i % 3 == 1) {  // from a point of a triangle
            sources.back() = std::int32_t(random() % (corners.size() / 3));
            const glm::vec3* t = &corners[std::size_t(sources.back()) * 3];
            const float u = 0.5f + 0.5f * uniform(random), v = (1.0f - u) * (0.5f + 0.5f * uniform(random));
            origin = t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
        }
        rays.push_back({.origin = origin,
                        .limit = i % 5 == 0 ? 0.9f : std::numeric_limits<float>::infinity(),
                        .direction = direction});
    }
    for (RayQuestion question : {RayQuestion::Closest, RayQuestion::Any}) {
        std::vector<std::uint32_t> wantedG, g;
        const std::vector<RayHit> wanted =
            hitsOf(AcceleratorKind::BruteForce, scene, question, rays, sources, wantedG);
        const auto found = std::ranges::count_if(wanted, [](const RayHit& hit) { return hit.slot >= 0; });
        EXPECT_GT(found, 10000);
        EXPECT_LT(found, 59000);
        for (AcceleratorKind kind : kKinds) {
            const std::vector<RayHit> hits = hitsOf(kind, scene, question, rays, sources, g);
            std::size_t wrong = 0;
            for (std::size_t i = 0; i < hits.size(); ++i)
                wrong += question == RayQuestion::Closest
                             ? (g[i] != wantedG[i] || hits[i].distance != wanted[i].distance ? 1u : 0u)
                             : ((hits[i].slot < 0) != (wanted[i].slot < 0) ? 1u : 0u);
            EXPECT_EQ(wrong, 0u) << acceleratorName(kind);
        }
    }
}

TEST(Intersection, AcceleratorsGiveTheHitsOfBruteForce) {
    EXPECT_TRUE(packScene(sceneOf(mixture()), packingFor(AcceleratorKind::SplitBvh)).splitTree);
    expectSameHits("mixture", mixture(), 3.0f);
    expectSameHits("sphere", octasphere(4), 2.0f);
    Corners away = octasphere(3);
    for (glm::vec3& p : away) p = 0.01f * p + glm::vec3(1.0f, 2.0f, 0.0f);
    expectSameHits("small and away", away, 1.9f);
}

TEST(Intersection, BruteForceIsRefusedWhereARayCannotTestAll) {
    EXPECT_THROW(packScene(sceneOf(cloud(kMaxBruteForce + 1)), {.accelerator = AcceleratorKind::BruteForce}),
                 InputError);
    EXPECT_NO_THROW(packScene(sceneOf(cloud(kMaxBruteForce)), {.accelerator = AcceleratorKind::BruteForce}));
    EXPECT_EQ(packScene(Scene{}, {.accelerator = AcceleratorKind::Grid}).nodeCount, 0u);
}

}  // namespace
}  // namespace helio::test
