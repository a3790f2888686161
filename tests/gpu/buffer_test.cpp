// Bytes in and out of device buffers, directly and through the staging ring.
#include "tests/gpu/raw_dispatch.hpp"
#include "tests/support/device.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <numeric>
#include <random>
#include <thread>

namespace helio {
namespace {

constexpr std::uint64_t kRing = gpu::Staging::kRingBytes;

std::vector<std::uint8_t> randomBytes(std::size_t count, std::uint32_t seed) {
    std::mt19937 generator(seed);
    std::vector<std::uint8_t> bytes(count);
    std::ranges::generate(bytes, [&] { return std::uint8_t(generator()); });
    return bytes;
}

/** Index of the first difference, or -1: a failure names the place, not two megabytes. */
std::int64_t firstDifference(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
    const auto [x, y] = std::ranges::mismatch(a, b);
    return x == a.end() && y == b.end() ? -1 : x - a.begin();
}

/** Both ways in and out: mapped memory where the device has it, and the ring that other devices need. */
class BufferTransfer : public testing::TestWithParam<bool> {
protected:
    void SetUp() override { test::device().impl().staging.allowDirect(GetParam()); }
    void TearDown() override { test::device().impl().staging.allowDirect(true); }
};
INSTANTIATE_TEST_SUITE_P(, BufferTransfer, testing::Bool(),
                         [](const auto& each) { return each.param ? "Direct" : "Staged"; });

TEST_P(BufferTransfer, ReturnsWhatWasUploadedForManySizes) {
    const std::uint64_t sizes[] = {1,
                                   2,
                                   3,
                                   4,
                                   5,
                                   63,
                                   64,
                                   65,
                                   4095,
                                   1000003,
                                   kRing / 2 - 1,
                                   kRing / 2,
                                   kRing / 2 + 1,
                                   kRing - 1,
                                   kRing,
                                   kRing + 1,
                                   3 * kRing + 12345};
    std::uint32_t seed = 0;
    for (const std::uint64_t size : sizes) {
        SCOPED_TRACE(size);
        const std::vector<std::uint8_t> in = randomBytes(size, ++seed);
        DeviceBuffer buffer = makeBuffer(test::device(), "round trip", in);
        EXPECT_EQ(buffer.bytes(), std::max<std::uint64_t>(size, 4));
        std::vector<std::uint8_t> out(size);
        buffer.download(out.data(), size);
        EXPECT_EQ(firstDifference(in, out), -1);
    }
}

TEST_P(BufferTransfer, ChangesOnlyTheRangeThatIsUploaded) {
    std::vector<std::uint8_t> expected = randomBytes(1 << 20, 5);
    DeviceBuffer buffer = makeBuffer(test::device(), "patched", expected);
    std::mt19937 generator(6);
    for (int i = 0; i < 200; ++i) {
        const std::uint64_t offset = generator() % expected.size();
        const std::uint64_t bytes = std::min<std::uint64_t>(generator() % 5000, expected.size() - offset);
        const std::vector<std::uint8_t> patch = randomBytes(bytes, 1000 + i);
        buffer.upload(patch.data(), bytes, offset);
        std::ranges::copy(patch, expected.begin() + std::ptrdiff_t(offset));
        const std::uint64_t from = generator() % expected.size();
        std::vector<std::uint8_t> part(std::min<std::uint64_t>(3000, expected.size() - from));
        buffer.download(part.data(), part.size(), from);
        ASSERT_TRUE(std::equal(part.begin(), part.end(), expected.begin() + std::ptrdiff_t(from)))
            << "patch " << i;
    }
    std::vector<std::uint8_t> out(expected.size());
    buffer.download(out.data(), out.size());
    EXPECT_EQ(firstDifference(expected, out), -1);
}

TEST_P(BufferTransfer, IsOrderedWithWorkInFlight) {
    // Each round the device copies `source` while it computes for a while; the upload that follows at once
    // must not reach into that copy.
    Device& device = test::device();
    Device::Impl& impl = device.impl();
    const std::uint32_t words = 1 << 18;
    DeviceBuffer source(device, "source", words * 4);
    std::vector<DeviceBuffer> copies;
    for (std::uint32_t round = 0; round < 12; ++round) {
        const std::vector<std::uint32_t> values(words, round * 7919 + 1);
        source.upload(values.data(), words * 4);
        copies.emplace_back(device, "copy", words * 4);
        gpu::Recording commands = impl.queue.begin("copy");
        commands->copyBuffer(*source.impl()->resource.buffer, *copies.back().impl()->resource.buffer,
                             vk::BufferCopy{.size = words * 4});
        impl.queue.submit(std::move(commands));
    }
    for (std::uint32_t round = 0; round < 12; ++round) {
        std::vector<std::uint32_t> out(words);
        copies[round].download(out.data(), words * 4);
        EXPECT_EQ(std::ranges::count(out, round * 7919 + 1), words) << "round " << round;
    }
}

TEST(DeviceBuffer, MayBeDestroyedWhileTheDeviceUsesIt) {
    Device& device = test::device();
    DeviceBuffer result(device, "result", 64);
    {
        DeviceBuffer factor = makeBuffer(device, "factor", std::vector<std::uint32_t>(16, 3));
        test::submitDispatch(device,
                             {.name = "triple",
                              .glsl = R"(#version 460
layout(local_size_x = 16) in;
layout(binding = 0) readonly buffer A { uint factor[]; };
layout(binding = 1) writeonly buffer B { uint result[]; };
void main() {
    uint x = 1;
    for (int i = 0; i < 1000; ++i) x = x * factor[gl_LocalInvocationIndex];
    result[gl_LocalInvocationIndex] = x;
})",
                              .bindings = {{{.binding = 0}, {.buffer = *factor.impl()->resource.buffer}},
                                           {{.binding = 1}, {.buffer = *result.impl()->resource.buffer}}}});
    }
    std::uint32_t power = 1;  // 3^1000 modulo 2^32
    for (int i = 0; i < 1000; ++i) power *= 3;
    std::vector<std::uint32_t> out(16);
    result.download(out.data(), 64);
    EXPECT_EQ(out, std::vector<std::uint32_t>(16, power));
}

TEST(DeviceBuffer, ThreadsMayUploadAndDownloadAtOnce) {
    // The validation layer also watches for objects that two threads use at once.
    Device& device = test::device();
    std::atomic<int> wrong{0};
    std::vector<std::thread> threads;
    for (std::uint32_t thread = 0; thread < 4; ++thread) {
        threads.emplace_back([&, thread] {
            for (std::uint32_t round = 0; round < 25; ++round) {
                const std::vector<std::uint32_t> in(20000, thread * 1000 + round);
                DeviceBuffer buffer = makeBuffer(device, "of a thread", in);
                gpu::Recording commands = device.impl().queue.begin("of a thread");
                commands->fillBuffer(*buffer.impl()->resource.buffer, 0, 4, thread);
                device.impl().queue.submit(std::move(commands));
                std::vector<std::uint32_t> out(in.size());
                buffer.download(out.data(), out.size() * 4);
                if (out[0] != thread || std::ranges::count(out, in[1]) < 19999) ++wrong;
            }
        });
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(wrong, 0);
}

TEST(DeviceBuffer, TakesAtLeastFourBytesAndHasADeviceAddress) {
    DeviceBuffer buffer(test::device(), "empty", 0);
    EXPECT_EQ(buffer.bytes(), 4u);
    EXPECT_NE(buffer.impl()->resource.address, 0u);
    EXPECT_TRUE(buffer);
    DeviceBuffer moved = std::move(buffer);
    EXPECT_FALSE(buffer);
    EXPECT_EQ(moved.name(), "empty");
}

TEST(DeviceImage, StartsAtZeroInEveryFormat) {
    Device& device = test::device();
    for (const Format format :
         {Format::R32UI, Format::R32I, Format::R32F, Format::RG32UI, Format::RG32F, Format::RGBA32UI,
          Format::RGBA32F, Format::RGBA16F, Format::RGBA8, Format::R8}) {
        SCOPED_TRACE(formatName(format));
        DeviceImage image(device, "cleared", 37, 11, format);
        const std::uint64_t bytes = 37ull * 11 * formatBytes(format);
        DeviceBuffer buffer = makeBuffer(device, "texels", std::vector<std::uint8_t>(bytes, 0xab));
        Device::Impl& impl = device.impl();
        gpu::Recording commands = impl.queue.begin("read image");
        commands->copyImageToBuffer(
            *image.impl()->resource.image, vk::ImageLayout::eGeneral, *buffer.impl()->resource.buffer,
            vk::BufferImageCopy{
                .imageSubresource = {.aspectMask = vk::ImageAspectFlagBits::eColor, .layerCount = 1},
                .imageExtent = {37, 11, 1}});
        impl.queue.submit(std::move(commands));
        std::vector<std::uint8_t> out(bytes);
        buffer.download(out.data(), bytes);
        EXPECT_EQ(std::size_t(std::ranges::count(out, 0)), bytes);
    }
}

}  // namespace
}  // namespace helio
