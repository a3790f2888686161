#include "engine/graph/build.hpp"

#include "engine/graph/compile.hpp"
#include "engine/graph/interface.hpp"
#include "engine/graph/plan_impl.hpp"
#include "engine/shader/spirv_trimmer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <map>

namespace helio::graph {
namespace {

std::uint64_t nextPlanSerial() {
    static std::atomic<std::uint64_t> serial{0};
    return ++serial;
}

/** Fills and copies move whole words. */
std::uint64_t allocatedBytes(const ResourceInput& resource) {
    return (resource.bytes + 3) / 4 * 4;
}

class Builder {
public:
    Builder(Graph::Impl& graph, const CompileOptions& options)
        : graph_(graph), options_(options), gpu_(*graph.device) {}

    std::unique_ptr<Plan::Impl> run() {
        makeInput();
        for (GraphProblem& problem : validate(input_)) problems_.push_back(std::move(problem));
        if (options_.executionsInFlight == 0)
            problems_.push_back({"", "", "", "CompileOptions::executionsInFlight is 0; give at least 1"});
        if (!problems_.empty()) throw GraphError(std::move(problems_));

        plan_ = std::make_unique<Plan::Impl>();
        plan_->device = &gpu_;
        plan_->serial = nextPlanSerial();
        plan_->graph = graph_.serial;
        plan_->compiled = graph::compile(input_);
        plan_->input = std::move(input_);
        plan_->objects.slots.resize(options_.executionsInFlight);
        makeResources();
        makePasses();
        plan_->readbacks = graph_.readbacks;
        for (const auto& readback : plan_->readbacks) readback->plans[plan_->serial] = plan_.get();
        return std::move(plan_);
    }

private:
    void makeInput() {
        input_.graph = graph_.serial;
        input_.alias = options_.alias;
        input_.poison = options_.poison;
        input_.readbacks = graph_.readbackInputs;
        input_.limits.bufferImageGranularity = gpu_.memory.bufferImageGranularity();
        input_.limits.maxArenaBytes = gpu_.facts.properties11.maxMemoryAllocationSize;
        for (const DeclaredResource& resource : graph_.resources) {
            input_.resources.push_back(resource.input);
            const Device::Impl* owner = resource.buffer  ? resource.buffer->device
                                        : resource.image ? resource.image->device
                                                         : &gpu_;
            if (owner != &gpu_)
                problems_.push_back({"", "", resource.input.name,
                                     "is imported from another device; make it on the graph's device"});
        }
        askMemory();
        for (const DeclaredPass& declared : graph_.passes) {
            PassInput pass{.name = declared.name, .accesses = {}, .keep = declared.keep};
            PassInterface interface;
            if (declared.kind == PassKind::Compute) {
                interface = checkInterface(graph_, declared, pass.accesses, problems_);
            } else {
                checkTransfer(declared, pass.accesses);
            }
            interfaces_.push_back(std::move(interface));
            input_.passes.push_back(std::move(pass));
        }
    }

    /** What transients need, and which of them can share memory at all. */
    void askMemory() {
        std::vector<std::uint32_t> types(input_.resources.size(), ~0u);
        std::uint32_t common = ~0u;
        for (std::size_t i = 0; i < input_.resources.size(); ++i) {
            ResourceInput& resource = input_.resources[i];
            const bool image = resource.kind == ResourceKind::Image;
            const bool sound =
                image ? resource.size[0] > 0 && resource.size[1] > 0 && resource.format != Format::Undefined
                      : resource.bytes > 0;
            if (resource.imported || !sound) continue;  // validate() speaks of the latter
            try {
                const vk::MemoryRequirements needed =
                    image ? gpu::imageRequirements(gpu_, resource.name, {resource.size[0], resource.size[1]},
                                                   gpu::vulkanFormat(resource.format))
                          : gpu::bufferRequirements(gpu_, resource.name, allocatedBytes(resource));
                resource.memoryBytes = needed.size;
                resource.alignment = needed.alignment;
                types[i] = needed.memoryTypeBits;
                common &= needed.memoryTypeBits;
            } catch (const DeviceError& error) {
                problems_.push_back(
                    {"", "", resource.name, fmt::format("{}; make it smaller or split it", error.what())});
            }
        }
        const bool together =
            gpu::chooseMemoryType(gpu_.facts.memory, common, gpu::MemoryUse::Device, gpu_.memory.unified())
                .has_value();
        std::map<std::uint32_t, std::uint32_t> classes;
        for (std::size_t i = 0; i < types.size(); ++i) {
            const std::uint32_t bits = together ? common : types[i];
            const auto [entry, isNew] = classes.try_emplace(bits, std::uint32_t(classTypes_.size()));
            if (isNew) classTypes_.push_back(bits);
            input_.resources[i].memoryClass = entry->second;
        }
    }

