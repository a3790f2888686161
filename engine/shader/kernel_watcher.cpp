#include "engine/core/log.hpp"
#include "engine/shader/glsl_compiler.hpp"
#include "engine/shader/kernel_cache.hpp"
#include "engine/shader/source_tree.hpp"

#include <heliograph/error.hpp>
#include <heliograph/kernel.hpp>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace helio {

struct KernelWatcher::Impl {
    Kernel kernel;
    KernelVariant variant;
    std::string problem;
    /** Files of the last attempt, with the text they had then. Empty before the first. */
    std::map<std::string, std::optional<std::string>> files;

    bool changed() const {
        if (files.empty()) return true;
        return std::any_of(files.begin(), files.end(),
                           [](const auto& file) { return readShaderSource(file.first) != file.second; });
    }
};

KernelWatcher::KernelWatcher(const Kernel& kernel, KernelVariant variant)
    : impl_(std::make_unique<Impl>(Impl{kernel, std::move(variant), {}, {}})) {}
KernelWatcher::~KernelWatcher() = default;
KernelWatcher::KernelWatcher(KernelWatcher&&) noexcept = default;
KernelWatcher& KernelWatcher::operator=(KernelWatcher&&) noexcept = default;

const Kernel& KernelWatcher::kernel() const {
    return impl_->kernel;
}
const std::string& KernelWatcher::problem() const {
    return impl_->problem;
}

bool KernelWatcher::poll() {
    if (shaderOverlay().empty() || !impl_->changed()) return false;
    const std::string path(impl_->kernel.source);
    const std::optional<std::string> text = readShaderSource(path);
    // Files of a broken attempt are known only up to the fault: those of the attempt before stay watched.
    std::map<std::string, std::optional<std::string>> files;
    for (const auto& [watched, was] : impl_->files) files[watched] = readShaderSource(watched);
    files[path] = text;
    const auto failed = [&](const std::string& problem) {
        impl_->files = std::move(files);
        if (problem != impl_->problem)
            log().warn("kernel '{}' keeps its last good state:\n{}", impl_->kernel.name, problem);
        impl_->problem = problem;
        return false;
    };
    if (!text) return failed(path + ": not found");
    const std::shared_ptr<const CompiledGlsl> result =
        compileCached(path, *text, impl_->variant, KeepOnDisk::No);
    for (const auto& [included, was] : result->includes) files[included] = was;
    if (!result->ok) return failed(result->messages);
    impl_->files = std::move(files);
    impl_->problem.clear();
    if (std::ranges::equal(result->spirv, impl_->kernel.spirv))
        return false;  // a comment, or back to what it was
    impl_->kernel.spirv = result->spirv;
    return true;
}

}  // namespace helio
