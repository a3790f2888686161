/** @file Plans of random graphs against oracles that share no code with the compiler. */
#include "tests/graph/hazard_simulator.hpp"
#include "tests/graph/random_graph.hpp"
#include "tests/support/sanitized.hpp"

#include <gtest/gtest.h>

#include <iostream>

namespace helio::graph {
namespace {

constexpr std::uint32_t graphCount = helio::test::kSanitized ? 2000 : 10000;

std::string firstFault(const HazardSimulator& simulator) {
    return simulator.faults().empty() ? "" : simulator.faults().front();
}

/** First and last live step of each resource by looking at every step for every resource. */
struct Life {
    std::uint32_t first = none, last = 0;
};
std::vector<Life> bruteForceLives(const Input& input, const Compiled& compiled) {
    std::vector<Life> lives(input.resources.size());
    for (std::uint32_t r = 0; r < lives.size(); ++r) {
        for (std::uint32_t s = 0; s < compiled.steps.size(); ++s) {
            const Step& step = compiled.steps[s];
            bool touched = step.kind == StepKind::Poison && step.index == r;
            if (step.kind == StepKind::Readback) touched = input.readbacks[step.index].resource == r;
            if (step.kind == StepKind::Pass)
                for (const AccessInput& a : input.passes[step.index].accesses) touched |= a.resource == r;
            if (!touched) continue;
            lives[r].first = std::min(lives[r].first, s);
            lives[r].last = s;
        }
    }
    return lives;
}

/** Bytes in use at the busiest step: no placement can take less. */
std::uint64_t liveBytesBound(const Input& input, const Compiled& compiled) {
    const std::vector<Life> lives = bruteForceLives(input, compiled);
    std::uint64_t bound = 0;
    for (std::uint32_t s = 0; s < compiled.steps.size(); ++s) {
        std::uint64_t bytes = 0;
        for (std::uint32_t r = 0; r < lives.size(); ++r)
            if (!input.resources[r].imported && lives[r].first != none && lives[r].first <= s &&
                s <= lives[r].last)
                bytes += input.resources[r].memoryBytes;
        bound = std::max(bound, bytes);
    }
    return bound;
}

/** Every fault of the placements; empty for sound ones. */
std::string placementFault(const Input& input, const Compiled& compiled) {
    const std::vector<Life> lives = bruteForceLives(input, compiled);
    std::size_t transients = 0;
    for (std::uint32_t r = 0; r < lives.size(); ++r)
        if (!input.resources[r].imported && lives[r].first != none) ++transients;
    if (compiled.placements.size() != transients) return "wrong number of placements";
    const std::uint64_t page = input.limits.bufferImageGranularity;
    for (std::size_t i = 0; i < compiled.placements.size(); ++i) {
        const Placement& a = compiled.placements[i];
        const ResourceInput& ra = input.resources[a.resource];
        if (a.bytes != ra.memoryBytes || a.offset % ra.alignment != 0) return ra.name + ": size or alignment";
        if (compiled.arenas.at(a.arena).memoryClass != ra.memoryClass) return ra.name + ": memory class";
        if (a.offset + a.bytes > compiled.arenas[a.arena].bytes) return ra.name + ": beyond its arena";
        for (std::size_t j = 0; j < i; ++j) {
            const Placement& b = compiled.placements[j];
            const ResourceInput& rb = input.resources[b.resource];
            if (a.arena != b.arena) continue;
            const bool meet = !(lives[a.resource].last < lives[b.resource].first ||
                                lives[b.resource].last < lives[a.resource].first);
            if (!meet && input.alias) continue;
            for (std::uint64_t byte = 0; byte < a.bytes; byte += 64) {
                const std::uint64_t at = a.offset + byte;
                if (at >= b.offset && at < b.offset + b.bytes) return ra.name + " overlaps " + rb.name;
                if (ra.kind != rb.kind && at / page >= b.offset / page &&
                    at / page <= (b.offset + b.bytes - 1) / page)
                    return ra.name + " is in one page with " + rb.name;
            }
        }
    }
    for (const Arena& arena : compiled.arenas)
        if (arena.bytes > input.limits.maxArenaBytes) return "an arena is too large";
    return "";
}

TEST(RandomGraphs, CompileAndLiveResourcesNeverOverlap) {
    std::uint64_t shared = 0, separate = 0, bound = 0;
    for (std::uint32_t seed = 0; seed < graphCount; ++seed) {
        const Builder g = randomGraph(seed);
        ASSERT_TRUE(validate(g.input).empty()) << seed << ": " << validate(g.input).front().message;
        const Compiled plan = g.compile();
        ASSERT_EQ(placementFault(g.input, plan), "") << "seed " << seed;
        if (!g.input.alias || g.input.limits.maxArenaBytes != ~std::uint64_t(0) || plan.arenas.size() != 1)
            continue;
        shared += plan.aliasing.allocatedBytes;
        separate += plan.aliasing.transientBytes;
        bound += liveBytesBound(g.input, plan);
    }
    std::cout << "allocated " << shared << " of " << separate << " bytes, lower bound " << bound << "\n";
    EXPECT_LT(double(shared), 0.95 * double(separate)) << "aliasing saves too little";
    EXPECT_LT(double(shared), 1.10 * double(bound)) << "placements waste too much";
}

TEST(RandomGraphs, BarriersSufficeAndValuesAreThoseOfTheDeclaredOrder) {
    for (std::uint32_t seed = 0; seed < graphCount; ++seed) {
        const Builder a = randomGraph(seed);
        const Builder b = randomGraph(seed + graphCount);  // another plan over the same imported resources
        const Compiled planA = a.compile();
        const Compiled planB = b.compile();
        HazardSimulator simulator;
        simulator.execute(a.input, planA, 0);
        simulator.execute(a.input, planA, 0);
        simulator.execute(b.input, planB, 1);
        simulator.execute(a.input, planA, 0);
        ASSERT_EQ(firstFault(simulator), "") << "seed " << seed << "\n" << dumpJson(a.input, planA);
    }
}

/** Drops one barrier at a time: the simulator sees most of them missed, so it is a sharp oracle and the
 * compiler emits few that are not needed. */
TEST(RandomGraphs, NearlyEveryBarrierIsNeeded) {
    std::uint64_t dropped = 0, noticed = 0;
    for (std::uint32_t seed = 0; seed < graphCount / 10; ++seed) {
        const Builder g = randomGraph(seed);
        const Compiled plan = g.compile();
        for (std::size_t s = 0; s < plan.steps.size(); ++s) {
            for (std::size_t b = 0; b < plan.steps[s].barriers.size(); ++b) {
                Compiled broken = plan;
                broken.steps[s].barriers.erase(broken.steps[s].barriers.begin() + std::ptrdiff_t(b));
                HazardSimulator simulator;
                simulator.execute(g.input, broken, 0);
                ++dropped;
                noticed += simulator.faults().empty() ? 0 : 1;
            }
        }
    }
    std::cout << noticed << " of " << dropped << " dropped barriers noticed\n";
    EXPECT_GT(dropped, 1000u);
    EXPECT_GT(double(noticed), 0.90 * double(dropped)) << noticed << " of " << dropped;
}

TEST(RandomGraphs, TheOracleSeesAMissingExecutionBarrier) {
    std::uint32_t noticed = 0;
    for (std::uint32_t seed = 0; seed < 200; ++seed) {
        const Builder g = randomGraph(seed);
        Compiled plan = g.compile();
        plan.entry.clear();
        HazardSimulator simulator;
        simulator.execute(g.input, plan, 0);
        simulator.execute(g.input, plan, 0);
        noticed += simulator.faults().empty() ? 0 : 1;
    }
    EXPECT_GT(noticed, 150u);
}

/** Ends lives one step early before placing: either oracle sees the clobbered value. */
TEST(RandomGraphs, TheOraclesSeeAShortenedLife) {
    std::uint32_t shortened = 0, byPlacement = 0, byValue = 0;
    for (std::uint32_t seed = 0; seed < 1000; ++seed) {
        Builder g = randomGraph(seed);
        g.input.alias = true;
        const Compiled plan = g.compile();
        for (std::size_t victim = 0; victim < plan.placements.size(); ++victim) {
            // A resource first used in the victim's last step is moved onto it.
            Compiled broken = plan;
            Placement& old = broken.placements[victim];
            for (Placement& young : broken.placements) {
                if (young.first != old.last || young.resource == old.resource || young.arena != old.arena)
                    continue;
                if (young.bytes > old.bytes || old.first == old.last) continue;
                young.offset = old.offset;
                ++shortened;
                byPlacement += placementFault(g.input, broken).empty() ? 0 : 1;
                HazardSimulator simulator;
                simulator.execute(g.input, broken, 0);
                byValue += simulator.faults().empty() ? 0 : 1;
                break;
            }
        }
    }
    EXPECT_GT(shortened, 100u);
    EXPECT_EQ(byPlacement, shortened);
    EXPECT_EQ(byValue, shortened);
}

/** Two steps in a row that only read the same versions the same way need nothing between them. */
TEST(RandomGraphs, NoBarrierBetweenIndependentReads) {
    for (std::uint32_t seed = 0; seed < 1000; ++seed) {
        const Builder g = randomGraph(seed);
        const Compiled plan = g.compile();
        std::map<std::uint32_t, const Use*> previous;
        for (const Step& step : plan.steps) {
            for (const Use& use : step.uses) {
                const auto before = previous.find(use.resource);
                const bool repeats = before != previous.end() && !before->second->writes && !use.writes &&
                                     before->second->layout == use.layout &&
                                     before->second->touches.size() == 1 && use.touches.size() == 1 &&
                                     before->second->touches[0].stage == use.touches[0].stage &&
                                     before->second->touches[0].access == use.touches[0].access;
                for (const Barrier& barrier : step.barriers) {
                    ASSERT_FALSE(repeats && barrier.resource == use.resource) << "seed " << seed;
                }
                previous[use.resource] = &use;
            }
        }
    }
}

}  // namespace
}  // namespace helio::graph
