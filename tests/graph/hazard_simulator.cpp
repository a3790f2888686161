#include "tests/graph/hazard_simulator.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace helio::graph {
namespace {

constexpr Stages everyStage = stage::Compute | stage::Indirect | stage::Copy | stage::Clear;

Stages expandStages(Stages stages) {
    return (stages & stage::All) != 0 ? (stages | everyStage) & ~stage::All : stages;
}

bool isWrite(Accesses accessBit) {
    return accessBit == access::StorageWrite || accessBit == access::TransferWrite;
}

/** Whether an access mask of a barrier covers one access. */
bool covers(Accesses mask, Accesses accessBit) {
    if ((mask & accessBit) != 0) return true;
    return (mask & (isWrite(accessBit) ? access::AllWrites : access::AllReads)) != 0;
}

std::uint64_t mix(std::uint64_t a, std::uint64_t b) {
    std::uint64_t x = a * 0x9e3779b97f4a7c15ull + b + 0x632be59bd9b4e019ull;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
    return x ^ (x >> 31);
}

/** Whether Vulkan allows these accesses to an image in this layout. */
bool layoutServes(Layout layout, Accesses accesses) {
    switch (layout) {
        case Layout::Undefined:
            return false;
        case Layout::General:
            return true;
        case Layout::ShaderRead:
            return accesses == access::SampledRead;
        case Layout::TransferSource:
            return accesses == access::TransferRead;
        case Layout::TransferDestination:
            return accesses == access::TransferWrite;
    }
    return false;
}

/** Symbols of every resource before and after every declared pass, run in order on separate memory. */
struct Reference {
    std::vector<std::map<std::uint32_t, std::uint64_t>> before, after;  ///< by pass, by resource
    std::vector<std::uint64_t> last;
};

Reference interpret(const Input& input, std::vector<std::uint64_t> values, std::uint64_t salt) {
    Reference reference;
    for (std::size_t i = 0; i < input.passes.size(); ++i) {
        std::map<std::uint32_t, std::uint64_t> before, after;
        std::uint64_t seen = mix(salt, i + 1);
        for (const AccessInput& a : input.passes[i].accesses) {
            before[a.resource] = values[a.resource];
            if (a.mode == Mode::Read || a.mode == Mode::Modify) seen = mix(seen, values[a.resource]);
        }
        for (const AccessInput& a : input.passes[i].accesses) {
            if (a.mode == Mode::Read) continue;
            // What a partial write leaves alone shows in the value.
            const std::uint64_t kept = a.mode == Mode::Overwrite ? 0 : values[a.resource];
            after[a.resource] = mix(mix(seen, a.resource + 1), kept);
        }
        for (const auto& [resource, value] : after) values[resource] = value;
        reference.before.push_back(std::move(before));
        reference.after.push_back(std::move(after));
    }
    reference.last = values;
    return reference;
}

}  // namespace

HazardSimulator::Place HazardSimulator::locate(const Input& input, const Compiled& compiled,
                                               std::uint32_t resource, std::uint32_t plan) const {
    const ResourceInput& declared = input.resources[resource];
    if (declared.imported) {
        const std::string name = "imported " + declared.name;
        return {name, name, 0, cell};
    }
    for (const Placement& p : compiled.placements)
        if (p.resource == resource)
            return {fmt::format("{}.{}", plan, declared.name), fmt::format("{}.{}", plan, p.arena), p.offset,
                    p.offset + p.bytes};
    return {fmt::format("{}.{} (not placed)", plan, declared.name), "nowhere", 0, 0};
}

void HazardSimulator::barriers(const std::vector<Barrier>& list, const Input& input, const Compiled& compiled,
                               std::uint32_t plan) {
    std::vector<const Barrier*> memory, others;
    for (const Barrier& barrier : list) (barrier.resource == none ? memory : others).push_back(&barrier);
    command(memory, input, compiled, plan);
    command(others, input, compiled, plan);
}

