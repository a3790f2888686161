#include "engine/shader/kernel_cache.hpp"

#include "engine/shader/glsl_compiler.hpp"
#include "engine/shader/source_tree.hpp"
#include "engine/shader/spirv_files.hpp"
#include "engine/shader/spirv_trimmer.hpp"
#include "engine/shader/spirv_validator.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <tuple>

namespace helio {
namespace {

/** Everything that decides a kernel's words but the files it includes. */
using Key = std::tuple<std::string, std::string, std::map<std::string, std::string>, std::string>;
using Result = std::shared_ptr<const CompiledGlsl>;

/** A kernel's name and text when it is in no file. */
struct RuntimeSource {
    std::string name;
    std::string text;
};

struct Cache {
    std::mutex mutex;
    std::map<Key, std::shared_future<Result>> kernels;
    /** Results that an edit on disk replaced: kernels still refer to their words. */
    std::vector<Result> replaced;
    std::map<std::string, RuntimeSource, std::less<>> runtimeSources;  ///< by Kernel::source
    std::map<std::string, std::unique_ptr<std::string>, std::less<>> names;
    std::set<const std::uint32_t*> words;  ///< of everything compiled, never freed
    std::atomic<std::uint64_t> compiled{0};
    std::atomic<std::uint64_t> loaded{0};
    std::atomic<std::uint64_t> reused{0};
};

Cache& cache() {
    static auto* const instance = new Cache;  // never freed: kernels refer to it
    return *instance;
}

/** A view of the text that stays valid. */
std::string_view intern(std::string_view text) {
    Cache& c = cache();
    const std::scoped_lock lock(c.mutex);
    auto found = c.names.find(text);
    if (found == c.names.end()) {
        found = c.names.emplace(std::string(text), std::make_unique<std::string>(text)).first;
    }
    return *found->second;
}

/** Whether a file of a folder laid over the embedded ones has changed, or come, or gone. */
bool stale(const CompiledGlsl& result) {
    return std::any_of(result.includes.begin(), result.includes.end(),
                       [](const auto& file) { return readShaderSource(file.first) != file.second; });
}

CompiledGlsl loadOrCompile(const std::string& path, const std::string& glsl, const KernelVariant& variant,
                           KeepOnDisk keep) {
    Cache& c = cache();
    if (keep == KeepOnDisk::Yes) {
        if (auto loaded = loadSpirv(path, glsl, variant)) {
            ++c.loaded;
            return std::move(*loaded);
        }
    }
    ++c.compiled;
    CompiledGlsl compiled = compileGlsl(path, glsl, variant);
    // A variant is made to leave things out.
    if (compiled.ok && !variant.defines.empty()) compiled.spirv = trimmedSpirv(std::move(compiled.spirv));
    if (keep == KeepOnDisk::Yes) storeSpirv(path, glsl, variant, compiled);
    return compiled;
}

Kernel makeKernel(std::string_view name, std::string_view source, const Result& result) {
    if (!result->ok)
        throw ShaderError(fmt::format("kernel '{}' does not compile:\n{}", name, result->messages));
    return {name, result->spirv, source};
}

}  // namespace

std::shared_ptr<const CompiledGlsl> compileCached(const std::string& path, const std::string& glsl,
                                                  const KernelVariant& variant, KeepOnDisk keep) {
    Cache& c = cache();
    const Key key{path, glsl, variant.defines, variant.generated};
    std::promise<Result> promise;
    std::shared_future<Result> known;
    {
        const std::scoped_lock lock(c.mutex);
        if (const auto found = c.kernels.find(key); found != c.kernels.end()) known = found->second;
        if (!known.valid()) c.kernels.emplace(key, promise.get_future().share());
    }
    if (known.valid()) {
        Result result = known.get();
        if (!stale(*result)) {
            ++c.reused;
            return result;
        }
        const std::scoped_lock lock(c.mutex);
        c.replaced.push_back(std::move(result));
        c.kernels.insert_or_assign(key, promise.get_future().share());
    }
    try {
        const auto result = std::make_shared<const CompiledGlsl>(loadOrCompile(path, glsl, variant, keep));
        {
            const std::scoped_lock lock(c.mutex);
            c.words.insert(result->spirv.data());
        }
        promise.set_value(result);
        return result;
    } catch (...) {  // out of memory: those who wait get it too, those who come later try again
        promise.set_exception(std::current_exception());
        const std::scoped_lock lock(c.mutex);
        c.kernels.erase(key);
        throw;
    }
}

bool isCompiledHere(std::span<const std::uint32_t> spirv) {
    Cache& c = cache();
    const std::scoped_lock lock(c.mutex);
    return c.words.contains(spirv.data());
}

KernelCacheStatistics kernelCacheStatistics() {
    return {cache().compiled, cache().loaded, cache().reused};
}

Kernel compileVariant(const Kernel& kernel, const KernelVariant& variant) {
    std::string path(kernel.source);
    std::optional<std::string> text = readShaderSource(kernel.source);
    if (!text) {
        Cache& c = cache();
        const std::scoped_lock lock(c.mutex);
        if (const auto found = c.runtimeSources.find(kernel.source); found != c.runtimeSources.end()) {
            path = found->second.name;
            text = found->second.text;
        }
    }
    if (!text) {
        throw ShaderError(fmt::format("kernel '{}': its source '{}' is not in the embedded tree", kernel.name,
                                      kernel.source));
    }
    return makeKernel(intern(kernel.name), intern(kernel.source),
                      compileCached(path, *text, variant, KeepOnDisk::Yes));
}

Kernel overlaid(const Kernel& kernel) {
    if (shaderOverlay().empty() || !isEmbedded(kernel.spirv) || !readShaderSource(kernel.source))
        return kernel;
    return compileVariant(kernel, {});
}

Kernel compileKernel(std::string_view name, std::string_view glsl, const KernelVariant& variant) {
    const Result result = compileCached(std::string(name), std::string(glsl), variant, KeepOnDisk::No);
    const std::string source = fmt::format("runtime/{}/{:016x}", name, std::hash<std::string_view>{}(glsl));
    Cache& c = cache();
    {
        const std::scoped_lock lock(c.mutex);
        c.runtimeSources.try_emplace(source, RuntimeSource{std::string(name), std::string(glsl)});
    }
    return makeKernel(intern(name), intern(source), result);
}

}  // namespace helio
