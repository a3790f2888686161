// The bookkeeping of memory blocks against an oracle that marks every byte, and the choice of memory types.
#include "engine/gpu/range_allocator.hpp"

#include "engine/gpu/memory.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace helio::gpu {
namespace {

TEST(RangeAllocator, TakesTheSmallestFreeRangeThatFits) {
    RangeAllocator ranges(1000);
    EXPECT_EQ(ranges.allocate(100, 1), 0u);
    EXPECT_EQ(ranges.allocate(50, 1), 100u);
    EXPECT_EQ(ranges.allocate(10, 1), 150u);
    ranges.free(0, 100);
    ranges.free(150, 10);  // Merges with the rest behind it.
    EXPECT_EQ(ranges.largestFree(), 850u);
    EXPECT_EQ(ranges.allocate(60, 1), 0u);
    EXPECT_EQ(ranges.freeBytes(), 890u);
}

TEST(RangeAllocator, RefusesWhatDoesNotFit) {
    RangeAllocator ranges(100);
    EXPECT_FALSE(ranges.allocate(101, 1));
    EXPECT_EQ(ranges.allocate(1, 1), 0u);
    EXPECT_FALSE(ranges.allocate(50, 64)) << "64 + 50 is beyond the end";
    EXPECT_EQ(ranges.allocate(36, 64), 64u);
    EXPECT_FALSE(ranges.allocate(64, 1)) << "63 bytes are left in one piece";
    EXPECT_EQ(ranges.allocate(63, 1), 1u);
    EXPECT_EQ(ranges.freeBytes(), 0u);
    EXPECT_FALSE(ranges.allocate(1, 1));
    EXPECT_FALSE(RangeAllocator(0).allocate(1, 1));
}

TEST(RangeAllocator, SurvivesHugeNumbers) {
    RangeAllocator ranges(~0ull);
    EXPECT_EQ(ranges.allocate(~0ull - 1, 1), 0u);
    EXPECT_FALSE(ranges.allocate(~0ull, 1));
    EXPECT_FALSE(ranges.allocate(2, 1ull << 63));
    EXPECT_EQ(ranges.freeBytes(), 1u);
}

TEST(RangeAllocator, NeverOverlapsAndMergesBackToOneRange) {
    std::mt19937 generator(1);
    for (int trial = 0; trial < 20; ++trial) {
        const std::uint64_t size = 500 + generator() % 4000;
        RangeAllocator ranges(size);
        std::vector<char> taken(size, 0);  // the oracle: one mark per byte
        struct Live {
            std::uint64_t offset, bytes;
        };
        std::vector<Live> live;
        for (int step = 0; step < 3000; ++step) {
            if (live.empty() || generator() % 5 < 3) {
                const std::uint64_t bytes = 1 + generator() % 200;
                const std::uint64_t alignment = 1ull << generator() % 8;
                const auto offset = ranges.allocate(bytes, alignment);
                // Exists by the oracle: some aligned run of free bytes.
                bool fits = false;
                for (std::uint64_t at = 0; !fits && at + bytes <= size; at += alignment) {
                    fits = std::find(taken.begin() + long(at), taken.begin() + long(at + bytes), 1) ==
                           taken.begin() + long(at + bytes);
                }
                ASSERT_EQ(offset.has_value(), fits) << "trial " << trial << " step " << step;
                if (!offset) continue;
                ASSERT_EQ(*offset % alignment, 0u);
                ASSERT_LE(*offset + bytes, size);
                for (std::uint64_t i = *offset; i < *offset + bytes; ++i) {
                    ASSERT_EQ(taken[i], 0) << "byte " << i << " is handed out twice";
                    taken[i] = 1;
                }
                live.push_back({*offset, bytes});
            } else {
                std::swap(live[generator() % live.size()], live.back());
                const Live gone = live.back();
                live.pop_back();
                ranges.free(gone.offset, gone.bytes);
                std::fill_n(taken.begin() + long(gone.offset), gone.bytes, 0);
            }
            ASSERT_EQ(ranges.freeBytes(), std::uint64_t(std::ranges::count(taken, 0)));
        }
        for (const Live& each : live) ranges.free(each.offset, each.bytes);
        EXPECT_TRUE(ranges.empty());
        EXPECT_EQ(ranges.largestFree(), size) << "free neighbours are not merged";
    }
}

vk::PhysicalDeviceMemoryProperties memoryTypes(std::initializer_list<vk::MemoryPropertyFlags> types) {
    vk::PhysicalDeviceMemoryProperties properties;
    for (const vk::MemoryPropertyFlags flags : types) {
        properties.memoryTypes[properties.memoryTypeCount++] = vk::MemoryType{.propertyFlags = flags};
    }
    return properties;
}
constexpr auto kLocal = vk::MemoryPropertyFlagBits::eDeviceLocal;
constexpr auto kHost = vk::MemoryPropertyFlagBits::eHostVisible | vk::MemoryPropertyFlagBits::eHostCoherent;
constexpr auto kCached = vk::MemoryPropertyFlagBits::eHostCached;

TEST(MemoryType, OfADiscreteDevice) {
    // The types of a typical graphics card, with a window of device memory that the host can write.
    const auto types = memoryTypes({kHost, kLocal | kHost, kLocal, kHost | kCached});
    EXPECT_EQ(chooseMemoryType(types, ~0u, MemoryUse::Device, false), 2u);
    EXPECT_EQ(chooseMemoryType(types, ~0u, MemoryUse::Upload, false), 0u);
    EXPECT_EQ(chooseMemoryType(types, ~0u, MemoryUse::Readback, false), 3u);
    EXPECT_EQ(chooseMemoryType(types, 0b0010, MemoryUse::Device, false), 1u) << "only allowed types";
    EXPECT_EQ(chooseMemoryType(types, 0b0100, MemoryUse::Readback, false), std::nullopt)
        << "the host cannot read it";
}

TEST(MemoryType, OfADeviceThatSharesTheHostsMemory) {
    const auto cpu = memoryTypes({kLocal | kHost | kCached});
    for (const MemoryUse use : {MemoryUse::Device, MemoryUse::Upload, MemoryUse::Readback}) {
        EXPECT_EQ(chooseMemoryType(cpu, ~0u, use, true), 0u);
    }
    const auto integrated = memoryTypes({kLocal, kLocal | kHost, kLocal | kHost | kCached});
    EXPECT_EQ(chooseMemoryType(integrated, ~0u, MemoryUse::Device, true), 2u);
}

TEST(MemoryType, NeedingAFeatureIsPassedOver) {
    const auto types = memoryTypes({kLocal | vk::MemoryPropertyFlagBits::eProtected,
                                    kLocal | vk::MemoryPropertyFlagBits::eLazilyAllocated, kHost});
    EXPECT_EQ(chooseMemoryType(types, ~0u, MemoryUse::Device, false), 2u);
    EXPECT_EQ(chooseMemoryType(types, 0b011, MemoryUse::Device, false), std::nullopt);
}

}  // namespace
}  // namespace helio::gpu
