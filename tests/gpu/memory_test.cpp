// Device memory: disjoint ranges, statistics, and typed failure.
#include "engine/gpu/device_impl.hpp"
#include "tests/support/device.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <random>

namespace helio {
namespace {

using gpu::Allocation;
using gpu::MemoryContent;
using gpu::MemoryUse;

TEST(Memory, RangesAreAlignedDisjointAndCountedUnderRandomUse) {
    Device device(test::deviceOptions());
    gpu::Memory& memory = device.impl().memory;
    const MemoryStatistics before = memory.statistics();
    EXPECT_EQ(before.allocations, 0u);
    EXPECT_EQ(before.usedBytes, 0u);

    struct Range {
        std::uint64_t end;
        MemoryContent content;
    };
    std::map<std::pair<VkDeviceMemory, std::uint64_t>, Range> oracle;  // (memory, begin) -> end
    struct Live {
        Allocation allocation;
        std::uint64_t bytes;
        std::uint8_t mark;
    };
    std::vector<Live> live;
    std::mt19937 generator(2);
    std::uint64_t used = 0, peak = 0;
    for (int step = 0; step < 6000; ++step) {
        if (live.size() < 20 || generator() % 2 == 0) {
            // Mostly small, some above half a block, which get driver memory of their own.
            std::uint64_t bytes = 1 + generator() % 100000;
            if (generator() % 50 == 0) bytes = (1ull << 20) + generator() % (20u << 20);
            const std::uint64_t alignment = 1ull << generator() % 13;
            const auto content = MemoryContent(generator() % 3);
            Allocation range = memory.allocate({.name = "stress",
                                                .bytes = bytes,
                                                .alignment = alignment,
                                                .use = MemoryUse(generator() % 3),
                                                .content = content});
            ASSERT_EQ(range.offset() % alignment, 0u);
            ASSERT_GE(range.bytes(), bytes);
            if (content == MemoryContent::Mixed) {
                ASSERT_EQ(range.offset() % memory.bufferImageGranularity(), 0u);
                ASSERT_EQ(range.bytes() % memory.bufferImageGranularity(), 0u);
            }
            const auto key = std::pair(static_cast<VkDeviceMemory>(range.memory()), range.offset());
            const auto [it, inserted] = oracle.emplace(key, Range{range.offset() + range.bytes(), content});
            ASSERT_TRUE(inserted);
            if (it != oracle.begin() && std::prev(it)->first.first == key.first) {
                ASSERT_LE(std::prev(it)->second.end, key.second) << "overlaps the range before";
                ASSERT_EQ(std::prev(it)->second.content, content) << "buffers and images share a block";
            }
            if (std::next(it) != oracle.end() && std::next(it)->first.first == key.first) {
                ASSERT_GE(std::next(it)->first.second, it->second.end) << "overlaps the range behind";
                ASSERT_EQ(std::next(it)->second.content, content) << "buffers and images share a block";
            }
            used += range.bytes();
            peak = std::max(peak, used);
            const auto mark = std::uint8_t(generator());
            if (range.mapped()) {
                std::memset(range.mapped(), mark, std::min<std::uint64_t>(bytes, 64));
                range.mapped()[bytes - 1] = std::byte(mark);
            }
            live.push_back({std::move(range), bytes, mark});
        } else {
            std::swap(live[generator() % live.size()], live.back());
            const Live& gone = live.back();
            if (gone.allocation.mapped()) {
                ASSERT_EQ(gone.allocation.mapped()[0], std::byte(gone.mark)) << "someone else wrote here";
                ASSERT_EQ(gone.allocation.mapped()[gone.bytes - 1], std::byte(gone.mark));
            }
            oracle.erase({static_cast<VkDeviceMemory>(gone.allocation.memory()), gone.allocation.offset()});
            used -= gone.allocation.bytes();
            live.pop_back();
        }
        const MemoryStatistics now = memory.statistics();
        ASSERT_EQ(now.usedBytes, used);
        ASSERT_EQ(now.peakUsedBytes, peak);
        ASSERT_EQ(now.allocations, live.size());
        ASSERT_GE(now.reservedBytes, now.usedBytes);
    }
    EXPECT_LT(memory.statistics().blocks, live.size() / 4 + 40) << "small ranges share blocks";
    live.clear();
    EXPECT_EQ(memory.statistics().usedBytes, 0u);
    EXPECT_EQ(memory.statistics().allocations, 0u);
    EXPECT_EQ(memory.statistics().peakUsedBytes, peak);
    memory.trim();
    EXPECT_EQ(memory.statistics().reservedBytes, 0u);
    EXPECT_EQ(memory.statistics().blocks, 0u);
}

TEST(Memory, StatisticsReturnToZeroWithTheResources) {
    Device device(test::deviceOptions());
    {
        std::vector<DeviceBuffer> buffers;
        for (int i = 1; i <= 50; ++i) {
            buffers.push_back(makeBuffer(device, "b", std::vector<int>(std::size_t(i) * 1000, i)));
        }
        const DeviceImage image(device, "i", 640, 480, Format::RGBA32F);
        EXPECT_EQ(device.memory().allocations, 51u);
        EXPECT_GE(device.memory().usedBytes, 50u * 51 / 2 * 4000 + 640 * 480 * 16);
        EXPECT_LE(device.memory().blocks, 2u) << "one block of buffers, one of images";
    }
    device.waitIdle();
    EXPECT_EQ(device.memory().allocations, 0u);
    EXPECT_EQ(device.memory().usedBytes, 0u);
}

/** What the exception says; empty where none came. */
OutOfDeviceMemory failureOf(const std::function<void()>& body) {
    try {
        body();
    } catch (const OutOfDeviceMemory& error) {
        return error;
    }
    return OutOfDeviceMemory("", 0, "nothing was thrown");
}

TEST(OutOfDeviceMemory, NamesTheResourceAndItsSizeForAbsurdBuffers) {
    Device& device = test::device();
    const MemoryStatistics before = device.memory();
    for (const std::uint64_t bytes :
         {std::uint64_t(1) << 62, std::uint64_t(1) << 40, device.info().maxBufferSize + 1}) {
        const OutOfDeviceMemory error = failureOf([&] { DeviceBuffer(device, "galaxy", bytes); });
        EXPECT_EQ(error.resource, "galaxy");
        EXPECT_EQ(error.bytes, bytes);
    }
    EXPECT_EQ(device.memory().usedBytes, before.usedBytes);
    EXPECT_EQ(device.memory().allocations, before.allocations);
}

TEST(OutOfDeviceMemory, ComesBeforeTheDriversLimitOfOneAllocationIsBroken) {
    Device& device = test::device();
    const std::uint64_t limit = device.impl().facts.properties11.maxMemoryAllocationSize;
    const OutOfDeviceMemory error =
        failureOf([&] { device.impl().memory.allocate({.name = "range", .bytes = limit + 1}); });
    EXPECT_EQ(error.resource, "range");
    EXPECT_EQ(error.bytes, limit + 1);
}

TEST(OutOfDeviceMemory, WhenALimitIsReachedAndWorkGoesOnAfterwards) {
    Device device(test::deviceOptions());
    device.impl().memory.setLimit(40ull << 20);
    const DeviceBuffer small(device, "small", 1 << 20);  // takes a block of 16 MiB
    const OutOfDeviceMemory error = failureOf([&] { DeviceBuffer(device, "film", 30ull << 20); });
    EXPECT_EQ(error.resource, "film");
    EXPECT_NE(
        std::string(error.what()).find("the limit of 40.0 MiB is reached; 16.0 MiB in 1 blocks are taken"),
        std::string::npos)
        << error.what();
    std::vector<DeviceBuffer> more;
    for (int i = 0; i < 15; ++i) more.emplace_back(device, "more", 1 << 20);
    EXPECT_EQ(device.memory().blocks, 1u) << "what is there is still handed out";
}

TEST(OutOfDeviceMemory, WhenTheDriverRefuses) {
    // A CPU driver takes host memory: with the process's address space limited, it is the driver that fails.
    Device device(test::deviceOptions());
    if (device.info().type != "cpu") return;  // Others have limits of their own, not reached this way.
    std::uint64_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const rlim_t now = pages * std::uint64_t(sysconf(_SC_PAGESIZE));
    rlimit old{};
    ASSERT_EQ(getrlimit(RLIMIT_AS, &old), 0);
    const rlimit tight{now + (256ull << 20), old.rlim_max};
    ASSERT_EQ(setrlimit(RLIMIT_AS, &tight), 0);
    const OutOfDeviceMemory error = failureOf([&] { DeviceBuffer(device, "terrain", 1ull << 30); });
    ASSERT_EQ(setrlimit(RLIMIT_AS, &old), 0);
    EXPECT_EQ(error.resource, "terrain");
    EXPECT_EQ(error.bytes, 1ull << 30);
    EXPECT_NE(std::string(error.what()).find("the driver refuses"), std::string::npos) << error.what();
    EXPECT_EQ(device.memory().allocations, 0u);
    DeviceBuffer after = makeBuffer(device, "after", std::vector<int>(1000, 4));
    std::vector<int> out(1000);
    after.download(out.data(), 4000);
    EXPECT_EQ(out, std::vector<int>(1000, 4));
}

TEST(DeviceImage, BeyondTheDevicesSizeIsRefusedByName) {
    try {
        DeviceImage(test::device(), "poster", 1u << 20, 4, Format::RGBA32F);
        FAIL() << "an image of a million texels across was made";
    } catch (const DeviceError& error) {
        EXPECT_NE(std::string(error.what()).find("image 'poster': 1048576x4 texels asked for"),
                  std::string::npos)
            << error.what();
    }
    EXPECT_THROW(DeviceImage(test::device(), "none", 0, 4, Format::RGBA32F), DeviceError);
}

}  // namespace
}  // namespace helio
