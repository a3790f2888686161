#pragma once
/** @file Vulkan-Hpp as the engine uses it: RAII handles, designated initialisers, exceptions. The loader is
 * opened at run time, so nothing links against it and a machine without Vulkan gets a DeviceError. */
#define VULKAN_HPP_NO_STRUCT_CONSTRUCTORS
#include <heliograph/error.hpp>

#include <vulkan/vulkan_format_traits.hpp>
#include <vulkan/vulkan_raii.hpp>

#include <string>
#include <utility>

namespace helio::gpu {

/** Runs `body`; a Vulkan error leaves it as a DeviceError that says what was being done. */
template <typename Body>
decltype(auto) translateErrors(const std::string& doing, Body&& body) {
    try {
        return std::forward<Body>(body)();
    } catch (const vk::SystemError& error) {
        throw DeviceError(doing + ": " + error.what());
    }
}

}  // namespace helio::gpu
