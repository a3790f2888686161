#include "engine/graph/interface.hpp"

#include "engine/graph/kernel_capabilities.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace helio::graph {
namespace {

TexelType texelTypeOf(Format format) {
    switch (format) {
        case Format::Undefined:
            return TexelType::None;
        case Format::R32UI:
        case Format::RG32UI:
        case Format::RGBA32UI:
            return TexelType::Uint;
        case Format::R32I:
            return TexelType::Int;
        default:
            return TexelType::Float;
    }
}

const char* texelTypeName(TexelType type) {
    switch (type) {
        case TexelType::None:
            return "no";
        case TexelType::Float:
            return "float";
        case TexelType::Int:
            return "int";
        case TexelType::Uint:
            return "uint";
    }
    return "";
}

const char* specTypeName(const SpecValue& value) {
    static constexpr const char* names[] = {"bool", "int", "uint", "float"};
    return names[value.index()];
}

Usage usageOf(BindingKind kind) {
    switch (kind) {
        case BindingKind::StorageBuffer:
            return Usage::StorageBuffer;
        case BindingKind::UniformBuffer:
            return Usage::UniformBuffer;
        case BindingKind::UniformTexelBuffer:
            return Usage::UniformTexelBuffer;
        case BindingKind::StorageTexelBuffer:
            return Usage::StorageTexelBuffer;
        case BindingKind::StorageImage:
            return Usage::StorageImage;
        case BindingKind::SampledImage:
            return Usage::SampledImage;
    }
    return Usage::StorageBuffer;
}

template <typename Range>
std::string listNames(const Range& things) {
    std::string names;
    for (const auto& thing : things) names += (names.empty() ? "'" : ", '") + thing.name + "'";
    return names.empty() ? "none" : names;
}

class Checker {
public:
    Checker(const Graph::Impl& graph, const DeclaredPass& pass, std::vector<GraphProblem>& problems)
        : graph_(graph), pass_(pass), problems_(problems), limits_(graph.device->limits()) {}

    PassInterface run(std::vector<AccessInput>& accesses) {
        try {
            interface_.reflection = &reflect(pass_.kernel);
        } catch (const ShaderError& error) {
            problems_.push_back(
                {pass_.name, "", "", fmt::format("has a broken kernel: {}; compile it anew", error.what())});
        }
        for (const DeclaredBinding& declared : pass_.bindings) {
            const Binding& binding = declared.binding;
            const DeclaredResource* resource = find(binding.resource, binding.graph);
            const ReflectedBinding* slot =
                interface_.reflection ? interface_.reflection->binding(binding.name) : nullptr;
            const bool image = resource && resource->input.kind == ResourceKind::Image;
            accesses.push_back({.binding = binding.name,
                                .resource = binding.resource,
                                .graph = binding.graph,
                                .mode = declared.mode,
                                .usage = slot    ? usageOf(slot->kind)
                                         : image ? Usage::StorageImage
                                                 : Usage::StorageBuffer,
                                .window = binding.window});
            if (!interface_.reflection) continue;
            if (!slot)
                report(binding, resource,
                       fmt::format("is not a binding of kernel '{}', which has {}; use one of these names, "
                                   "or leave it out",
                                   pass_.kernel.name, listNames(interface_.reflection->bindings)));
            else if (checkSlot(binding, *slot, declared.mode, resource) && resource)
                bind(binding, *slot, *resource);
        }
        for (const Buffer& arguments : pass_.indirect)
            accesses.push_back({.binding = "indirect",
                                .resource = arguments.id,
                                .graph = arguments.graph,
                                .mode = Mode::Read,
                                .usage = Usage::IndirectArguments});
        if (interface_.reflection) {
            checkUndeclared();
            checkSpec();
            for (const std::string& name : missingCapabilities(*interface_.reflection, graph_.device->facts))
                problems_.push_back({pass_.name, "", "",
                                     fmt::format("has a kernel, '{}', that asks for {}, which the device "
                                                 "lacks or the engine leaves off; "
                                                 "choose a variant without it",
                                                 pass_.kernel.name, name)});
        }
        if (!pass_.recorder)
            problems_.push_back({pass_.name, "", "", "records nothing; give it record() with a dispatch"});
        return std::move(interface_);
    }

private:
    const DeclaredResource* find(std::uint32_t resource, std::uint32_t graph) const {
        return graph == graph_.serial && resource < graph_.resources.size() ? &graph_.resources[resource]
                                                                            : nullptr;
    }

