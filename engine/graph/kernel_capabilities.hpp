#pragma once
/** @file What a kernel's SPIR-V asks of the device beyond the least that the engine needs. */
#include "engine/gpu/capabilities.hpp"
#include "engine/shader/reflection.hpp"

#include <string>
#include <vector>

namespace helio::graph {

/** The capabilities that the kernel declares and the device lacks, by SPIR-V's names. */
std::vector<std::string> missingCapabilities(const KernelReflection& kernel, const gpu::DeviceFacts& device);

}  // namespace helio::graph
