#include "engine/shader/spirv_trimmer.hpp"

#include <spirv-tools/optimizer.hpp>

#include <utility>

namespace helio {

std::vector<std::uint32_t> trimmedSpirv(std::vector<std::uint32_t> spirv) {
    spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_3);
    optimizer.RegisterPass(spvtools::CreateCCPPass())
        .RegisterPass(spvtools::CreateDeadBranchElimPass())
        .RegisterPass(spvtools::CreateEliminateDeadFunctionsPass());
    spvtools::OptimizerOptions options;
    options.set_run_validator(false);
    std::vector<std::uint32_t> trimmed;
    const bool done = optimizer.Run(spirv.data(), spirv.size(), &trimmed, options);
    return done && !trimmed.empty() ? std::move(trimmed) : std::move(spirv);
}

}  // namespace helio
