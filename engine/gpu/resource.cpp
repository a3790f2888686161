#include "engine/gpu/resource.hpp"

#include "engine/gpu/device_impl.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace helio::gpu {

namespace {

vk::BufferCreateInfo bufferInfo(std::uint64_t bytes, vk::BufferUsageFlags usage) {
    return {.size = bytes, .usage = usage, .sharingMode = vk::SharingMode::eExclusive};
}

vk::ImageCreateInfo imageInfo(vk::Extent2D extent, vk::Format format, vk::ImageUsageFlags usage) {
    return {.imageType = vk::ImageType::e2D,
            .format = format,
            .extent = {extent.width, extent.height, 1},
            .mipLevels = 1,
            .arrayLayers = 1,
            .samples = vk::SampleCountFlagBits::e1,
            .tiling = vk::ImageTiling::eOptimal,
            .usage = usage,
            .sharingMode = vk::SharingMode::eExclusive,
            .initialLayout = vk::ImageLayout::eUndefined};
}

BufferResource bindBuffer(Device::Impl& gpu, std::string name, std::uint64_t bytes,
                          vk::BufferUsageFlags usage, const Allocation& range, std::uint64_t offset) {
    return translateErrors("creating buffer '" + name + "'", [&] {
        BufferResource resource;
        resource.bytes = bytes;
        resource.buffer = vk::raii::Buffer(gpu.device, bufferInfo(bytes, usage));
        resource.buffer.bindMemory(range.memory(), range.offset() + offset);
        if (range.mapped()) resource.mapped = range.mapped() + offset;
        if (usage & vk::BufferUsageFlagBits::eShaderDeviceAddress) {
            resource.address = gpu.device.getBufferAddress({.buffer = *resource.buffer});
        }
        setName(gpu.device, *resource.buffer, name);
        resource.name = std::move(name);
        return resource;
    });
}

ImageResource bindImage(Device::Impl& gpu, std::string name, vk::Extent2D extent, vk::Format format,
                        vk::ImageUsageFlags usage, const Allocation& range, std::uint64_t offset) {
    return translateErrors("creating image '" + name + "'", [&] {
        ImageResource resource;
        resource.extent = extent;
        resource.format = format;
        resource.image = vk::raii::Image(gpu.device, imageInfo(extent, format, usage));
        resource.image.bindMemory(range.memory(), range.offset() + offset);
        setName(gpu.device, *resource.image, name);
        resource.view = vk::raii::ImageView(
            gpu.device,
            vk::ImageViewCreateInfo{
                .image = *resource.image,
                .viewType = vk::ImageViewType::e2D,
                .format = format,
                .subresourceRange = {
                    .aspectMask = vk::ImageAspectFlagBits::eColor, .levelCount = 1, .layerCount = 1}});
        setName(gpu.device, *resource.view, name);
        resource.name = std::move(name);
        return resource;
    });
}

}  // namespace

vk::Format vulkanFormat(Format format) {
    switch (format) {
        case Format::Undefined:
            return vk::Format::eUndefined;
        case Format::R32UI:
            return vk::Format::eR32Uint;
        case Format::R32I:
            return vk::Format::eR32Sint;
        case Format::R32F:
            return vk::Format::eR32Sfloat;
        case Format::RG32UI:
            return vk::Format::eR32G32Uint;
        case Format::RG32F:
            return vk::Format::eR32G32Sfloat;
        case Format::RGBA32UI:
            return vk::Format::eR32G32B32A32Uint;
        case Format::RGBA32F:
            return vk::Format::eR32G32B32A32Sfloat;
        case Format::RGBA16F:
            return vk::Format::eR16G16B16A16Sfloat;
        case Format::RGBA8:
            return vk::Format::eR8G8B8A8Unorm;
        case Format::R8:
            return vk::Format::eR8Unorm;
    }
    return vk::Format::eUndefined;
}

vk::MemoryRequirements bufferRequirements(const Device::Impl& gpu, const std::string& name,
                                          std::uint64_t bytes, vk::BufferUsageFlags usage) {
    assert(bytes > 0);
    if (bytes > gpu.info.maxBufferSize) {
        throw OutOfDeviceMemory(
            name, bytes,
            fmt::format("a buffer of the device holds at most {} bytes", gpu.info.maxBufferSize));
    }
    const vk::BufferCreateInfo info = bufferInfo(bytes, usage);
    return gpu.device.getBufferMemoryRequirements(vk::DeviceBufferMemoryRequirements{.pCreateInfo = &info})
        .memoryRequirements;
}

