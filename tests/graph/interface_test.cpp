/** @file What is refused of passes against their kernels' SPIR-V and the device's limits, at compile and
 * while recording. Every problem names pass, binding, resource and remedy. */
#include "engine/gpu/device_impl.hpp"
#include "engine/graph/kernel_capabilities.hpp"
#include "tests/graph/kernels.hpp"
#include "tests/support/device.hpp"

#include <heliograph/error.hpp>
#include <heliograph/graph.hpp>

#include <gtest/gtest.h>

#include <algorithm>

namespace helio {
namespace {

using test::device;
using test::iotaKernel;
using test::kernelOf;
using test::stepKernel;

const auto nothing = [](Commands&) {};

std::vector<GraphProblem> problemsOf(Graph& g, const CompileOptions& options = {}) {
    try {
        g.compile(options);
    } catch (const GraphError& error) {
        return error.problems;
    }
    return {};
}

void expectProblem(Graph& g, const std::string& pass, const std::string& binding, const std::string& resource,
                   const std::string& text) {
    const std::vector<GraphProblem> problems = problemsOf(g);
    ASSERT_EQ(problems.size(), 1u) << (problems.empty() ? "" : GraphError(problems).what());
    EXPECT_EQ(problems[0].pass, pass);
    EXPECT_EQ(problems[0].binding, binding);
    EXPECT_EQ(problems[0].resource, resource);
    EXPECT_NE(problems[0].message.find(text), std::string::npos) << problems[0].message;
    EXPECT_NE(problems[0].message.find(';'), std::string::npos) << "no remedy: " << problems[0].message;
}

/** The message of the GraphError that executing the plan throws; "" where it throws none. */
std::string refusalOf(Plan& plan, const std::string& pass) {
    try {
        plan.execute();
    } catch (const GraphError& error) {
        EXPECT_EQ(error.problems.size(), 1u);
        EXPECT_EQ(error.problems[0].pass, pass);
        EXPECT_NE(error.problems[0].message.find(';'), std::string::npos) << error.problems[0].message;
        return error.problems[0].message;
    }
    return "";
}

struct TwoBuffers {
    DeviceBuffer first{device(), "first", 256}, second{device(), "second", 256};
    Graph g{device()};
    Buffer a = g.import(first), b = g.import(second);
};

TEST(Interface, UndeclaredBinding) {
    TwoBuffers t;
    t.g.compute("p", stepKernel()).writes({{"uOut", t.b}}).record(nothing);
    expectProblem(t.g, "p", "uIn", "", "that the pass does not declare; add it to reads()");
}

TEST(Interface, DeclaredButAbsentBinding) {
    TwoBuffers t;
    t.g.compute("p", stepKernel())
        .reads({{"uIn", t.a}, {"uLights", t.a}})
        .writes({{"uOut", t.b}})
        .record(nothing);
    expectProblem(t.g, "p", "uLights", "first",
                  "is not a binding of kernel 'test/step', which has 'uIn', 'uOut'");
}

TEST(Interface, WrittenButDeclaredAsRead) {
    TwoBuffers t;
    t.g.compute("p", stepKernel()).reads({{"uIn", t.a}, {"uOut", t.b}}).keep().record(nothing);
    const auto problems = problemsOf(t.g);
    ASSERT_EQ(problems.size(), 2u);  // may be written, cannot be read
    EXPECT_NE(problems[0].message.find("the kernel may write it; mark it readonly"), std::string::npos);
    EXPECT_NE(problems[1].message.find("writeonly in the kernel; declare it with writes()"),
              std::string::npos);
}

TEST(Interface, UnqualifiedBufferDeclaredAsRead) {
    TwoBuffers t;
    t.g.compute("p", test::countKernel()).reads({{"uCount", t.a}}).keep().record(nothing);
    expectProblem(t.g, "p", "uCount", "first", "the kernel may write it; mark it readonly");
}

TEST(Interface, ReadonlyDeclaredAsWritten) {
    TwoBuffers t;
    t.g.compute("p", stepKernel()).writes({{"uIn", t.a}, {"uOut", t.b}}).record(nothing);
    expectProblem(t.g, "p", "uIn", "first", "readonly in the kernel; declare it with reads()");
}

TEST(Interface, WriteonlyDeclaredAsModified) {
    TwoBuffers t;
    t.g.compute("p", stepKernel()).reads({{"uIn", t.a}}).modifies({{"uOut", t.b}}).record(nothing);
    expectProblem(t.g, "p", "uOut", "second", "writeonly in the kernel; declare it with writes()");
}

TEST(Interface, ImageWhereTheKernelHasABuffer) {
    TwoBuffers t;
    const Image image = t.g.image("image", {{4, 4}, Format::RGBA32F});
    t.g.compute("p", stepKernel()).reads({{"uIn", t.a}}).writes({{"uOut", image}}).keep().record(nothing);
    expectProblem(t.g, "p", "uOut", "image", "is an image where a buffer belongs");
}

const char* const paintDeclarations = "layout(rgba32f, set = 0, binding = 0) uniform writeonly image2D uOut;";
const char* const paintBody = "imageStore(uOut, ivec2(gl_GlobalInvocationID.xy), vec4(1));";

TEST(Interface, BufferWhereTheKernelHasAnImage) {
    TwoBuffers t;
    t.g.compute("p", kernelOf("test/paint", paintDeclarations, paintBody))
        .writes({{"uOut", t.a}})
        .record(nothing);
    expectProblem(t.g, "p", "uOut", "first", "is a buffer where an image belongs");
}

TEST(Interface, ImageFormatDiffers) {
    Graph g(device());
    const Image image = g.image("image", {{4, 4}, Format::RGBA16F});
    g.compute("p", kernelOf("test/paint", paintDeclarations, paintBody))
        .writes({{"uOut", image}})
        .keep()
        .record(nothing);
    expectProblem(g, "p", "uOut", "image", "has format RGBA16F but the kernel's image is RGBA32F");
}

TEST(Interface, TexelTypeDiffers) {
    TwoBuffers t;
    const Kernel kernel =
        kernelOf("test/fetch",
                 "layout(set = 0, binding = 0) uniform samplerBuffer uIn;\n"
                 "layout(std430, set = 0, binding = 1) writeonly buffer Out { vec4 values[]; } uOut;",
                 "uOut.values[0] = texelFetch(uIn, 0);");
    t.g.compute("p", kernel).reads({{"uIn", t.a, Format::RGBA32UI}}).writes({{"uOut", t.b}}).record(nothing);
    expectProblem(t.g, "p", "uIn", "first",
                  "is viewed as RGBA32UI, of uint texels, but the kernel has float texels");
}

TEST(Interface, IntegerTexelsNeedAFormat) {
    TwoBuffers t;
    const Kernel kernel =
        kernelOf("test/fetch_int",
                 "layout(set = 0, binding = 0) uniform isamplerBuffer uIn;\n"
                 "layout(std430, set = 0, binding = 1) writeonly buffer Out { ivec4 values[]; } uOut;",
                 "uOut.values[0] = texelFetch(uIn, 0);");
    t.g.compute("p", kernel).reads({{"uIn", t.a}}).writes({{"uOut", t.b}}).record(nothing);
    expectProblem(t.g, "p", "uIn", "first", "needs a view format");
}

TEST(Interface, FormatForAPlainBuffer) {
    TwoBuffers t;
    t.g.compute("p", stepKernel())
        .reads({{"uIn", t.a, Format::R32UI}})
        .writes({{"uOut", t.b}})
        .record(nothing);
    expectProblem(t.g, "p", "uIn", "first", "has a view format but is a");
}

TEST(Interface, BlockLargerThanTheBuffer) {
    DeviceBuffer small(device(), "small", 16);
    Graph g(device());
    const Kernel kernel = kernelOf(
        "test/block", "layout(std430, set = 0, binding = 0) buffer Block { vec4 a; vec4 b; } uBlock;",
        "uBlock.a += uBlock.b;");
    g.compute("p", kernel).modifies({{"uBlock", g.import(small)}}).record(nothing);
    expectProblem(g, "p", "uBlock", "small", "has 16 bytes bound but the kernel's block has 32");
}

TEST(Interface, WindowOffTheAlignment) {
    TwoBuffers t;
    t.g.compute("p", stepKernel())
        .reads({{"uIn", t.a, Window{2, 0}}})
        .writes({{"uOut", t.b}})
        .record(nothing);
    expectProblem(t.g, "p", "uIn", "first", "is bound at byte 2 but the device asks for a multiple of");
}

TEST(Interface, StorageBindingBeyondTheDevicesRange) {
    const std::uint64_t range = device().info().maxStorageBufferRange;
    const std::uint64_t bytes = (range + 16) / 16 * 16;
    if (range >= device().info().maxBufferSize || range >= 0xffffffffull)
        return;  // no buffer can be too large
    Graph g(device());
    const Buffer large = g.buffer("large", {bytes}), out = g.buffer("out", {256});
    g.fill("zero", large, 0);
    g.compute("p", stepKernel()).reads({{"uIn", large}}).writes({{"uOut", out}}).keep().record(nothing);
    expectProblem(g, "p", "uIn", "large",
                  "read it through a samplerBuffer, or bind a part with Window{offset, bytes}");
}

TEST(Interface, UnknownSpecializationConstant) {
    TwoBuffers t;
    const Kernel kernel =
        kernelOf("test/constant",
                 "layout(constant_id = 1) const uint SIZE = 2u;\n"
                 "layout(std430, set = 0, binding = 0) writeonly buffer Out { uint values[]; } uOut;",
                 "uOut.values[0] = SIZE;");
    t.g.compute("p", kernel, {.spec = {{"SISE", 3u}}}).writes({{"uOut", t.b}}).record(nothing);
    expectProblem(t.g, "p", "SISE", "",
                  "is no specialization constant of kernel 'test/constant', which has 'SIZE'");
}

TEST(Interface, SpecializationConstantOfAnotherType) {
    TwoBuffers t;
    const Kernel kernel =
        kernelOf("test/constant",
                 "layout(constant_id = 1) const uint SIZE = 2u;\n"
                 "layout(std430, set = 0, binding = 0) writeonly buffer Out { uint values[]; } uOut;",
                 "uOut.values[0] = SIZE;");
    t.g.compute("p", kernel, {.spec = {{"SIZE", 3.0f}}}).writes({{"uOut", t.b}}).record(nothing);
    expectProblem(t.g, "p", "SIZE", "", "of type uint but is given a value of type float");
}

TEST(Interface, WorkgroupTooLarge) {
    TwoBuffers t;
    const Kernel kernel =
        kernelOf("test/width",
                 "layout(local_size_x_id = 9) in;\nlayout(constant_id = 9) const uint WIDTH = 64u;\n"
                 "layout(std430, set = 0, binding = 0) writeonly buffer Out { uint values[]; } uOut;",
                 "uOut.values[0] = WIDTH;");
    t.g.compute("p", kernel, {.spec = {{"WIDTH", 1u << 20}}}).writes({{"uOut", t.b}}).record(nothing);
    const auto problems = problemsOf(t.g);
    ASSERT_EQ(problems.size(), 2u);  // the side and the product
    EXPECT_NE(problems[0].message.find("has a workgroup of 1048576 in dimension 0"), std::string::npos);
}

TEST(Interface, PassWithoutARecorder) {
    TwoBuffers t;
    t.g.compute("p", stepKernel()).reads({{"uIn", t.a}}).writes({{"uOut", t.b}});
    expectProblem(t.g, "p", "", "", "records nothing; give it record()");
}

TEST(Interface, BrokenKernel) {
    TwoBuffers t;
    const std::vector<std::uint32_t> words(10, 0x12345678u);
    t.g.compute("p", Kernel{.name = "broken", .spirv = words, .source = ""})
        .writes({{"uOut", t.b}})
        .record(nothing);
    expectProblem(t.g, "p", "", "", "has a broken kernel");
}

TEST(Interface, ForeignHandleAndForeignReadback) {
    TwoBuffers t, other;
    t.g.compute("p", stepKernel()).reads({{"uIn", other.a}}).writes({{"uOut", t.b}}).record(nothing);
    t.g.readback<std::uint32_t>(other.b);
    const auto problems = problemsOf(t.g);
    ASSERT_EQ(problems.size(), 2u);
    EXPECT_EQ(problems[0].binding, "uIn");
    EXPECT_EQ(problems[1].binding, "readback");
}

TEST(Interface, CopyToASmallerBuffer) {
    Graph g(device());
    DeviceBuffer small(device(), "small", 16), large(device(), "large", 32);
    g.copy("copy", g.import(large), g.import(small));
    expectProblem(g, "copy", "to", "small", "has 16 bytes but 32 are copied to it");
}

TEST(Interface, CopyOntoItself) {
    Graph g(device());
    DeviceBuffer buffer(device(), "buffer", 16);
    g.copy("copy", g.import(buffer), g.import(buffer));
    expectProblem(g, "copy", "to", "buffer", "overlaps binding 'from'");
}

TEST(Interface, EveryProblemOfEveryPassAtOnce) {
    TwoBuffers t;
    const Buffer empty = t.g.buffer("empty", {0}), early = t.g.buffer("early", {64});
    t.g.compute("first", stepKernel()).reads({{"uIn", early}}).writes({{"uOut", t.b}}).record(nothing);
    t.g.compute("second", stepKernel(), {.spec = {{"NONE", 1u}}})
        .reads({{"uIn", t.a}})
        .writes({{"uOut", empty}});
    const auto problems = problemsOf(t.g);
    const auto has = [&](const std::string& pass, const std::string& text) {
        return std::any_of(problems.begin(), problems.end(), [&](const GraphProblem& problem) {
            return problem.pass == pass && problem.message.find(text) != std::string::npos;
        });
    };
    EXPECT_TRUE(has("first", "is read before any pass writes it"));
    EXPECT_TRUE(has("second", "is no specialization constant"));
    EXPECT_TRUE(has("second", "records nothing"));
    EXPECT_TRUE(has("", "has 0 bytes"));
    EXPECT_EQ(problems.size(), 4u);
}

TEST(Interface, ImageTooLargeForTheDevice) {
    Graph g(device());
    const Image image = g.image("image", {{1u << 20, 4}, Format::RGBA32F});
    g.compute("p", kernelOf("test/paint", paintDeclarations, paintBody))
        .writes({{"uOut", image}})
        .keep()
        .record(nothing);
    expectProblem(g, "", "", "image", "1048576x4 texels asked for");
}

TEST(Interface, CapabilityThatTheDeviceLacks) {
    // Judged on made-up facts, so that it is tested on every device; then what this device has compiles.
    const Kernel kernel =
        kernelOf("test/clustered",
                 "#extension GL_KHR_shader_subgroup_clustered : require\n"
                 "layout(std430, set = 0, binding = 0) writeonly buffer Out { uint values[]; } uOut;",
                 "uOut.values[gl_GlobalInvocationID.x] = subgroupClusteredAdd(1u, 4u);");
    gpu::DeviceFacts facts = device().impl().facts;
    facts.properties11.subgroupSupportedOperations = vk::SubgroupFeatureFlagBits::eBasic;
    EXPECT_EQ(graph::missingCapabilities(reflect(kernel), facts),
              std::vector<std::string>{"GroupNonUniformClustered"});
    facts.properties11.subgroupSupportedOperations |= vk::SubgroupFeatureFlagBits::eClustered;
    EXPECT_TRUE(graph::missingCapabilities(reflect(kernel), facts).empty());

    TwoBuffers t;
    t.g.compute("p", kernel).writes({{"uOut", t.b}}).record(nothing);
    if (graph::missingCapabilities(reflect(kernel), device().impl().facts).empty())
        EXPECT_TRUE(problemsOf(t.g).empty());
    else
        expectProblem(t.g, "p", "", "", "asks for GroupNonUniformClustered, which the device lacks");
}

TEST(Interface, ImportFromAnotherDevice) {
    Device other(test::deviceOptions());
    DeviceBuffer foreign(other, "foreign", 16);
    Graph g(device());
    g.fill("fill", g.import(foreign), 0);
    expectProblem(g, "", "", "foreign", "is imported from another device");
}

TEST(Interface, ExecutionsInFlightMustBeOneAtLeast) {
    TwoBuffers t;
    t.g.fill("fill", t.b, 1);
    const auto problems = problemsOf(t.g, {.executionsInFlight = 0});
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_NE(problems[0].message.find("executionsInFlight is 0"), std::string::npos);
}

struct Recording : TwoBuffers {
    /** The refusal while one iota pass records; the plan then still works. */
    std::string of(std::function<void(Commands&)> recorder) {
        bool broken = true;
        g.compute("p", iotaKernel()).overwrites({{"uOut", b}}).indirect(a).record([&](Commands& c) {
            if (broken)
                recorder(c);
            else
                c.push(std::uint32_t(3)).dispatch(1);
        });
        auto result = g.readback<std::uint32_t>(b);
        Plan plan = g.compile();
        const std::string refusal = refusalOf(plan, "p");
        broken = false;
        EXPECT_EQ(result.wait(plan.execute()).at(5), 8u);
        return refusal;
    }
};

TEST(Recording, PushOfAnotherSize) {
    EXPECT_NE(Recording()
                  .of([](Commands& c) { c.push(1.0); })
                  .find("pushes 8 bytes but its kernel's push constants have 4"),
              std::string::npos);
}

TEST(Recording, DispatchWithoutPush) {
    EXPECT_NE(
        Recording().of([](Commands& c) { c.dispatch(1); }).find("without its 4 bytes of push constants"),
        std::string::npos);
}

TEST(Recording, DispatchAboveTheLimit) {
    EXPECT_NE(Recording()
                  .of([](Commands& c) { c.push(1u).dispatch(1, 0xffffffffu); })
                  .find("workgroups in dimension y"),
              std::string::npos);
    EXPECT_NE(Recording()
                  .of([](Commands& c) { c.push(1u).dispatchInvocations(~0ull); })
                  .find("workgroups in dimension x"),
              std::string::npos);
}

TEST(Recording, ZeroWorkgroupsDoNothing) {
    TwoBuffers t;
    t.g.fill("seven", t.b, 7);
    t.g.compute("p", iotaKernel()).writes({{"uOut", t.b}}).record([](Commands& c) {
        c.dispatch(0).dispatchInvocations(0).dispatchOver(0, 5).dispatch(1, 1, 0);
    });
    auto result = t.g.readback<std::uint32_t>(t.b);
    Plan plan = t.g.compile();
    EXPECT_EQ(result.wait(plan.execute()), std::vector<std::uint32_t>(64, 7));
}

TEST(Recording, IndirectUndeclared) {
    Recording r;
    const Buffer undeclared = r.b;
    EXPECT_NE(r.of([=](Commands& c) {
                   c.push(1u).dispatchIndirect(undeclared);
               }).find("not declared; add indirect()"),
              std::string::npos);
}

TEST(Recording, IndirectBeyondTheBuffer) {
    Recording r;
    const Buffer arguments = r.a;
    EXPECT_NE(r.of([=](Commands& c) {
                   c.push(1u).dispatchIndirect(arguments, 248);
               }).find("holds no workgroup counts at byte 248"),
              std::string::npos);
}

TEST(Recording, DispatchOverAForeignImage) {
    Graph other(device());
    const Image image = other.image("image", {{4, 4}, Format::RGBA32F});
    EXPECT_NE(
        Recording().of([=](Commands& c) { c.push(1u).dispatchOver(image); }).find("image of another graph"),
        std::string::npos);
}

TEST(Recording, ARecorderMayThrowAnything) {
    TwoBuffers t;
    bool broken = true;
    t.g.compute("p", iotaKernel()).overwrites({{"uOut", t.b}}).record([&](Commands& c) {
        c.push(0u).dispatch(1);
        if (broken) throw std::runtime_error("mine");
    });
    Plan plan = t.g.compile();
    EXPECT_THROW(plan.execute(), std::runtime_error);
    broken = false;
    EXPECT_EQ(plan.execute().serial, 1u);
}

TEST(Tokens, OfAnotherPlanOrNone) {
    TwoBuffers t;
    t.g.fill("fill", t.b, 1);
    auto result = t.g.readback<std::uint32_t>(t.b);
    Plan one = t.g.compile(), two = t.g.compile();
    const Execution run = one.execute();
    EXPECT_THROW(two.wait(run), GraphError);
    EXPECT_THROW(two.timings(run), GraphError);
    EXPECT_THROW(one.wait({}), GraphError);
    EXPECT_THROW(result.wait({}), GraphError);
    EXPECT_EQ(result.wait(run).size(), 64u);
    one = Plan();
    EXPECT_THROW(result.wait(run), GraphError) << "its plan is gone";
}

}  // namespace
}  // namespace helio
