#pragma once
/** @file One GLSL compute shader to SPIR-V with the linked glslang, under the options of the build. Keeps
 * nothing. */
#include <heliograph/kernel.hpp>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace helio {

struct CompiledGlsl {
    bool ok = false;
    std::vector<std::uint32_t> spirv;
    /** The compiler's messages, one a line: "FILE:LINE: MESSAGE". */
    std::string messages;
    /** Every file that was looked for while including, by path from the root, and what was found then.
     * Without "generated.glsl", which is the variant's. */
    std::map<std::string, std::optional<std::string>> includes;
};

/** Compiles `glsl`, which messages call `path` and whose includes are looked for beside it and from the root.
 * Thread-safe. Never throws for a fault of the text. */
CompiledGlsl compileGlsl(const std::string& path, const std::string& glsl, const KernelVariant& variant);

}  // namespace helio
