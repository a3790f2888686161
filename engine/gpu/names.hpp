#pragma once
/** @file Names of Vulkan objects, for validation messages and captures. */
#include "engine/gpu/vk.hpp"

#include <string>
#include <string_view>

namespace helio::gpu {

/** Names a handle; does nothing where debug utils is off (no validation). */
template <typename Handle>
void setName(const vk::raii::Device& device, Handle handle, std::string_view name) {
    if (!device.getDispatcher()->vkSetDebugUtilsObjectNameEXT) return;
    const std::string text(name);
    device.setDebugUtilsObjectNameEXT(
        {.objectType = Handle::objectType,
         .objectHandle = reinterpret_cast<std::uint64_t>(static_cast<typename Handle::CType>(handle)),
         .pObjectName = text.c_str()});
}

}  // namespace helio::gpu
