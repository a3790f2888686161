#include "engine/graph/host_access.hpp"

#include "engine/graph/compile.hpp"
#include "engine/graph/translate.hpp"

#include <utility>

namespace helio {
namespace graph {
namespace {

void waitForHost(gpu::Queue& queue, std::optional<gpu::Recording> work) {
    if (!work && queue.hostMayAccess()) return;
    gpu::Recording recording = work ? std::move(*work) : queue.begin("to the host");
    recordBarriers(*recording, {hostDependency()}, {});
    queue.wait(queue.submit(std::move(recording), true));
}

}  // namespace

void download(Device::Impl& gpu, const gpu::BufferResource& buffer, void* data, std::uint64_t bytes,
              std::uint64_t offset) {
    gpu.staging.download(buffer, data, bytes, offset, [&gpu](std::optional<gpu::Recording> work) {
        gpu::translateErrors("waiting for the device", [&] { waitForHost(gpu.queue, std::move(work)); });
    });
}

}  // namespace graph

void DeviceBuffer::download(void* data, std::uint64_t bytes, std::uint64_t offset) const {
    graph::download(*impl_->device, impl_->resource, data, bytes, offset);
}

DeviceImage::DeviceImage(Device& device, std::string name, std::uint32_t width, std::uint32_t height,
                         Format format) {
    Device::Impl& impl = device.impl();
    gpu::ImageResource resource =
        gpu::createImage(impl, std::move(name), {width, height}, gpu::vulkanFormat(format));
    gpu::translateErrors("clearing image '" + resource.name + "'", [&] {
        // The memory may have been another resource's a submission ago: the source scope takes up the wait
        // for it.
        const graph::Barrier toGeneral{.resource = 0,
                                       .fromStages = graph::stage::All,
                                       .fromAccess = graph::access::AllWrites,
                                       .toStages = graph::stage::Clear,
                                       .toAccess = graph::access::TransferWrite,
                                       .oldLayout = graph::Layout::Undefined,
                                       .newLayout = graph::Layout::General,
                                       .cause = graph::Cause::FirstUse};
        const vk::ImageSubresourceRange whole{
            .aspectMask = vk::ImageAspectFlagBits::eColor, .levelCount = 1, .layerCount = 1};
        gpu::Recording commands = impl.queue.begin("clear image");
        graph::recordBarriers(*commands, {toGeneral}, {{.image = *resource.image}});
        commands->clearColorImage(*resource.image, vk::ImageLayout::eGeneral, vk::ClearColorValue{}, whole);
        impl.queue.submit(std::move(commands));
    });
    impl_.reset(new Impl{&impl, std::move(resource), format});
}

}  // namespace helio
