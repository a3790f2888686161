#include "engine/gpu/kept_data.hpp"

#include "engine/gpu/cache_file.hpp"
#include "engine/gpu/device_impl.hpp"

#include <fmt/format.h>

namespace helio::gpu {
namespace {

std::filesystem::path fileFor(const Device& device, std::string_view name,
                              const std::filesystem::path& folder) {
    const std::filesystem::path place = folder.empty() ? defaultPipelineCacheFolder() : folder;
    if (place.empty()) return place;
    return place / fmt::format("{}-{}", name, cacheFileName(device.impl().facts.properties));
}

}  // namespace

std::optional<std::vector<std::byte>> keptData(const Device& device, std::string_view name,
                                               const std::filesystem::path& folder) {
    const std::filesystem::path file = fileFor(device, name, folder);
    return file.empty() ? std::nullopt : readCacheData(file);
}

bool keepData(const Device& device, std::string_view name, std::span<const std::byte> data,
              const std::filesystem::path& folder) {
    const std::filesystem::path file = fileFor(device, name, folder);
    return !file.empty() && writeCacheFile(file, data);
}

}  // namespace helio::gpu
