/** @file Culling, versions, lives, aliasing, layouts, barriers and dumps of small graphs, case by case. */
#include "tests/graph/builder.hpp"
#include "tests/graph/hazard_simulator.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace helio::graph {
namespace {

using Names = std::vector<std::string>;

const Barrier* barrierOn(const Step& step, std::uint32_t resource) {
    for (const Barrier& barrier : step.barriers)
        if (barrier.resource == resource) return &barrier;
    return nullptr;
}

void expectSound(const Builder& g, const Compiled& plan) {
    HazardSimulator simulator;
    for (int run = 0; run < 3; ++run) simulator.execute(g.input, plan, 0);
    EXPECT_TRUE(simulator.faults().empty()) << simulator.faults().front();
}

struct Chain : Builder {
    std::vector<std::uint32_t> links;
    explicit Chain(int length) {
        links.push_back(importBuffer("source"));
        for (int i = 0; i < length; ++i) {
            links.push_back(buffer("t" + std::to_string(i)));
            pass("p" + std::to_string(i)).reads(links[std::size_t(i)]).overwrites(links.back());
        }
        readback(links.back());
    }
};

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
    EXPECT_EQ(plan.exit[0].fromStages, stage::Copy);
    EXPECT_EQ(plan.exit[0].toStages, stage::Host);
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

TEST(Dump, JsonNamesEverything) {
    Builder g;
    const auto a = g.buffer("a"), b = g.buffer("b"), x = g.importBuffer("x");
    g.pass("a").overwrites(a);
    g.pass("use a").reads(a).modifies(x);
    g.pass("b").overwrites(b);
    g.pass("use b").reads(b).modifies(x);
    g.pass("useless").writes(g.image("spare"));
    const nlohmann::json json = nlohmann::json::parse(dumpJson(g.input, g.compile()));
    EXPECT_EQ(json["steps"].size(), 4u);
    EXPECT_EQ(json["culled"][0]["pass"], "useless");
    EXPECT_EQ(json["culled"][0]["reason"], "no root needs what it writes: 'spare'");
    EXPECT_EQ(json["resources"][a]["memory"]["shares_with"], nlohmann::json::array({b}));
    EXPECT_EQ(json["resources"][3]["used"], false);
    EXPECT_EQ(json["steps"][2]["barriers"][0]["cause"], "aliasing");
    EXPECT_EQ(json["steps"][1]["barriers"][0]["from"]["access"], "storage-write");
    EXPECT_EQ(json["transient_bytes"], 2048);
    EXPECT_EQ(json["allocated_bytes"], 1024);
}

TEST(Dump, GraphvizEscapesNamesAndShowsCulledAndShared) {
    Builder g;
    const auto a = g.buffer("a \"quoted\""), b = g.buffer("b"), x = g.importBuffer("x");
    g.pass("back\\slash").overwrites(a);
    g.pass("use a").reads(a).modifies(x);
    g.pass("b").overwrites(b);
    g.pass("use b").reads(b).modifies(x);
    g.pass("useless").writes(g.buffer("spare"));
    const std::string dot = dumpGraphviz(g.input, g.compile());
    EXPECT_EQ(dot.rfind("digraph plan {", 0), 0u);
    EXPECT_NE(dot.find("a \\\"quoted\\\" v1"), std::string::npos);
    EXPECT_NE(dot.find("back\\\\slash"), std::string::npos);
    EXPECT_NE(dot.find("shares with b"), std::string::npos);
    EXPECT_NE(dot.find("useless\\nculled: no root needs"), std::string::npos);
    EXPECT_NE(dot.find("spare\\nunused"), std::string::npos);
}

}  // namespace
}  // namespace helio::graph