void HazardSimulator::command(const std::vector<const Barrier*>& batch, const Input& input,
                              const Compiled& compiled, std::uint32_t plan) {
    if (batch.empty()) return;
    // Barriers of one command do not chain with one another: all start from the same past.
    struct Before {
        Stages chained;
        bool available;
    };
    std::vector<Before> before;
    for (const Past& old : past_) before.push_back({old.chained, old.available});
    std::vector<Past> changes;
    for (const Barrier* barrier : batch) {
        const Stages from = expandStages(barrier->fromStages);
        const Stages to = expandStages(barrier->toStages);
        Place place;
        if (barrier->resource != none) place = locate(input, compiled, barrier->resource, plan);
        const bool relayout = barrier->resource != none && barrier->oldLayout != barrier->newLayout;
        for (std::size_t i = 0; i < before.size(); ++i) {
            Past& old = past_[i];
            const bool inScope = (from & (old.stage | before[i].chained)) != 0;
            const bool sameMemory = barrier->resource == none || place.resource == old.resource;
            bool available = before[i].available;
            if (inScope) old.chained |= to;
            if (inScope && old.write && sameMemory) {
                available |= (from & old.stage) != 0 && covers(barrier->fromAccess, old.access);
                old.available |= available;
                if (available)
                    for (Stages bit = 1; bit < 32; bit <<= 1)
                        if ((to & bit) != 0) old.visible[bit] |= barrier->toAccess;
            }
            if (relayout && old.arena == place.arena && old.begin < place.end && place.begin < old.end &&
                (!inScope || (old.write && !available)))
                faults_.push_back(
                    fmt::format("layout change of {} is not after {}", place.resource, old.what));
        }
        if (!relayout) continue;
        Layout& layout =
            layouts_
                .try_emplace(place.resource, input.resources[barrier->resource].imported ? Layout::General
                                                                                         : Layout::Undefined)
                .first->second;
        if (barrier->oldLayout != Layout::Undefined && layout != barrier->oldLayout)
            faults_.push_back(
                fmt::format("layout change of {} starts from the wrong layout", place.resource));
        layout = barrier->newLayout;
        if (barrier->oldLayout == Layout::Undefined) setContents(place, mix(++step_, 0xdead));
        Past change{.resource = place.resource,
                    .arena = place.arena,
                    .begin = place.begin,
                    .end = place.end,
                    .write = true,
                    .chained = to,
                    .available = true,
                    .visible = {},
                    .what = "layout change of " + place.resource};
        for (Stages bit = 1; bit < 32; bit <<= 1)
            if ((to & bit) != 0) change.visible[bit] = barrier->toAccess;
        changes.push_back(std::move(change));
    }
    past_.insert(past_.end(), changes.begin(), changes.end());
}

void HazardSimulator::touch(const Place& place, Stages stage, Accesses accessBit, const std::string& what) {
    const bool write = isWrite(accessBit);
    // Stale data of others in this memory need not be visible once the resource's own write follows them.
    std::size_t ownWrite = 0;
    for (std::size_t i = 0; i < past_.size(); ++i)
        if (past_[i].write && past_[i].resource == place.resource && past_[i].stage != stage::None)
            ownWrite = i;
    for (std::size_t i = 0; i < past_.size(); ++i) {
        const Past& old = past_[i];
        if (old.arena != place.arena || old.end <= place.begin || place.end <= old.begin) continue;
        if (!old.write && !write) continue;
        if (old.step == step_ && old.stage != stage::None) {
            if (old.resource != place.resource)
                faults_.push_back(fmt::format("{} is in the memory of {}", what, old.what));
            continue;
        }
        const bool ordered = (old.chained & stage) != 0;
        if (old.write && !write) {
            if (old.resource != place.resource && i < ownWrite) continue;
            const auto seen = old.visible.find(stage);
            if (seen == old.visible.end() || !covers(seen->second, accessBit))
                faults_.push_back(fmt::format("{} may not see {}", what, old.what));
        } else if (!ordered || (old.write && !old.available)) {
            faults_.push_back(fmt::format("{} may overtake {}", what, old.what));
        }
    }
    past_.push_back({.resource = place.resource,
                     .arena = place.arena,
                     .begin = place.begin,
                     .end = place.end,
                     .stage = stage,
                     .access = accessBit,
                     .write = write,
                     .visible = {},
                     .step = step_,
                     .what = what});
}

