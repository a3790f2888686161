#pragma once
/** @file
 * Compute kernels: SPIR-V made at build, with the GLSL it came from for run-time variants. The build makes
 * one `extern const Kernel` per .comp file (helio_add_kernels in cmake/HeliographKernels.cmake):
 *
 *     #include <heliograph_kernels/pathtrace.hpp>   // kernels of passes/pathtrace
 *     graph.compute("trace", helio::shaders::trace);
 *
 * SPIR-V is 1.6 (Vulkan 1.3): the device must have the maintenance4 feature enabled, which 1.3 guarantees.
 */
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace helio {

/** Values of specialization constants by their GLSL name; a constant not named keeps its default. */
using SpecValue = std::variant<bool, std::int32_t, std::uint32_t, float>;
using SpecConstants = std::map<std::string, SpecValue>;

/** A compute kernel. The build makes one constant per file in namespace helio::shaders; the spans refer to
 * memory that is never freed (embedded, or owned by the run-time compiler's cache). */
struct Kernel {
    std::string_view name;                 ///< "pathtrace/trace"
    std::span<const std::uint32_t> spirv;  ///< Vulkan 1.3 SPIR-V, entry point main
    std::string_view source;  ///< path in the embedded source tree, "passes/pathtrace/trace.comp"
};

/** Preprocessor definitions by name, and generated text for #include "generated.glsl". */
struct KernelVariant {
    std::map<std::string, std::string> defines;
    std::string generated;
};

/** Compiles the kernel's embedded source again under a variant (cached by source and variant, in
 * the process and between processes in a folder beside the pipeline cache). The empty variant gives the
 * build's SPIR-V, word for word. Thread-safe. Throws ShaderError with the compiler's messages, which name
 * file and line. */
Kernel compileVariant(const Kernel& kernel, const KernelVariant& variant);

/** Compiles GLSL text, called `name` in messages; `#include "shaders/..."` finds the embedded tree. Cached
 * and thread-safe like compileVariant, which takes the result too. Throws ShaderError. */
Kernel compileKernel(std::string_view name, std::string_view glsl, const KernelVariant& variant = {});

/** Debug reload: watches the files that a kernel is made of in the folder HELIOGRAPH_SHADER_DIR (a source
 * tree: it holds shaders/ and passes/) and compiles the kernel again when one has changed. An edit that does
 * not compile keeps the last good kernel and says why. Without the folder nothing ever changes. Not
 * thread-safe. */
class KernelWatcher {
public:
    /** Starts with the kernel as given; the first poll() finds whether the folder's files differ from it. */
    explicit KernelWatcher(const Kernel& kernel, KernelVariant variant = {});
    ~KernelWatcher();
    KernelWatcher(KernelWatcher&&) noexcept;
    KernelWatcher& operator=(KernelWatcher&&) noexcept;

    /** Looks at the files; true where kernel() is another one since the last call. Cheap enough for every
     * frame. */
    bool poll();
    const Kernel& kernel() const;  ///< the last good one
    const std::string& problem()
        const;  ///< the compiler's messages of the present files; empty where they compile

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/** A file of the embedded GLSL tree: the path that an #include names, and its text. */
struct ShaderSource {
    std::string_view path;
    std::string_view text;
};

/** Every embedded file, in order of path: the library's shaders and kernels, then what applications' kernels
 * brought along. */
std::vector<ShaderSource> embeddedShaderSources();

/** Adds files to the embedded tree at static initialisation; helio_add_kernels generates these for targets
 * other than the library. The views must stay valid. A path that is there already keeps its first text. */
struct RegisterShaderSources {
    RegisterShaderSources(std::initializer_list<ShaderSource> sources);
};

}  // namespace helio