    void checkTransfer(const DeclaredPass& pass, std::vector<AccessInput>& accesses) {
        const auto access = [](const Binding& binding, Mode mode, Usage usage) {
            return AccessInput{binding.name, binding.resource, binding.graph, mode, usage, binding.window};
        };
        const auto bytesOf = [&](const Binding& binding) -> std::uint64_t {
            return binding.graph == graph_.serial && binding.resource < graph_.resources.size()
                       ? graph_.resources[binding.resource].input.bytes
                       : 0;
        };
        const auto nameOf = [&](const Binding& binding) {
            return graph_.resources[binding.resource].input.name;
        };
        if (pass.kind == PassKind::Fill) {
            const Binding& target = pass.bindings[0].binding;
            accesses.push_back(access(target, Mode::Overwrite, Usage::Fill));
            if (bytesOf(target) % 4 != 0 && graph_.resources[target.resource].buffer)
                problems_.push_back(
                    {pass.name, "", nameOf(target),
                     fmt::format("is filled by words but has {} bytes; make it a multiple of 4",
                                 bytesOf(target))});
            return;
        }
        const Binding& source = pass.bindings[0].binding;
        const Binding& target = pass.bindings[1].binding;
        const bool whole = bytesOf(source) == bytesOf(target);
        accesses.push_back(access(source, Mode::Read, Usage::CopySource));
        accesses.push_back(access(target, whole ? Mode::Overwrite : Mode::Write, Usage::CopyDestination));
        if (bytesOf(target) < bytesOf(source) && bytesOf(target) > 0)
            problems_.push_back(
                {pass.name, "to", nameOf(target),
                 fmt::format("has {} bytes but {} are copied to it; make it at least as large",
                             bytesOf(target), bytesOf(source))});
    }

    void makeResources() {
        PlanObjects& objects = plan_->objects;
        std::vector<std::uint64_t> alignment(plan_->compiled.arenas.size(), 1);
        std::vector<const Placement*> largest(plan_->compiled.arenas.size(), nullptr);
        for (const Placement& placement : plan_->compiled.placements) {
            const std::uint32_t arena = placement.arena;
            alignment[arena] =
                std::max(alignment[arena], plan_->input.resources[placement.resource].alignment);
            if (!largest[arena] || placement.bytes > largest[arena]->bytes) largest[arena] = &placement;
        }
        for (std::size_t i = 0; i < plan_->compiled.arenas.size(); ++i) {
            const Arena& arena = plan_->compiled.arenas[i];
            objects.arenas.push_back(
                gpu_.memory.allocate({.name = fmt::format("transients of a plan, the largest of which is {}",
                                                          plan_->input.resources[largest[i]->resource].name),
                                      .bytes = arena.bytes,
                                      .alignment = alignment[i],
                                      .typeBits = classTypes_[arena.memoryClass],
                                      .use = gpu::MemoryUse::Device,
                                      .content = gpu::MemoryContent::Mixed}));
        }
        plan_->resources.resize(plan_->input.resources.size());
        views_.resize(plan_->input.resources.size());
        buffers_.resize(plan_->input.resources.size(), nullptr);
        // Pointers into these are kept below.
        objects.buffers.reserve(plan_->compiled.placements.size());
        objects.images.reserve(plan_->compiled.placements.size());
        for (const Placement& placement : plan_->compiled.placements) {
            const ResourceInput& resource = plan_->input.resources[placement.resource];
            const gpu::Allocation& arena = objects.arenas[placement.arena];
            if (resource.kind == ResourceKind::Image) {
                objects.images.push_back(
                    gpu::placeImage(gpu_, resource.name, {resource.size[0], resource.size[1]},
                                    gpu::vulkanFormat(resource.format), arena, placement.offset));
                refer(placement.resource, objects.images.back());
            } else {
                objects.buffers.push_back(
                    gpu::placeBuffer(gpu_, resource.name, allocatedBytes(resource), arena, placement.offset));
                refer(placement.resource, objects.buffers.back());
            }
        }
        for (std::uint32_t i = 0; i < graph_.resources.size(); ++i) {
            if (graph_.resources[i].buffer) refer(i, graph_.resources[i].buffer->resource);
            if (graph_.resources[i].image) refer(i, graph_.resources[i].image->resource);
        }
    }

    void refer(std::uint32_t resource, const gpu::BufferResource& buffer) {
        plan_->resources[resource].buffer = *buffer.buffer;
        buffers_[resource] = &buffer;
    }
    void refer(std::uint32_t resource, const gpu::ImageResource& image) {
        plan_->resources[resource].image = *image.image;
        views_[resource] = *image.view;
    }

    void makePasses() {
        plan_->passes.resize(graph_.passes.size());
        plan_->objects.sets.resize(graph_.passes.size());
        for (const Step& step : plan_->compiled.steps)
            if (step.kind == StepKind::Pass) makePass(step);
    }

