#pragma once
/** @file
 * What the rooms above build on: `Device::Impl`, reached by `device.impl()`. Include this one header.
 *
 *   Device::Impl& gpu = device.impl();
 *   gpu.device, gpu.physical, gpu.facts     the vk::raii device; DeviceFacts of capabilities.hpp (limits,
 * features) gpu.queue                               queue.hpp: recording and submission Recording r =
 * gpu.queue.begin("name");  r->dispatch(...);  std::uint64_t value = gpu.queue.submit(std::move(r));
 *       gpu.queue.wait(value), done(value), submitted();  gpu.queue.retire(object): destroyed when all so far
 * is done. Submissions run strictly in order, and each sees all writes of the one before (semaphore):
 * barriers are needed only inside one Recording, and for the host (engine/graph/host_access.hpp).
 *   gpu.memory                              memory.hpp: allocate(MemoryRequest) -> Allocation (RAII),
 * statistics() resource.hpp bufferRequirements(gpu, bytes, usage), imageRequirements(gpu, width, height,
 * format)   without creating any BufferResource b = createBuffer(gpu, "name", bytes[, use, usage]);      own
 * memory; b.mapped where possible BufferResource b = placeBuffer(gpu, "name", bytes, allocation, offset); in
 * memory shared with others ImageResource  i = createImage / placeImage(...);                       layout
 * UNDEFINED, view included vk::raii::BufferView v = createTexelView(gpu, b, vk::Format, offset, bytes); For
 * aliasing: allocate one MemoryContent::Mixed range as large as the plan needs, with the AND of the
 *       resources' typeBits, place all at offsets that are multiples of each one's alignment and, between a
 * buffer and an image, of gpu.memory.bufferImageGranularity(). pipeline.hpp std::shared_ptr<const
 * ComputePipeline> p = gpu.pipelines.get(ComputePipelineInfo{...});   cached in process and on disk;
 * p->layout, p->pipeline, p->setLayouts DescriptorSet s(gpu, *p, {write...}); a set 0, written once
 *   timestamps.hpp
 *       TimestampPool t(gpu, count);  t.reset(r); t.write(r, i); after wait: t.milliseconds() relative to the
 * first gpu.staging                             staging.hpp: upload/download to and from any BufferResource
 *   DeviceBuffer::Impl / DeviceImage::Impl  { Device::Impl* device; BufferResource / ImageResource resource;
 * } An imported image is in layout GENERAL between submissions, always. setName(gpu.device, handle, "name")
 * names.hpp; free without validation translateErrors("doing x", lambda)      vk.hpp: Vulkan exceptions to
 * DeviceError
 */
#include "engine/gpu/capabilities.hpp"
#include "engine/gpu/instance.hpp"
#include "engine/gpu/memory.hpp"
#include "engine/gpu/names.hpp"
#include "engine/gpu/pipeline.hpp"
#include "engine/gpu/queue.hpp"
#include "engine/gpu/resource.hpp"
#include "engine/gpu/staging.hpp"
#include "engine/gpu/timestamps.hpp"
#include "engine/gpu/vk.hpp"

#include <heliograph/device.hpp>

namespace helio {

/** Members are destroyed from the last to the first. */
struct Device::Impl {
    explicit Impl(const DeviceOptions& options);
    ~Impl();
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    /** The chosen device, before anything is made on it. */
    struct Opened {
        gpu::Instance instance;
        vk::raii::PhysicalDevice physical = nullptr;
        gpu::DeviceFacts facts;
        DeviceInfo info;
        std::uint32_t family = 0;
        vk::raii::Device device = nullptr;
    };

    Opened opened;
    gpu::Instance& instance = opened.instance;
    const vk::raii::PhysicalDevice& physical = opened.physical;
    const gpu::DeviceFacts& facts = opened.facts;
    const DeviceInfo& info = opened.info;
    const vk::raii::Device& device = opened.device;
    gpu::Memory memory;
    gpu::PipelineCache pipelines;
    gpu::Queue queue;
    gpu::Staging staging;

    const vk::PhysicalDeviceLimits& limits() const { return facts.properties.limits; }
};

struct DeviceBuffer::Impl {
    ~Impl();
    Device::Impl* device;
    gpu::BufferResource resource;
};

struct DeviceImage::Impl {
    ~Impl();
    Device::Impl* device;
    gpu::ImageResource resource;
    Format format;
};

}  // namespace helio
