#pragma once
/** @file Kernels compiled before, in this process or an earlier one: see compileVariant and compileKernel. */
#include "engine/shader/glsl_compiler.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace helio {

/** Whether results are kept between processes too. */
enum class KeepOnDisk : bool { No, Yes };

/** The compiled text, faults included: compiled now, or before from the same text, variant and included
 * files. What it returns is never freed. Thread-safe. */
std::shared_ptr<const CompiledGlsl> compileCached(const std::string& path, const std::string& glsl,
                                                  const KernelVariant& variant, KeepOnDisk keep);

/** Whether compileCached made these words. */
bool isCompiledHere(std::span<const std::uint32_t> spirv);

/** What a kernel that the build embedded is under the folder of shaderOverlay(): for debugging and for tests
 * that plant faults. The kernel as given where there is no such folder, or its words were not embedded, or
 * its source is in no tree. */
Kernel overlaid(const Kernel& kernel);

struct KernelCacheStatistics {
    std::uint64_t compiled = 0;  ///< times glslang ran
    std::uint64_t loaded = 0;    ///< results taken from an earlier process
    std::uint64_t reused = 0;    ///< results taken from this process
};
KernelCacheStatistics kernelCacheStatistics();

}  // namespace helio
