#pragma once
/** @file What a compiled plan holds. */
#include "engine/graph/compile.hpp"
#include "engine/graph/declaration.hpp"
#include "engine/graph/translate.hpp"

#include <deque>
#include <optional>

namespace helio::graph {

/** A compute pass, ready to record. */
struct PlanPass {
    std::string name;
    PassKind kind = PassKind::Compute;
    std::function<void(Commands&)> recorder;
    std::vector<std::uint32_t> indirect;  ///< buffers the pass may take workgroup counts from
    std::array<std::uint32_t, 3> localSize = {1, 1, 1};
    std::uint32_t pushBytes = 0;
    std::shared_ptr<const gpu::ComputePipeline> pipeline;
    std::uint32_t word = 0;                      ///< of a fill
    std::uint32_t source = none, target = none;  ///< of a copy; the target of a fill too
};

/** What one execution in flight needs of its own. Made at its first use. */
struct Slot {
    Execution execution;
    gpu::TimestampPool stamps;
    std::vector<gpu::BufferResource> readbacks;
    bool made = false;
};

/** Device objects, which outlive the plan until the last execution is done. Destroyed from last to first. */
struct PlanObjects {
    std::vector<gpu::Allocation> arenas;
    std::vector<gpu::BufferResource> buffers;
    std::vector<gpu::ImageResource> images;
    std::vector<vk::raii::BufferView> views;
    std::vector<vk::raii::Sampler> samplers;
    std::vector<std::shared_ptr<const gpu::ComputePipeline>> pipelines;
    std::vector<gpu::DescriptorSet> sets;  ///< by pass of the declaration
    std::vector<Slot> slots;
};

}  // namespace helio::graph

namespace helio {

struct Plan::Impl {
    ~Impl();
    Execution execute();
    void record(const vk::raii::CommandBuffer& commands, graph::Slot& slot);
    void recordStep(const vk::raii::CommandBuffer& commands, const graph::Step& step, graph::Slot& slot);
    void recordCompute(const vk::raii::CommandBuffer& commands, std::uint32_t pass);
    void recordPoison(const vk::raii::CommandBuffer& commands, std::uint32_t resource);
    void recordReadback(const vk::raii::CommandBuffer& commands, std::uint32_t readback, graph::Slot& slot);
    void makeSlot(graph::Slot& slot);
    /** The slot that holds the execution; null where later ones took it. */
    const graph::Slot* slotOf(const Execution& execution) const;
    std::vector<PassTiming> readTimings(const graph::Slot& slot) const;
    std::string stepName(const graph::Step& step) const;
    /** Throws GraphError for a token of another plan or of no execution. */
    void checkToken(const Execution& execution) const;

    static constexpr std::size_t keptTimings = 8;

    Device::Impl* device = nullptr;
    std::uint64_t serial = 0;
    std::uint32_t graph = 0;  ///< serial of the graph
    std::uint64_t executions = 0;
    graph::Input input;
    graph::Compiled compiled;
    std::vector<graph::PlanPass> passes;
    std::vector<graph::VulkanResource> resources;
    std::vector<std::shared_ptr<ReadbackBytes::Impl>> readbacks;
    graph::PlanObjects objects;
    std::deque<std::pair<std::uint64_t, std::vector<PassTiming>>>
        timings;  ///< of executions whose slot was taken
};

/** Recording of one compute pass. */
struct Commands::Impl {
    const Plan::Impl& plan;
    const graph::PlanPass& pass;
    const vk::raii::CommandBuffer& commands;
    bool pushed = false;
};

}  // namespace helio