    void makePass(const Step& step) {
        const DeclaredPass& declared = graph_.passes[step.index];
        PlanPass& pass = plan_->passes[step.index];
        pass.name = declared.name;
        pass.kind = declared.kind;
        pass.recorder = declared.recorder;
        pass.word = declared.word;
        for (const Buffer& buffer : declared.indirect) pass.indirect.push_back(buffer.id);
        if (pass.kind != PassKind::Compute) {
            pass.source = declared.bindings.front().binding.resource;
            pass.target = declared.bindings.back().binding.resource;
            return;
        }
        const PassInterface& interface = interfaces_[step.index];
        pass.localSize = interface.localSize;
        pass.pushBytes = interface.reflection->pushConstants.bytes;

        gpu::ComputePipelineInfo info{.name = fmt::format("{} ({})", declared.name, declared.kernel.name),
                                      .spirv = declared.kernel.spirv,
                                      .bindings = {},
                                      .pushConstantBytes = pass.pushBytes,
                                      .spec = interface.spec};
        if (info.spirv.size_bytes() >= kWorthSpecializing) info.specialize = specializedSpirv;
        std::vector<gpu::DescriptorWrite> writes;
        for (const BoundResource& bound : interface.bindings) {
            info.bindings.push_back(
                {.binding = bound.slot->binding, .type = descriptorType(bound.slot->kind)});
            writes.push_back(describe(bound, step));
        }
        // In one order, whatever the order of declaration: equal kernels share a pipeline.
        std::sort(info.bindings.begin(), info.bindings.end(),
                  [](const gpu::BindingSlot& a, const gpu::BindingSlot& b) { return a.binding < b.binding; });
        pass.pipeline = gpu_.pipelines.get(info);
        plan_->objects.pipelines.push_back(pass.pipeline);
        plan_->objects.sets[step.index] = gpu::DescriptorSet(gpu_, *pass.pipeline, writes);
    }

    static vk::DescriptorType descriptorType(BindingKind kind) {
        switch (kind) {
            case BindingKind::StorageBuffer:
                return vk::DescriptorType::eStorageBuffer;
            case BindingKind::UniformBuffer:
                return vk::DescriptorType::eUniformBuffer;
            case BindingKind::UniformTexelBuffer:
                return vk::DescriptorType::eUniformTexelBuffer;
            case BindingKind::StorageTexelBuffer:
                return vk::DescriptorType::eStorageTexelBuffer;
            case BindingKind::StorageImage:
                return vk::DescriptorType::eStorageImage;
            case BindingKind::SampledImage:
                return vk::DescriptorType::eCombinedImageSampler;
        }
        return vk::DescriptorType::eStorageBuffer;
    }

    gpu::DescriptorWrite describe(const BoundResource& bound, const Step& step) {
        gpu::DescriptorWrite write{.binding = bound.slot->binding};
        switch (bound.slot->kind) {
            case BindingKind::StorageBuffer:
            case BindingKind::UniformBuffer:
                write.buffer = plan_->resources[bound.resource].buffer;
                write.offset = bound.offset;
                write.range = bound.bytes;
                break;
            case BindingKind::UniformTexelBuffer:
            case BindingKind::StorageTexelBuffer:
                plan_->objects.views.push_back(gpu::createTexelView(gpu_, *buffers_[bound.resource],
                                                                    gpu::vulkanFormat(bound.view),
                                                                    bound.offset, bound.bytes));
                write.texelView = *plan_->objects.views.back();
                break;
            case BindingKind::SampledImage:
                write.sampler = sampler(bound.sampling);
                [[fallthrough]];
            case BindingKind::StorageImage:
                write.imageView = views_[bound.resource];
                for (const Use& use : step.uses)
                    if (use.resource == bound.resource) write.imageLayout = vulkanLayout(use.layout);
                break;
        }
        return write;
    }

    vk::Sampler sampler(Sampling sampling) {
        const auto [entry, isNew] = samplers_.try_emplace(sampling, plan_->objects.samplers.size());
        if (isNew) {
            const bool linear = sampling == Sampling::Linear;
            plan_->objects.samplers.emplace_back(
                gpu_.device,
                vk::SamplerCreateInfo{.magFilter = linear ? vk::Filter::eLinear : vk::Filter::eNearest,
                                      .minFilter = linear ? vk::Filter::eLinear : vk::Filter::eNearest,
                                      .mipmapMode = vk::SamplerMipmapMode::eNearest,
                                      .addressModeU = vk::SamplerAddressMode::eClampToEdge,
                                      .addressModeV = vk::SamplerAddressMode::eClampToEdge,
                                      .addressModeW = vk::SamplerAddressMode::eClampToEdge});
        }
        return *plan_->objects.samplers[entry->second];
    }

    Graph::Impl& graph_;
    const CompileOptions& options_;
    Device::Impl& gpu_;
    Input input_;
    std::vector<PassInterface> interfaces_;  ///< by pass
    std::vector<GraphProblem> problems_;
    std::vector<std::uint32_t> classTypes_;  ///< memory type bits of each memory class
    std::unique_ptr<Plan::Impl> plan_;
    std::vector<vk::ImageView> views_;                 ///< by resource
    std::vector<const gpu::BufferResource*> buffers_;  ///< by resource
    std::map<Sampling, std::size_t> samplers_;
};

}  // namespace

Plan buildPlan(Graph::Impl& graph, const CompileOptions& options) {
    return gpu::translateErrors("compiling a graph", [&] { return Plan(Builder(graph, options).run()); });
}

}  // namespace helio::graph
