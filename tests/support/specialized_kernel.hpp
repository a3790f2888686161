#pragma once
/** @file What is left of a kernel under its specialization constants, as a driver may fold them: by
 * spirv-opt. */
#include <heliograph/kernel.hpp>

#include <cstdint>
#include <set>
#include <string>
#include <vector>

namespace helio::test {

struct SpecializedKernel {
    std::vector<std::uint32_t> spirv;
    std::size_t instructions = 0;    ///< of the functions
    std::set<std::string> bindings;  ///< that some instruction uses
};

/** Freezes the constants and takes out what cannot be reached. Throws std::runtime_error where spirv-opt
 * fails. */
SpecializedKernel specialize(const Kernel& kernel, const SpecConstants& constants);

}  // namespace helio::test