vk::MemoryRequirements imageRequirements(const Device::Impl& gpu, const std::string& name,
                                         vk::Extent2D extent, vk::Format format, vk::ImageUsageFlags usage) {
    const vk::ImageCreateInfo info = imageInfo(extent, format, usage);
    vk::ImageFormatProperties limits;
    try {
        limits = gpu.physical.getImageFormatProperties(format, info.imageType, info.tiling, usage);
    } catch (const vk::FormatNotSupportedError&) {
        throw DeviceError(fmt::format("image '{}': the device has no storage images of format {}", name,
                                      vk::to_string(format)));
    }
    if (extent.width == 0 || extent.height == 0 || extent.width > limits.maxExtent.width ||
        extent.height > limits.maxExtent.height) {
        throw DeviceError(fmt::format("image '{}': {}x{} texels asked for; the device has 1x1 to {}x{}", name,
                                      extent.width, extent.height, limits.maxExtent.width,
                                      limits.maxExtent.height));
    }
    return gpu.device.getImageMemoryRequirements(vk::DeviceImageMemoryRequirements{.pCreateInfo = &info})
        .memoryRequirements;
}

BufferResource createBuffer(Device::Impl& gpu, std::string name, std::uint64_t bytes, MemoryUse use,
                            vk::BufferUsageFlags usage) {
    const vk::MemoryRequirements needed = bufferRequirements(gpu, name, bytes, usage);
    Allocation memory = gpu.memory.allocate({.name = name,
                                             .bytes = needed.size,
                                             .alignment = needed.alignment,
                                             .typeBits = needed.memoryTypeBits,
                                             .use = use,
                                             .content = MemoryContent::Buffers});
    BufferResource resource = bindBuffer(gpu, std::move(name), bytes, usage, memory, 0);
    resource.memory = std::move(memory);
    return resource;
}

ImageResource createImage(Device::Impl& gpu, std::string name, vk::Extent2D extent, vk::Format format,
                          vk::ImageUsageFlags usage) {
    const vk::MemoryRequirements needed = imageRequirements(gpu, name, extent, format, usage);
    Allocation memory = gpu.memory.allocate({.name = name,
                                             .bytes = needed.size,
                                             .alignment = needed.alignment,
                                             .typeBits = needed.memoryTypeBits,
                                             .use = MemoryUse::Device,
                                             .content = MemoryContent::Images});
    ImageResource resource = bindImage(gpu, std::move(name), extent, format, usage, memory, 0);
    resource.memory = std::move(memory);
    return resource;
}

BufferResource placeBuffer(Device::Impl& gpu, std::string name, std::uint64_t bytes, const Allocation& range,
                           std::uint64_t offset, vk::BufferUsageFlags usage) {
    return bindBuffer(gpu, std::move(name), bytes, usage, range, offset);
}

ImageResource placeImage(Device::Impl& gpu, std::string name, vk::Extent2D extent, vk::Format format,
                         const Allocation& range, std::uint64_t offset, vk::ImageUsageFlags usage) {
    return bindImage(gpu, std::move(name), extent, format, usage, range, offset);
}

vk::raii::BufferView createTexelView(Device::Impl& gpu, const BufferResource& buffer, vk::Format format,
                                     std::uint64_t offset, std::uint64_t bytes) {
    const std::uint64_t texelBytes = vk::blockSize(format);
    assert(offset <= buffer.bytes);
    if (bytes == VK_WHOLE_SIZE) bytes = (buffer.bytes - offset) / texelBytes * texelBytes;
    if (bytes / texelBytes > gpu.info.maxTexelBufferElements) {
        throw DeviceError(
            fmt::format("buffer '{}': a view of {} texels is asked for; the device has at most {}",
                        buffer.name, bytes / texelBytes, gpu.info.maxTexelBufferElements));
    }
    return translateErrors("viewing buffer '" + buffer.name + "'", [&] {
        vk::raii::BufferView view(
            gpu.device, vk::BufferViewCreateInfo{
                            .buffer = *buffer.buffer, .format = format, .offset = offset, .range = bytes});
        setName(gpu.device, *view, buffer.name);
        return view;
    });
}

}  // namespace helio::gpu
