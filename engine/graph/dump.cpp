#include "engine/graph/compile.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <utility>

namespace helio::graph {
namespace {

template <std::size_t N>
std::string joinNames(std::uint32_t bits, const std::pair<std::uint32_t, const char*> (&names)[N]) {
    std::string text;
    for (const auto& [bit, name] : names)
        if ((bits & bit) != 0) text += fmt::format("{}{}", text.empty() ? "" : "|", name);
    return text.empty() ? "none" : text;
}

std::string dotString(const std::string& text) {
    std::string escaped = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') escaped += '\\';
        if (c == '\n')
            escaped += "\\n";
        else
            escaped += c;
    }
    return escaped + "\"";
}

std::string stepName(const Input& input, const Step& step) {
    switch (step.kind) {
        case StepKind::Pass:
            return input.passes[step.index].name;
        case StepKind::Poison:
            return "poison " + input.resources[step.index].name;
        case StepKind::Readback:
            return "readback " + input.resources[input.readbacks[step.index].resource].name;
    }
    return {};
}

const char* stepKindName(StepKind kind) {
    switch (kind) {
        case StepKind::Pass:
            return "pass";
        case StepKind::Poison:
            return "poison";
        case StepKind::Readback:
            return "readback";
    }
    return "";
}

const Placement* placementOf(const Compiled& compiled, std::uint32_t resource) {
    for (const Placement& placement : compiled.placements)
        if (placement.resource == resource) return &placement;
    return nullptr;
}

/** Resources that hold some of the same bytes at other times. */
std::vector<std::uint32_t> sharers(const Compiled& compiled, const Placement& mine) {
    std::vector<std::uint32_t> shared;
    for (const Placement& other : compiled.placements)
        if (other.resource != mine.resource && other.arena == mine.arena &&
            other.offset < mine.offset + mine.bytes && mine.offset < other.offset + other.bytes)
            shared.push_back(other.resource);
    return shared;
}

std::string sizeText(const ResourceInput& resource) {
    if (resource.kind == ResourceKind::Buffer) return fmt::format("{} bytes", resource.bytes);
    return fmt::format("{} x {} {}", resource.size[0], resource.size[1], formatName(resource.format));
}

nlohmann::json barrierJson(const Input& input, const Barrier& barrier) {
    nlohmann::json json{
        {"cause", causeName(barrier.cause)},
        {"from", {{"stages", stageNames(barrier.fromStages)}, {"access", accessNames(barrier.fromAccess)}}},
        {"to", {{"stages", stageNames(barrier.toStages)}, {"access", accessNames(barrier.toAccess)}}}};
    if (barrier.resource != none) {
        json["resource"] = barrier.resource;
        json["name"] = input.resources[barrier.resource].name;
        if (input.resources[barrier.resource].kind == ResourceKind::Image)
            json["layout"] = {{"old", layoutName(barrier.oldLayout)}, {"new", layoutName(barrier.newLayout)}};
    }
    if (!barrier.former.empty()) json["former"] = barrier.former;
    return json;
}

nlohmann::json barriersJson(const Input& input, const std::vector<Barrier>& barriers) {
    nlohmann::json json = nlohmann::json::array();
    for (const Barrier& barrier : barriers) json.push_back(barrierJson(input, barrier));
    return json;
}

nlohmann::json resourceJson(const Input& input, const Compiled& compiled, std::uint32_t index) {
    const ResourceInput& resource = input.resources[index];
    const bool image = resource.kind == ResourceKind::Image;
    nlohmann::json json{{"id", index},
                        {"name", resource.name},
                        {"kind", image ? "image" : "buffer"},
                        {"imported", resource.imported}};
    if (image) {
        json["width"] = resource.size[0];
        json["height"] = resource.size[1];
        json["format"] = formatName(resource.format);
    } else {
        json["bytes"] = resource.bytes;
    }
    json["used"] = std::find(compiled.unusedResources.begin(), compiled.unusedResources.end(), index) ==
                   compiled.unusedResources.end();
    if (const Placement* placement = placementOf(compiled, index)) {
        json["memory"] = {{"arena", placement->arena},    {"offset", placement->offset},
                          {"bytes", placement->bytes},    {"first_step", placement->first},
                          {"last_step", placement->last}, {"shares_with", sharers(compiled, *placement)}};
    }
    return json;
}

}  // namespace

std::string stageNames(Stages stages) {
    static const std::pair<std::uint32_t, const char*> names[] = {
        {stage::Compute, "compute"}, {stage::Indirect, "indirect"}, {stage::Copy, "copy"},
        {stage::Clear, "clear"},     {stage::Host, "host"},         {stage::All, "all"}};
    return joinNames(stages, names);
}

std::string accessNames(Accesses accesses) {
    static const std::pair<std::uint32_t, const char*> names[] = {{access::StorageRead, "storage-read"},
                                                                  {access::StorageWrite, "storage-write"},
                                                                  {access::SampledRead, "sampled-read"},
                                                                  {access::UniformRead, "uniform-read"},
                                                                  {access::IndirectRead, "indirect-read"},
                                                                  {access::TransferRead, "transfer-read"},
                                                                  {access::TransferWrite, "transfer-write"},
                                                                  {access::HostRead, "host-read"},
                                                                  {access::HostWrite, "host-write"},
                                                                  {access::AllWrites, "all-writes"},
                                                                  {access::AllReads, "all-reads"}};
    return joinNames(accesses, names);
}

