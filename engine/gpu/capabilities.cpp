#include "engine/gpu/capabilities.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace helio::gpu {

namespace {

/** One row of the capability table. */
struct Rule {
    const char* name;
    bool required;
    const char* whenMissing;
    bool (*present)(const DeviceFacts&);
    std::string (*value)(const DeviceFacts&) = nullptr;
};

constexpr const char* kRefused = "the device is refused";

std::string versionText(std::uint32_t version) {
    return fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version),
                       VK_API_VERSION_PATCH(version));
}

bool subgroups(const DeviceFacts& f, vk::SubgroupFeatureFlags operations) {
    return (f.properties11.subgroupSupportedStages & vk::ShaderStageFlagBits::eCompute) &&
           (f.properties11.subgroupSupportedOperations & operations) == operations;
}

std::uint32_t timestampBits(const DeviceFacts& f) {
    const auto family = f.computeFamily();
    return family ? f.queues[*family].timestampValidBits : 0;
}

using F = const DeviceFacts&;
using Subgroup = vk::SubgroupFeatureFlagBits;

// Names are Vulkan's. A limit is "present" where it reaches what the engine needs at least.
const Rule kRules[] = {
    {"apiVersion", true, "the device is refused: Vulkan 1.3 is needed",
     [](F f) { return f.properties.apiVersion >= VK_API_VERSION_1_3; },
     [](F f) { return versionText(f.properties.apiVersion); }},
    {"computeQueue", true, kRefused, [](F f) { return f.computeFamily().has_value(); }},
    {"synchronization2", true, kRefused, [](F f) { return f.features13.synchronization2 == VK_TRUE; }},
    {"timelineSemaphore", true, kRefused, [](F f) { return f.features12.timelineSemaphore == VK_TRUE; }},
    {"bufferDeviceAddress", true, kRefused, [](F f) { return f.features12.bufferDeviceAddress == VK_TRUE; }},
    {"maintenance4", true, kRefused, [](F f) { return f.features13.maintenance4 == VK_TRUE; }},

    {"dynamicRendering", false, "the comparison with Vulkan's graphics pipeline",
     [](F f) { return f.features13.dynamicRendering == VK_TRUE; }},
    {"graphicsQueue", false, "the comparison with Vulkan's graphics pipeline",
     [](F f) {
         const auto family = f.computeFamily();
         return family && bool(f.queues[*family].queueFlags & vk::QueueFlagBits::eGraphics);
     }},
    {"geometryShader", false, "triangle ids from Vulkan's graphics pipeline",
     [](F f) { return f.features.geometryShader == VK_TRUE; }},
    {"pipelineStatisticsQuery", false, "counts of shader invocations",
     [](F f) { return f.features.pipelineStatisticsQuery == VK_TRUE; }},
    {"timestamps", false, "times of passes on the device", [](F f) { return timestampBits(f) > 0; },
     [](F f) {
         return fmt::format("{} bits of {} ns", timestampBits(f), f.properties.limits.timestampPeriod);
     }},
    {"shaderInt64", false, "64-bit integers in kernels: fixed-point splats, the one-pass visibility buffer",
     [](F f) { return f.features.shaderInt64 == VK_TRUE; }},
    {"shaderBufferInt64Atomics", false, "64-bit atomics: fixed-point splats, the one-pass visibility buffer",
     [](F f) { return f.features12.shaderBufferInt64Atomics == VK_TRUE; }},
    {"shaderFloat64", false, "kernels in double precision",
     [](F f) { return f.features.shaderFloat64 == VK_TRUE; }},
    {"shaderBufferFloat32AtomicAdd", false, "float atomics; fixed-point ones are used",
     [](F f) { return f.atomicFloat.shaderBufferFloat32AtomicAdd == VK_TRUE; }},
    {"scalarBlockLayout", false, "tightly packed structures in buffers",
     [](F f) { return f.features12.scalarBlockLayout == VK_TRUE; }},
    {"storageBuffer8BitAccess", false, "byte arrays in storage buffers; words are unpacked",
     [](F f) { return f.features12.storageBuffer8BitAccess == VK_TRUE; }},
    {"storageBuffer16BitAccess", false, "16-bit arrays in storage buffers; words are unpacked",
     [](F f) { return f.features11.storageBuffer16BitAccess == VK_TRUE; }},
    {"shaderStorageImageExtendedFormats", false, "storage images of the formats RG32F, RG32UI and R8",
     [](F f) { return f.features.shaderStorageImageExtendedFormats == VK_TRUE; }},
    {"shaderStorageImageWriteWithoutFormat", false, "one kernel for storage images of any format",
     [](F f) { return f.features.shaderStorageImageWriteWithoutFormat == VK_TRUE; }},
    {"subgroupBasic", false, "subgroup kernels; shared memory is used",
     [](F f) { return subgroups(f, Subgroup::eBasic); },
     [](F f) { return fmt::format("{} invocations", f.properties11.subgroupSize); }},
    {"subgroupArithmetic", false, "subgroup reductions and scans; shared memory is used",
     [](F f) { return subgroups(f, Subgroup::eArithmetic); }},
    {"subgroupBallot", false, "subgroup compaction; shared memory is used",
     [](F f) { return subgroups(f, Subgroup::eBallot); }},
    {"subgroupShuffle", false, "exchange within subgroups; shared memory is used",
     [](F f) { return subgroups(f, Subgroup::eShuffle); }},
    {"subgroupSizeControl", false, "choice of the subgroup size",
     [](F f) { return f.features13.subgroupSizeControl == VK_TRUE; },
     [](F f) {
         return fmt::format("{} to {}", f.properties13.minSubgroupSize, f.properties13.maxSubgroupSize);
     }},
    {"descriptorIndexing", false, "arrays of textures indexed freely; atlases in texel buffers are used",
     [](F f) {
         return f.features12.runtimeDescriptorArray == VK_TRUE &&
                f.features12.shaderSampledImageArrayNonUniformIndexing == VK_TRUE &&
                f.features12.descriptorBindingPartiallyBound == VK_TRUE;
     }},
    {"rayQuery", false, "nothing: the engine's own traversal is used on every device",
     [](F f) { return f.rayQuery.rayQuery == VK_TRUE; }},
    {"memoryBudget", false, "the driver's budget in messages about exhausted memory",
     [](F f) { return f.hasExtension(VK_EXT_MEMORY_BUDGET_EXTENSION_NAME); }},

    {"maxPushConstantsSize", true, kRefused,
     [](F f) { return f.properties.limits.maxPushConstantsSize >= 128; },
     [](F f) { return fmt::format("{} bytes", f.properties.limits.maxPushConstantsSize); }},
    {"maxStorageBufferRange", true, kRefused,
     [](F f) { return f.properties.limits.maxStorageBufferRange >= (1u << 27); },
     [](F f) { return fmt::format("{} bytes", f.properties.limits.maxStorageBufferRange); }},
    {"maxTexelBufferElements", true, kRefused,
     [](F f) { return f.properties.limits.maxTexelBufferElements >= 65536; },
     [](F f) { return fmt::format("{} texels", f.properties.limits.maxTexelBufferElements); }},
    {"maxBufferSize", true, kRefused, [](F f) { return f.properties13.maxBufferSize >= (1ull << 30); },
     [](F f) { return fmt::format("{} bytes", f.properties13.maxBufferSize); }},
    {"maxComputeWorkGroupInvocations", true, kRefused,
     [](F f) { return f.properties.limits.maxComputeWorkGroupInvocations >= 128; },
     [](F f) { return fmt::format("{}", f.properties.limits.maxComputeWorkGroupInvocations); }},
    {"maxComputeSharedMemorySize", true, kRefused,
     [](F f) { return f.properties.limits.maxComputeSharedMemorySize >= 16384; },
     [](F f) { return fmt::format("{} bytes", f.properties.limits.maxComputeSharedMemorySize); }},
};

