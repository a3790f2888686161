#include "engine/shader/source_tree.hpp"

#include "engine/shader/embedded_sources.hpp"

#include <heliograph/kernel.hpp>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <mutex>

namespace helio {
namespace {

struct Tree {
    std::mutex mutex;
    std::map<std::string_view, std::string_view> files;
};

/** Made on first use, so that registration at static initialisation finds it in any order. */
Tree& tree() {
    static Tree* const instance = [] {
        auto* made = new Tree;  // never freed: kernels may be compiled while other statics are destroyed
        for (const ShaderSource& source : libraryShaderSources())
            made->files.emplace(source.path, source.text);
        return made;
    }();
    return *instance;
}

}  // namespace

RegisterShaderSources::RegisterShaderSources(std::initializer_list<ShaderSource> sources) {
    Tree& files = tree();
    const std::scoped_lock lock(files.mutex);
    for (const ShaderSource& source : sources) files.files.emplace(source.path, source.text);
}

std::vector<ShaderSource> embeddedShaderSources() {
    Tree& files = tree();
    const std::scoped_lock lock(files.mutex);
    std::vector<ShaderSource> sources;
    for (const auto& [path, text] : files.files) sources.push_back({path, text});
    return sources;
}

std::filesystem::path shaderOverlay() {
    const char* folder = std::getenv("HELIOGRAPH_SHADER_DIR");
    return folder != nullptr ? std::filesystem::path(folder) : std::filesystem::path();
}

std::optional<std::string> readShaderSource(std::string_view path) {
    const std::filesystem::path relative = std::filesystem::path(path).lexically_normal();
    if (relative.empty() || relative.is_absolute() || *relative.begin() == "..") return std::nullopt;
    if (const std::filesystem::path overlay = shaderOverlay(); !overlay.empty()) {
        if (std::ifstream file(overlay / relative, std::ios::binary); file) {
            return std::string(std::istreambuf_iterator<char>(file), {});
        }
    }
    Tree& files = tree();
    const std::scoped_lock lock(files.mutex);
    const auto found = files.files.find(relative.generic_string());
    if (found == files.files.end()) return std::nullopt;
    return std::string(found->second);
}

}  // namespace helio
