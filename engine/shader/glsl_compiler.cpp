#include "engine/shader/glsl_compiler.hpp"

#include "engine/shader/source_tree.hpp"

#include <fmt/format.h>
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include <filesystem>
#include <memory>
#include <sstream>

namespace helio {
namespace {

constexpr std::size_t maxIncludeDepth = 64;

/** Finds includes in the source tree and notes what was looked for. */
class TreeIncluder : public glslang::TShader::Includer {
public:
    TreeIncluder(const std::string& generated, CompiledGlsl& out) : generated_(generated), out_(out) {}

    IncludeResult* includeLocal(const char* header, const char* includer, size_t depth) override {
        return find(std::filesystem::path(includer).parent_path() / header, depth);
    }
    IncludeResult* includeSystem(const char* header, const char*, size_t depth) override {
        return find(header, depth);
    }
    void releaseInclude(IncludeResult* result) override {
        if (result == nullptr) return;
        delete static_cast<std::string*>(result->userData);
        delete result;
    }

private:
    IncludeResult* find(const std::filesystem::path& path, size_t depth) {
        const std::string name = path.lexically_normal().generic_string();
        if (depth > maxIncludeDepth)
            return give("", fmt::format("included more than {} deep", maxIncludeDepth));
        if (name == "generated.glsl") return give(name, generated_);
        const auto [entry, isNew] = out_.includes.try_emplace(name);
        if (isNew) entry->second = readShaderSource(name);
        return entry->second ? give(name, *entry->second) : nullptr;
    }
    static IncludeResult* give(const std::string& name, const std::string& text) {
        auto owned = std::make_unique<std::string>(text);
        const char* data = owned->data();
        const std::size_t length = owned->size();
        return new IncludeResult(name, data, length, owned.release());
    }

    const std::string& generated_;
    CompiledGlsl& out_;
};

/** glslang's log, without its tallies and its prefix "ERROR: ". */
std::string tidyMessages(const std::string& log) {
    std::istringstream lines(log);
    std::string text;
    for (std::string line; std::getline(lines, line);) {
        while (!line.empty() && (line.back() == ' ' || line.back() == '\r')) line.pop_back();
        if (line.empty() || line.find("compilation errors.") != std::string::npos) continue;
        if (line.ends_with("'' : compilation terminated")) continue;
        if (line.starts_with("ERROR: ")) line.erase(0, 7);
        if (line.starts_with("Linking compute stage: Missing entry point") && !text.empty()) continue;
        text += (text.empty() ? "" : "\n") + line;
    }
    return text;
}

void initializeGlslang() {
    // Never finalized: a kernel may be compiled as long as the process lives.
    static const bool initialized = glslang::InitializeProcess();
    (void)initialized;
}

}  // namespace

CompiledGlsl compileGlsl(const std::string& path, const std::string& glsl, const KernelVariant& variant) {
    initializeGlslang();
    CompiledGlsl out;
    std::string preamble;
    for (const auto& [name, value] : variant.defines) preamble += fmt::format("#define {} {}\n", name, value);

    // The same as `glslangValidator -V --target-env vulkan1.3`, so that the same text gives the same words.
    glslang::TShader shader(EShLangCompute);
    const char* const text = glsl.data();
    const int length = static_cast<int>(glsl.size());
    const char* const name = path.c_str();
    shader.setStringsWithLengthsAndNames(&text, &length, &name, 1);
    shader.setPreamble(preamble.c_str());
    shader.setEnvInput(glslang::EShSourceGlsl, EShLangCompute, glslang::EShClientVulkan, 100);
    shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_3);
    shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_6);
    constexpr auto rules = static_cast<EShMessages>(EShMsgSpvRules | EShMsgVulkanRules);
    TreeIncluder includer(variant.generated, out);
    if (!shader.parse(GetDefaultResources(), 100, false, rules, includer)) {
        out.messages = tidyMessages(shader.getInfoLog());
        return out;
    }
    glslang::TProgram program;
    program.addShader(&shader);
    if (!program.link(rules) || !program.mapIO()) {
        out.messages = tidyMessages(fmt::format("{}\n{}", shader.getInfoLog(), program.getInfoLog()));
        return out;
    }
    spv::SpvBuildLogger logger;
    glslang::GlslangToSpv(*program.getIntermediate(EShLangCompute), out.spirv, &logger);
    out.messages = tidyMessages(logger.getAllMessages());
    out.ok = !out.spirv.empty();
    return out;
}

}  // namespace helio
