#pragma once
/** @file
 * What a kernel's SPIR-V says of its interface: bindings, push constants, specialization constants, local
 * size and capabilities. Read with SPIRV-Cross, once per kernel.
 *
 * A binding's name is the GLSL variable: the instance name of a block (`buffer Nodes {...} uNodes;` is
 * "uNodes"), the block's name where it has no instance name, and the variable's name of anything else.
 */
#include <heliograph/device.hpp>
#include <heliograph/kernel.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace helio {

enum class BindingKind : std::uint8_t {
    StorageBuffer,       ///< buffer block
    UniformBuffer,       ///< uniform block
    UniformTexelBuffer,  ///< samplerBuffer, usamplerBuffer, isamplerBuffer, textureBuffer
    StorageTexelBuffer,  ///< imageBuffer and its kin
    StorageImage,        ///< image2D and its kin
    SampledImage         ///< sampler2D and its kin: image and sampler in one
};
std::string_view bindingKindName(BindingKind kind);

/** Component type of an image's or texel buffer's texels as the shader sees them. */
enum class TexelType : std::uint8_t { None, Float, Int, Uint };

/** A member of a block or of a struct in it. Offsets and sizes in bytes, as laid out in memory. */
struct ReflectedMember {
    std::string name;
    std::string type;          ///< "float", "uvec3", "mat4x3" (columns x rows), or the struct's GLSL name
    std::uint32_t offset = 0;  ///< from the start of the struct it is in
    std::uint32_t bytes = 0;   ///< 0 for a run-time array
    std::uint32_t arrayStride = 0;         ///< of the outermost dimension; 0 where it is no array
    std::uint32_t matrixStride = 0;        ///< 0 where it is no matrix
    std::vector<ReflectedMember> members;  ///< of a struct
};

struct ReflectedBinding {
    std::string name;
    std::uint32_t set = 0;
    std::uint32_t binding = 0;
    BindingKind kind = BindingKind::StorageBuffer;
    std::uint32_t count = 1;  ///< descriptors: 1, or the size of an array of them
    bool readable = true;     ///< false where declared writeonly
    bool writable = false;    ///< false where declared readonly, and of what cannot be written
    bool used = true;         ///< false where main never comes to it; such a binding needs no descriptor
    /** Storage images and texel buffers: the declared format. Undefined where none is declared or the engine
     * has no such format. */
    Format format = Format::Undefined;
    TexelType texel = TexelType::None;
    std::uint32_t bytes = 0;  ///< of a block, without its run-time array
    std::vector<ReflectedMember> members;
};

struct ReflectedPushConstants {
    std::string name;
    std::uint32_t bytes = 0;  ///< 0 where the kernel has none
    std::vector<ReflectedMember> members;
};

struct ReflectedSpecConstant {
    std::string name;  ///< "local_size_x" (y, z) for a workgroup size that has no name of its own
    std::uint32_t id = 0;
    SpecValue defaultValue;  ///< its alternative is the constant's type
};

struct KernelReflection {
    std::vector<ReflectedBinding> bindings;  ///< by set, then binding
    ReflectedPushConstants pushConstants;
    std::vector<ReflectedSpecConstant> specConstants;  ///< by id
    std::array<std::uint32_t, 3> localSize = {1, 1, 1};
    std::array<std::optional<std::uint32_t>, 3>
        localSizeIds;                       ///< ids of spec constants that set the local size
    std::vector<std::string> capabilities;  ///< SPIR-V's names, e.g. "Int64Atomics"; alphabetical

    /** Nothing where there is none of that name. */
    const ReflectedBinding* binding(std::string_view name) const;
    const ReflectedSpecConstant* specConstant(std::string_view name) const;
    bool needs(std::string_view capability) const;
    /** The local size under given constants. Throws ShaderError where a constant is unknown or not of its
     * type. */
    std::array<std::uint32_t, 3> localSizeWith(const SpecConstants& constants) const;
};

/** Reads a kernel's interface; kept for the process by the kernel's words. Thread-safe. Throws ShaderError,
 * with the kernel's name, where the SPIR-V is broken (validated unless the build or
 * the run-time compiler made it), is no compute shader, or uses a kind of binding not
 * above. */
const KernelReflection& reflect(const Kernel& kernel);

/** Without keeping it, and always validated. */
KernelReflection reflectSpirv(std::string_view name, std::span<const std::uint32_t> spirv);

}  // namespace helio
