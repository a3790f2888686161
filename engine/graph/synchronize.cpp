#include "engine/graph/compile.hpp"

#include <algorithm>
#include <array>

namespace helio::graph {
namespace {

constexpr std::array<Stages, 5> eachStage = {stage::Compute, stage::Indirect, stage::Copy, stage::Clear,
                                             stage::Host};

Stages stagesOf(const Use& use) {
    Stages stages = stage::None;
    for (const Touch& touch : use.touches) stages |= touch.stage;
    return stages;
}
Accesses accessesOf(const Use& use) {
    Accesses accesses = access::None;
    for (const Touch& touch : use.touches) accesses |= touch.access;
    return accesses;
}

/** What has happened to a resource so far in this execution. */
struct State {
    bool touched = false;
    bool everythingVisible = false;  ///< by the barrier that opens the execution
    Layout layout = Layout::Undefined;
    Stages writeStages = stage::None;  ///< of the last write, or where the last layout change handed over
    Accesses writeAccess =
        access::None;                 ///< of the last write; none after a layout change, which is available
    Stages readStages = stage::None;  ///< reads since the last write
    std::array<Accesses, eachStage.size()> visible = {};  ///< the last write, per stage

    bool sees(const Use& use) const {
        if (everythingVisible) return true;
        for (const Touch& touch : use.touches)
            for (std::size_t i = 0; i < eachStage.size(); ++i)
                if ((touch.stage & eachStage[i]) != 0 && (touch.access & ~visible[i]) != 0) return false;
        return true;
    }
    void makeVisible(const Use& use) {
        for (const Touch& touch : use.touches)
            for (std::size_t i = 0; i < eachStage.size(); ++i)
                if ((touch.stage & eachStage[i]) != 0) visible[i] |= touch.access;
    }
};

class Synchronizer {
public:
    Synchronizer(const Input& input, Compiled& compiled)
        : input_(input),
          compiled_(compiled),
          states_(input.resources.size()),
          placement_(input.resources.size()) {
        for (std::size_t i = 0; i < states_.size(); ++i) {
            const bool imported = input.resources[i].imported;
            states_[i].everythingVisible = imported;
            // Between plans, imported images rest in the general layout.
            if (imported && input.resources[i].kind == ResourceKind::Image)
                states_[i].layout = Layout::General;
        }
        for (const Placement& placement : compiled.placements) placement_[placement.resource] = &placement;
    }

    void run() {
        // Earlier executions, of this plan or another, may have touched the imported resources and the very
        // memory of the transients, and uploads may have filled the imported ones.
        compiled_.entry.push_back({.fromStages = stage::All,
                                   .fromAccess = access::AllWrites,
                                   .toStages = stage::All,
                                   .toAccess = access::AllReads | access::AllWrites,
                                   .cause = Cause::Execution});
        for (Step& step : compiled_.steps) {
            for (const Use& use : step.uses) visit(step, use);
            // Memory barriers come first: a layout change waits for them.
            std::stable_partition(step.barriers.begin(), step.barriers.end(),
                                  [](const Barrier& barrier) { return barrier.resource == none; });
        }
        finish();
    }

private:
    void visit(Step& step, const Use& use) {
        State& state = states_[use.resource];
        const bool transient = !input_.resources[use.resource].imported;
        if (transient && !state.touched)
            firstUse(step, use, state);
        else
            follow(step, use, state);
        state.touched = true;
        state.layout = use.layout;
        if (use.writes) {
            state.everythingVisible = false;
            state.writeStages = stagesOf(use);
            state.writeAccess = accessesOf(use) & access::Writes;
            state.readStages = stage::None;
            state.visible = {};
        } else {
            state.readStages |= stagesOf(use);
        }
    }

