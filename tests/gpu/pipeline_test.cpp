// Compute pipelines: constants reach the kernel, equal content is made once, and the file of the cache.
#include "tests/gpu/raw_dispatch.hpp"
#include "tests/support/device.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <fstream>

namespace helio {
namespace {

constexpr const char* kConstants = R"(#version 460
layout(local_size_x = 1) in;
layout(constant_id = 0) const uint aUint = 1;
layout(constant_id = 3) const int anInt = 2;
layout(constant_id = 5) const float aFloat = 3.0;
layout(constant_id = 9) const bool aBool = false;
layout(binding = 2) buffer Result { uint result[8]; };
layout(push_constant) uniform Push { uint a; uint b; };
void main() {
    result[0] = aUint;
    result[1] = uint(anInt);
    result[2] = floatBitsToUint(aFloat);
    result[3] = aBool ? 1u : 0u;
    result[4] = a;
    result[5] = b;
})";

std::vector<std::uint32_t> runConstants(std::vector<std::pair<std::uint32_t, SpecValue>> spec) {
    DeviceBuffer result(test::device(), "result", 32);
    test::submitDispatch(test::device(),
                         {.name = "constants",
                          .glsl = kConstants,
                          .bindings = {{{.binding = 2}, {.buffer = *result.impl()->resource.buffer}}},
                          .push = {77, 88},
                          .spec = std::move(spec)});
    std::vector<std::uint32_t> out(6);
    result.download(out.data(), 24);
    return out;
}

TEST(ComputePipeline, TakesSpecializationAndPushConstants) {
    const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x); };
    EXPECT_EQ(runConstants({}), (std::vector<std::uint32_t>{1, 2, bits(3), 0, 77, 88}));
    EXPECT_EQ(runConstants({{0, 4000000000u}, {3, -5}, {5, -0.25f}, {9, true}}),
              (std::vector<std::uint32_t>{4000000000u, std::uint32_t(-5), bits(-0.25f), 1, 77, 88}));
    EXPECT_EQ(runConstants({{9, true}}), (std::vector<std::uint32_t>{1, 2, bits(3), 1, 77, 88}));
}

TEST(ComputePipeline, IsMadeOncePerContent) {
    gpu::PipelineCache& pipelines = test::device().impl().pipelines;
    const Kernel kernel = compileKernel("constants", kConstants);
    gpu::ComputePipelineInfo info{
        .name = "one", .spirv = kernel.spirv, .bindings = {{.binding = 2}}, .pushConstantBytes = 8};
    const auto first = pipelines.get(info);
    const std::uint32_t created = pipelines.created();
    info.name = "the same under another name";
    EXPECT_EQ(pipelines.get(info), first);
    const std::vector<std::uint32_t> copy(kernel.spirv.begin(), kernel.spirv.end());
    info.spirv = copy;
    EXPECT_EQ(pipelines.get(info), first);
    EXPECT_EQ(pipelines.created(), created);
    info.spec = {{0, 6u}};
    const auto other = pipelines.get(info);
    EXPECT_NE(other, first);
    info.spec = {{0, 7u}};
    EXPECT_NE(pipelines.get(info), other) << "another value of the same constant";
    info.spec = {{1, 6u}};
    EXPECT_NE(pipelines.get(info), other) << "another constant of the same value";
    EXPECT_EQ(pipelines.created(), created + 3);
}

TEST(ComputePipeline, WithTooManyPushConstantsIsRefusedByName) {
    Device& device = test::device();
    const Kernel kernel = compileKernel("constants", kConstants);
    try {
        device.impl().pipelines.get({.name = "greedy",
                                     .spirv = kernel.spirv,
                                     .bindings = {{.binding = 2}},
                                     .pushConstantBytes = device.impl().limits().maxPushConstantsSize + 4});
        FAIL();
    } catch (const DeviceError& error) {
        EXPECT_NE(std::string(error.what()).find("pipeline 'greedy'"), std::string::npos) << error.what();
    }
}

class PipelineCacheFolder : public testing::Test {
protected:
    void TearDown() override { std::filesystem::remove_all(options.pipelineCache); }
    /** Opens a device, makes one pipeline, closes it; returns the bytes it took from the file. */
    std::uint64_t session() {
        const Device device(options);
        const Kernel kernel = compileKernel("constants", kConstants);
        device.impl().pipelines.get(
            {.name = "one", .spirv = kernel.spirv, .bindings = {{.binding = 2}}, .pushConstantBytes = 8});
        file = device.impl().pipelines.file();
        return device.impl().pipelines.loadedBytes();
    }
    DeviceOptions options = [] {
        DeviceOptions o = test::deviceOptions();
        o.pipelineCache = test::scratchFolder() / "pipeline cache test";
        return o;
    }();
    std::filesystem::path file;
};

TEST_F(PipelineCacheFolder, IsFilledByOneSessionAndTakenByTheNext) {
    EXPECT_EQ(session(), 0u);
    ASSERT_TRUE(std::filesystem::exists(file));
    EXPECT_GT(session(), 0u);
}

TEST_F(PipelineCacheFolder, WithADamagedFileIsFilledAnew) {
    session();
    for (const std::string damage :
         {"", "garbage", "HELIOPC1 and then nothing sensible, though long enough"}) {
        std::ofstream(file, std::ios::binary | std::ios::trunc) << damage;
        EXPECT_EQ(session(), 0u) << "'" << damage << "' was taken";
        EXPECT_GT(session(), 0u) << "after '" << damage << "' the file was not written anew";
    }
}

TEST_F(PipelineCacheFolder, ThatCannotBeMadeIsNoError) {
    std::ofstream(options.pipelineCache.string()) << "a file where the folder should be";
    EXPECT_EQ(session(), 0u);
}

}  // namespace
}  // namespace helio
