#include "engine/graph/translate.hpp"

#include <utility>

namespace helio::graph {

vk::PipelineStageFlags2 vulkanStages(Stages stages) {
    using S = vk::PipelineStageFlagBits2;
    // Clears belong to the clear stage, but which stage a buffer fill belongs to differs between versions of
    // the specification and the validation layer: all transfer stages hold both.
    static constexpr std::pair<Stages, S> table[] = {{stage::Compute, S::eComputeShader},
                                                     {stage::Indirect, S::eDrawIndirect},
                                                     {stage::Copy, S::eCopy},
                                                     {stage::Clear, S::eAllTransfer},
                                                     {stage::Host, S::eHost},
                                                     {stage::All, S::eAllCommands}};
    vk::PipelineStageFlags2 flags;
    for (const auto& [ours, theirs] : table)
        if ((stages & ours) != 0) flags |= theirs;
    return flags;
}

vk::AccessFlags2 vulkanAccesses(Accesses accesses) {
    using A = vk::AccessFlagBits2;
    static constexpr std::pair<Accesses, A> table[] = {{access::StorageRead, A::eShaderStorageRead},
                                                       {access::StorageWrite, A::eShaderStorageWrite},
                                                       {access::SampledRead, A::eShaderSampledRead},
                                                       {access::UniformRead, A::eUniformRead},
                                                       {access::IndirectRead, A::eIndirectCommandRead},
                                                       {access::TransferRead, A::eTransferRead},
                                                       {access::TransferWrite, A::eTransferWrite},
                                                       {access::HostRead, A::eHostRead},
                                                       {access::HostWrite, A::eHostWrite},
                                                       {access::AllWrites, A::eMemoryWrite},
                                                       {access::AllReads, A::eMemoryRead}};
    vk::AccessFlags2 flags;
    for (const auto& [ours, theirs] : table)
        if ((accesses & ours) != 0) flags |= theirs;
    return flags;
}

vk::ImageLayout vulkanLayout(Layout layout) {
    switch (layout) {
        case Layout::Undefined:
            return vk::ImageLayout::eUndefined;
        case Layout::General:
            return vk::ImageLayout::eGeneral;
        case Layout::ShaderRead:
            return vk::ImageLayout::eShaderReadOnlyOptimal;
        case Layout::TransferSource:
            return vk::ImageLayout::eTransferSrcOptimal;
        case Layout::TransferDestination:
            return vk::ImageLayout::eTransferDstOptimal;
    }
    return vk::ImageLayout::eUndefined;
}

void recordBarriers(const vk::raii::CommandBuffer& commands, const std::vector<Barrier>& barriers,
                    const std::vector<VulkanResource>& resources) {
    std::vector<vk::MemoryBarrier2> memory;
    std::vector<vk::BufferMemoryBarrier2> buffers;
    std::vector<vk::ImageMemoryBarrier2> images;
    for (const Barrier& barrier : barriers) {
        const vk::PipelineStageFlags2 fromStages = vulkanStages(barrier.fromStages);
        const vk::PipelineStageFlags2 toStages = vulkanStages(barrier.toStages);
        const vk::AccessFlags2 fromAccess = vulkanAccesses(barrier.fromAccess);
        const vk::AccessFlags2 toAccess = vulkanAccesses(barrier.toAccess);
        if (barrier.resource == none) {
            memory.push_back({.srcStageMask = fromStages,
                              .srcAccessMask = fromAccess,
                              .dstStageMask = toStages,
                              .dstAccessMask = toAccess});
        } else if (const vk::Image image = resources[barrier.resource].image) {
            images.push_back(
                {.srcStageMask = fromStages,
                 .srcAccessMask = fromAccess,
                 .dstStageMask = toStages,
                 .dstAccessMask = toAccess,
                 .oldLayout = vulkanLayout(barrier.oldLayout),
                 .newLayout = vulkanLayout(barrier.newLayout),
                 .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                 .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                 .image = image,
                 .subresourceRange = {
                     .aspectMask = vk::ImageAspectFlagBits::eColor, .levelCount = 1, .layerCount = 1}});
        } else {
            buffers.push_back({.srcStageMask = fromStages,
                               .srcAccessMask = fromAccess,
                               .dstStageMask = toStages,
                               .dstAccessMask = toAccess,
                               .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                               .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                               .buffer = resources[barrier.resource].buffer,
                               .size = VK_WHOLE_SIZE});
        }
    }
    if (!memory.empty())
        commands.pipelineBarrier2(
            {.memoryBarrierCount = std::uint32_t(memory.size()), .pMemoryBarriers = memory.data()});
    if (!buffers.empty() || !images.empty())
        commands.pipelineBarrier2({.bufferMemoryBarrierCount = std::uint32_t(buffers.size()),
                                   .pBufferMemoryBarriers = buffers.data(),
                                   .imageMemoryBarrierCount = std::uint32_t(images.size()),
                                   .pImageMemoryBarriers = images.data()});
}

}  // namespace helio::graph
