#include "engine/shader/spirv_files.hpp"

#include "engine/gpu/cache_file.hpp"
#include "engine/gpu/pipeline.hpp"
#include "engine/shader/source_tree.hpp"

#include <heliograph/version.hpp>

#include <fmt/format.h>
#include <glslang/Public/ShaderLang.h>

#include <algorithm>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace helio {
namespace {

/** Length-prefixed strings, one after another. */
class Packer {
public:
    void add(std::string_view text) {
        const std::uint64_t size = text.size();
        const auto* head = reinterpret_cast<const std::byte*>(&size);
        bytes.insert(bytes.end(), head, head + sizeof(size));
        const auto* body = reinterpret_cast<const std::byte*>(text.data());
        bytes.insert(bytes.end(), body, body + text.size());
    }
    std::vector<std::byte> bytes;
};

class Unpacker {
public:
    explicit Unpacker(std::span<const std::byte> bytes) : bytes_(bytes) {}
    /** Nothing at the end and where a length passes the end. */
    std::optional<std::string_view> next() {
        std::uint64_t size = 0;
        if (bytes_.size() < sizeof(size)) return std::nullopt;
        std::memcpy(&size, bytes_.data(), sizeof(size));
        if (size > bytes_.size() - sizeof(size)) return std::nullopt;
        const std::string_view text(reinterpret_cast<const char*>(bytes_.data()) + sizeof(size), size);
        bytes_ = bytes_.subspan(sizeof(size) + size);
        return text;
    }

private:
    std::span<const std::byte> bytes_;
};

/** What decides the words, but the included files. */
std::string identity(const std::string& path, const std::string& glsl, const KernelVariant& variant) {
    const glslang::Version glslangVersion = glslang::GetVersion();
    Packer packer;
    packer.add(fmt::format("heliograph {} trimmed glslang {}.{}.{} {}", version(), glslangVersion.major,
                           glslangVersion.minor, glslangVersion.patch, glslangVersion.flavor));
    for (const std::string& text : {path, glsl, variant.generated}) packer.add(text);
    for (const auto& [name, value] : variant.defines) {
        packer.add(name);
        packer.add(value);
    }
    return {reinterpret_cast<const char*>(packer.bytes.data()), packer.bytes.size()};
}

std::filesystem::path fileOf(const std::filesystem::path& folder, std::string_view id) {
    const auto* bytes = reinterpret_cast<const std::byte*>(id.data());
    return folder / fmt::format("{:016x}.bin", gpu::cacheHash({bytes, id.size()}));
}

constexpr std::string_view present = "present";
constexpr std::string_view absent = "absent";

void prune(const std::filesystem::path& folder) {
    std::error_code error;
    std::vector<std::pair<std::filesystem::file_time_type, std::filesystem::path>> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
        files.emplace_back(entry.last_write_time(error), entry.path());
    }
    if (files.size() <= maxSpirvFiles) return;
    std::sort(files.begin(), files.end());
    for (std::size_t i = 0; i < files.size() - maxSpirvFiles; ++i)
        std::filesystem::remove(files[i].second, error);
}

}  // namespace

std::filesystem::path spirvFolder() {
    const std::filesystem::path folder = gpu::defaultPipelineCacheFolder();
    return folder.empty() ? folder : folder / "spirv";
}

std::optional<CompiledGlsl> loadSpirv(const std::string& path, const std::string& glsl,
                                      const KernelVariant& variant) {
    const std::filesystem::path folder = spirvFolder();
    if (folder.empty()) return std::nullopt;
    const std::string id = identity(path, glsl, variant);
    const auto bytes = gpu::readCacheData(fileOf(folder, id));
    if (!bytes) return std::nullopt;
    Unpacker unpacker(*bytes);
    if (unpacker.next() != id) return std::nullopt;
    const auto words = unpacker.next();
    if (!words || words->empty() || words->size() % sizeof(std::uint32_t) != 0) return std::nullopt;
    CompiledGlsl compiled;
    compiled.ok = true;
    compiled.spirv.resize(words->size() / sizeof(std::uint32_t));
    std::memcpy(compiled.spirv.data(), words->data(), words->size());
    while (const auto included = unpacker.next()) {
        const auto state = unpacker.next();
        const auto text = unpacker.next();
        if (!state || !text) return std::nullopt;
        std::optional<std::string> was;
        if (*state == present) was = std::string(*text);
        if (readShaderSource(*included) != was) return std::nullopt;
        compiled.includes.emplace(*included, std::move(was));
    }
    return compiled;
}

void storeSpirv(const std::string& path, const std::string& glsl, const KernelVariant& variant,
                const CompiledGlsl& compiled) {
    const std::filesystem::path folder = spirvFolder();
    if (folder.empty() || !compiled.ok) return;
    const std::string id = identity(path, glsl, variant);
    Packer packer;
    packer.add(id);
    packer.add({reinterpret_cast<const char*>(compiled.spirv.data()),
                compiled.spirv.size() * sizeof(std::uint32_t)});
    for (const auto& [included, text] : compiled.includes) {
        packer.add(included);
        packer.add(text ? present : absent);
        packer.add(text.value_or(""));
    }
    gpu::writeCacheFile(fileOf(folder, id), packer.bytes);
    prune(folder);
}

}  // namespace helio
