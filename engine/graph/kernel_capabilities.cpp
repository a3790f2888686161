#include "engine/graph/kernel_capabilities.hpp"

namespace helio::graph {
namespace {

using Facts = gpu::DeviceFacts;

bool subgroups(const Facts& facts, vk::SubgroupFeatureFlagBits operation) {
    return bool(facts.properties11.subgroupSupportedOperations & operation);
}

struct Rule {
    const char* capability;
    bool (*offered)(const Facts&);
};

/** False where the engine does not switch the feature on. Capabilities not listed are in every Vulkan 1.3
 * device, or fail when the pipeline is made. Drivers tend to run kernels that ask for subgroup operations
 * they lack, with wrong results. */
constexpr Rule rules[] = {
    {"Int64", [](const Facts& f) { return f.features.shaderInt64 == VK_TRUE; }},
    {"Int64Atomics", [](const Facts& f) { return f.features12.shaderBufferInt64Atomics == VK_TRUE; }},
    {"Float64", [](const Facts& f) { return f.features.shaderFloat64 == VK_TRUE; }},
    {"Float16", [](const Facts&) { return false; }},
    {"Int8", [](const Facts& f) { return f.features12.shaderInt8 == VK_TRUE; }},
    {"Int16", [](const Facts& f) { return f.features.shaderInt16 == VK_TRUE; }},
    {"AtomicFloat32AddEXT",
     [](const Facts& f) { return f.atomicFloat.shaderBufferFloat32AtomicAdd == VK_TRUE; }},
    {"StorageBuffer8BitAccess",
     [](const Facts& f) { return f.features12.storageBuffer8BitAccess == VK_TRUE; }},
    {"StorageBuffer16BitAccess",
     [](const Facts& f) { return f.features11.storageBuffer16BitAccess == VK_TRUE; }},
    {"StorageImageExtendedFormats",
     [](const Facts& f) { return f.features.shaderStorageImageExtendedFormats == VK_TRUE; }},
    {"StorageImageReadWithoutFormat", [](const Facts&) { return false; }},
    {"StorageImageWriteWithoutFormat",
     [](const Facts& f) { return f.features.shaderStorageImageWriteWithoutFormat == VK_TRUE; }},
    {"GroupNonUniform", [](const Facts& f) { return subgroups(f, vk::SubgroupFeatureFlagBits::eBasic); }},
    {"GroupNonUniformVote", [](const Facts& f) { return subgroups(f, vk::SubgroupFeatureFlagBits::eVote); }},
    {"GroupNonUniformArithmetic",
     [](const Facts& f) { return subgroups(f, vk::SubgroupFeatureFlagBits::eArithmetic); }},
    {"GroupNonUniformBallot",
     [](const Facts& f) { return subgroups(f, vk::SubgroupFeatureFlagBits::eBallot); }},
    {"GroupNonUniformShuffle",
     [](const Facts& f) { return subgroups(f, vk::SubgroupFeatureFlagBits::eShuffle); }},
    {"GroupNonUniformShuffleRelative",
     [](const Facts& f) { return subgroups(f, vk::SubgroupFeatureFlagBits::eShuffleRelative); }},
    {"GroupNonUniformClustered",
     [](const Facts& f) { return subgroups(f, vk::SubgroupFeatureFlagBits::eClustered); }},
    {"GroupNonUniformQuad", [](const Facts& f) { return subgroups(f, vk::SubgroupFeatureFlagBits::eQuad); }},
};

}  // namespace

std::vector<std::string> missingCapabilities(const KernelReflection& kernel, const gpu::DeviceFacts& device) {
    std::vector<std::string> missing;
    for (const Rule& rule : rules)
        if (kernel.needs(rule.capability) && !rule.offered(device)) missing.emplace_back(rule.capability);
    return missing;
}

}  // namespace helio::graph
