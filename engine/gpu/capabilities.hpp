#pragma once
/** @file What a physical device offers, asked once, and what the engine makes of it. */
#include "engine/gpu/vk.hpp"

#include <heliograph/device.hpp>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace helio::gpu {

/** Everything the engine asks a physical device. Plain data, so that judging it is testable without a device.
 */
struct DeviceFacts {
    vk::PhysicalDeviceProperties properties;
    vk::PhysicalDeviceVulkan11Properties properties11;
    vk::PhysicalDeviceVulkan12Properties properties12;
    vk::PhysicalDeviceVulkan13Properties properties13;
    vk::PhysicalDeviceFeatures features;
    vk::PhysicalDeviceVulkan11Features features11;
    vk::PhysicalDeviceVulkan12Features features12;
    vk::PhysicalDeviceVulkan13Features features13;
    vk::PhysicalDeviceShaderAtomicFloatFeaturesEXT atomicFloat;
    vk::PhysicalDeviceRayQueryFeaturesKHR rayQuery;
    vk::PhysicalDeviceMemoryProperties memory;
    std::vector<vk::QueueFamilyProperties> queues;
    std::vector<std::string> extensions;

    bool hasExtension(std::string_view name) const;
    /** The queue family to use: the first with compute and graphics, else the first with compute. */
    std::optional<std::uint32_t> computeFamily() const;
};

/** Asks the device. What a device below Vulkan 1.3 has is left at "absent". */
DeviceFacts queryDevice(const vk::raii::PhysicalDevice& physical);

/** The capability table and the verdict. Pure. */
DeviceInfo describeDevice(const DeviceFacts& facts);

/** Index of the device to open. `request` as DeviceOptions::device; `source` names where it came from
 * ("--device", "HELIOGRAPH_DEVICE") for messages. Throws DeviceError that lists every device with its
 * refusal. Pure. */
std::size_t chooseDevice(const std::vector<DeviceInfo>& devices, const std::string& request,
                         const std::string& source);

}  // namespace helio::gpu
