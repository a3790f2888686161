#pragma once
/** @file Reads a kernel's interface out of SPIR-V through the C interface of SPIRV-Cross. */
#include "engine/shader/reflection.hpp"

#include <spirv_cross/spirv_cross_c.h>

#include <set>
#include <span>
#include <string>

namespace helio {

/** One module while it is read. */
class SpirvReader {
public:
    /** Parses valid words: broken ones can crash SPIRV-Cross (see spirvFault). Throws ShaderError that begins
     * with the kernel's name. */
    SpirvReader(std::string_view kernel, std::span<const std::uint32_t> spirv);
    ~SpirvReader();
    SpirvReader(const SpirvReader&) = delete;
    SpirvReader& operator=(const SpirvReader&) = delete;

    KernelReflection read();

private:
    [[noreturn]] void fail(const std::string& fault) const;
    void check(spvc_result result) const;
    std::string nameOf(std::uint32_t id) const;
    std::string typeName(spvc_type type) const;
    std::vector<ReflectedMember> readMembers(spvc_type structure) const;
    void readBindings(KernelReflection& out);
    ReflectedBinding readBinding(const spvc_reflected_resource& resource, spvc_resource_type type) const;
    void readPushConstants(KernelReflection& out);
    void readConstants(KernelReflection& out);
    void addSpecConstant(std::vector<ReflectedSpecConstant>& constants, ReflectedSpecConstant added) const;
    void readCapabilities(KernelReflection& out);

    std::string kernel_;
    spvc_context context_ = nullptr;
    spvc_compiler compiler_ = nullptr;
    spvc_resources resources_ = nullptr;
    std::set<std::uint32_t> used_;  ///< ids of bindings that main comes to
};

}  // namespace helio
