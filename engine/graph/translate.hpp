#pragma once
/** @file The compiler's stages, accesses, layouts and barriers in Vulkan's terms, one to one. */
#include "engine/gpu/vk.hpp"
#include "engine/graph/types.hpp"

#include <functional>
#include <vector>

namespace helio::graph {

vk::PipelineStageFlags2 vulkanStages(Stages stages);
vk::AccessFlags2 vulkanAccesses(Accesses accesses);
vk::ImageLayout vulkanLayout(Layout layout);

/** A resource as barriers name it: one of the two is set. */
struct VulkanResource {
    vk::Buffer buffer = {};
    vk::Image image = {};
};

/** Records the barriers: memory barriers in one command, then those of resources in a second one. */
void recordBarriers(const vk::raii::CommandBuffer& commands, const std::vector<Barrier>& barriers,
                    const std::vector<VulkanResource>& resources);

}  // namespace helio::graph
