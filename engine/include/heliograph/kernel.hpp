#pragma once
/** @file Compute kernels: SPIR-V made at build, with the GLSL it came from for run-time variants. */
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <variant>

namespace helio {

/** Values of specialization constants by their GLSL name; a constant not named keeps its default. */
using SpecValue = std::variant<bool, std::int32_t, std::uint32_t, float>;
using SpecConstants = std::map<std::string, SpecValue>;

/** A compute kernel. The build makes one constant per file in namespace helio::shaders; the spans refer to
 * memory that is never freed (embedded, or owned by the run-time compiler's cache). */
struct Kernel {
    std::string_view name;                 ///< "pathtrace/trace"
    std::span<const std::uint32_t> spirv;  ///< Vulkan 1.3 SPIR-V, entry point main
    std::string_view source;               ///< path in the embedded source tree, "passes/pathtrace/trace.comp"
};

/** Preprocessor definitions by name, and generated text for #include "generated.glsl". */
struct KernelVariant {
    std::map<std::string, std::string> defines;
    std::string generated;
};

/** Compiles the kernel's embedded source again under a variant (cached in the process by source and
 * variant). Throws ShaderError with the compiler's messages, which name file and line. */
Kernel compileVariant(const Kernel& kernel, const KernelVariant& variant);

/** Compiles GLSL text; `#include "shaders/..."` finds the embedded tree. Throws ShaderError. */
Kernel compileKernel(std::string_view name, std::string_view glsl, const KernelVariant& variant = {});

}  // namespace helio
