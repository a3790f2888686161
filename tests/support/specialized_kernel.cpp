#include "tests/support/specialized_kernel.hpp"

#include "engine/shader/reflection.hpp"
#include "tests/gpu/run_program.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace helio::test {
namespace {

std::string literal(const SpecValue& value) {
    if (const bool* b = std::get_if<bool>(&value)) return *b ? "true" : "false";
    return std::visit([](auto v) { return fmt::format("{}", v); }, value);
}

}  // namespace

SpecializedKernel specialize(const Kernel& kernel, const SpecConstants& constants) {
    const auto folder = std::filesystem::temp_directory_path();
    const std::string before = folder / fmt::format("specialize-{}.spv", ::getpid());
    const std::string after = folder / fmt::format("specialize-{}-out.spv", ::getpid());
    std::ofstream(before, std::ios::binary)
        .write(reinterpret_cast<const char*>(kernel.spirv.data()),
               std::streamsize(kernel.spirv.size_bytes()));
    const KernelReflection known = reflect(kernel);
    std::string values;
    for (const auto& [name, value] : constants) {
        if (const ReflectedSpecConstant* constant = known.specConstant(name))
            values += fmt::format("{}:{} ", constant->id, literal(value));
    }
    const Finished done = runProgram(
        "", fmt::format(
                "spirv-opt --target-env=vulkan1.3 --set-spec-const-default-value '{}' --freeze-spec-const "
                "--fold-spec-const-op-composite --eliminate-dead-branches --merge-return "
                "--inline-entry-points-exhaustive --scalar-replacement=200 --ssa-rewrite --ccp "
                "--eliminate-dead-branches --eliminate-dead-code-aggressive {} -o {}",
                values, before, after));
    std::filesystem::remove(before);
    if (done.status != 0) throw std::runtime_error("spirv-opt: " + done.output);
    SpecializedKernel result;
    std::ifstream file(after, std::ios::binary);
    std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
    file.close();
    std::filesystem::remove(after);
    result.spirv.resize(bytes.size() / 4);
    std::copy(bytes.begin(), bytes.end(), reinterpret_cast<char*>(result.spirv.data()));
    constexpr std::uint32_t opFunction = 54;
    bool inFunctions = false;
    for (std::size_t i = 5; i < result.spirv.size(); i += std::max(1u, result.spirv[i] >> 16)) {
        inFunctions = inFunctions || (result.spirv[i] & 0xffffu) == opFunction;
        result.instructions += inFunctions ? 1 : 0;
    }
    for (const ReflectedBinding& binding : reflectSpirv(kernel.name, result.spirv).bindings)
        if (binding.used) result.bindings.insert(binding.name);
    return result;
}

}  // namespace helio::test