const char* layoutName(Layout layout) {
    switch (layout) {
        case Layout::Undefined:
            return "undefined";
        case Layout::General:
            return "general";
        case Layout::ShaderRead:
            return "shader-read";
        case Layout::TransferSource:
            return "transfer-source";
        case Layout::TransferDestination:
            return "transfer-destination";
    }
    return "";
}

const char* causeName(Cause cause) {
    switch (cause) {
        case Cause::ReadAfterWrite:
            return "read after write";
        case Cause::WriteAfterRead:
            return "write after read";
        case Cause::WriteAfterWrite:
            return "write after write";
        case Cause::LayoutChange:
            return "layout change";
        case Cause::FirstUse:
            return "first use";
        case Cause::Aliasing:
            return "aliasing";
        case Cause::Execution:
            return "between executions";
        case Cause::HostAccess:
            return "host read";
    }
    return "";
}

std::string dumpJson(const Input& input, const Compiled& compiled) {
    nlohmann::json json;
    json["steps"] = nlohmann::json::array();
    for (const Step& step : compiled.steps) {
        nlohmann::json uses = nlohmann::json::array();
        for (const Use& use : step.uses) {
            nlohmann::json touches = nlohmann::json::array();
            for (const Touch& touch : use.touches)
                touches.push_back(
                    {{"stage", stageNames(touch.stage)}, {"access", accessNames(touch.access)}});
            uses.push_back({{"resource", use.resource},
                            {"name", input.resources[use.resource].name},
                            {"reads", use.reads},
                            {"writes", use.writes},
                            {"version_before", use.versionBefore},
                            {"version_after", use.versionAfter},
                            {"touches", touches}});
        }
        json["steps"].push_back({{"kind", stepKindName(step.kind)},
                                 {"name", stepName(input, step)},
                                 {"uses", uses},
                                 {"barriers", barriersJson(input, step.barriers)}});
    }
    json["entry_barriers"] = barriersJson(input, compiled.entry);
    json["exit_barriers"] = barriersJson(input, compiled.exit);
    json["resources"] = nlohmann::json::array();
    for (std::uint32_t i = 0; i < input.resources.size(); ++i)
        json["resources"].push_back(resourceJson(input, compiled, i));
    json["arenas"] = nlohmann::json::array();
    for (const Arena& arena : compiled.arenas)
        json["arenas"].push_back({{"memory_class", arena.memoryClass}, {"bytes", arena.bytes}});
    json["culled"] = nlohmann::json::array();
    for (const CulledPass& culled : compiled.culledPasses)
        json["culled"].push_back({{"pass", input.passes[culled.pass].name}, {"reason", culled.reason}});
    json["transient_bytes"] = compiled.aliasing.transientBytes;
    json["allocated_bytes"] = compiled.aliasing.allocatedBytes;
    return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string dumpGraphviz(const Input& input, const Compiled& compiled) {
    std::string nodes;
    std::string edges;
    // One node per version of a resource, so that the picture has no cycles.
    std::vector<std::vector<bool>> drawn(input.resources.size());
    const auto version = [&](std::uint32_t resource, std::uint32_t number) {
        std::vector<bool>& known = drawn[resource];
        if (known.size() <= number) known.resize(number + 1, false);
        const std::string id = fmt::format("r{}_{}", resource, number);
        if (known[number]) return id;
        known[number] = true;
        std::string label = fmt::format("{} v{}\n{}", input.resources[resource].name, number,
                                        sizeText(input.resources[resource]));
        if (const Placement* placement = placementOf(compiled, resource)) {
            label += fmt::format("\narena {} at {}", placement->arena, placement->offset);
            std::string names;
            for (const std::uint32_t other : sharers(compiled, *placement))
                names += (names.empty() ? "" : ", ") + input.resources[other].name;
            if (!names.empty()) label += "\nshares with " + names;
        } else {
            label += "\nimported";
        }
        nodes += fmt::format("  {} [shape=ellipse, label={}];\n", id, dotString(label));
        return id;
    };
    for (std::size_t i = 0; i < compiled.steps.size(); ++i) {
        const Step& step = compiled.steps[i];
        std::string label = stepName(input, step);
        for (const Barrier& barrier : step.barriers)
            label += fmt::format(
                "\n{}: {} ({}) to {} ({}){}", causeName(barrier.cause), stageNames(barrier.fromStages),
                accessNames(barrier.fromAccess), stageNames(barrier.toStages), accessNames(barrier.toAccess),
                barrier.resource == none ? "" : " on " + input.resources[barrier.resource].name);
        nodes += fmt::format("  s{} [shape=box, label={}];\n", i, dotString(label));
        for (const Use& use : step.uses) {
            if (use.reads || (use.writes && !use.discards && use.versionBefore > 0))
                edges += fmt::format("  {} -> s{}{};\n", version(use.resource, use.versionBefore), i,
                                     use.reads ? "" : " [style=dotted]");
            if (use.writes)
                edges += fmt::format("  s{} -> {};\n", i, version(use.resource, use.versionAfter));
        }
    }
    for (const CulledPass& culled : compiled.culledPasses)
        nodes += fmt::format("  c{} [shape=box, style=dashed, color=gray, label={}];\n", culled.pass,
                             dotString(input.passes[culled.pass].name + "\nculled: " + culled.reason));
    for (const std::uint32_t resource : compiled.unusedResources)
        nodes += fmt::format("  u{} [shape=ellipse, style=dashed, color=gray, label={}];\n", resource,
                             dotString(input.resources[resource].name + "\nunused"));
    return "digraph plan {\n  rankdir=LR;\n" + nodes + edges + "}\n";
}

}  // namespace helio::graph
