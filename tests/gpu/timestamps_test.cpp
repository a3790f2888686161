// Device timestamps.
#include "engine/gpu/device_impl.hpp"
#include "tests/support/device.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>

namespace helio {
namespace {

TEST(Timestamps, TicksBecomeMillisecondsAcrossAWrap) {
    EXPECT_DOUBLE_EQ(gpu::ticksToMilliseconds(1000, 3000, 64, 1.0), 0.002);
    EXPECT_DOUBLE_EQ(gpu::ticksToMilliseconds(1000, 1500, 64, 52.08), 500 * 52.08e-6);
    EXPECT_DOUBLE_EQ(gpu::ticksToMilliseconds((1ull << 36) - 10, 20, 36, 1e6), 30.0);
    EXPECT_DOUBLE_EQ(gpu::ticksToMilliseconds(~0ull - 4, 5, 64, 1e6), 10.0);
    // Bits above the valid ones are undefined and must not count.
    EXPECT_DOUBLE_EQ(gpu::ticksToMilliseconds(0xdead0000000005ull, 0xbeef0000000009ull, 36, 1e6), 4.0);
}

TEST(Timestamps, NeverGoBackwardsAndStayWithinTheHostsTime) {
    Device& device = test::device();
    Device::Impl& gpu = device.impl();
    constexpr std::uint32_t kCount = 33;
    const gpu::TimestampPool pool(gpu, kCount);
    ASSERT_EQ(pool.available(), device.info().has("timestamps"));
    if (!pool.available()) return;
    DeviceBuffer buffer(device, "filled", 8 << 20);
    const auto start = std::chrono::steady_clock::now();
    gpu::Recording commands = gpu.queue.begin("timed");
    pool.reset(*commands);
    for (std::uint32_t i = 0; i < kCount; ++i) {
        pool.write(*commands, i);
        // Each fill writes a part of its own, so that none waits for another.
        commands->fillBuffer(*buffer.impl()->resource.buffer, i * 65536ull, 65536, i);
    }
    gpu.queue.wait(gpu.queue.submit(std::move(commands)));
    const double host =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    const std::vector<double> times = pool.milliseconds(kCount);
    ASSERT_EQ(times.size(), kCount);
    EXPECT_EQ(times.front(), 0.0);
    EXPECT_TRUE(std::ranges::is_sorted(times));
    EXPECT_GT(times.back(), 0.0);
    EXPECT_LE(times.back(), host);
    EXPECT_EQ(pool.milliseconds(1), std::vector<double>{0.0});
}

}  // namespace
}  // namespace helio
