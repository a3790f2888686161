#pragma once
/** @file Small findings about a device that later processes need not make again, in the folder of the
 * pipeline cache: a file per finding, device and driver build. */
#include <heliograph/device.hpp>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace helio::gpu {

/** What keepData() wrote under the name, or nothing where there is no file or it is damaged. An empty folder
 * is the default one. Never throws. */
std::optional<std::vector<std::byte>> keptData(const Device& device, std::string_view name,
                                               const std::filesystem::path& folder = {});
/** Returns whether it was written; a failure is logged. */
bool keepData(const Device& device, std::string_view name, std::span<const std::byte> data,
              const std::filesystem::path& folder = {});

}  // namespace helio::gpu
