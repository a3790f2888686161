#pragma once
/** @file
 * Native handles, for applications that use Vulkan themselves. The only public header that needs Vulkan's.
 * The handles stay the engine's: never destroy one, and use none after its Device, buffer or image is gone.
 */
#include <heliograph/device.hpp>

#include <vulkan/vulkan_core.h>

#include <cstdint>

namespace helio {

/** The handles of an open device. An application that submits to the queue itself must not do so while
 * another thread uses the Device, and orders its work against the engine's by Device::waitIdle(). */
struct VulkanHandles {
    VkInstance instance;
    VkPhysicalDevice physicalDevice;
    VkDevice device;
    VkQueue queue;
    std::uint32_t queueFamily;
};
VulkanHandles vulkanHandles(const Device& device);

VkBuffer vulkanBuffer(const DeviceBuffer& buffer);
/** In layout VK_IMAGE_LAYOUT_GENERAL whenever the queue is idle; leave it so. */
VkImage vulkanImage(const DeviceImage& image);

}  // namespace helio
