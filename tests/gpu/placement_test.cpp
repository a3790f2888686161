// Resources placed in memory that they share: what the graph's aliasing rests on.
#include "engine/gpu/device_impl.hpp"
#include "engine/graph/host_access.hpp"
#include "tests/support/device.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace helio {
namespace {

std::uint64_t roundUp(std::uint64_t value, std::uint64_t multiple) {
    return (value + multiple - 1) / multiple * multiple;
}

TEST(Placement, BuffersAndImagesShareOneRange) {
    Device& device = test::device();
    Device::Impl& gpu = device.impl();
    const vk::Extent2D extent{100, 60};
    const auto bufferNeeds = gpu::bufferRequirements(gpu, "a", 50000);
    const auto imageNeeds = gpu::imageRequirements(gpu, "i", extent, vk::Format::eR32G32B32A32Sfloat);
    const std::uint64_t granularity = gpu.memory.bufferImageGranularity();
    const std::uint64_t second = roundUp(bufferNeeds.size, std::max(bufferNeeds.alignment, granularity));
    const std::uint64_t bytes = std::max(second + bufferNeeds.size, imageNeeds.size);

    const std::uint64_t usedBefore = device.memory().usedBytes;
    gpu::Allocation range =
        gpu.memory.allocate({.name = "transients",
                             .bytes = bytes,
                             .alignment = std::max(bufferNeeds.alignment, imageNeeds.alignment),
                             .typeBits = bufferNeeds.memoryTypeBits & imageNeeds.memoryTypeBits,
                             .content = gpu::MemoryContent::Mixed});
    gpu::BufferResource a = gpu::placeBuffer(gpu, "a", 50000, range, 0);
    gpu::BufferResource b = gpu::placeBuffer(gpu, "b", 50000, range, second);
    gpu::ImageResource image = gpu::placeImage(gpu, "i", extent, vk::Format::eR32G32B32A32Sfloat, range, 0);
    gpu::BufferResource alias = gpu::placeBuffer(gpu, "alias of a", 50000, range, 0);
    EXPECT_EQ(device.memory().usedBytes, usedBefore + range.bytes()) << "placing takes no memory";

    gpu::Recording commands = gpu.queue.begin("fill");
    commands->fillBuffer(*a.buffer, 0, 50000, 0x11111111);
    commands->fillBuffer(*b.buffer, 0, 50000, 0x22222222);
    gpu.queue.submit(std::move(commands));
    std::vector<std::uint32_t> out(12500);
    graph::download(gpu, alias, out.data(), 50000, 0);
    EXPECT_EQ(std::size_t(std::ranges::count(out, 0x11111111u)), out.size())
        << "the alias sees the same bytes";
    graph::download(gpu, b, out.data(), 50000, 0);
    EXPECT_EQ(std::size_t(std::ranges::count(out, 0x22222222u)), out.size());
    EXPECT_TRUE(*image.view);

    gpu.queue.retire(std::move(a));
    gpu.queue.retire(std::move(b));
    gpu.queue.retire(std::move(image));
    gpu.queue.retire(std::move(alias));
    range.reset();
    EXPECT_EQ(device.memory().usedBytes, usedBefore);
}

TEST(Placement, RequirementsAreThoseOfTheResourceThatIsMade) {
    Device::Impl& gpu = test::device().impl();
    for (const std::uint64_t bytes : {4ull, 1000ull, 123456789ull}) {
        const auto needs = gpu::bufferRequirements(gpu, "b", bytes);
        const gpu::BufferResource buffer = gpu::createBuffer(gpu, "b", bytes);
        EXPECT_EQ(needs, buffer.buffer.getMemoryRequirements());
    }
    const auto needs = gpu::imageRequirements(gpu, "i", {1000, 7}, vk::Format::eR32Uint);
    const gpu::ImageResource image = gpu::createImage(gpu, "i", {1000, 7}, vk::Format::eR32Uint);
    EXPECT_EQ(needs, image.image.getMemoryRequirements());
}

}  // namespace
}  // namespace helio