const char* typeName(vk::PhysicalDeviceType type) {
    switch (type) {
        case vk::PhysicalDeviceType::eCpu:
            return "cpu";
        case vk::PhysicalDeviceType::eDiscreteGpu:
            return "discrete";
        case vk::PhysicalDeviceType::eIntegratedGpu:
            return "integrated";
        case vk::PhysicalDeviceType::eVirtualGpu:
            return "virtual";
        default:
            return "other";
    }
}

}  // namespace

bool DeviceFacts::hasExtension(std::string_view name) const {
    return std::ranges::find(extensions, name) != extensions.end();
}

std::optional<std::uint32_t> DeviceFacts::computeFamily() const {
    using Flag = vk::QueueFlagBits;
    std::optional<std::uint32_t> compute;
    for (std::uint32_t i = 0; i < queues.size(); ++i) {
        const vk::QueueFlags flags = queues[i].queueFlags;
        if (!(flags & Flag::eCompute) || queues[i].queueCount == 0) continue;
        if (flags & Flag::eGraphics) return i;
        if (!compute) compute = i;
    }
    return compute;
}

DeviceFacts queryDevice(const vk::raii::PhysicalDevice& physical) {
    DeviceFacts facts;
    facts.properties = physical.getProperties();
    facts.memory = physical.getMemoryProperties();
    facts.queues = physical.getQueueFamilyProperties();
    for (const vk::ExtensionProperties& extension : physical.enumerateDeviceExtensionProperties()) {
        facts.extensions.emplace_back(extension.extensionName.data());
    }
    if (facts.properties.apiVersion < VK_API_VERSION_1_3) {
        facts.features = physical.getFeatures();
        return facts;
    }
    const auto properties =
        physical.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceVulkan11Properties,
                                vk::PhysicalDeviceVulkan12Properties, vk::PhysicalDeviceVulkan13Properties>();
    facts.properties11 = properties.get<vk::PhysicalDeviceVulkan11Properties>();
    facts.properties12 = properties.get<vk::PhysicalDeviceVulkan12Properties>();
    facts.properties13 = properties.get<vk::PhysicalDeviceVulkan13Properties>();

    vk::PhysicalDeviceFeatures2 features{.pNext = &facts.features11};
    facts.features11.pNext = &facts.features12;
    facts.features12.pNext = &facts.features13;
    void** tail = &facts.features13.pNext;
    if (facts.hasExtension(VK_EXT_SHADER_ATOMIC_FLOAT_EXTENSION_NAME)) {
        *tail = &facts.atomicFloat;
        tail = &facts.atomicFloat.pNext;
    }
    if (facts.hasExtension(VK_KHR_RAY_QUERY_EXTENSION_NAME)) *tail = &facts.rayQuery;
    (*physical).getFeatures2(&features, *physical.getDispatcher());
    facts.features = features.features;
    // The structures are copied about from here on: no pointers between them.
    facts.properties11.pNext = facts.properties12.pNext = facts.properties13.pNext = nullptr;
    facts.features11.pNext = facts.features12.pNext = facts.features13.pNext = nullptr;
    facts.atomicFloat.pNext = facts.rayQuery.pNext = nullptr;
    return facts;
}

