#pragma once
/** @file Looks things up in compiled plans, and plays them against the hazard simulator. */
#include "tests/graph/builder.hpp"
#include "tests/graph/hazard_simulator.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace helio::graph {

/** Names of the passes that run, in order. */
inline std::vector<std::string> livePasses(const Input& input, const Compiled& compiled) {
    std::vector<std::string> names;
    for (const Step& step : compiled.steps)
        if (step.kind == StepKind::Pass) names.push_back(input.passes[step.index].name);
    return names;
}

/** The step that runs the named pass; null where it was culled. */
inline const Step* stepOf(const Input& input, const Compiled& compiled, const std::string& name) {
    for (const Step& step : compiled.steps)
        if (step.kind == StepKind::Pass && input.passes[step.index].name == name) return &step;
    return nullptr;
}

inline const Barrier* barrierOn(const Step& step, std::uint32_t resource) {
    for (const Barrier& barrier : step.barriers)
        if (barrier.resource == resource) return &barrier;
    return nullptr;
}

inline const Placement* placementOf(const Compiled& compiled, std::uint32_t resource) {
    for (const Placement& placement : compiled.placements)
        if (placement.resource == resource) return &placement;
    return nullptr;
}

inline bool shareMemory(const Compiled& compiled, std::uint32_t a, std::uint32_t b) {
    const Placement* x = placementOf(compiled, a);
    const Placement* y = placementOf(compiled, b);
    return x && y && x->arena == y->arena && x->offset < y->offset + y->bytes &&
           y->offset < x->offset + x->bytes;
}

/** Three executions in a row have no hazard and every read finds its value. */
inline void expectSound(const Builder& g, const Compiled& plan) {
    HazardSimulator simulator;
    for (int run = 0; run < 3; ++run) simulator.execute(g.input, plan, 0);
    EXPECT_TRUE(simulator.faults().empty()) << simulator.faults().front();
}

/** source -> t0 -> t1 -> ..., the last one read back. */
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

}  // namespace helio::graph
