#include "tests/bench/raster/images.hpp"

#include <utility>
#include <vector>

namespace helio::bench {

BenchImage makeImage(Device::Impl& gpu, const std::string& name, vk::Format format, vk::Extent2D extent,
                     std::uint32_t levels, vk::ImageUsageFlags usage) {
    BenchImage result;
    result.image =
        vk::raii::Image(gpu.device, vk::ImageCreateInfo{.imageType = vk::ImageType::e2D,
                                                        .format = format,
                                                        .extent = {extent.width, extent.height, 1},
                                                        .mipLevels = levels,
                                                        .arrayLayers = 1,
                                                        .samples = vk::SampleCountFlagBits::e1,
                                                        .tiling = vk::ImageTiling::eOptimal,
                                                        .usage = usage,
                                                        .initialLayout = vk::ImageLayout::eUndefined});
    const vk::MemoryRequirements needed = result.image.getMemoryRequirements();
    result.memory = gpu.memory.allocate({.name = name,
                                         .bytes = needed.size,
                                         .alignment = needed.alignment,
                                         .typeBits = needed.memoryTypeBits,
                                         .use = gpu::MemoryUse::Device,
                                         .content = gpu::MemoryContent::Images});
    result.image.bindMemory(result.memory.memory(), result.memory.offset());
    const bool isDepth = bool(usage & vk::ImageUsageFlagBits::eDepthStencilAttachment);
    result.view = vk::raii::ImageView(
        gpu.device,
        vk::ImageViewCreateInfo{.image = *result.image,
                                .viewType = vk::ImageViewType::e2D,
                                .format = format,
                                .subresourceRange = {.aspectMask = isDepth ? vk::ImageAspectFlagBits::eDepth
                                                                           : vk::ImageAspectFlagBits::eColor,
                                                     .levelCount = 1,
                                                     .layerCount = 1}});
    return result;
}

void barrier(const vk::raii::CommandBuffer& commands, std::initializer_list<vk::Image> images, bool keep) {
    const vk::MemoryBarrier2 memory{
        .srcStageMask = vk::PipelineStageFlagBits2::eAllCommands,
        .srcAccessMask = vk::AccessFlagBits2::eMemoryRead | vk::AccessFlagBits2::eMemoryWrite,
        .dstStageMask = vk::PipelineStageFlagBits2::eAllCommands,
        .dstAccessMask = vk::AccessFlagBits2::eMemoryRead | vk::AccessFlagBits2::eMemoryWrite};
    std::vector<vk::ImageMemoryBarrier2> layouts;
    for (const vk::Image image : images) {
        layouts.push_back({.srcStageMask = memory.srcStageMask,
                           .srcAccessMask = memory.srcAccessMask,
                           .dstStageMask = memory.dstStageMask,
                           .dstAccessMask = memory.dstAccessMask,
                           .oldLayout = keep ? vk::ImageLayout::eGeneral : vk::ImageLayout::eUndefined,
                           .newLayout = vk::ImageLayout::eGeneral,
                           .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                           .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                           .image = image,
                           .subresourceRange = {.aspectMask = vk::ImageAspectFlagBits::eColor,
                                                .levelCount = VK_REMAINING_MIP_LEVELS,
                                                .layerCount = 1}});
    }
    commands.pipelineBarrier2({.memoryBarrierCount = 1,
                               .pMemoryBarriers = &memory,
                               .imageMemoryBarrierCount = std::uint32_t(layouts.size()),
                               .pImageMemoryBarriers = layouts.data()});
}

void finish(Device::Impl& gpu, gpu::Recording recording) {
    gpu.queue.wait(gpu.queue.submit(std::move(recording)));
}

}  // namespace helio::bench
