/** @file Every kind of binding on the device: values through images, texel, uniform and storage buffers,
 * windows, indirect arguments, fills, copies, specialization constants and poison. */
#include "tests/graph/kernels.hpp"
#include "tests/support/device.hpp"

#include <heliograph/graph.hpp>

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <iostream>

namespace helio::binding_test {
namespace {

using test::device;
using test::kernelOf;

constexpr std::uint32_t count = 1000;
constexpr std::uint64_t size = count * sizeof(std::uint32_t);
using Values = std::vector<std::uint32_t>;

TEST(Bindings, PoisonShowsWhatWasNeverWritten) {
    const Kernel half = kernelOf(
        "test/half", "layout(std430, set = 0, binding = 0) writeonly buffer Out { float values[]; } uOut;",
        "uint i = gl_GlobalInvocationID.x; if (i < uOut.values.length() / 2) uOut.values[i] = 1.0;");
    const Kernel image =
        kernelOf("test/left", "layout(rgba32f, set = 0, binding = 0) uniform writeonly image2D uOut;",
                 "ivec2 p = ivec2(gl_GlobalInvocationID.xy); if (p.x < 4) imageStore(uOut, p, vec4(1));",
                 "local_size_x = 8, local_size_y = 8");
    Graph g(device());
    const Buffer buffer = g.buffer("half", {size});
    const Image picture = g.image("left", {{8, 8}, Format::RGBA32F});
    g.compute("half", half).writes({{"uOut", buffer}}).record([](Commands& c) {
        c.dispatchInvocations(count);
    });
    g.compute("left", image).writes({{"uOut", picture}}).record([=](Commands& c) {
        c.dispatchOver(picture);
    });
    auto values = g.readback<float>(buffer);
    auto texels = g.readback<float>(picture);
    Plan plan = g.compile({.poison = true});
    const Execution run = plan.execute();
    const std::vector<float> read = values.wait(run);
    for (std::size_t i = 0; i < read.size(); ++i) {
        if (i < count / 2)
            EXPECT_EQ(read[i], 1.0f) << i;
        else
            EXPECT_EQ(std::bit_cast<std::uint32_t>(read[i]), 0x7fc0deadu) << i;
    }
    const std::vector<float> pixels = texels.wait(run);
    ASSERT_EQ(pixels.size(), 8u * 8 * 4);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        if (i / 4 % 8 < 4)
            EXPECT_EQ(pixels[i], 1.0f) << i;
        else
            EXPECT_TRUE(std::isnan(pixels[i])) << i;
    }
}

TEST(Bindings, IndirectDispatch) {
    const Kernel arguments = kernelOf(
        "test/arguments",
        "layout(std430, set = 0, binding = 0) writeonly buffer Groups { uint words[]; } uGroups;",
        "uGroups.words[0] = 7u; uGroups.words[1] = 3u; uGroups.words[2] = 2u; uGroups.words[3] = 1u;",
        "local_size_x = 1");
    const Kernel mark =
        kernelOf("test/mark", "layout(std430, set = 0, binding = 0) buffer Total { uint value; } uTotal;",
                 "atomicAdd(uTotal.value, 1u);", "local_size_x = 8");
    Graph g(device());
    const Buffer groups = g.buffer("groups", {16}), total = g.buffer("total", {4});
    g.compute("arguments", arguments).overwrites({{"uGroups", groups}}).record([](Commands& c) {
        c.dispatch(1);
    });
    g.fill("zero", total, 0);
    g.compute("mark", mark).modifies({{"uTotal", total}}).indirect(groups).record([=](Commands& c) {
        c.dispatchIndirect(groups, 4);
    });
    auto result = g.readback<std::uint32_t>(total);
    Plan plan = g.compile();
    for (int i = 0; i < 3; ++i) EXPECT_EQ(result.wait(plan.execute()), Values{3 * 2 * 1 * 8});
}

TEST(Bindings, FillAndCopy) {
    Graph g(device());
    const Buffer small = g.buffer("small", {10}), large = g.buffer("large", {24});
    g.fill("fill large", large, 0xaaaaaaaau);
    g.fill("fill small", small, 0x04030201u);
    g.copy("copy", small, large);
    auto result = g.readback<std::uint8_t>(large);
    Plan plan = g.compile();
    const std::vector<std::uint8_t> expected{1,    2,    3,    4,    1,    2,    3,    4,
                                             1,    2,    0xaa, 0xaa, 0xaa, 0xaa, 0xaa, 0xaa,
                                             0xaa, 0xaa, 0xaa, 0xaa, 0xaa, 0xaa, 0xaa, 0xaa};
    EXPECT_EQ(result.wait(plan.execute()), expected);
}

TEST(Bindings, ImagesOfManyFormatsAndSampling) {
    const auto paint = [](const std::string& format, const std::string& prefix) {
        return kernelOf(
            "test/paint_" + format,
            "layout(" + format + ", set = 0, binding = 0) uniform writeonly " + prefix + "image2D uOut;",
            "ivec2 p = ivec2(gl_GlobalInvocationID.xy); if (all(lessThan(p, imageSize(uOut)))) "
            "imageStore(uOut, p, " +
                prefix + "vec4(p.x, p.y, 3, 1));",
            "local_size_x = 8, local_size_y = 8");
    };
    const Kernel sample = kernelOf(
        "test/sample",
        "layout(set = 0, binding = 0) uniform sampler2D uIn;\n"
        "layout(rgba32f, set = 0, binding = 1) uniform writeonly image2D uOut;",
        "ivec2 p = ivec2(gl_GlobalInvocationID.xy); ivec2 s = imageSize(uOut); if (all(lessThan(p, s))) "
        "imageStore(uOut, p, textureLod(uIn, vec2(p) / vec2(s), 0.0));",
        "local_size_x = 8, local_size_y = 8");
    Graph g(device());
    const Image wide = g.image("wide", {{13, 9}, Format::RGBA32F}),
                bits = g.image("bits", {{13, 9}, Format::R32UI}),
                half = g.image("half", {{13, 9}, Format::RGBA16F}),
                linear = g.image("linear", {{13, 9}, Format::RGBA32F});
    const auto over = [](Image image) { return [=](Commands& c) { c.dispatchOver(image); }; };
    g.compute("wide", paint("rgba32f", "")).overwrites({{"uOut", wide}}).record(over(wide));
    g.compute("bits", paint("r32ui", "u")).overwrites({{"uOut", bits}}).record(over(bits));
    g.compute("half", paint("rgba16f", "")).overwrites({{"uOut", half}}).record(over(half));
    g.compute("linear", sample)
        .reads({{"uIn", wide, Sampling::Linear}})
        .overwrites({{"uOut", linear}})
        .record(over(linear));
    auto wideBack = g.readback<float>(wide);
    auto bitsBack = g.readback<std::uint32_t>(bits);
    auto halfBack = g.readback<std::uint16_t>(half);
    auto linearBack = g.readback<float>(linear);
    Plan plan = g.compile();
    for (int repeat = 0; repeat < 2; ++repeat) {
        const Execution run = plan.execute();
        const auto w = wideBack.wait(run);
        const auto b = bitsBack.wait(run);
        const auto h = halfBack.wait(run);
        const auto l = linearBack.wait(run);
        ASSERT_EQ(w.size(), 13u * 9 * 4);
        ASSERT_EQ(b.size(), 13u * 9);
        for (std::size_t y = 0; y < 9; ++y) {
            for (std::size_t x = 0; x < 13; ++x) {
                const std::size_t i = y * 13 + x;
                EXPECT_EQ(w[i * 4], float(x));
                EXPECT_EQ(w[i * 4 + 1], float(y));
                EXPECT_EQ(b[i], x);
                EXPECT_EQ(h[i * 4 + 2], 0x4200u);  // 3 in half precision
                // Sampled half a texel up and left of the centre: clamped at the edge, else the mean.
                EXPECT_NEAR(l[i * 4], x == 0 ? 0.0 : double(x) - 0.5, 0.03);
            }
        }
    }
}

TEST(Bindings, TexelAndUniformBuffersAndWindows) {
    const Kernel gather =
        kernelOf("test/gather",
                 "layout(set = 0, binding = 0) uniform samplerBuffer uFloats;\n"
                 "layout(set = 0, binding = 1) uniform usamplerBuffer uWords;\n"
                 "layout(std140, set = 0, binding = 2) uniform Scale { vec4 scale; } uScale;\n"
                 "layout(r32f, set = 0, binding = 3) uniform writeonly imageBuffer uOut;\n"
                 "layout(std430, set = 0, binding = 4) readonly buffer Part { float values[]; } uPart;",
                 "int i = int(gl_GlobalInvocationID.x); if (i < imageSize(uOut)) imageStore(uOut, i, "
                 "vec4(texelFetch(uFloats, i).y * uScale.scale.x + float(texelFetch(uWords, i).x) + "
                 "uPart.values[i]));");
    constexpr std::uint32_t n = 256;
    std::vector<float> floats(n * 4), part(n * 2);
    Values words(n);
    for (std::uint32_t i = 0; i < n; ++i) {
        floats[i * 4 + 1] = float(i);
        words[i] = 1000 * i;
        part[n + i] = 0.25f;
    }
    DeviceBuffer f = makeBuffer(device(), "floats", floats), w = makeBuffer(device(), "words", words),
                 s = makeBuffer(device(), "scale", std::vector<float>{2, 0, 0, 0}),
                 p = makeBuffer(device(), "part", part);
    Graph g(device());
    const Buffer out = g.buffer("out", {n * 4});
    g.compute("gather", gather)
        .reads({{"uFloats", g.import(f)}, {"uWords", g.import(w), Format::R32UI}, {"uScale", g.import(s)}})
        .reads({{"uPart", g.import(p), Window{n * 4, n * 4}}})
        .overwrites({{"uOut", out}})
        .record([](Commands& c) { c.dispatchInvocations(n); });
    auto result = g.readback<float>(out);
    Plan plan = g.compile();
    const std::vector<float> read = result.wait(plan.execute());
    ASSERT_EQ(read.size(), n);
    for (std::uint32_t i = 0; i < n; ++i)
        EXPECT_EQ(read[i], 2.0f * float(i) + 1000.0f * float(i) + 0.25f) << i;
}

/** Data larger than one storage binding may span: read through a texel buffer, and through windows. */
TEST(Bindings, DataBeyondTheStorageBufferRange) {
    const std::uint64_t range = device().info().maxStorageBufferRange;
    if (range >= device().info().maxBufferSize || range > (256u << 20)) {
        std::cout << "left out: a storage binding of " << range
                  << " bytes is as large as this test allocates\n";
        return;
    }
    const std::uint64_t bytes = range + (4u << 20);
    const Kernel write =
        kernelOf("test/write_far",
                 "layout(std430, set = 0, binding = 0) writeonly buffer Far { uvec4 values[]; } uFar;",
                 "uint i = gl_GlobalInvocationID.x; if (i < uFar.values.length()) uFar.values[i] = uvec4(i, "
                 "1, 2, 3);");
    const Kernel read =
        kernelOf("test/read_far",
                 "layout(set = 0, binding = 0) uniform usamplerBuffer uAll;\n"
                 "layout(std430, set = 0, binding = 1) writeonly buffer Out { uvec4 values[]; } uOut;",
                 "int i = int(gl_GlobalInvocationID.x);\n"
                 "if (i < 64) uOut.values[i] = texelFetch(uAll, textureSize(uAll) - 1 - i);");
    Graph g(device());
    const Buffer large = g.buffer("large", {bytes}), out = g.buffer("out", {1024});
    g.fill("zero", large, 0);
    g.compute("write", write).writes({{"uFar", large, Window{range, 0}}}).record([](Commands& c) {
        c.dispatchInvocations((4u << 20) / 16);
    });
    g.compute("read", read).reads({{"uAll", large}}).overwrites({{"uOut", out}}).record([](Commands& c) {
        c.dispatch(1);
    });
    auto result = g.readback<std::uint32_t>(out);
    Plan plan = g.compile();
    const Values values = result.wait(plan.execute());
    for (std::uint32_t i = 0; i < 64; ++i) {
        EXPECT_EQ(values[4 * i], (4u << 20) / 16 - 1 - i);
        EXPECT_EQ(values[4 * i + 3], 3u);
    }
}

TEST(Bindings, ImportedImageKeepsItsTexels) {
    const Kernel add =
        kernelOf("test/add_image", "layout(r32ui, set = 0, binding = 0) uniform uimage2D uImage;",
                 "ivec2 p = ivec2(gl_GlobalInvocationID.xy); imageStore(uImage, p, imageLoad(uImage, p) + "
                 "uvec4(p.x + 8 * p.y));",
                 "local_size_x = 8, local_size_y = 8");
    const Kernel zero =
        kernelOf("test/zero_image", "layout(r32ui, set = 0, binding = 0) uniform writeonly uimage2D uImage;",
                 "imageStore(uImage, ivec2(gl_GlobalInvocationID.xy), uvec4(0));",
                 "local_size_x = 8, local_size_y = 8");
    DeviceImage image(device(), "accumulated", 8, 8, Format::R32UI);
    Graph start(device());
    const Image a = start.import(image);
    start.compute("zero", zero).overwrites({{"uImage", a}}).record([=](Commands& c) { c.dispatchOver(a); });
    Plan starting = start.compile();
    Graph g(device());
    const Image b = g.import(image);
    g.compute("add", add).modifies({{"uImage", b}}).record([=](Commands& c) { c.dispatchOver(b); });
    auto result = g.readback<std::uint32_t>(b);
    Plan plan = g.compile();
    starting.execute();
    Execution run;
    for (int i = 0; i < 5; ++i) run = plan.execute();
    const Values read = result.wait(run);
    for (std::uint32_t i = 0; i < 64; ++i) EXPECT_EQ(read[i], 5 * i);

    // Nothing but copies: their layout changes must wait for what another plan wrote.
    DeviceImage other(device(), "other", 8, 8, Format::R32UI);
    Graph writer(device());
    for (const Image c : {writer.import(image), writer.import(other)})
        writer.compute("add", add).modifies({{"uImage", c}}).record([=](Commands& r) { r.dispatchOver(c); });
    Plan writing = writer.compile();
    Graph reader(device());
    auto first = reader.readback<std::uint32_t>(reader.import(image));
    auto second = reader.readback<std::uint32_t>(reader.import(other));
    Plan reading = reader.compile();
    writing.execute();
    const Execution read2 = reading.execute();
    EXPECT_EQ(first.wait(read2)[63], 6u * 63);
    EXPECT_EQ(second.wait(read2)[63], 63u);
}

TEST(Bindings, SpecializationConstantsByNameAndLocalSize) {
    const Kernel kernel =
        kernelOf("test/spec",
                 "layout(constant_id = 3) const uint FACTOR = 2u;\n"
                 "layout(constant_id = 5) const bool NEGATE = false;\n"
                 "layout(constant_id = 6) const float OFFSET = 0.5;\n"
                 "layout(local_size_x_id = 9) in;\nlayout(constant_id = 9) const uint WIDTH = 64u;\n"
                 "layout(std430, set = 0, binding = 0) writeonly buffer Out { float values[]; } uOut;",
                 "uint i = gl_GlobalInvocationID.x; if (i < uOut.values.length()) uOut.values[i] = "
                 "(NEGATE ? -1.0 : 1.0) * float(i * FACTOR) + OFFSET + float(gl_WorkGroupSize.x) * 1000.0;");
    Graph g(device());
    const Buffer a = g.buffer("a", {400}), b = g.buffer("b", {400});
    g.compute("defaults", kernel).overwrites({{"uOut", a}}).record([](Commands& c) {
        c.dispatchInvocations(100);
    });
    g.compute("given", kernel,
              {.spec = {{"FACTOR", 7u}, {"NEGATE", true}, {"OFFSET", 0.25f}, {"WIDTH", 16u}}})
        .overwrites({{"uOut", b}})
        .record([](Commands& c) { c.dispatchInvocations(100); });
    auto first = g.readback<float>(a), second = g.readback<float>(b);
    Plan plan = g.compile();
    const Execution run = plan.execute();
    const std::vector<float> x = first.wait(run), y = second.wait(run);
    for (std::uint32_t i = 0; i < 100; ++i) {
        EXPECT_EQ(x[i], float(2 * i) + 0.5f + 64000.0f);
        EXPECT_EQ(y[i], -float(7 * i) + 0.25f + 16000.0f);
    }
}

}  // namespace
}  // namespace helio::binding_test
