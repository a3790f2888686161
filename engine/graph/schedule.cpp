#include "engine/graph/compile.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace helio::graph {
namespace {

Touch touchOf(Usage usage, Mode mode) {
    const bool reads = mode == Mode::Read || mode == Mode::Modify;
    const bool writes = isWrite(mode);
    switch (usage) {
        case Usage::UniformBuffer:
            return {stage::Compute, access::UniformRead};
        case Usage::UniformTexelBuffer:
        case Usage::SampledImage:
            return {stage::Compute, access::SampledRead};
        case Usage::StorageBuffer:
        case Usage::StorageTexelBuffer:
        case Usage::StorageImage:
            return {stage::Compute, (reads ? access::StorageRead : 0) | (writes ? access::StorageWrite : 0)};
        case Usage::IndirectArguments:
            return {stage::Indirect, access::IndirectRead};
        case Usage::CopySource:
            return {stage::Copy, access::TransferRead};
        case Usage::CopyDestination:
            return {stage::Copy, access::TransferWrite};
        case Usage::Fill:
            return {stage::Clear, access::TransferWrite};
    }
    return {};
}

Layout layoutOf(Usage usage) {
    switch (usage) {
        case Usage::StorageImage:
            return Layout::General;
        case Usage::SampledImage:
            return Layout::ShaderRead;
        default:
            return Layout::Undefined;
    }
}

/** Merges an access into the step's uses. */
void addAccess(std::vector<Use>& uses, const AccessInput& access) {
    auto use = std::find_if(uses.begin(), uses.end(),
                            [&](const Use& known) { return known.resource == access.resource; });
    const Layout layout = layoutOf(access.usage);
    if (use == uses.end()) {
        uses.push_back({.resource = access.resource, .discards = true, .layout = layout, .touches = {}});
        use = uses.end() - 1;
    }
    // One image through storage and sampled bindings at once: only the general layout serves both.
    if (use->layout != layout) use->layout = Layout::General;
    use->reads |= access.mode == Mode::Read || access.mode == Mode::Modify;
    use->writes |= isWrite(access.mode);
    use->discards &= access.mode == Mode::Overwrite;
    const Touch touch = touchOf(access.usage, access.mode);
    for (Touch& known : use->touches) {
        if (known.stage != touch.stage) continue;
        known.access |= touch.access;
        return;
    }
    use->touches.push_back(touch);
}

/** Puts a filling step before each transient's first use. */
std::vector<Step> withPoison(const Input& input, std::vector<Step> steps) {
    std::vector<bool> seen(input.resources.size(), false);
    std::vector<Step> poisoned;
    for (Step& step : steps) {
        for (const Use& use : step.uses) {
            const ResourceInput& resource = input.resources[use.resource];
            if (resource.imported || seen[use.resource]) continue;
            seen[use.resource] = true;
            const bool image = resource.kind == ResourceKind::Image;
            poisoned.push_back({.kind = StepKind::Poison,
                                .index = use.resource,
                                .uses = {{.resource = use.resource,
                                          .writes = true,
                                          .discards = true,
                                          .layout = image ? Layout::TransferDestination : Layout::Undefined,
                                          .touches = {{stage::Clear, access::TransferWrite}}}},
                                .barriers = {}});
        }
        poisoned.push_back(std::move(step));
    }
    return poisoned;
}

std::string nothingNeeds(const Input& input, const PassInput& pass) {
    std::string names;
    for (const AccessInput& access : pass.accesses)
        if (isWrite(access.mode))
            names += fmt::format("{}'{}'", names.empty() ? "" : ", ", input.resources[access.resource].name);
    return names.empty() ? "it writes nothing" : fmt::format("no root needs what it writes: {}", names);
}

}  // namespace

std::vector<std::string> cull(const Input& input) {
    std::vector<std::string> reasons(input.passes.size());
    // Whether a later live step needs what the resource holds at this point of the walk.
    std::vector<bool> needed(input.resources.size(), false);
    for (const ReadbackInput& readback : input.readbacks) needed[readback.resource] = true;
    for (std::size_t i = input.passes.size(); i-- > 0;) {
        const PassInput& pass = input.passes[i];
        bool live = pass.keep;
        for (const AccessInput& access : pass.accesses)
            live |= isWrite(access.mode) &&
                    (needed[access.resource] || input.resources[access.resource].imported);
        if (!live) {
            reasons[i] = nothingNeeds(input, pass);
            continue;
        }
        for (const AccessInput& access : pass.accesses)
            if (access.mode == Mode::Overwrite) needed[access.resource] = false;
        for (const AccessInput& access : pass.accesses)
            if (access.mode != Mode::Overwrite) needed[access.resource] = true;
    }
    return reasons;
}

std::vector<Step> schedule(const Input& input, const std::vector<std::string>& cullReasons) {
    std::vector<Step> steps;
    for (std::uint32_t i = 0; i < input.passes.size(); ++i) {
        if (!cullReasons[i].empty()) continue;
        Step step{.kind = StepKind::Pass, .index = i, .uses = {}, .barriers = {}};
        for (const AccessInput& access : input.passes[i].accesses) addAccess(step.uses, access);
        steps.push_back(std::move(step));
    }
    for (std::uint32_t i = 0; i < input.readbacks.size(); ++i) {
        const std::uint32_t resource = input.readbacks[i].resource;
        const bool image = input.resources[resource].kind == ResourceKind::Image;
        steps.push_back({.kind = StepKind::Readback,
                         .index = i,
                         .uses = {{.resource = resource,
                                   .reads = true,
                                   .layout = image ? Layout::TransferSource : Layout::Undefined,
                                   .touches = {{stage::Copy, access::TransferRead}}}},
                         .barriers = {}});
    }
    if (input.poison) steps = withPoison(input, std::move(steps));

    std::vector<std::uint32_t> version(input.resources.size(), 0);
    for (Step& step : steps) {
        for (Use& use : step.uses) {
            use.versionBefore = version[use.resource];
            if (use.writes) ++version[use.resource];
            use.versionAfter = version[use.resource];
        }
    }
    return steps;
}

Compiled compile(const Input& input) {
    if (std::vector<GraphProblem> problems = validate(input); !problems.empty())
        throw GraphError(std::move(problems));
    Compiled compiled;
    const std::vector<std::string> reasons = cull(input);
    for (std::uint32_t i = 0; i < reasons.size(); ++i)
        if (!reasons[i].empty()) compiled.culledPasses.push_back({i, reasons[i]});
    compiled.steps = schedule(input, reasons);

    std::vector<bool> used(input.resources.size(), false);
    for (const Step& step : compiled.steps)
        for (const Use& use : step.uses) used[use.resource] = true;
    for (std::uint32_t i = 0; i < used.size(); ++i)
        if (!used[i]) compiled.unusedResources.push_back(i);

    place(input, compiled);
    synchronize(input, compiled);
    return compiled;
}

}  // namespace helio::graph
