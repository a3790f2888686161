#pragma once
/** @file One dispatch over the device room's own interface, for tests below the graph. */
#include "engine/gpu/device_impl.hpp"

#include <heliograph/kernel.hpp>

#include <cstdint>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

namespace helio::test {

struct RawDispatch {
    std::string name;
    std::string glsl;
    std::vector<std::pair<gpu::BindingSlot, gpu::DescriptorWrite>> bindings = {};
    std::vector<std::uint32_t> push = {};
    std::vector<std::pair<std::uint32_t, SpecValue>> spec = {};
    std::uint32_t groups = 1;
};

/** Compiles, binds, submits; returns the timeline value. */
inline std::uint64_t submitDispatch(Device& device, const RawDispatch& what) {
    Device::Impl& gpu = device.impl();
    gpu::ComputePipelineInfo info{.name = what.name,
                                  .spirv = compileKernel(what.name, what.glsl).spirv,
                                  .pushConstantBytes = std::uint32_t(what.push.size() * 4),
                                  .spec = what.spec};
    std::vector<gpu::DescriptorWrite> writes;
    for (const auto& [slot, write] : what.bindings) {
        info.bindings.push_back(slot);
        writes.push_back(write);
        writes.back().binding = slot.binding;
    }
    const auto pipeline = gpu.pipelines.get(info);
    gpu::DescriptorSet set(gpu, *pipeline, writes);
    gpu::Recording commands = gpu.queue.begin(what.name);
    commands->bindPipeline(vk::PipelineBindPoint::eCompute, *pipeline->pipeline);
    if (set.handle()) {
        commands->bindDescriptorSets(vk::PipelineBindPoint::eCompute, *pipeline->layout, 0, {set.handle()},
                                     {});
    }
    if (!what.push.empty()) {
        commands->pushConstants<std::uint32_t>(*pipeline->layout, vk::ShaderStageFlagBits::eCompute, 0,
                                               what.push);
    }
    commands->dispatch(what.groups, 1, 1);
    const std::uint64_t value = gpu.queue.submit(std::move(commands));
    gpu.queue.retire(std::move(set));
    return value;
}

}  // namespace helio::test
