#include "engine/core/log.hpp"
#include "engine/gpu/device_impl.hpp"

#include <heliograph/device.hpp>
#include <heliograph/vulkan.hpp>

#include <algorithm>
#include <cassert>
#include <cstdlib>

namespace helio {

namespace {

using gpu::DeviceFacts;
using gpu::translateErrors;

/** A logical device with everything that the engine can use of what is there. */
vk::raii::Device createDevice(const vk::raii::PhysicalDevice& physical, const DeviceFacts& facts,
                              std::uint32_t family) {
    const auto& f = facts.features;
    const auto& f11 = facts.features11;
    const auto& f12 = facts.features12;
    const auto& f13 = facts.features13;
    vk::PhysicalDeviceShaderAtomicFloatFeaturesEXT atomicFloat{
        .shaderBufferFloat32Atomics = facts.atomicFloat.shaderBufferFloat32Atomics,
        .shaderBufferFloat32AtomicAdd = facts.atomicFloat.shaderBufferFloat32AtomicAdd};
    vk::PhysicalDeviceVulkan13Features features13{.subgroupSizeControl = f13.subgroupSizeControl,
                                                  .computeFullSubgroups = f13.computeFullSubgroups,
                                                  .synchronization2 = f13.synchronization2,
                                                  .dynamicRendering = f13.dynamicRendering,
                                                  .maintenance4 = f13.maintenance4};
    vk::PhysicalDeviceVulkan12Features features12{
        .pNext = &features13,
        .storageBuffer8BitAccess = f12.storageBuffer8BitAccess,
        .shaderBufferInt64Atomics = f12.shaderBufferInt64Atomics,
        .shaderInt8 = f12.shaderInt8,
        .shaderSampledImageArrayNonUniformIndexing = f12.shaderSampledImageArrayNonUniformIndexing,
        .descriptorBindingPartiallyBound = f12.descriptorBindingPartiallyBound,
        .runtimeDescriptorArray = f12.runtimeDescriptorArray,
        .scalarBlockLayout = f12.scalarBlockLayout,
        .shaderSubgroupExtendedTypes = f12.shaderSubgroupExtendedTypes,
        .timelineSemaphore = f12.timelineSemaphore,
        .bufferDeviceAddress = f12.bufferDeviceAddress};
    vk::PhysicalDeviceVulkan11Features features11{.pNext = &features12,
                                                  .storageBuffer16BitAccess = f11.storageBuffer16BitAccess};
    const vk::PhysicalDeviceFeatures2 features{
        .pNext = &features11,
        .features = {.geometryShader = f.geometryShader,
                     .pipelineStatisticsQuery = f.pipelineStatisticsQuery,
                     .shaderStorageImageExtendedFormats = f.shaderStorageImageExtendedFormats,
                     .shaderStorageImageWriteWithoutFormat = f.shaderStorageImageWriteWithoutFormat,
                     .shaderFloat64 = f.shaderFloat64,
                     .shaderInt64 = f.shaderInt64,
                     .shaderInt16 = f.shaderInt16}};
    std::vector<const char*> extensions;
    if (facts.hasExtension(VK_EXT_SHADER_ATOMIC_FLOAT_EXTENSION_NAME)) {
        extensions.push_back(VK_EXT_SHADER_ATOMIC_FLOAT_EXTENSION_NAME);
        features13.pNext = &atomicFloat;
    }
    if (facts.hasExtension(VK_EXT_MEMORY_BUDGET_EXTENSION_NAME)) {
        extensions.push_back(VK_EXT_MEMORY_BUDGET_EXTENSION_NAME);
    }
    const float priority = 1;
    const vk::DeviceQueueCreateInfo queue{
        .queueFamilyIndex = family, .queueCount = 1, .pQueuePriorities = &priority};
    return vk::raii::Device(physical,
                            vk::DeviceCreateInfo{.pNext = &features,
                                                 .queueCreateInfoCount = 1,
                                                 .pQueueCreateInfos = &queue,
                                                 .enabledExtensionCount = std::uint32_t(extensions.size()),
                                                 .ppEnabledExtensionNames = extensions.data()});
}

std::vector<vk::raii::PhysicalDevice> physicalDevices(const vk::raii::Instance& instance) {
    try {
        return instance.enumeratePhysicalDevices();
    } catch (const vk::InitializationFailedError&) {
        return {};  // What the loader answers when drivers are installed and none finds a device.
    }
}

Device::Impl::Opened openDevice(const DeviceOptions& options) {
    std::string request = options.device.empty() ? "auto" : options.device;
    std::string source = "device";
    if (const char* variable = std::getenv("HELIOGRAPH_DEVICE"); request == "auto" && variable && *variable) {
        request = variable;
        source = "HELIOGRAPH_DEVICE";
    }
    Device::Impl::Opened opened{gpu::Instance(options.validation), nullptr, {}, {}, 0, nullptr};
    return translateErrors("opening the device", [&] {
        std::vector<vk::raii::PhysicalDevice> physical = physicalDevices(opened.instance.handle());
        std::vector<DeviceFacts> facts;
        std::vector<DeviceInfo> infos;
        for (const vk::raii::PhysicalDevice& each : physical) {
            facts.push_back(gpu::queryDevice(each));
            infos.push_back(gpu::describeDevice(facts.back()));
            if (!infos.back().usable) {
                log().warn("device {} '{}' is refused: {}", infos.size() - 1, infos.back().name,
                           infos.back().refusal);
            }
        }
        const std::size_t chosen = gpu::chooseDevice(infos, request, source);
        opened.physical = std::move(physical[chosen]);
        opened.facts = std::move(facts[chosen]);
        opened.info = std::move(infos[chosen]);
        opened.family = opened.facts.computeFamily().value();
        opened.device = createDevice(opened.physical, opened.facts, opened.family);
        log().debug("device '{}' is open", opened.info.name);
        return std::move(opened);
    });
}

/** Whether device memory is the host's, so that the host may read and write it in place. */
bool unifiedMemory(const DeviceFacts& facts) {
    return facts.properties.deviceType == vk::PhysicalDeviceType::eCpu ||
           facts.properties.deviceType == vk::PhysicalDeviceType::eIntegratedGpu;
}

}  // namespace

bool DeviceInfo::has(std::string_view capability) const {
    const auto found = std::ranges::find(capabilities, capability, &Capability::name);
    assert(found != capabilities.end() && "not a capability that the engine lists");
    return found != capabilities.end() && found->present;
}

std::vector<DeviceInfo> listDevices() {
    const gpu::Instance instance(false);
    return translateErrors("listing devices", [&] {
        std::vector<DeviceInfo> infos;
        for (const vk::raii::PhysicalDevice& physical : physicalDevices(instance.handle())) {
            infos.push_back(gpu::describeDevice(gpu::queryDevice(physical)));
        }
        return infos;
    });
}

Device::Impl::Impl(const DeviceOptions& options)
    : opened(openDevice(options)),
      memory(physical, device, unifiedMemory(facts), facts.hasExtension(VK_EXT_MEMORY_BUDGET_EXTENSION_NAME)),
      pipelines(device, facts.properties,
                options.pipelineCache.empty() ? gpu::defaultPipelineCacheFolder() : options.pipelineCache),
      queue(device, opened.family),
      staging(*this) {
    gpu::setName(device, *device, info.name);
}

Device::Impl::~Impl() {
    try {
        queue.waitIdle();
    } catch (const Error& error) {
        log().warn("closing the device: {}", error.what());
    }
}

Device::Device(const DeviceOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Device::~Device() = default;
Device::Device(Device&&) noexcept = default;
Device& Device::operator=(Device&&) noexcept = default;

const DeviceInfo& Device::info() const {
    return impl_->info;
}
MemoryStatistics Device::memory() const {
    return impl_->memory.statistics();
}
std::vector<std::string> Device::validationMessages() const {
    return impl_->instance.messages();
}
void Device::waitIdle() const {
    impl_->queue.waitIdle();
}

VulkanHandles vulkanHandles(const Device& device) {
    const Device::Impl& impl = device.impl();
    return {.instance = static_cast<VkInstance>(*impl.instance.handle()),
            .physicalDevice = static_cast<VkPhysicalDevice>(*impl.physical),
            .device = static_cast<VkDevice>(*impl.device),
            .queue = static_cast<VkQueue>(impl.queue.handle()),
            .queueFamily = impl.queue.family()};
}

VkBuffer vulkanBuffer(const DeviceBuffer& buffer) {
    return static_cast<VkBuffer>(*buffer.impl()->resource.buffer);
}
VkImage vulkanImage(const DeviceImage& image) {
    return static_cast<VkImage>(*image.impl()->resource.image);
}

}  // namespace helio