    void report(const Binding& binding, const DeclaredResource* resource, std::string message) {
        problems_.push_back(
            {pass_.name, binding.name, resource ? resource->input.name : "", std::move(message)});
    }

    /** The slot alone, and the access to it. */
    bool checkSlot(const Binding& binding, const ReflectedBinding& slot, Mode mode,
                   const DeclaredResource* resource) {
        const std::size_t before = problems_.size();
        if (slot.set != 0)
            report(binding, resource,
                   fmt::format("is in descriptor set {}; kernels of a graph use set 0", slot.set));
        if (slot.count != 1)
            report(binding, resource,
                   fmt::format(
                       "is an array of {} descriptors; a graph binds one resource to a name: use one binding "
                       "for each, or one buffer for all",
                       slot.count));
        const bool cannotBeWritten = slot.kind == BindingKind::UniformBuffer ||
                                     slot.kind == BindingKind::UniformTexelBuffer ||
                                     slot.kind == BindingKind::SampledImage;
        if (mode == Mode::Read && slot.writable)
            report(binding, resource,
                   "is declared with reads() but the kernel may write it; mark it readonly in the kernel, or "
                   "declare "
                   "it with writes() or modifies()");
        if (mode == Mode::Read && !slot.readable)
            report(binding, resource,
                   "is declared with reads() but is writeonly in the kernel; declare it with writes()");
        // What cannot be written at all is refused by validate().
        if (mode != Mode::Read && !slot.writable && !cannotBeWritten)
            report(binding, resource,
                   "is declared as written but is readonly in the kernel; declare it with reads()");
        if (mode == Mode::Modify && slot.writable && !slot.readable)
            report(binding, resource,
                   "is declared with modifies() but is writeonly in the kernel; declare it with writes()");
        return problems_.size() == before;
    }

    void bind(const Binding& binding, const ReflectedBinding& slot, const DeclaredResource& resource) {
        BoundResource bound{.resource = binding.resource, .slot = &slot, .sampling = binding.sampling};
        const bool wantsImage =
            slot.kind == BindingKind::StorageImage || slot.kind == BindingKind::SampledImage;
        if (wantsImage != (resource.input.kind == ResourceKind::Image)) return;  // validate() says so
        if (wantsImage)
            bindImage(binding, slot, resource);
        else if (!bindBuffer(binding, slot, resource, bound))
            return;
        interface_.bindings.push_back(bound);
    }

    void bindImage(const Binding& binding, const ReflectedBinding& slot, const DeclaredResource& resource) {
        const Format format = resource.input.format;
        if (slot.kind == BindingKind::StorageImage && slot.format != Format::Undefined &&
            slot.format != format)
            report(binding, &resource,
                   fmt::format("has format {} but the kernel's image is {}; change one of them",
                               formatName(format), formatName(slot.format)));
        else if (slot.texel != TexelType::None && slot.texel != texelTypeOf(format))
            report(
                binding, &resource,
                fmt::format(
                    "has format {}, of {} texels, but the kernel's image has {} texels; change one of them",
                    formatName(format), texelTypeName(texelTypeOf(format)), texelTypeName(slot.texel)));
        const vk::FormatFeatureFlags features =
            graph_.device->physical.getFormatProperties(gpu::vulkanFormat(format)).optimalTilingFeatures;
        if (slot.kind == BindingKind::SampledImage && binding.sampling == Sampling::Linear &&
            !(features & vk::FormatFeatureFlagBits::eSampledImageFilterLinear))
            report(binding, &resource,
                   fmt::format("is sampled with Sampling::Linear, which the device cannot do in {}; use "
                               "Sampling::Nearest or another format",
                               formatName(format)));
    }

