#include "engine/shader/reflection.hpp"

#include "engine/shader/kernel_cache.hpp"
#include "engine/shader/spirv_reader.hpp"
#include "engine/shader/spirv_validator.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <mutex>

namespace helio {
namespace {

template <typename List>
auto* findByName(List& list, std::string_view name) {
    const auto found =
        std::find_if(list.begin(), list.end(), [&](const auto& item) { return item.name == name; });
    return found == list.end() ? nullptr : &*found;
}

std::uint64_t hashWords(std::span<const std::uint32_t> words) {
    std::uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a over words
    for (const std::uint32_t word : words) hash = (hash ^ word) * 0x100000001b3u;
    return hash;
}

}  // namespace

std::string_view bindingKindName(BindingKind kind) {
    switch (kind) {
        case BindingKind::StorageBuffer:
            return "storage buffer";
        case BindingKind::UniformBuffer:
            return "uniform buffer";
        case BindingKind::UniformTexelBuffer:
            return "uniform texel buffer";
        case BindingKind::StorageTexelBuffer:
            return "storage texel buffer";
        case BindingKind::StorageImage:
            return "storage image";
        case BindingKind::SampledImage:
            return "sampled image";
    }
    return "";
}

const ReflectedBinding* KernelReflection::binding(std::string_view name) const {
    return findByName(bindings, name);
}

const ReflectedSpecConstant* KernelReflection::specConstant(std::string_view name) const {
    return findByName(specConstants, name);
}

bool KernelReflection::needs(std::string_view capability) const {
    return std::binary_search(capabilities.begin(), capabilities.end(), capability);
}

std::array<std::uint32_t, 3> KernelReflection::localSizeWith(const SpecConstants& constants) const {
    std::array<std::uint32_t, 3> size = localSize;
    for (const auto& [name, value] : constants) {
        const ReflectedSpecConstant* constant = specConstant(name);
        if (constant == nullptr)
            throw ShaderError(fmt::format("there is no specialization constant '{}'", name));
        if (constant->defaultValue.index() != value.index()) {
            throw ShaderError(
                fmt::format("specialization constant '{}' is given a value of another type", name));
        }
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (localSizeIds[axis] != constant->id) continue;
            size[axis] = std::holds_alternative<std::int32_t>(value)
                             ? static_cast<std::uint32_t>(std::get<std::int32_t>(value))
                             : std::get<std::uint32_t>(value);
        }
    }
    return size;
}

const KernelReflection& reflect(const Kernel& kernel) {
    // By content, not address: an application may free its own words and use the place again.
    using Key = std::pair<std::uint64_t, std::size_t>;
    static std::mutex mutex;
    static auto* const cache = new std::map<Key, KernelReflection>;  // never freed: references are handed out
    const Key key{hashWords(kernel.spirv), kernel.spirv.size()};
    {
        const std::scoped_lock lock(mutex);
        if (const auto found = cache->find(key); found != cache->end()) return found->second;
    }
    // SPIRV-Cross trusts its input; validating takes ten times as long, so only what others made is
    // validated.
    KernelReflection reflection = isEmbedded(kernel.spirv) || isCompiledHere(kernel.spirv)
                                      ? SpirvReader(kernel.name, kernel.spirv).read()
                                      : reflectSpirv(kernel.name, kernel.spirv);
    const std::scoped_lock lock(mutex);
    return cache->emplace(key, std::move(reflection)).first->second;
}

KernelReflection reflectSpirv(std::string_view name, std::span<const std::uint32_t> spirv) {
    if (const std::string fault = spirvFault(spirv); !fault.empty()) {
        throw ShaderError(fmt::format("kernel '{}': its SPIR-V is broken: {}", name, fault));
    }
    return SpirvReader(name, spirv).read();
}

}  // namespace helio