    /** A transient takes its memory over from those that held it before, and an image its layout. */
    void firstUse(Step& step, const Use& use, State& state) {
        Barrier handOver{.toStages = stagesOf(use), .toAccess = accessesOf(use), .cause = Cause::Aliasing};
        const Placement& mine = *placement_[use.resource];
        for (const Placement& other : compiled_.placements) {
            if (other.resource == mine.resource || other.arena != mine.arena || other.last >= mine.first)
                continue;
            if (other.offset + other.bytes <= mine.offset || mine.offset + mine.bytes <= other.offset)
                continue;
            const State& former = states_[other.resource];
            handOver.fromStages |= former.writeStages | former.readStages;
            handOver.fromAccess |= former.writeAccess;
            handOver.former.push_back(other.resource);
        }
        if (!handOver.former.empty()) step.barriers.push_back(handOver);
        if (use.layout != state.layout) {
            step.barriers.push_back({.resource = use.resource,
                                     // Follows the barrier above, or the one that opens the execution. The
                                     // access chains them for the synchronization validation too.
                                     .fromStages = stagesOf(use),
                                     .fromAccess = accessesOf(use) & access::Writes,
                                     .toStages = stagesOf(use),
                                     .toAccess = accessesOf(use),
                                     .oldLayout = Layout::Undefined,
                                     .newLayout = use.layout,
                                     .cause = Cause::FirstUse});
        }
    }

    void follow(Step& step, const Use& use, State& state) {
        const bool relayout = use.layout != state.layout;
        Barrier barrier{.resource = use.resource,
                        .fromStages = state.writeStages,
                        .fromAccess = state.writeAccess,
                        .toStages = stagesOf(use),
                        .toAccess = accessesOf(use),
                        .oldLayout = state.layout,
                        .newLayout = use.layout};
        if (relayout || use.writes) {
            // A layout change is a write: it waits for the readers too.
            barrier.fromStages |= state.readStages;
            barrier.cause = !use.writes                       ? Cause::LayoutChange
                            : state.readStages != stage::None ? Cause::WriteAfterRead
                                                              : Cause::WriteAfterWrite;
            if (use.reads && use.writes && state.writeStages != stage::None)
                barrier.cause = Cause::ReadAfterWrite;
            if (relayout && use.discards) barrier.oldLayout = Layout::Undefined;
            // An imported resource not yet touched in this execution: the opening barrier has done it all.
            if (barrier.fromStages == stage::None) {
                if (!relayout) return;
                // A change of layout writes: it names the earlier executions' accesses itself, for the
                // synchronization validation chains the opening barrier to reads and writes of steps only.
                barrier.fromStages = stage::All;
                barrier.fromAccess = access::AllWrites;
            }
            if (relayout) {
                state.everythingVisible = false;
                state.writeStages = barrier.toStages;
                state.writeAccess = access::None;
                state.readStages = stage::None;
                state.visible = {};
                state.makeVisible(use);
            }
        } else {
            if (state.sees(use)) return;
            barrier.cause = Cause::ReadAfterWrite;
            state.makeVisible(use);
        }
        step.barriers.push_back(barrier);
    }

    void finish() {
        compiled_.exit.push_back(hostDependency());
        for (std::uint32_t i = 0; i < states_.size(); ++i) {
            const ResourceInput& resource = input_.resources[i];
            State& state = states_[i];
            if (!resource.imported || resource.kind != ResourceKind::Image || state.layout == Layout::General)
                continue;
            compiled_.exit.push_back({.resource = i,
                                      .fromStages = state.writeStages | state.readStages,
                                      .fromAccess = state.writeAccess,
                                      .toStages = stage::All,
                                      .toAccess = access::None,
                                      .oldLayout = state.layout,
                                      .newLayout = Layout::General,
                                      .cause = Cause::LayoutChange});
        }
    }

    const Input& input_;
    Compiled& compiled_;
    std::vector<State> states_;
    std::vector<const Placement*> placement_;
};

}  // namespace

Barrier hostDependency() {
    return {.fromStages = stage::All,
            .fromAccess = access::AllWrites,
            .toStages = stage::Host,
            .toAccess = access::HostRead | access::HostWrite,
            .cause = Cause::HostAccess};
}

void synchronize(const Input& input, Compiled& compiled) {
    Synchronizer(input, compiled).run();
}

}  // namespace helio::graph
