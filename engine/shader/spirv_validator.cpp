#include "engine/shader/spirv_validator.hpp"

#include <dlfcn.h>
#include <spirv-tools/libspirv.hpp>

namespace helio {

std::string spirvFault(std::span<const std::uint32_t> spirv) {
    std::string fault;
    spvtools::Context context(SPV_ENV_VULKAN_1_3);
    context.SetMessageConsumer(
        [&](spv_message_level_t level, const char*, const spv_position_t&, const char* message) {
            if (level <= SPV_MSG_ERROR && fault.empty()) fault = message;
        });
    spvtools::ValidatorOptions options;
    options.SetScalarBlockLayout(true);  // a device feature, which the pipeline checks
    spv_const_binary_t binary{spirv.data(), spirv.size()};
    spv_diagnostic diagnostic = nullptr;
    const spv_result_t result = spvValidateWithOptions(context.CContext(), options, &binary, &diagnostic);
    if (diagnostic != nullptr) {
        if (fault.empty() && diagnostic->error != nullptr) fault = diagnostic->error;
        spvDiagnosticDestroy(diagnostic);
    }
    if (result != SPV_SUCCESS && fault.empty()) fault = "unknown fault";
    // The message's own explanations follow on further lines.
    return fault.substr(0, fault.find('\n'));
}

bool isEmbedded(std::span<const std::uint32_t> spirv) {
    Dl_info info;
    return ::dladdr(spirv.data(), &info) != 0;
}

}  // namespace helio