DeviceInfo describeDevice(const DeviceFacts& facts) {
    const vk::PhysicalDeviceLimits& limits = facts.properties.limits;
    DeviceInfo info;
    info.name = facts.properties.deviceName.data();
    info.type = typeName(facts.properties.deviceType);
    info.driver = facts.properties12.driverName.data();
    info.driverVersion = facts.properties12.driverInfo.data();
    if (info.driverVersion.empty()) info.driverVersion = versionText(facts.properties.driverVersion);
    info.apiVersion = versionText(facts.properties.apiVersion);
    info.vendorId = facts.properties.vendorID;
    info.deviceId = facts.properties.deviceID;
    info.subgroupSize = facts.properties11.subgroupSize;
    info.maxStorageBufferRange = limits.maxStorageBufferRange;
    info.maxTexelBufferElements = limits.maxTexelBufferElements;
    info.maxBufferSize = facts.properties13.maxBufferSize;
    info.maxWorkgroupInvocations = limits.maxComputeWorkGroupInvocations;
    info.maxSharedMemoryBytes = limits.maxComputeSharedMemorySize;
    for (std::uint32_t i = 0; i < facts.memory.memoryHeapCount; ++i) {
        const vk::MemoryHeap& heap = facts.memory.memoryHeaps[i];
        if (heap.flags & vk::MemoryHeapFlagBits::eDeviceLocal)
            info.memoryBytes = std::max(info.memoryBytes, heap.size);
    }

    // Below Vulkan 1.3 nothing else was asked, so the version is the one reason to give.
    const bool oldVersion = facts.properties.apiVersion < VK_API_VERSION_1_3;
    for (const Rule& rule : kRules) {
        Capability capability{.name = rule.name,
                              .present = rule.present(facts),
                              .required = rule.required,
                              .value = rule.value ? rule.value(facts) : "",
                              .whenMissing = rule.whenMissing};
        if (capability.required && !capability.present && (!oldVersion || info.refusal.empty())) {
            if (!info.refusal.empty()) info.refusal += ", ";
            info.refusal += capability.name;
            info.refusal += capability.value.empty() ? " is missing" : " is only " + capability.value;
            if (oldVersion) info.refusal += " and 1.3 is needed";
        }
        info.capabilities.push_back(std::move(capability));
    }
    info.usable = info.refusal.empty();
    return info;
}