void HazardSimulator::checkContents(const Place& place, std::uint64_t expected, const std::string& what) {
    std::vector<std::uint64_t>& cells = memory_[place.arena];
    if (cells.size() < (place.end + cell - 1) / cell) cells.resize((place.end + cell - 1) / cell, 0);
    for (std::uint64_t i = place.begin / cell; i < (place.end + cell - 1) / cell; ++i) {
        if (cells[i] == expected) continue;
        faults_.push_back(fmt::format("{} finds another value than it should at byte {}", what, i * cell));
        return;
    }
}

void HazardSimulator::setContents(const Place& place, std::uint64_t value) {
    std::vector<std::uint64_t>& cells = memory_[place.arena];
    if (cells.size() < (place.end + cell - 1) / cell) cells.resize((place.end + cell - 1) / cell, 0);
    for (std::uint64_t i = place.begin / cell; i < (place.end + cell - 1) / cell; ++i) cells[i] = value;
}

void HazardSimulator::execute(const Input& input, const Compiled& compiled, std::uint32_t plan) {
    ++execution_;
    std::vector<std::uint64_t> values(input.resources.size(), 0);
    for (std::size_t i = 0; i < values.size(); ++i)
        if (input.resources[i].imported)
            values[i] = importedReference_["imported " + input.resources[i].name];
    const Reference reference = interpret(input, values, mix(plan, execution_));
    std::vector<std::size_t> firstWriter(input.resources.size(), input.passes.size());
    for (std::size_t i = input.passes.size(); i-- > 0;)
        for (const AccessInput& a : input.passes[i].accesses)
            if (a.mode != Mode::Read) firstWriter[a.resource] = i;

    barriers(compiled.entry, input, compiled, plan);
    for (const Step& step : compiled.steps) {
        barriers(step.barriers, input, compiled, plan);
        ++step_;
        const std::string name = step.kind == StepKind::Pass       ? input.passes[step.index].name
                                 : step.kind == StepKind::Readback ? "readback"
                                                                   : "poison";
        for (const Use& use : step.uses) {
            const Place place = locate(input, compiled, use.resource, plan);
            const std::string what = fmt::format("{} (run {}) on {}", name, execution_, place.resource);
            if (input.resources[use.resource].kind == ResourceKind::Image) {
                const Layout initial =
                    input.resources[use.resource].imported ? Layout::General : Layout::Undefined;
                if (layouts_.try_emplace(place.resource, initial).first->second != use.layout)
                    faults_.push_back(what + " finds another layout than it should");
                for (const Touch& each : use.touches)
                    if (!layoutServes(use.layout, each.access))
                        faults_.push_back(what + " is in a layout that does not serve its accesses");
            }
            for (const Touch& each : use.touches)
                for (Accesses bit = 1; bit != 0 && bit < access::AllWrites; bit <<= 1)
                    if ((each.access & bit) != 0) touch(place, each.stage, bit, what);

            if (step.kind == StepKind::Poison) {
                setContents(place, mix(step_, 0xdead));
            } else if (step.kind == StepKind::Readback) {
                checkContents(place, reference.last[use.resource], what);
            } else {
                // A transient's first write is whole; any other write that is not leaves the rest as it was.
                const bool isFresh =
                    firstWriter[use.resource] == step.index && !input.resources[use.resource].imported;
                if (use.reads || (!use.discards && !isFresh))
                    checkContents(place, reference.before[step.index].at(use.resource), what);
                if (use.writes) setContents(place, reference.after[step.index].at(use.resource));
            }
        }
    }
    barriers(compiled.exit, input, compiled, plan);
    for (std::uint32_t i = 0; i < input.resources.size(); ++i) {
        if (!input.resources[i].imported) continue;
        const Place place = locate(input, compiled, i, plan);
        importedReference_[place.resource] = reference.last[i];
        checkContents(place, reference.last[i],
                      "the imported resource after the run, " + place.resource + ",");
        if (input.resources[i].kind == ResourceKind::Image &&
            layouts_.try_emplace(place.resource, Layout::General).first->second != Layout::General)
            faults_.push_back(place.resource + " is not left in the general layout");
    }
}

}  // namespace helio::graph
