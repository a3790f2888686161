#pragma once
/** @file Images that the benchmarks' comparators use and the engine itself has no need of: depth, mip levels.
 */
#include "engine/gpu/device_impl.hpp"

#include <cstdint>
#include <string>

namespace helio::bench {

struct BenchImage {
    gpu::Allocation memory;
    vk::raii::Image image = nullptr;
    vk::raii::ImageView view = nullptr;  ///< of level 0
};

/** A 2D image with a view of its first level. Contents and layout are undefined. */
BenchImage makeImage(Device::Impl& gpu, const std::string& name, vk::Format format, vk::Extent2D extent,
                     std::uint32_t levels, vk::ImageUsageFlags usage);

/** Everything before is done and visible; images named go from any layout to GENERAL, their contents kept
 * where `keep`. */
void barrier(const vk::raii::CommandBuffer& commands, std::initializer_list<vk::Image> images = {},
             bool keep = false);

/** Submits and waits. */
void finish(Device::Impl& gpu, gpu::Recording recording);

}  // namespace helio::bench
