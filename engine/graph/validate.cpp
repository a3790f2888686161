#include "engine/graph/compile.hpp"

#include <fmt/format.h>

#include <map>
#include <set>

namespace helio::graph {
namespace {

/** Whether a mode asks for contents that an earlier pass must have left. */
bool needsContents(Mode mode) {
    return mode == Mode::Read || mode == Mode::Modify;
}

bool isImageUsage(Usage usage) {
    return usage == Usage::StorageImage || usage == Usage::SampledImage;
}

const char* declaration(Mode mode) {
    switch (mode) {
        case Mode::Read:
            return "reads()";
        case Mode::Write:
            return "writes()";
        case Mode::Overwrite:
            return "overwrites()";
        case Mode::Modify:
            return "modifies()";
    }
    return "";
}

std::uint64_t endOf(const Window& window, std::uint64_t size) {
    return window.bytes == 0 ? size : window.offset + window.bytes;
}

class Validator {
public:
    explicit Validator(const Input& input) : input_(input), written_(input.resources.size(), false) {}

    std::vector<GraphProblem> run() {
        for (const ResourceInput& resource : input_.resources) checkResource(resource);
        for (const PassInput& pass : input_.passes) checkPass(pass);
        for (const ReadbackInput& readback : input_.readbacks) checkReadback(readback);
        checkRoots();
        return std::move(problems_);
    }

private:
    void report(std::string pass, std::string binding, std::string resource, std::string message) {
        problems_.push_back({std::move(pass), std::move(binding), std::move(resource), std::move(message)});
    }

    void checkResource(const ResourceInput& resource) {
        if (resource.kind == ResourceKind::Buffer && resource.bytes == 0)
            report("", "", resource.name,
                   "has 0 bytes; give it at least 4, or leave the buffer and its passes out");
        if (resource.kind == ResourceKind::Image && (resource.size[0] == 0 || resource.size[1] == 0))
            report("", "", resource.name,
                   fmt::format(
                       "is {} x {} texels; give each side at least 1, or leave the image and its passes out",
                       resource.size[0], resource.size[1]));
        if (resource.kind == ResourceKind::Image && resource.format == Format::Undefined)
            report("", "", resource.name, "has no format; name one, e.g. Format::RGBA32F");
        if (!resource.imported && resource.memoryBytes > input_.limits.maxArenaBytes)
            report("", "", resource.name,
                   fmt::format("needs {} bytes, more than the device allocates at once ({}); split it",
                               resource.memoryBytes, input_.limits.maxArenaBytes));
    }

    /** Whether the handle is one of this graph; reports where not. */
    bool checkHandle(const std::string& pass, const std::string& binding, std::uint32_t resource,
                     std::uint32_t graph) {
        if (resource == none) {
            report(pass, binding, "",
                   "has an empty handle; declare the resource with buffer(), image() or import()");
            return false;
        }
        if (graph != input_.graph || resource >= input_.resources.size()) {
            report(pass, binding, "",
                   "has a handle of another graph; declare or import the resource in this graph and use that "
                   "handle");
            return false;
        }
        return true;
    }

    void checkPass(const PassInput& pass) {
        std::set<std::string> names;
        std::map<std::uint32_t, std::vector<const AccessInput*>> byResource;
        for (const AccessInput& access : pass.accesses) {
            // Indirect arguments, fills and copies have no binding of a shader.
            const bool isBinding = access.usage != Usage::IndirectArguments &&
                                   access.usage != Usage::CopySource &&
                                   access.usage != Usage::CopyDestination && access.usage != Usage::Fill;
            if (isBinding && access.binding.empty())
                report(pass.name, "", resourceName(access),
                       "has a binding without a name; give the shader's name");
            else if (isBinding && !names.insert(access.binding).second)
                report(pass.name, access.binding, resourceName(access),
                       "is declared twice; declare it once, with modifies() where it is read and written");
            if (!checkHandle(pass.name, access.binding, access.resource, access.graph)) continue;
            checkAccess(pass, access);
            byResource[access.resource].push_back(&access);
        }
        for (const auto& [resource, accesses] : byResource) checkOverlap(pass, accesses);
        for (const AccessInput& access : pass.accesses)
            if (access.graph == input_.graph && access.resource < written_.size() && isWrite(access.mode))
                written_[access.resource] = true;
    }