    /** Fills the bound part; false where the window is no part of the buffer, which validate() says. */
    bool bindBuffer(const Binding& binding, const ReflectedBinding& slot, const DeclaredResource& resource,
                    BoundResource& bound) {
        const std::uint64_t size = resource.input.bytes;
        const Window& window = binding.window;
        if (window.offset >= size || window.bytes > size - window.offset) return false;
        bound.offset = window.offset;
        bound.bytes = window.bytes > 0 ? window.bytes : size - window.offset;
        const bool texel =
            slot.kind == BindingKind::UniformTexelBuffer || slot.kind == BindingKind::StorageTexelBuffer;
        if (!texel && binding.view != Format::Undefined)
            report(binding, &resource,
                   fmt::format("has a view format but is a {} in the kernel; leave the format out",
                               bindingKindName(slot.kind)));
        if (texel) {
            bindTexels(binding, slot, resource, bound);
            return true;
        }
        const bool uniform = slot.kind == BindingKind::UniformBuffer;
        checkAlignment(
            binding, resource,
            uniform ? limits_.minUniformBufferOffsetAlignment : limits_.minStorageBufferOffsetAlignment);
        const std::uint64_t range = uniform ? limits_.maxUniformBufferRange : limits_.maxStorageBufferRange;
        if (bound.bytes > range)
            report(
                binding, &resource,
                fmt::format("spans {} bytes but a {} binding of the device reaches {}; {}bind a part with "
                            "Window{{offset, bytes}}",
                            bound.bytes, bindingKindName(slot.kind), range,
                            uniform ? "use a storage buffer, or " : "read it through a samplerBuffer, or "));
        if (slot.bytes > bound.bytes)
            report(binding, &resource,
                   fmt::format("has {} bytes bound but the kernel's block has {}; bind at least as many",
                               bound.bytes, slot.bytes));
        return true;
    }

    void bindTexels(const Binding& binding, const ReflectedBinding& slot, const DeclaredResource& resource,
                    BoundResource& bound) {
        bound.view = binding.view != Format::Undefined  ? binding.view
                     : slot.format != Format::Undefined ? slot.format
                     : slot.texel == TexelType::Float   ? Format::RGBA32F
                     : slot.texel == TexelType::Uint    ? Format::RGBA32UI
                                                        : Format::Undefined;
        if (bound.view == Format::Undefined) {
            report(binding, &resource, "needs a view format; give the Binding one, e.g. Format::R32I");
            return;
        }
        if (slot.format != Format::Undefined && slot.format != bound.view)
            report(binding, &resource,
                   fmt::format("is viewed as {} but the kernel's imageBuffer is {}; change one of them",
                               formatName(bound.view), formatName(slot.format)));
        else if (slot.texel != TexelType::None && slot.texel != texelTypeOf(bound.view))
            report(
                binding, &resource,
                fmt::format("is viewed as {}, of {} texels, but the kernel has {} texels; change one of them",
                            formatName(bound.view), texelTypeName(texelTypeOf(bound.view)),
                            texelTypeName(slot.texel)));
        checkAlignment(binding, resource, limits_.minTexelBufferOffsetAlignment);
        const std::uint64_t texelBytes = formatBytes(bound.view);
        const std::uint64_t texels = bound.bytes / texelBytes;
        if (binding.window.bytes % texelBytes != 0)
            report(binding, &resource,
                   fmt::format(
                       "has a window of {} bytes, no whole number of texels of {}; make it a multiple of {}",
                       binding.window.bytes, formatName(bound.view), texelBytes));
        else if (texels == 0)
            report(binding, &resource,
                   fmt::format("has {} bytes, less than one texel of {}; bind at least {}", bound.bytes,
                               formatName(bound.view), texelBytes));
        if (texels > limits_.maxTexelBufferElements)
            report(binding, &resource,
                   fmt::format("has {} texels but a view of the device holds {}; bind a part with "
                               "Window{{offset, bytes}}",
                               texels, limits_.maxTexelBufferElements));
        const vk::FormatProperties properties =
            graph_.device->physical.getFormatProperties(gpu::vulkanFormat(bound.view));
        const vk::FormatFeatureFlags needed = slot.kind == BindingKind::UniformTexelBuffer
                                                  ? vk::FormatFeatureFlagBits::eUniformTexelBuffer
                                                  : vk::FormatFeatureFlagBits::eStorageTexelBuffer;
        if (!(properties.bufferFeatures & needed))
            report(
                binding, &resource,
                fmt::format("is viewed as {}, which the device does not offer for a {}; use another format",
                            formatName(bound.view), bindingKindName(slot.kind)));
        bound.bytes = texels * texelBytes;
    }

