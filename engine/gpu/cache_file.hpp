#pragma once
/** @file Files that keep caches between processes: whole or not at all, and never trusted. */
#include "engine/gpu/vk.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace helio::gpu {

/** One file name per device and driver build. */
std::string cacheFileName(const vk::PhysicalDeviceProperties& properties);

/** FNV-1a, 64 bits. */
std::uint64_t cacheHash(std::span<const std::byte> data);

/** What writeCacheFile wrote, or nothing where there is no file or it is damaged (length, hash). Never
 * throws. */
std::optional<std::vector<std::byte>> readCacheData(const std::filesystem::path& file);

/** The same for a driver's data; nothing also where another device or driver made it (the header of
 * Vulkan's pipeline cache data, version one). Never throws. */
std::optional<std::vector<std::byte>> readCacheFile(const std::filesystem::path& file,
                                                    const vk::PhysicalDeviceProperties& properties);

/** Writes a temporary beside the file and renames it over, so that readers see the old or the new file,
 * whole. Makes the folder. Returns whether it was written; a failure is logged. */
bool writeCacheFile(const std::filesystem::path& file, std::span<const std::byte> data);

}  // namespace helio::gpu
