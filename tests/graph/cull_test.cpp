/** @file Which passes live, and the versions of resources. */
#include "tests/graph/plan_queries.hpp"

#include <gtest/gtest.h>

namespace helio::graph {
namespace {

using Names = std::vector<std::string>;

TEST(Cull, ChainIsKeptInOrder) {
    const Chain g(3);
    const Compiled plan = g.compile();
    EXPECT_EQ(livePasses(g.input, plan), (Names{"p0", "p1", "p2"}));
    expectSound(g, plan);
}

TEST(Cull, UnusedOutput) {
    Builder g;
    const auto a = g.buffer("a"), b = g.buffer("b");
    g.pass("wanted").writes(a);
    g.pass("unwanted").reads(a).writes(b);
    g.readback(a);
    const Compiled plan = g.compile();
    EXPECT_EQ(livePasses(g.input, plan), Names{"wanted"});
    ASSERT_EQ(plan.culledPasses.size(), 1u);
    EXPECT_EQ(plan.culledPasses[0].reason, "no root needs what it writes: 'b'");
    EXPECT_EQ(plan.unusedResources, std::vector<std::uint32_t>{b});
    EXPECT_EQ(placementOf(plan, b), nullptr) << "memory for a resource nobody touches";
}

TEST(Cull, WholeUnusedBranch) {
    Builder g;
    const auto a = g.buffer("a"), b = g.buffer("b"), c = g.buffer("c"), d = g.buffer("d");
    g.pass("a").writes(a);
    g.pass("b").reads(a).writes(b);
    g.pass("c").reads(b).writes(c);
    g.pass("d").reads(a).writes(d);
    g.readback(d);
    EXPECT_EQ(livePasses(g.input, g.compile()), (Names{"a", "d"}));
}

TEST(Cull, OneUsedOutputOfTwoKeepsThePass) {
    Builder g;
    const auto a = g.buffer("a"), b = g.buffer("b");
    g.pass("both").writes(a).writes(b);
    g.readback(b);
    const Compiled plan = g.compile();
    EXPECT_EQ(livePasses(g.input, plan), Names{"both"});
    EXPECT_NE(placementOf(plan, a), nullptr) << "a live pass writes it";
}

TEST(Cull, Diamond) {
    Builder g;
    const auto top = g.buffer("top"), left = g.buffer("left"), right = g.buffer("right"),
               bottom = g.buffer("bottom");
    g.pass("top").overwrites(top);
    g.pass("left").reads(top).overwrites(left);
    g.pass("right").reads(top).overwrites(right);
    g.pass("bottom").reads(left).reads(right).overwrites(bottom);
    g.readback(bottom);
    const Compiled plan = g.compile();
    EXPECT_EQ(livePasses(g.input, plan), (Names{"top", "left", "right", "bottom"}));
    EXPECT_NE(barrierOn(*stepOf(g.input, plan, "left"), top), nullptr);
    EXPECT_EQ(barrierOn(*stepOf(g.input, plan, "right"), top), nullptr) << "already visible";
    EXPECT_TRUE(shareMemory(plan, top, bottom));
    EXPECT_FALSE(shareMemory(plan, left, right));
    expectSound(g, plan);
}

TEST(Cull, KeepMarksARootWithItsProducers) {
    Builder g;
    const auto a = g.buffer("a");
    g.pass("make").writes(a);
    g.pass("effect").reads(a).keep();
    EXPECT_EQ(livePasses(g.input, g.compile()), (Names{"make", "effect"}));
}

TEST(Cull, KeepNeedsNoResources) {
    Builder g;
    g.pass("effect").keep();
    EXPECT_EQ(livePasses(g.input, g.compile()), Names{"effect"});
}

TEST(Cull, PassThatOnlyReads) {
    Builder g;
    const auto a = g.buffer("a");
    g.pass("make").writes(a);
    g.pass("look").reads(a);
    g.readback(a);
    const Compiled plan = g.compile();
    ASSERT_EQ(plan.culledPasses.size(), 1u);
    EXPECT_EQ(plan.culledPasses[0].reason, "it writes nothing");
}

TEST(Cull, ImportedWriteIsARoot) {
    Builder g;
    const auto a = g.importBuffer("a"), b = g.importBuffer("b");
    g.pass("p").reads(a).writes(b);
    EXPECT_EQ(livePasses(g.input, g.compile()), Names{"p"});
}

TEST(Cull, WriteThenWriteKeepsBothSinceTheSecondMayBePartial) {
    Builder g;
    const auto a = g.buffer("a");
    g.pass("first").writes(a);
    g.pass("second").writes(a);
    g.readback(a);
    const Compiled plan = g.compile();
    EXPECT_EQ(livePasses(g.input, plan), (Names{"first", "second"}));
    const Barrier* barrier = barrierOn(*stepOf(g.input, plan, "second"), a);
    ASSERT_NE(barrier, nullptr);
    EXPECT_EQ(barrier->cause, Cause::WriteAfterWrite);
    EXPECT_EQ(barrier->fromAccess, access::StorageWrite);
    expectSound(g, plan);
}

TEST(Cull, WriteThenOverwriteDropsTheFirst) {
    Builder g;
    const auto a = g.buffer("a");
    g.pass("first").writes(a);
    g.pass("second").overwrites(a);
    g.readback(a);
    EXPECT_EQ(livePasses(g.input, g.compile()), Names{"second"});
}

TEST(Cull, FillOverwrites) {
    Builder g;
    const auto a = g.buffer("a");
    g.pass("first").writes(a);
    g.fill("zero", a);
    g.pass("add").modifies(a);
    g.readback(a);
    EXPECT_EQ(livePasses(g.input, g.compile()), (Names{"zero", "add"}));
}

TEST(Cull, ReadBetweenWriteAndOverwriteKeepsTheFirst) {
    Builder g;
    const auto a = g.buffer("a"), b = g.buffer("b");
    g.pass("first").writes(a);
    g.pass("between").reads(a).writes(b);
    g.pass("second").overwrites(a);
    g.readback(a);
    g.readback(b);
    const Compiled plan = g.compile();
    EXPECT_EQ(livePasses(g.input, plan), (Names{"first", "between", "second"}));
    const Barrier* barrier = barrierOn(*stepOf(g.input, plan, "second"), a);
    ASSERT_NE(barrier, nullptr);
    EXPECT_EQ(barrier->cause, Cause::WriteAfterRead);
    expectSound(g, plan);
}

TEST(Cull, CulledReaderDoesNotKeepItsSource) {
    Builder g;
    const auto a = g.buffer("a"), b = g.buffer("b"), c = g.buffer("c");
    g.pass("a").writes(a);
    g.pass("b").reads(a).writes(b);
    g.pass("c").writes(c);
    g.readback(c);
    EXPECT_EQ(livePasses(g.input, g.compile()), Names{"c"});
}

TEST(Cull, ModifiesChainKeepsEveryLink) {
    Builder g;
    const auto a = g.buffer("a");
    g.pass("set").overwrites(a);
    for (int i = 0; i < 4; ++i) g.pass("add" + std::to_string(i)).modifies(a);
    g.readback(a);
    const Compiled plan = g.compile();
    EXPECT_EQ(livePasses(g.input, plan).size(), 5u);
    for (int i = 0; i < 4; ++i)
        EXPECT_NE(barrierOn(*stepOf(g.input, plan, "add" + std::to_string(i)), a), nullptr);
    expectSound(g, plan);
}

TEST(Cull, WorkAfterTheLastReadIsDropped) {
    Builder g;
    const auto a = g.buffer("a"), b = g.importBuffer("b");
    g.pass("set").writes(a);
    g.pass("use").reads(a).writes(b);
    g.pass("late").modifies(a);
    EXPECT_EQ(livePasses(g.input, g.compile()), (Names{"set", "use"}));
}

TEST(Versions, CountWritesPerResource) {
    Builder g;
    const auto a = g.buffer("a"), b = g.importBuffer("b");
    g.pass("w1").writes(a);
    g.pass("w2").modifies(a);
    g.pass("r").reads(a).writes(b);
    const Compiled plan = g.compile();
    EXPECT_EQ(stepOf(g.input, plan, "w1")->uses[0].versionAfter, 1u);
    EXPECT_EQ(stepOf(g.input, plan, "w2")->uses[0].versionBefore, 1u);
    EXPECT_EQ(stepOf(g.input, plan, "w2")->uses[0].versionAfter, 2u);
    EXPECT_EQ(stepOf(g.input, plan, "r")->uses[0].versionBefore, 2u);
    EXPECT_EQ(stepOf(g.input, plan, "r")->uses[0].versionAfter, 2u);
}

}  // namespace
}  // namespace helio::graph
