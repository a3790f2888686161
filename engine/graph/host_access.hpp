#pragma once
/** @file What the host sees of the device's work outside plans: dependencies on the host are barriers, and
 * those are the graph's. */
#include "engine/gpu/device_impl.hpp"

#include <cstdint>

namespace helio::graph {

/** Waits for all work and copies `bytes` from `offset` of the buffer out. */
void download(Device::Impl& gpu, const gpu::BufferResource& buffer, void* data, std::uint64_t bytes,
              std::uint64_t offset);

}  // namespace helio::graph
