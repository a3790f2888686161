/** @file Barriers, image layouts and poison, case by case. */
#include "tests/graph/plan_queries.hpp"

#include <gtest/gtest.h>

namespace helio::graph {
namespace {

using Names = std::vector<std::string>;

TEST(Barriers, NoneBetweenIndependentPasses) {
    Builder g;
    const auto a = g.buffer("a"), b = g.buffer("b");
    g.pass("a").overwrites(a);
    g.pass("b").overwrites(b);
    g.readback(a);
    g.readback(b);
    const Compiled plan = g.compile();
    EXPECT_TRUE(stepOf(g.input, plan, "a")->barriers.empty());
    EXPECT_TRUE(stepOf(g.input, plan, "b")->barriers.empty());
}

TEST(Barriers, ReadAfterWriteNamesStagesAndAccesses) {
    Builder g;
    const auto a = g.buffer("a"), b = g.buffer("b");
    g.pass("w").writes(a);
    g.pass("r").access(a, Mode::Read, Usage::UniformTexelBuffer).writes(b);
    g.readback(b);
    const Compiled plan = g.compile();
    const Barrier* barrier = barrierOn(*stepOf(g.input, plan, "r"), a);
    ASSERT_NE(barrier, nullptr);
    EXPECT_EQ(barrier->fromStages, stage::Compute);
    EXPECT_EQ(barrier->fromAccess, access::StorageWrite);
    EXPECT_EQ(barrier->toStages, stage::Compute);
    EXPECT_EQ(barrier->toAccess, access::SampledRead);
    EXPECT_EQ(barrier->cause, Cause::ReadAfterWrite);
}

TEST(Barriers, AnotherKindOfReadNeedsItsOwnVisibility) {
    Builder g;
    const auto a = g.buffer("a"), b = g.importBuffer("b");
    g.pass("w").writes(a);
    g.pass("r1").reads(a).modifies(b);
    g.pass("r2").access(a, Mode::Read, Usage::UniformTexelBuffer).modifies(b);
    g.pass("r3").reads(a).modifies(b);
    const Compiled plan = g.compile();
    ASSERT_NE(barrierOn(*stepOf(g.input, plan, "r2"), a), nullptr);
    EXPECT_EQ(barrierOn(*stepOf(g.input, plan, "r2"), a)->toAccess, access::SampledRead);
    EXPECT_EQ(barrierOn(*stepOf(g.input, plan, "r3"), a), nullptr);
    expectSound(g, plan);
}

TEST(Barriers, IndirectArgumentsAreReadInTheirStage) {
    Builder g;
    const auto a = g.buffer("a", 64), b = g.buffer("b");
    g.pass("count").writes(a);
    g.pass("go").indirect(a).writes(b);
    g.readback(b);
    const Compiled plan = g.compile();
    const Barrier* barrier = barrierOn(*stepOf(g.input, plan, "go"), a);
    ASSERT_NE(barrier, nullptr);
    EXPECT_EQ(barrier->toStages, stage::Indirect);
    EXPECT_EQ(barrier->toAccess, access::IndirectRead);
    expectSound(g, plan);
}

TEST(Barriers, IndirectAndShaderReadOfOneBufferInOnePass) {
    Builder g;
    const auto a = g.buffer("a", 64), b = g.buffer("b");
    g.pass("count").writes(a);
    g.pass("go").indirect(a).reads(a).writes(b);
    g.readback(b);
    const Compiled plan = g.compile();
    const Barrier* barrier = barrierOn(*stepOf(g.input, plan, "go"), a);
    ASSERT_NE(barrier, nullptr);
    EXPECT_EQ(barrier->toStages, stage::Indirect | stage::Compute);
    EXPECT_EQ(barrier->toAccess, access::IndirectRead | access::StorageRead);
    expectSound(g, plan);
}

TEST(Barriers, WriteAfterReadIsAnExecutionDependency) {
    Builder g;
    const auto a = g.importBuffer("a"), b = g.buffer("b");
    g.pass("r").reads(a).writes(b);
    g.pass("w").writes(a);
    g.readback(b);
    const Compiled plan = g.compile();
    const Barrier* barrier = barrierOn(*stepOf(g.input, plan, "w"), a);
    ASSERT_NE(barrier, nullptr);
    EXPECT_EQ(barrier->fromStages, stage::Compute);
    EXPECT_EQ(barrier->fromAccess, access::None);
    EXPECT_EQ(barrier->cause, Cause::WriteAfterRead);
    expectSound(g, plan);
}

TEST(Barriers, WriteWaitsForReadersOfEveryStage) {
    Builder g;
    const auto a = g.buffer("a", 64), b = g.importBuffer("b", 64), c = g.importBuffer("c", 64);
    g.pass("w").overwrites(a);
    g.pass("r").indirect(a).modifies(b);
    g.copy("copy", a, c);
    g.pass("w2").modifies(a).modifies(b);
    const Compiled plan = g.compile();
    const Barrier* barrier = barrierOn(*stepOf(g.input, plan, "w2"), a);
    ASSERT_NE(barrier, nullptr);
    EXPECT_EQ(barrier->fromStages, stage::Compute | stage::Indirect | stage::Copy);
    expectSound(g, plan);
}

TEST(Barriers, ImportedNeedsNothingAtFirstUse) {
    Builder g;
    const auto a = g.importBuffer("a"), b = g.importImage("b");
    g.pass("p").reads(a).modifies(b);
    const Compiled plan = g.compile();
    EXPECT_TRUE(plan.steps[0].barriers.empty()) << "the opening barrier covers it";
    ASSERT_EQ(plan.entry.size(), 1u);
    EXPECT_EQ(plan.entry[0].fromAccess, access::AllWrites);
    expectSound(g, plan);
}

TEST(Barriers, FillAndCopyHaveTheirOwnStages) {
    Builder g;
    const auto a = g.buffer("a"), b = g.buffer("b");
    g.fill("fill", a);
    g.copy("copy", a, b);
    g.readback(b);
    const Compiled plan = g.compile();
    const Barrier* barrier = barrierOn(*stepOf(g.input, plan, "copy"), a);
    ASSERT_NE(barrier, nullptr);
    EXPECT_EQ(barrier->fromStages, stage::Clear);
    EXPECT_EQ(barrier->toStages, stage::Copy);
    EXPECT_EQ(barrier->toAccess, access::TransferRead);
    expectSound(g, plan);
}

TEST(Barriers, HostReadsWhatWasCopiedBack) {
    const Chain g(1);
    const Compiled plan = g.compile();
    ASSERT_EQ(plan.exit.size(), 1u);
    EXPECT_EQ(plan.exit[0].fromStages, stage::All);
    EXPECT_EQ(plan.exit[0].fromAccess, access::AllWrites);
    EXPECT_EQ(plan.exit[0].toStages, stage::Host);
    EXPECT_EQ(plan.exit[0].toAccess, access::HostRead | access::HostWrite);
}

TEST(Layouts, ImageStartsUndefinedAndMovesForReadback) {
    Builder g;
    const auto a = g.image("a");
    g.pass("p").writes(a);
    g.readback(a);
    const Compiled plan = g.compile();
    const Barrier* first = barrierOn(plan.steps[0], a);
    ASSERT_NE(first, nullptr);
    EXPECT_EQ(first->oldLayout, Layout::Undefined);
    EXPECT_EQ(first->newLayout, Layout::General);
    EXPECT_EQ(first->cause, Cause::FirstUse);
    const Barrier* second = barrierOn(plan.steps[1], a);
    ASSERT_NE(second, nullptr);
    EXPECT_EQ(second->oldLayout, Layout::General);
    EXPECT_EQ(second->newLayout, Layout::TransferSource);
    EXPECT_EQ(second->fromAccess, access::StorageWrite);
    EXPECT_TRUE(plan.exit.size() == 1 && plan.exit[0].resource == none) << "a transient rests in any layout";
    expectSound(g, plan);
}

TEST(Layouts, FirstUseAfterAliasDiscardsAndFollowsTheMemoryBarrier) {
    Builder g;
    const auto a = g.image("a"), b = g.image("b"), x = g.importBuffer("x");
    g.pass("a").overwrites(a);
    g.pass("use a").reads(a).modifies(x);
    g.pass("b").overwrites(b);
    g.pass("use b").reads(b).modifies(x);
    const Compiled plan = g.compile();
    ASSERT_TRUE(shareMemory(plan, a, b));
    const Step& step = *stepOf(g.input, plan, "b");
    ASSERT_EQ(step.barriers.size(), 2u);
    EXPECT_EQ(step.barriers[0].cause, Cause::Aliasing);
    EXPECT_EQ(step.barriers[1].oldLayout, Layout::Undefined);
    EXPECT_EQ(step.barriers[1].fromStages & step.barriers[0].toStages, stage::Compute) << "chained";
    expectSound(g, plan);
}

TEST(Layouts, SampledAndStorageInOnePassIsGeneral) {
    Builder g;
    const auto a = g.image("a"), b = g.buffer("b");
    g.pass("w").writes(a);
    g.pass("both").reads(a).access(a, Mode::Read, Usage::SampledImage).writes(b);
    g.readback(b);
    const Compiled plan = g.compile();
    EXPECT_EQ(stepOf(g.input, plan, "both")->uses[0].layout, Layout::General);
    expectSound(g, plan);
}

TEST(Layouts, StorageAfterSampledInOnePassIsGeneralToo) {
    Builder g;
    const auto a = g.image("a"), b = g.buffer("b");
    g.pass("w").writes(a);
    g.pass("both").access(a, Mode::Read, Usage::SampledImage).reads(a).writes(b);
    g.readback(b);
    const Compiled plan = g.compile();
    EXPECT_EQ(stepOf(g.input, plan, "both")->uses[0].layout, Layout::General);
    expectSound(g, plan);
}

TEST(Layouts, SampledHasItsOwnLayoutAndComesBack) {
    Builder g;
    const auto a = g.image("a"), b = g.buffer("b");
    g.pass("w").writes(a);
    g.pass("sample").access(a, Mode::Read, Usage::SampledImage).writes(b);
    g.pass("again").modifies(a).modifies(b);
    g.readback(b);
    g.readback(a);
    const Compiled plan = g.compile();
    EXPECT_EQ(barrierOn(*stepOf(g.input, plan, "sample"), a)->newLayout, Layout::ShaderRead);
    EXPECT_EQ(barrierOn(*stepOf(g.input, plan, "again"), a)->oldLayout, Layout::ShaderRead);
    EXPECT_EQ(barrierOn(*stepOf(g.input, plan, "again"), a)->newLayout, Layout::General);
    expectSound(g, plan);
}

TEST(Layouts, ImportedImageIsLeftGeneral) {
    Builder g;
    const auto a = g.importImage("a");
    g.pass("p").writes(a);
    g.readback(a);
    const Compiled plan = g.compile();
    ASSERT_EQ(plan.exit.size(), 2u);
    EXPECT_EQ(plan.exit[1].resource, a);
    EXPECT_EQ(plan.exit[1].newLayout, Layout::General);
    expectSound(g, plan);
}

TEST(Poison, StandsBeforeEachFirstUse) {
    Chain g(3);
    g.input.poison = true;
    const Compiled plan = g.compile();
    Names kinds;
    for (const Step& step : plan.steps)
        kinds.push_back(step.kind == StepKind::Poison ? "poison " + g.input.resources[step.index].name
                        : step.kind == StepKind::Pass ? g.input.passes[step.index].name
                                                      : "readback");
    EXPECT_EQ(kinds, (Names{"poison t0", "p0", "poison t1", "p1", "poison t2", "p2", "readback"}));
    expectSound(g, plan);
}

}  // namespace
}  // namespace helio::graph