    std::string resourceName(const AccessInput& access) const {
        return access.graph == input_.graph && access.resource < input_.resources.size()
                   ? input_.resources[access.resource].name
                   : "";
    }

    void checkAccess(const PassInput& pass, const AccessInput& access) {
        const ResourceInput& resource = input_.resources[access.resource];
        const bool image = resource.kind == ResourceKind::Image;
        if (image != isImageUsage(access.usage))
            report(pass.name, access.binding, resource.name,
                   image ? "is an image where a buffer belongs; bind a buffer"
                         : "is a buffer where an image belongs; bind an image");
        if (!resource.imported && !written_[access.resource] && needsContents(access.mode))
            report(pass.name, access.binding, resource.name,
                   fmt::format(
                       "is {} before any pass writes it; declare a pass that writes it earlier, or import it",
                       access.mode == Mode::Read ? "read" : "modified"));
        if (isWrite(access.mode) &&
            (access.usage == Usage::UniformBuffer || access.usage == Usage::UniformTexelBuffer ||
             access.usage == Usage::SampledImage))
            report(
                pass.name, access.binding, resource.name,
                fmt::format(
                    "cannot be written through a uniform or sampled binding; declare it with reads(), not {}",
                    declaration(access.mode)));
        if (image) return;
        const Window& window = access.window;
        // The sum could wrap, so compare by subtraction.
        if (window.offset >= resource.bytes ? resource.bytes > 0
                                            : window.bytes > resource.bytes - window.offset)
            report(pass.name, access.binding, resource.name,
                   fmt::format("is bound at bytes {} to {} but has {}; move the window inside", window.offset,
                               window.bytes == 0 ? std::string("its end")
                                                 : fmt::format("{}", window.offset + window.bytes),
                               resource.bytes));
        if (access.mode == Mode::Overwrite &&
            (window.offset != 0 || endOf(window, resource.bytes) != resource.bytes))
            report(pass.name, access.binding, resource.name,
                   "is overwritten through a window that leaves bytes out; declare it with writes()");
    }

    /** Bindings of one resource in one pass run at once: only reads, or declared modifies, may overlap. */
    void checkOverlap(const PassInput& pass, const std::vector<const AccessInput*>& accesses) {
        for (std::size_t i = 0; i < accesses.size(); ++i) {
            for (std::size_t j = i + 1; j < accesses.size(); ++j) {
                const AccessInput& a = *accesses[i];
                const AccessInput& b = *accesses[j];
                if (!isWrite(a.mode) && !isWrite(b.mode)) continue;
                if (a.mode == Mode::Modify && b.mode == Mode::Modify) continue;
                const ResourceInput& resource = input_.resources[a.resource];
                const bool disjoint = resource.kind == ResourceKind::Buffer &&
                                      (endOf(a.window, resource.bytes) <= b.window.offset ||
                                       endOf(b.window, resource.bytes) <= a.window.offset);
                if (disjoint) continue;
                report(
                    pass.name, b.binding, resource.name,
                    fmt::format("overlaps binding '{}' of the same pass, and one of them is written; use one "
                                "binding with modifies(), windows that do not overlap, or two passes",
                                a.binding));
            }
        }
    }

    void checkReadback(const ReadbackInput& readback) {
        if (!checkHandle("", "readback", readback.resource, readback.graph)) return;
        const ResourceInput& resource = input_.resources[readback.resource];
        if (!resource.imported && !written_[readback.resource])
            report("", "readback", resource.name,
                   "is read back but no pass writes it; declare a pass that writes it, or import it");
    }

    /** A graph that runs nothing is a mistake, not an empty plan. */
    void checkRoots() {
        if (input_.passes.empty() || !input_.readbacks.empty()) return;
        for (const PassInput& pass : input_.passes) {
            if (pass.keep) return;
            for (const AccessInput& access : pass.accesses)
                if (isWrite(access.mode) && access.graph == input_.graph &&
                    access.resource < written_.size() && input_.resources[access.resource].imported)
                    return;
        }
        report("", "", "",
               "no pass is needed; read a resource back, write an imported one, or mark a pass with keep()");
    }

    const Input& input_;
    std::vector<bool> written_;  ///< by a pass so far
    std::vector<GraphProblem> problems_;
};

}  // namespace

std::vector<GraphProblem> validate(const Input& input) {
    return Validator(input).run();
}

}  // namespace helio::graph
