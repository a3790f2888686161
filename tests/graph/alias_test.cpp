/** @file Placement of transients in shared memory. */
#include "tests/graph/plan_queries.hpp"

#include <gtest/gtest.h>

namespace helio::graph {
namespace {

TEST(Alias, ChainNeedsTwoSlotsOnly) {
    const Chain g(8);
    const Compiled plan = g.compile();
    EXPECT_EQ(plan.aliasing.transientBytes, 8u * 1024);
    EXPECT_EQ(plan.aliasing.allocatedBytes, 2u * 1024);
    expectSound(g, plan);
}

TEST(Alias, OffKeepsAllApart) {
    Chain g(8);
    g.input.alias = false;
    const Compiled plan = g.compile();
    EXPECT_EQ(plan.aliasing.allocatedBytes, 8u * 1024);
    for (std::size_t i = 1; i < g.links.size(); ++i)
        for (std::size_t j = 1; j < i; ++j) EXPECT_FALSE(shareMemory(plan, g.links[i], g.links[j]));
    expectSound(g, plan);
}

TEST(Alias, BuffersAndImagesShareMemory) {
    Builder g;
    const auto source = g.importBuffer("source");
    const auto a = g.buffer("a", 4096), b = g.buffer("b", 64), c = g.image("c", 16, 16),
               d = g.importBuffer("d");
    g.pass("1").reads(source).writes(a);
    g.pass("2").reads(a).writes(b);
    g.pass("3").reads(b).writes(c);
    g.pass("4").reads(c).writes(d);
    const Compiled plan = g.compile();
    EXPECT_TRUE(shareMemory(plan, a, c));
    const Step& step = *stepOf(g.input, plan, "3");
    ASSERT_GE(step.barriers.size(), 2u);
    EXPECT_EQ(step.barriers[0].resource, none) << "the memory barrier comes first";
    EXPECT_EQ(step.barriers[0].cause, Cause::Aliasing);
    EXPECT_EQ(step.barriers[0].former, std::vector<std::uint32_t>{a});
    EXPECT_EQ(step.barriers[0].fromAccess, access::StorageWrite);
    expectSound(g, plan);
}

TEST(Alias, HandOverBetweenUnrelatedResourcesWaits) {
    Builder g;
    const auto a = g.buffer("a"), b = g.buffer("b"), x = g.importBuffer("x"), y = g.importBuffer("y");
    g.pass("a").overwrites(a);
    g.pass("use a").reads(a).modifies(x);
    g.pass("b").overwrites(b);
    g.pass("use b").reads(b).modifies(y);
    const Compiled plan = g.compile();
    ASSERT_TRUE(shareMemory(plan, a, b));
    const Step& step = *stepOf(g.input, plan, "b");
    ASSERT_EQ(step.barriers.size(), 1u);
    EXPECT_EQ(step.barriers[0].fromStages, stage::Compute);
    EXPECT_EQ(step.barriers[0].toAccess, access::StorageWrite);
    expectSound(g, plan);
}

TEST(Alias, ReadbackEndsALife) {
    Builder g;
    const auto a = g.buffer("a"), b = g.buffer("b");
    g.pass("a").overwrites(a);
    g.pass("b").overwrites(b);
    g.readback(a);
    g.readback(b);
    EXPECT_FALSE(shareMemory(g.compile(), a, b));
}

TEST(Alias, OutputNobodyReadsStillHoldsItsMemoryWhileItsPassRuns) {
    Builder g;
    const auto a = g.buffer("a"), b = g.buffer("b");
    g.pass("p").writes(a).writes(b);
    g.readback(b);
    EXPECT_FALSE(shareMemory(g.compile(), a, b));
}

TEST(Alias, InputAndOutputOfOnePassDoNotShare) {
    const Chain g(2);
    EXPECT_FALSE(shareMemory(g.compile(), g.links[1], g.links[2]));
}

TEST(Alias, AlignmentIsKept) {
    Builder g;
    const auto a = g.buffer("a", 64), b = g.buffer("b", 64);
    g.input.resources[b].alignment = 256;
    g.input.resources[a].alignment = 256;
    g.pass("p").writes(a).writes(b);
    g.readback(b);
    const Compiled plan = g.compile();
    EXPECT_EQ(placementOf(plan, a)->offset % 256, 0u);
    EXPECT_EQ(placementOf(plan, b)->offset % 256, 0u);
    EXPECT_EQ(plan.aliasing.allocatedBytes, 320u);
}

TEST(Alias, GranularityKeepsBuffersAndImagesApart) {
    Builder g;
    const auto a = g.buffer("a", 64), b = g.image("b", 2, 2), c = g.buffer("c", 64);
    g.input.limits.bufferImageGranularity = 1024;
    g.pass("p").writes(a).writes(b).writes(c);
    g.readback(b);
    const Compiled plan = g.compile();
    EXPECT_NE(placementOf(plan, a)->offset / 1024, placementOf(plan, b)->offset / 1024);
    EXPECT_EQ(placementOf(plan, a)->offset / 1024, placementOf(plan, c)->offset / 1024) << "both linear";
}

TEST(Alias, MemoryClassesDoNotMix) {
    Builder g;
    const auto a = g.buffer("a"), b = g.buffer("b"), x = g.importBuffer("x");
    g.input.resources[b].memoryClass = 1;
    g.pass("a").overwrites(a);
    g.pass("use a").reads(a).modifies(x);
    g.pass("b").overwrites(b);
    g.pass("use b").reads(b).modifies(x);
    const Compiled plan = g.compile();
    EXPECT_EQ(plan.arenas.size(), 2u);
    EXPECT_FALSE(shareMemory(plan, a, b));
}

TEST(Alias, ArenasStayBelowTheLimit) {
    Builder g;
    g.input.limits.maxArenaBytes = 2048;
    std::vector<std::uint32_t> buffers;
    auto pass = g.pass("p");
    for (int i = 0; i < 5; ++i) {
        buffers.push_back(g.buffer("t" + std::to_string(i)));
        pass.writes(buffers.back());
    }
    g.readback(buffers[0]);
    const Compiled plan = g.compile();
    EXPECT_EQ(plan.arenas.size(), 3u);
    for (const Arena& arena : plan.arenas) EXPECT_LE(arena.bytes, 2048u);
}

}  // namespace
}  // namespace helio::graph
