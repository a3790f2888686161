#include "engine/shader/spirv_trimmer.hpp"

#include "engine/shader/spirv_files.hpp"

#include <spirv-tools/optimizer.hpp>

#include <string>
#include <unordered_map>
#include <utility>

namespace helio {
namespace {

/** Nothing where the passes fail. */
std::vector<std::uint32_t> trim(spvtools::Optimizer& optimizer, std::span<const std::uint32_t> spirv) {
    optimizer.RegisterPass(spvtools::CreateCCPPass())
        .RegisterPass(spvtools::CreateDeadBranchElimPass())
        .RegisterPass(spvtools::CreateEliminateDeadFunctionsPass());
    spvtools::OptimizerOptions options;
    options.set_run_validator(false);
    std::vector<std::uint32_t> trimmed;
    if (!optimizer.Run(spirv.data(), spirv.size(), &trimmed, options)) trimmed.clear();
    return trimmed;
}

}  // namespace

std::vector<std::uint32_t> trimmedSpirv(std::vector<std::uint32_t> spirv) {
    spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_3);
    std::vector<std::uint32_t> trimmed = trim(optimizer, spirv);
    return trimmed.empty() ? std::move(spirv) : std::move(trimmed);
}

std::vector<std::uint32_t> specializedSpirv(
    std::span<const std::uint32_t> spirv,
    std::span<const std::pair<std::uint32_t, std::uint32_t>> constants) {
    std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> values;
    KernelVariant variant;
    for (const auto& [id, value] : constants) {
        values.emplace(id, std::vector{value});
        variant.defines.emplace(std::to_string(id), std::to_string(value));
    }
    const std::string words(reinterpret_cast<const char*>(spirv.data()), spirv.size_bytes());
    if (auto kept = loadSpirv("specialized", words, variant)) return std::move(kept->spirv);
    spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_3);
    optimizer.RegisterPass(spvtools::CreateSetSpecConstantDefaultValuePass(values))
        .RegisterPass(spvtools::CreateFreezeSpecConstantValuePass())
        .RegisterPass(spvtools::CreateFoldSpecConstantOpAndCompositePass());
    CompiledGlsl specialized{.ok = true, .spirv = trim(optimizer, spirv), .messages = {}, .includes = {}};
    if (!specialized.spirv.empty()) storeSpirv("specialized", words, variant, specialized);
    return std::move(specialized.spirv);
}

}  // namespace helio
