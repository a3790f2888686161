// A Vulkan layer that makes devices look poorer than they are, so that refusals and fallbacks can be tested
// end to end on a machine whose only device has everything. HELIOGRAPH_TEST_LACKS names what to hide,
// separated by commas: "vulkan13" (reports 1.2.0), "timelineSemaphore", "synchronization2", "shaderInt64",
// "shaderBufferInt64Atomics", "shaderFloat64", "smallStorageRange" (64 KiB).
#include <vulkan/vk_layer.h>
#include <vulkan/vulkan_core.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <string>
#include <type_traits>

namespace {

// One instance at a time is all that the tests open.
PFN_vkGetInstanceProcAddr nextInstanceProc = nullptr;
PFN_vkGetPhysicalDeviceProperties nextProperties = nullptr;
PFN_vkGetPhysicalDeviceProperties2 nextProperties2 = nullptr;
PFN_vkGetPhysicalDeviceFeatures2 nextFeatures2 = nullptr;

bool lacks(const char* what) {
    const char* list = std::getenv("HELIOGRAPH_TEST_LACKS");
    return list && ("," + std::string(list) + ",").find("," + std::string(what) + ",") != std::string::npos;
}

void spoil(VkPhysicalDeviceProperties& properties) {
    if (lacks("vulkan13")) properties.apiVersion = VK_API_VERSION_1_2;
    if (lacks("smallStorageRange")) properties.limits.maxStorageBufferRange = 65536;
}

VKAPI_ATTR void VKAPI_CALL getProperties(VkPhysicalDevice device, VkPhysicalDeviceProperties* properties) {
    nextProperties(device, properties);
    spoil(*properties);
}

VKAPI_ATTR void VKAPI_CALL getProperties2(VkPhysicalDevice device, VkPhysicalDeviceProperties2* properties) {
    nextProperties2(device, properties);
    spoil(properties->properties);
}

VKAPI_ATTR void VKAPI_CALL getFeatures2(VkPhysicalDevice device, VkPhysicalDeviceFeatures2* features) {
    nextFeatures2(device, features);
    if (lacks("shaderInt64")) features->features.shaderInt64 = VK_FALSE;
    if (lacks("shaderFloat64")) features->features.shaderFloat64 = VK_FALSE;
    for (auto* each = static_cast<VkBaseOutStructure*>(features->pNext); each; each = each->pNext) {
        if (each->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES) {
            auto& features12 = reinterpret_cast<VkPhysicalDeviceVulkan12Features&>(*each);
            if (lacks("timelineSemaphore")) features12.timelineSemaphore = VK_FALSE;
            if (lacks("shaderBufferInt64Atomics")) features12.shaderBufferInt64Atomics = VK_FALSE;
        }
        if (each->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES) {
            auto& features13 = reinterpret_cast<VkPhysicalDeviceVulkan13Features&>(*each);
            if (lacks("synchronization2")) features13.synchronization2 = VK_FALSE;
        }
    }
}

VKAPI_ATTR VkResult VKAPI_CALL createInstance(const VkInstanceCreateInfo* info,
                                              const VkAllocationCallbacks* allocator, VkInstance* instance) {
    // The loader hands each layer the next one in the chain through the create info.
    for (auto* each = static_cast<const VkBaseInStructure*>(info->pNext); each; each = each->pNext) {
        if (each->sType != VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO) continue;
        auto* link =
            const_cast<VkLayerInstanceCreateInfo*>(reinterpret_cast<const VkLayerInstanceCreateInfo*>(each));
        if (link->function != VK_LAYER_LINK_INFO) continue;
        nextInstanceProc = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
        link->u.pLayerInfo = link->u.pLayerInfo->pNext;
        const auto create =
            reinterpret_cast<PFN_vkCreateInstance>(nextInstanceProc(VK_NULL_HANDLE, "vkCreateInstance"));
        const VkResult result = create(info, allocator, instance);
        if (result != VK_SUCCESS) return result;
        // Asked for now: once the chain is complete, the same question leads back to this layer.
        const auto resolve = [&](auto& function, const char* name) {
            function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(
                nextInstanceProc(*instance, name));
        };
        resolve(nextProperties, "vkGetPhysicalDeviceProperties");
        resolve(nextProperties2, "vkGetPhysicalDeviceProperties2");
        resolve(nextFeatures2, "vkGetPhysicalDeviceFeatures2");
        return result;
    }
    return VK_ERROR_INITIALIZATION_FAILED;
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getInstanceProc(VkInstance instance, const char* name) {
    const std::string wanted = name;
    if (wanted == "vkGetInstanceProcAddr") return reinterpret_cast<PFN_vkVoidFunction>(getInstanceProc);
    if (wanted == "vkCreateInstance") return reinterpret_cast<PFN_vkVoidFunction>(createInstance);
    if (wanted == "vkGetPhysicalDeviceProperties") return reinterpret_cast<PFN_vkVoidFunction>(getProperties);
    if (wanted == "vkGetPhysicalDeviceProperties2")
        return reinterpret_cast<PFN_vkVoidFunction>(getProperties2);
    if (wanted == "vkGetPhysicalDeviceFeatures2") return reinterpret_cast<PFN_vkVoidFunction>(getFeatures2);
    return nextInstanceProc ? nextInstanceProc(instance, name) : nullptr;
}

}  // namespace

extern "C" __attribute__((visibility("default"))) VKAPI_ATTR VkResult VKAPI_CALL
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* interface) {
    interface->loaderLayerInterfaceVersion = std::min(interface->loaderLayerInterfaceVersion, 2u);
    interface->pfnGetInstanceProcAddr = getInstanceProc;
    interface->pfnGetDeviceProcAddr = nullptr;  // no device function is touched
    interface->pfnGetPhysicalDeviceProcAddr = nullptr;
    return VK_SUCCESS;
}