std::size_t chooseDevice(const std::vector<DeviceInfo>& devices, const std::string& request,
                         const std::string& source) {
    const auto rank = [&](const DeviceInfo& device) {
        static constexpr const char* kOrder[] = {"discrete", "integrated", "virtual", "cpu"};
        return std::ranges::find(kOrder, device.type) - std::begin(kOrder);
    };
    std::string listing;
    for (std::size_t i = 0; i < devices.size(); ++i) {
        listing += fmt::format("{} {} '{}' ({})", i == 0 ? "" : ";", i, devices[i].name,
                               devices[i].usable ? "usable" : "refused: " + devices[i].refusal);
    }
    if (devices.empty()) {
        throw DeviceError(
            "no Vulkan device: the loader lists none (Debian: mesa-vulkan-drivers has one that runs on the "
            "CPU)");
    }

    std::vector<std::size_t> candidates;
    const bool automatic = request.empty() || request == "auto";
    if (automatic) {
        for (std::size_t i = 0; i < devices.size(); ++i) candidates.push_back(i);
    } else if (std::ranges::all_of(request, [](char c) { return c >= '0' && c <= '9'; })) {
        if (request.size() < 6 && std::stoul(request) < devices.size())
            candidates.push_back(std::stoul(request));
    } else {
        const auto lower = [](std::string text) {
            std::ranges::transform(text, text.begin(),
                                   [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
            return text;
        };
        for (std::size_t i = 0; i < devices.size(); ++i) {
            if (lower(devices[i].name).find(lower(request)) != std::string::npos) candidates.push_back(i);
        }
    }

    const std::size_t* best = nullptr;
    for (const std::size_t& i : candidates) {
        if (devices[i].usable && (!best || rank(devices[i]) < rank(devices[*best]))) best = &i;
    }
    if (best) return *best;
    if (automatic) throw DeviceError("no usable Vulkan device; the loader lists:" + listing);
    throw DeviceError(fmt::format("{} '{}' names {}; the loader lists:{}", source, request,
                                  candidates.empty() ? "no device" : "no usable device", listing));
}

}  // namespace helio::gpu
