#pragma once
/** @file Kernels compiled in this process: see compileVariant and compileKernel. */
#include "engine/shader/glsl_compiler.hpp"

#include <cstdint>
#include <memory>
#include <string>

namespace helio {

/** The compiled text, faults included: compiled now, or before in this process from the same text, variant
 * and included files. What it returns is never freed. Thread-safe. */
std::shared_ptr<const CompiledGlsl> compileCached(const std::string& path, const std::string& glsl,
                                                  const KernelVariant& variant);

struct KernelCacheStatistics {
    std::uint64_t compiled = 0;  ///< times glslang ran
    std::uint64_t reused = 0;    ///< requests answered without
};
KernelCacheStatistics kernelCacheStatistics();

}  // namespace helio
