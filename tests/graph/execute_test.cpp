/** @file Plans on the device: values, aliasing, culling, repetition, imports, indirect work, readbacks,
 * times. */
#include "tests/graph/kernels.hpp"
#include "tests/support/device.hpp"

#include <heliograph/error.hpp>
#include <heliograph/graph.hpp>

#include <gtest/gtest.h>

#include <chrono>
#include <numeric>

namespace helio {
namespace {

using test::countKernel;
using test::device;
using test::iotaKernel;
using test::joinKernel;
using test::kernelOf;
using test::stepKernel;

constexpr std::uint32_t count = 1000;
constexpr std::uint64_t size = count * sizeof(std::uint32_t);
using Values = std::vector<std::uint32_t>;

Values iota(std::uint32_t start) {
    Values values(count);
    std::iota(values.begin(), values.end(), start);
    return values;
}
Values step(Values values) {
    for (std::uint32_t& value : values) value = value * 3 + 1;
    return values;
}
Values join(const Values& left, const Values& right) {
    Values values(left.size());
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = left[i] * 5 + right[i];
    return values;
}

void addIota(Graph& g, Buffer out, std::uint32_t start) {
    g.compute("iota", iotaKernel()).overwrites({{"uOut", out}}).record([start](Commands& c) {
        c.push(start).dispatchInvocations(count);
    });
}
void addStep(Graph& g, const std::string& name, Buffer in, Buffer out) {
    g.compute(name, stepKernel()).reads({{"uIn", in}}).overwrites({{"uOut", out}}).record([](Commands& c) {
        c.dispatchInvocations(count);
    });
}
void addJoin(Graph& g, const std::string& name, Buffer left, Buffer right, Buffer sum) {
    g.compute(name, joinKernel())
        .reads({{"uLeft", left}, {"uRight", right}})
        .overwrites({{"uSum", sum}})
        .record([](Commands& c) { c.dispatchInvocations(count); });
}
void addCount(Graph& g, const std::string& name, Buffer counter) {
    g.compute(name, countKernel()).modifies({{"uCount", counter}}).record([](Commands& c) { c.dispatch(1); });
}

TEST(Execute, Chain) {
    Graph g(device());
    Buffer buffer = g.buffer("start", {size});
    addIota(g, buffer, 7);
    Values expected = iota(7);
    for (int i = 0; i < 10; ++i) {
        const Buffer next = g.buffer("link", {size});
        addStep(g, "step", buffer, next);
        expected = step(expected);
        buffer = next;
    }
    auto result = g.readback<std::uint32_t>(buffer);
    Plan plan = g.compile();
    EXPECT_EQ(result.wait(plan.execute()), expected);
    EXPECT_LE(plan.aliasing().allocatedBytes * 4, plan.aliasing().transientBytes);
}

/** Diamonds one after another, with and without aliasing and poison: the same bits. */
TEST(Execute, DiamondsAreTheSameAliasedApartAndPoisoned) {
    Graph g(device());
    Buffer top = g.buffer("top", {size});
    addIota(g, top, 1);
    Values expected = iota(1);
    for (int i = 0; i < 5; ++i) {
        const Buffer left = g.buffer("left", {size}), right = g.buffer("right", {size}),
                     far = g.buffer("far", {size}), bottom = g.buffer("bottom", {size});
        addStep(g, "left", top, left);
        addStep(g, "right", top, right);
        addStep(g, "far", right, far);
        addJoin(g, "join", left, far, bottom);
        expected = join(step(expected), step(step(expected)));
        top = bottom;
    }
    auto result = g.readback<std::uint32_t>(top);
    Plan aliased = g.compile(), apart = g.compile({.alias = false}), poisoned = g.compile({.poison = true});
    EXPECT_LT(aliased.aliasing().allocatedBytes, apart.aliasing().allocatedBytes);
    EXPECT_EQ(result.wait(aliased.execute()), expected);
    EXPECT_EQ(result.wait(apart.execute()), expected);
    EXPECT_EQ(result.wait(poisoned.execute()), expected);
    EXPECT_EQ(result.wait(poisoned.execute()), expected);
}

TEST(Execute, CulledPassesNeverRun) {
    int recorded = 0;
    Graph g(device());
    const Buffer used = g.buffer("used", {size}), unused = g.buffer("unused", {size});
    addIota(g, used, 0);
    g.compute("wasted", stepKernel())
        .reads({{"uIn", used}})
        .writes({{"uOut", unused}})
        .record([&](Commands& c) {
            ++recorded;
            c.dispatchInvocations(count);
        });
    auto result = g.readback<std::uint32_t>(used);
    Plan plan = g.compile();
    for (int i = 0; i < 3; ++i) EXPECT_EQ(result.wait(plan.execute()), iota(0));
    EXPECT_EQ(recorded, 0);
    EXPECT_EQ(plan.culled(), std::vector<std::string>{"wasted"});
    EXPECT_EQ(plan.passes(), std::vector<std::string>{"iota"});
}

TEST(Execute, KeptPassRunsEachTime) {
    DeviceBuffer counter = makeBuffer(device(), "counter", Values{0});
    Graph g(device());
    addCount(g, "count", g.import(counter));
    Plan plan = g.compile();
    Execution last;
    for (int i = 0; i < 100; ++i) last = plan.execute();
    plan.wait(last);
    std::uint32_t value = 0;
    counter.download(&value, 4);
    EXPECT_EQ(value, 100u);
}

/** Recorders run at each execution, so push constants may change. */
TEST(Execute, RunsAHundredTimesWithFreshPushConstants) {
    std::uint32_t start = 0;
    Graph g(device());
    const Buffer a = g.buffer("a", {size}), b = g.buffer("b", {size});
    g.compute("iota", iotaKernel()).writes({{"uOut", a}}).record([&](Commands& c) {
        c.push(start).dispatchInvocations(count);
    });
    addStep(g, "step", a, b);
    auto result = g.readback<std::uint32_t>(b);
    Plan plan = g.compile();
    for (start = 0; start < 100; ++start) ASSERT_EQ(result.wait(plan.execute()), step(iota(start))) << start;
}

TEST(Execute, SeveralInFlightKeepTheirReadbacks) {
    std::uint32_t start = 0;
    Graph g(device());
    const Buffer a = g.buffer("a", {size});
    g.compute("iota", iotaKernel()).writes({{"uOut", a}}).record([&](Commands& c) {
        c.push(start).dispatchInvocations(count);
    });
    auto result = g.readback<std::uint32_t>(a);
    Plan plan = g.compile({.executionsInFlight = 3});
    std::vector<Execution> runs;
    for (start = 0; start < 5; ++start) runs.push_back(plan.execute());
    EXPECT_THROW(result.wait(runs[0]), GraphError);
    EXPECT_THROW(result.wait(runs[1]), GraphError);
    for (std::uint32_t i = 2; i < 5; ++i) EXPECT_EQ(result.wait(runs[i]), iota(i));
    EXPECT_EQ(plan.timings(runs[0]).size(), 2u) << "times outlive readbacks";
}

TEST(Execute, TwoPlansShareAnImportedBuffer) {
    DeviceBuffer shared = makeBuffer(device(), "shared", iota(0));
    Graph one(device()), two(device());
    const Buffer a = one.import(shared), b = two.import(shared);
    const Buffer t = one.buffer("t", {size});
    addStep(one, "step", a, t);
    one.copy("copy", t, a);
    const Kernel negate =
        kernelOf("test/negate", "layout(std430, set = 0, binding = 0) buffer Data { uint values[]; } uData;",
                 "uint i = gl_GlobalInvocationID.x; if (i < uData.values.length()) uData.values[i] = "
                 "~uData.values[i];");
    two.compute("negate", negate).modifies({{"uData", b}}).record([](Commands& c) {
        c.dispatchInvocations(count);
    });
    auto last = two.readback<std::uint32_t>(b);
    Plan first = one.compile(), second = two.compile();
    Values expected = iota(0);
    for (int i = 0; i < 20; ++i) {
        first.execute();
        const Execution run = second.execute();
        expected = step(expected);
        for (std::uint32_t& value : expected) value = ~value;
        ASSERT_EQ(last.wait(run), expected) << i;
    }
    Values read(count);
    shared.download(read.data(), size);
    EXPECT_EQ(read, expected);
}

TEST(Execute, UploadBetweenExecutionsIsSeen) {
    DeviceBuffer source = makeBuffer(device(), "source", iota(0));
    Graph g(device());
    const Buffer in = g.import(source), out = g.buffer("out", {size});
    addStep(g, "step", in, out);
    auto result = g.readback<std::uint32_t>(out);
    Plan plan = g.compile({.executionsInFlight = 4});
    std::vector<Execution> runs;
    for (std::uint32_t i = 0; i < 4; ++i) {
        source.upload(iota(i * 10).data(), size);
        runs.push_back(plan.execute());
    }
    for (std::uint32_t i = 0; i < 4; ++i) EXPECT_EQ(result.wait(runs[i]), step(iota(i * 10)));
}

TEST(Execute, TimesAddUpToTheWhole) {
    const Kernel work = kernelOf(
        "test/work", "layout(std430, set = 0, binding = 0) buffer Data { uint values[]; } uData;",
        "uint i = gl_GlobalInvocationID.x; if (i < uData.values.length()) { uint x = uData.values[i]; "
        "for (int k = 0; k < 2000; ++k) x = x * 1664525u + 1013904223u; uData.values[i] = x; }");
    constexpr std::uint32_t n = 1 << 16;
    Graph g(device());
    const Buffer a = g.buffer("a", {n * 4});
    g.fill("zero", a, 0);
    for (int i = 0; i < 3; ++i)
        g.compute("work " + std::to_string(i), work).modifies({{"uData", a}}).record([](Commands& c) {
            c.dispatchInvocations(n);
        });
    auto result = g.readback<std::uint32_t>(a);
    Plan plan = g.compile();
    plan.wait(plan.execute());  // compiles the kernels
    const auto start = std::chrono::steady_clock::now();
    const Execution run = plan.execute();
    plan.wait(run);
    const double wall =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    const std::vector<PassTiming> times = plan.timings(run);
    ASSERT_EQ(times.size(), 5u);
    EXPECT_EQ(times[0].name, "zero");
    EXPECT_EQ(times[1].name, "work 0");
    EXPECT_EQ(times[4].name, "readback a");
    double sum = 0;
    for (const PassTiming& time : times) {
        EXPECT_GE(time.milliseconds, 0.0);
        sum += time.milliseconds;
    }
    EXPECT_GT(sum, 0.0);
    EXPECT_LE(sum, wall * 1.01) << "the device worked longer than we waited";
}

TEST(Execute, PlanOutlivesItsGraphAndMayBeMoved) {
    Plan plan;
    Readback<std::uint32_t> result;
    {
        Graph g(device());
        const Buffer a = g.buffer("a", {size});
        addIota(g, a, 5);
        result = g.readback<std::uint32_t>(a);
        Plan made = g.compile();
        plan = std::move(made);
    }
    EXPECT_EQ(result.wait(plan.execute()), iota(5));
}

TEST(Execute, PlanDestroyedWhileRunningIsSafe) {
    DeviceBuffer counter = makeBuffer(device(), "counter", Values{0});
    {
        Graph g(device());
        addCount(g, "count", g.import(counter));
        Plan plan = g.compile();
        for (int i = 0; i < 10; ++i) plan.execute();
    }
    std::uint32_t value = 0;
    counter.download(&value, 4);
    EXPECT_EQ(value, 10u);
}

TEST(Execute, ImportedTwiceIsOneResource) {
    DeviceBuffer buffer(device(), "b", 16);
    Graph g(device());
    EXPECT_EQ(g.import(buffer).id, g.import(buffer).id);
}

TEST(Execute, CompilingAgainMakesNoNewPipelines) {
    Graph g(device());
    const Buffer a = g.buffer("a", {size});
    addIota(g, a, 5);
    auto result = g.readback<std::uint32_t>(a);
    Plan first = g.compile();
    const auto start = std::chrono::steady_clock::now();
    Plan second = g.compile();
    const double ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    RecordProperty("compile_milliseconds", std::to_string(ms));
    EXPECT_EQ(result.wait(second.execute()), iota(5));
    EXPECT_EQ(result.wait(first.execute()), iota(5));
}

}  // namespace
}  // namespace helio
