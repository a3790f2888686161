#include "engine/gpu/cache_file.hpp"

#include "engine/core/log.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>

namespace helio::gpu {

namespace {

/** Precedes the driver's data: its own header says nothing about length or damage. */
struct FileHeader {
    std::array<char, 8> magic = {'H', 'E', 'L', 'I', 'O', 'P', 'C', '1'};
    std::uint64_t bytes = 0;
    std::uint64_t hash = 0;
};

bool belongsTo(std::span<const std::byte> data, const vk::PhysicalDeviceProperties& properties) {
    VkPipelineCacheHeaderVersionOne header;
    if (data.size() < sizeof header) return false;
    std::memcpy(&header, data.data(), sizeof header);
    return header.headerSize >= sizeof header &&
           header.headerVersion == VK_PIPELINE_CACHE_HEADER_VERSION_ONE &&
           header.vendorID == properties.vendorID && header.deviceID == properties.deviceID &&
           std::memcmp(header.pipelineCacheUUID, properties.pipelineCacheUUID.data(), VK_UUID_SIZE) == 0;
}

bool writeAll(int descriptor, const void* data, std::size_t bytes) {
    const auto* at = static_cast<const char*>(data);
    while (bytes > 0) {
        const ssize_t written = ::write(descriptor, at, bytes);
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return false;
        at += written;
        bytes -= std::size_t(written);
    }
    return true;
}

}  // namespace

std::string cacheFileName(const vk::PhysicalDeviceProperties& properties) {
    std::string name = fmt::format("pipelines-{:04x}-{:04x}-", properties.vendorID, properties.deviceID);
    for (const std::uint8_t byte : properties.pipelineCacheUUID) name += fmt::format("{:02x}", byte);
    return name + ".bin";
}

std::uint64_t cacheHash(std::span<const std::byte> data) {
    std::uint64_t hash = 0xcbf29ce484222325ull;
    for (const std::byte byte : data) hash = (hash ^ std::uint64_t(byte)) * 0x100000001b3ull;
    return hash;
}

std::optional<std::vector<std::byte>> readCacheData(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary | std::ios::ate);
    if (!in) return std::nullopt;
    // Of the open file: by its name another one may have taken its place.
    const auto size = std::uint64_t(in.tellg());
    in.seekg(0);
    const auto ignore = [&](const char* why) -> std::optional<std::vector<std::byte>> {
        log().info("cache file '{}' is passed over: {}", file.string(), why);
        return std::nullopt;
    };
    FileHeader header;
    const FileHeader expected;
    if (!in.read(reinterpret_cast<char*>(&header), sizeof header)) return ignore("it is too short");
    if (header.magic != expected.magic) return ignore("it is not one of the engine's");
    // Compared before anything is allocated: a damaged length must not ask for terabytes.
    if (header.bytes != size - sizeof header) return ignore("its length is wrong");
    std::vector<std::byte> data(header.bytes);
    if (!in.read(reinterpret_cast<char*>(data.data()), std::streamsize(data.size())))
        return ignore("it is too short");
    if (cacheHash(data) != header.hash) return ignore("it is damaged");
    return data;
}

std::optional<std::vector<std::byte>> readCacheFile(const std::filesystem::path& file,
                                                    const vk::PhysicalDeviceProperties& properties) {
    auto data = readCacheData(file);
    if (data && !belongsTo(*data, properties)) {
        log().info("pipeline cache '{}' is passed over: another device or driver wrote it", file.string());
        return std::nullopt;
    }
    return data;
}

bool writeCacheFile(const std::filesystem::path& file, std::span<const std::byte> data) {
    static std::atomic<unsigned> serial{0};
    const std::filesystem::path temporary = file.string() + fmt::format(".{}.{}.tmp", ::getpid(), serial++);
    std::error_code error;
    std::filesystem::create_directories(file.parent_path(), error);
    const int descriptor = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
    if (descriptor < 0) {
        log().info("cache file '{}' cannot be written: {}", file.string(), std::strerror(errno));
        return false;
    }
    const FileHeader header{.bytes = data.size(), .hash = cacheHash(data)};
    const bool written =
        writeAll(descriptor, &header, sizeof header) && writeAll(descriptor, data.data(), data.size());
    ::close(descriptor);
    if (written) std::filesystem::rename(temporary, file, error);
    if (!written || error) {
        log().info("cache file '{}' cannot be written", file.string());
        std::filesystem::remove(temporary, error);
        return false;
    }
    return true;
}

}  // namespace helio::gpu
