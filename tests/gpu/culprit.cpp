// Breaks the rules of Vulkan on purpose. Each test "passes" by its own word; the listener must fail it, or
// the run. Started by validation_test.cpp.
#include "engine/gpu/device_impl.hpp"
#include "tests/support/device.hpp"

#include <gtest/gtest.h>

namespace helio {
namespace {

TEST(Culprit, Innocent) {
    DeviceBuffer buffer(test::device(), "innocent", 1024);
    const std::vector<char> bytes(1024);
    buffer.upload(bytes.data(), 1024);
    test::device().waitIdle();
}

TEST(Culprit, WrongCommand) {
    DeviceBuffer buffer(test::device(), "too small", 1024);
    gpu::Recording commands = test::device().impl().queue.begin("wrong");
    commands->fillBuffer(*buffer.impl()->resource.buffer, 2, 4, 0);  // not a multiple of 4
}

TEST(Culprit, MissingBarrier) {
    DeviceBuffer buffer(test::device(), "raced buffer", 1024);
    gpu::Recording commands = test::device().impl().queue.begin("race");
    commands->fillBuffer(*buffer.impl()->resource.buffer, 0, 1024, 1);
    commands->fillBuffer(*buffer.impl()->resource.buffer, 0, 1024, 2);
    test::device().impl().queue.submit(std::move(commands));
}

TEST(Culprit, MissingSemaphore) {
    // Two submissions past the engine's queue, so that neither waits for the other.
    Device::Impl& gpu = test::device().impl();
    DeviceBuffer buffer(test::device(), "raced buffer", 1024);
    const vk::raii::CommandPool pool(gpu.device, {.queueFamilyIndex = gpu.queue.family()});
    const vk::raii::CommandBuffers commands(gpu.device, {.commandPool = *pool, .commandBufferCount = 2});
    for (const vk::raii::CommandBuffer& each : commands) {
        each.begin({});
        each.fillBuffer(*buffer.impl()->resource.buffer, 0, 1024, 1);
        each.end();
        const vk::CommandBufferSubmitInfo info{.commandBuffer = *each};
        const vk::raii::Queue queue(gpu.device, gpu.queue.family(), 0);
        queue.submit2(vk::SubmitInfo2{.commandBufferInfoCount = 1, .pCommandBufferInfos = &info});
    }
    gpu.device.waitIdle();
}

TEST(Culprit, LeaksUntilTheDeviceIsClosed) {
    test::device()
        .impl()
        .device
        .createBuffer({.size = 16,
                       .usage = vk::BufferUsageFlagBits::eStorageBuffer,
                       .sharingMode = vk::SharingMode::eExclusive})
        .release();
}

TEST(Culprit, Confesses) {
    DeviceBuffer buffer(test::device(), "confessed", 1024);
    gpu::Recording commands = test::device().impl().queue.begin("wrong");
    commands->fillBuffer(*buffer.impl()->resource.buffer, 2, 4, 0);
    EXPECT_EQ(test::takeValidationMessages().size(), 1u);
}

}  // namespace
}  // namespace helio
