#pragma once
/** @file Kernels compiled in this process: see compileVariant and compileKernel. */
#include <cstdint>

namespace helio {

struct KernelCacheStatistics {
    std::uint64_t compiled = 0;  ///< times glslang ran
    std::uint64_t reused = 0;    ///< requests answered without
};
KernelCacheStatistics kernelCacheStatistics();

}  // namespace helio
