#pragma once
/** @file Buffers and images bound to device memory. */
#include "engine/gpu/memory.hpp"
#include "engine/gpu/vk.hpp"

#include <heliograph/device.hpp>

#include <cstdint>
#include <string>

namespace helio::gpu {

/** Every use the engine has for a buffer. */
inline constexpr vk::BufferUsageFlags kBufferUsage =
    vk::BufferUsageFlagBits::eStorageBuffer | vk::BufferUsageFlagBits::eUniformBuffer |
    vk::BufferUsageFlagBits::eUniformTexelBuffer | vk::BufferUsageFlagBits::eStorageTexelBuffer |
    vk::BufferUsageFlagBits::eIndirectBuffer | vk::BufferUsageFlagBits::eTransferSrc |
    vk::BufferUsageFlagBits::eTransferDst | vk::BufferUsageFlagBits::eShaderDeviceAddress;
inline constexpr vk::ImageUsageFlags kImageUsage =
    vk::ImageUsageFlagBits::eStorage | vk::ImageUsageFlagBits::eSampled |
    vk::ImageUsageFlagBits::eTransferSrc | vk::ImageUsageFlagBits::eTransferDst;

/** A buffer. Move-only. */
struct BufferResource {
    std::string name;
    std::uint64_t bytes = 0;
    Allocation memory;            ///< empty where placed in memory that others own
    std::byte* mapped = nullptr;  ///< host address, or null
    vk::raii::Buffer buffer = nullptr;
    vk::DeviceAddress address = 0;
};

/** A 2D image of one level with a view of all of it. Move-only. */
struct ImageResource {
    std::string name;
    vk::Extent2D extent;
    vk::Format format = vk::Format::eUndefined;
    Allocation memory;
    vk::raii::Image image = nullptr;
    vk::raii::ImageView view = nullptr;
};

vk::Format vulkanFormat(Format format);

/** What a resource of this size would need. Throws OutOfDeviceMemory that names it where no buffer of the
 * device can be so large. */
vk::MemoryRequirements bufferRequirements(const Device::Impl& gpu, const std::string& name,
                                          std::uint64_t bytes, vk::BufferUsageFlags usage = kBufferUsage);
/** Throws DeviceError that names it where the device has no such image. */
vk::MemoryRequirements imageRequirements(const Device::Impl& gpu, const std::string& name,
                                         vk::Extent2D extent, vk::Format format,
                                         vk::ImageUsageFlags usage = kImageUsage);

/** A buffer or image with memory of its own. Contents are undefined. Throws OutOfDeviceMemory. */
BufferResource createBuffer(Device::Impl& gpu, std::string name, std::uint64_t bytes,
                            MemoryUse use = MemoryUse::Device, vk::BufferUsageFlags usage = kBufferUsage);
ImageResource createImage(Device::Impl& gpu, std::string name, vk::Extent2D extent, vk::Format format,
                          vk::ImageUsageFlags usage = kImageUsage);

/** The same at `offset` of a range that outlives it and that others may use at other times. The offset must
 * be a multiple of the requirements' alignment. */
BufferResource placeBuffer(Device::Impl& gpu, std::string name, std::uint64_t bytes, const Allocation& range,
                           std::uint64_t offset, vk::BufferUsageFlags usage = kBufferUsage);
ImageResource placeImage(Device::Impl& gpu, std::string name, vk::Extent2D extent, vk::Format format,
                         const Allocation& range, std::uint64_t offset,
                         vk::ImageUsageFlags usage = kImageUsage);

/** A texel view of [offset, offset + bytes) of a buffer; VK_WHOLE_SIZE takes the rest in whole texels. Throws
 * DeviceError where the device's maxTexelBufferElements is less. */
vk::raii::BufferView createTexelView(Device::Impl& gpu, const BufferResource& buffer, vk::Format format,
                                     std::uint64_t offset = 0, std::uint64_t bytes = VK_WHOLE_SIZE);

}  // namespace helio::gpu
