// The pipeline cache's file: what is written comes back, what is damaged or foreign does not.
#include "engine/gpu/cache_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <thread>

namespace helio::gpu {
namespace {

namespace fs = std::filesystem;

class CacheFile : public testing::Test {
protected:
    CacheFile() {
        properties.vendorID = 0x10005;
        properties.deviceID = 7;
        for (std::size_t i = 0; i < VK_UUID_SIZE; ++i) properties.pipelineCacheUUID[i] = std::uint8_t(i * 17);
        folder = fs::temp_directory_path() / ("heliograph-cache-" + std::to_string(::getpid()));
        file = folder / "deep" / cacheFileName(properties);
    }
    ~CacheFile() override {
        std::error_code ignored;
        fs::remove_all(folder, ignored);
    }

    /** Driver data: Vulkan's header, then a body. */
    std::vector<std::byte> data(std::size_t bodyBytes, int fill) const {
        VkPipelineCacheHeaderVersionOne header{sizeof header,
                                               VK_PIPELINE_CACHE_HEADER_VERSION_ONE,
                                               properties.vendorID,
                                               properties.deviceID,
                                               {}};
        std::memcpy(header.pipelineCacheUUID, properties.pipelineCacheUUID.data(), VK_UUID_SIZE);
        std::vector<std::byte> bytes(sizeof header + bodyBytes, std::byte(fill));
        std::memcpy(bytes.data(), &header, sizeof header);
        return bytes;
    }
    std::string contents() const {
        std::ifstream in(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    void overwrite(const std::string& text) const { std::ofstream(file, std::ios::binary) << text; }

    vk::PhysicalDeviceProperties properties;
    fs::path folder;
    fs::path file;
};

TEST_F(CacheFile, ComesBackAsWritten) {
    EXPECT_FALSE(readCacheFile(file, properties)) << "there is none yet";
    const auto in = data(100000, 3);
    ASSERT_TRUE(writeCacheFile(file, in));
    EXPECT_EQ(readCacheFile(file, properties), in);
    const auto next = data(5, 4);
    ASSERT_TRUE(writeCacheFile(file, next));
    EXPECT_EQ(readCacheFile(file, properties), next);
    EXPECT_EQ(std::distance(fs::directory_iterator(file.parent_path()), {}), 1) << "a temporary is left";
}

TEST_F(CacheFile, WithAnyByteChangedIsPassedOver) {
    ASSERT_TRUE(writeCacheFile(file, data(64, 9)));
    const std::string good = contents();
    for (std::size_t i = 0; i < good.size(); ++i) {
        std::string bad = good;
        bad[i] = char(bad[i] ^ 0x20);
        overwrite(bad);
        EXPECT_FALSE(readCacheFile(file, properties)) << "byte " << i;
    }
    overwrite(good);
    EXPECT_TRUE(readCacheFile(file, properties));
}

TEST_F(CacheFile, OfAnyOtherLengthIsPassedOver) {
    ASSERT_TRUE(writeCacheFile(file, data(64, 9)));
    const std::string good = contents();
    for (std::size_t length = 0; length < good.size(); ++length) {
        overwrite(good.substr(0, length));
        EXPECT_FALSE(readCacheFile(file, properties)) << "length " << length;
    }
    overwrite(good + "x");
    EXPECT_FALSE(readCacheFile(file, properties));
    overwrite("not a cache at all, but text that is longer than the header");
    EXPECT_FALSE(readCacheFile(file, properties));
}

TEST_F(CacheFile, OfAnotherDeviceOrDriverIsPassedOver) {
    ASSERT_TRUE(writeCacheFile(file, data(64, 9)));
    vk::PhysicalDeviceProperties other = properties;
    other.deviceID = 8;
    EXPECT_FALSE(readCacheFile(file, other));
    EXPECT_NE(cacheFileName(other), cacheFileName(properties));
    other = properties;
    other.vendorID = 1;
    EXPECT_FALSE(readCacheFile(file, other));
    other = properties;
    other.pipelineCacheUUID[15] ^= 1;
    EXPECT_FALSE(readCacheFile(file, other));
    EXPECT_NE(cacheFileName(other), cacheFileName(properties));
}

TEST_F(CacheFile, ThatCannotBeWrittenIsNoError) {
    std::ofstream(folder.string()) << "a file where the folder should be";
    EXPECT_FALSE(writeCacheFile(file, data(64, 9)));
    EXPECT_FALSE(readCacheFile(file, properties));
}

TEST_F(CacheFile, IsWholeUnderConcurrentWritersAndReaders) {
    ASSERT_TRUE(writeCacheFile(file, data(50000, 0)));
    std::vector<std::thread> threads;
    for (int writer = 1; writer <= 3; ++writer) {
        threads.emplace_back([this, writer] {
            for (int i = 0; i < 40; ++i)
                writeCacheFile(file, data(20000 + std::size_t(writer) * 10000, writer));
        });
    }
    int torn = 0;
    for (int i = 0; i < 200; ++i) {
        const auto read = readCacheFile(file, properties);
        if (!read ||
            !std::all_of(read->begin() + 32, read->end(), [&](std::byte b) { return b == read->back(); })) {
            ++torn;
        }
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(torn, 0);
    EXPECT_EQ(std::distance(fs::directory_iterator(file.parent_path()), {}), 1) << "a temporary is left";
}

}  // namespace
}  // namespace helio::gpu