    void checkAlignment(const Binding& binding, const DeclaredResource& resource, std::uint64_t alignment) {
        if (binding.window.offset % alignment != 0)
            report(
                binding, &resource,
                fmt::format("is bound at byte {} but the device asks for a multiple of {}; move the window",
                            binding.window.offset, alignment));
    }

    void checkUndeclared() {
        for (const ReflectedBinding& slot : interface_.reflection->bindings) {
            if (!slot.used) continue;
            const bool declared =
                std::any_of(pass_.bindings.begin(), pass_.bindings.end(),
                            [&](const DeclaredBinding& d) { return d.binding.name == slot.name; });
            if (!declared)
                problems_.push_back(
                    {pass_.name, slot.name, "",
                     fmt::format("is a {} of kernel '{}' that the pass does not declare; add it to {}",
                                 bindingKindName(slot.kind), pass_.kernel.name,
                                 !slot.writable   ? "reads()"
                                 : !slot.readable ? "writes()"
                                                  : "writes() or modifies()")});
        }
    }

    void checkSpec() {
        const KernelReflection& reflection = *interface_.reflection;
        const std::size_t before = problems_.size();
        for (const auto& [name, value] : pass_.spec) {
            const ReflectedSpecConstant* constant = reflection.specConstant(name);
            if (!constant)
                problems_.push_back(
                    {pass_.name, name, "",
                     fmt::format(
                         "is no specialization constant of kernel '{}', which has {}; use one of these names",
                         pass_.kernel.name, listNames(reflection.specConstants))});
            else if (constant->defaultValue.index() != value.index())
                problems_.push_back(
                    {pass_.name, name, "",
                     fmt::format(
                         "is a specialization constant of type {} but is given a value of type {}; give a {}",
                         specTypeName(constant->defaultValue), specTypeName(value),
                         specTypeName(constant->defaultValue))});
            else
                interface_.spec.emplace_back(constant->id, value);
        }
        if (problems_.size() != before) return;
        interface_.localSize = reflection.localSizeWith(pass_.spec);
        std::uint64_t invocations = 1;
        for (std::size_t i = 0; i < 3; ++i) {
            invocations *= interface_.localSize[i];
            if (interface_.localSize[i] == 0 || interface_.localSize[i] > limits_.maxComputeWorkGroupSize[i])
                problems_.push_back(
                    {pass_.name, "", "",
                     fmt::format("has a workgroup of {} in dimension {}; the device takes 1 to {}",
                                 interface_.localSize[i], i, limits_.maxComputeWorkGroupSize[i])});
        }
        if (invocations > limits_.maxComputeWorkGroupInvocations)
            problems_.push_back({pass_.name, "", "",
                                 fmt::format("has workgroups of {} invocations; the device takes at most {}",
                                             invocations, limits_.maxComputeWorkGroupInvocations)});
    }

    const Graph::Impl& graph_;
    const DeclaredPass& pass_;
    std::vector<GraphProblem>& problems_;
    const vk::PhysicalDeviceLimits& limits_;
    PassInterface interface_;
};

}  // namespace

PassInterface checkInterface(const Graph::Impl& graph, const DeclaredPass& pass,
                             std::vector<AccessInput>& accesses, std::vector<GraphProblem>& problems) {
    return Checker(graph, pass, problems).run(accesses);
}

}  // namespace helio::graph
