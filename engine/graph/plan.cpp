#include "engine/graph/plan_impl.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace helio {

using graph::PassKind;
using graph::ResourceKind;
using graph::Slot;
using graph::Step;
using graph::StepKind;

namespace {

/** Word that poison fills with: a quiet NaN as a float, and unlikely as an integer. */
constexpr std::uint32_t poisonWord = 0x7fc0deadu;

[[noreturn]] void refuse(std::string pass, std::string resource, std::string message) {
    throw GraphError({{std::move(pass), "", std::move(resource), std::move(message)}});
}

}  // namespace

Plan::Impl::~Impl() {
    for (const auto& readback : readbacks) readback->plans.erase(serial);
    // Executions may still run: what they use goes when they are done.
    if (device) device->queue.retire(std::move(objects));
}

void Plan::Impl::checkToken(const Execution& execution) const {
    if (execution.plan != serial || execution.serial == 0 || execution.serial > executions)
        refuse("", "", "the token is no execution of this plan; use what this plan's execute() returned");
}

std::string Plan::Impl::stepName(const Step& step) const {
    switch (step.kind) {
        case StepKind::Pass:
            return passes[step.index].name;
        case StepKind::Poison:
            return "poison " + input.resources[step.index].name;
        case StepKind::Readback:
            return "readback " + input.resources[input.readbacks[step.index].resource].name;
    }
    return {};
}

void Plan::Impl::makeSlot(Slot& slot) {
    if (slot.made) return;
    slot.stamps = gpu::TimestampPool(*device, std::uint32_t(compiled.steps.size() + 1));
    slot.readbacks.clear();
    for (const graph::ReadbackInput& readback : input.readbacks) {
        const graph::ResourceInput& resource = input.resources[readback.resource];
        const std::uint64_t bytes =
            resource.kind == ResourceKind::Image
                ? std::uint64_t(resource.size[0]) * resource.size[1] * formatBytes(resource.format)
                : resource.bytes;
        slot.readbacks.push_back(gpu::createBuffer(*device, "readback of " + resource.name, bytes,
                                                   gpu::MemoryUse::Readback,
                                                   vk::BufferUsageFlagBits::eTransferDst));
    }
    slot.made = true;
}

Execution Plan::Impl::execute() {
    Slot& slot = objects.slots[executions % objects.slots.size()];
    if (slot.execution.serial != 0) {
        device->queue.wait(slot.execution.value);
        timings.emplace_back(slot.execution.serial, readTimings(slot));
        if (timings.size() > keptTimings) timings.pop_front();
        slot.execution = {};
    }
    makeSlot(slot);
    gpu::Recording recording = device->queue.begin(fmt::format("plan {}", serial));
    record(*recording, slot);
    const std::uint64_t value = device->queue.submit(std::move(recording), true);
    slot.execution = {.value = value, .serial = ++executions, .plan = serial};
    return slot.execution;
}

void Plan::Impl::record(const vk::raii::CommandBuffer& commands, Slot& slot) {
    slot.stamps.reset(commands);
    graph::recordBarriers(commands, compiled.entry, resources);
    slot.stamps.write(commands, 0);
    for (std::uint32_t i = 0; i < compiled.steps.size(); ++i) {
        graph::recordBarriers(commands, compiled.steps[i].barriers, resources);
        recordStep(commands, compiled.steps[i], slot);
        slot.stamps.write(commands, i + 1);
    }
    graph::recordBarriers(commands, compiled.exit, resources);
}

void Plan::Impl::recordStep(const vk::raii::CommandBuffer& commands, const Step& step, Slot& slot) {
    if (step.kind == StepKind::Poison) return recordPoison(commands, step.index);
    if (step.kind == StepKind::Readback) return recordReadback(commands, step.index, slot);
    const graph::PlanPass& pass = passes[step.index];
    switch (pass.kind) {
        case PassKind::Compute:
            return recordCompute(commands, step.index);
        case PassKind::Fill:
            return commands.fillBuffer(resources[pass.target].buffer, 0, VK_WHOLE_SIZE, pass.word);
        case PassKind::Copy:
            return commands.copyBuffer(resources[pass.source].buffer, resources[pass.target].buffer,
                                       vk::BufferCopy{.size = input.resources[pass.source].bytes});
    }
}

void Plan::Impl::recordCompute(const vk::raii::CommandBuffer& commands, std::uint32_t index) {
    const graph::PlanPass& pass = passes[index];
    commands.bindPipeline(vk::PipelineBindPoint::eCompute, *pass.pipeline->pipeline);
    if (const vk::DescriptorSet set = objects.sets[index].handle())
        commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *pass.pipeline->layout, 0, set, {});
    Commands::Impl recording{*this, pass, commands};
    Commands recorder(recording);
    pass.recorder(recorder);
}

void Plan::Impl::recordPoison(const vk::raii::CommandBuffer& commands, std::uint32_t index) {
    const graph::ResourceInput& resource = input.resources[index];
    if (resource.kind == ResourceKind::Buffer)
        return commands.fillBuffer(resources[index].buffer, 0, VK_WHOLE_SIZE, poisonWord);
    vk::ClearColorValue value;
    switch (resource.format) {
        case Format::R32UI:
        case Format::RG32UI:
        case Format::RGBA32UI:
        case Format::R32I:
            value.setUint32({poisonWord, poisonWord, poisonWord, poisonWord});
            break;
        // Normalised formats have no NaN: a colour that nobody means.
        case Format::RGBA8:
        case Format::R8:
            value.setFloat32({1.0f, 0.0f, 1.0f, 0.5f});
            break;
        default: {
            const float nan = std::bit_cast<float>(poisonWord);
            value.setFloat32({nan, nan, nan, nan});
        }
    }
    const vk::ImageSubresourceRange all{
        .aspectMask = vk::ImageAspectFlagBits::eColor, .levelCount = 1, .layerCount = 1};
    commands.clearColorImage(resources[index].image, vk::ImageLayout::eTransferDstOptimal, value, all);
}

void Plan::Impl::recordReadback(const vk::raii::CommandBuffer& commands, std::uint32_t index, Slot& slot) {
    const std::uint32_t id = input.readbacks[index].resource;
    const graph::ResourceInput& resource = input.resources[id];
    const vk::Buffer target = *slot.readbacks[index].buffer;
    if (resource.kind == ResourceKind::Buffer)
        return commands.copyBuffer(resources[id].buffer, target, vk::BufferCopy{.size = resource.bytes});
    commands.copyImageToBuffer(
        resources[id].image, vk::ImageLayout::eTransferSrcOptimal, target,
        vk::BufferImageCopy{
            .imageSubresource = {.aspectMask = vk::ImageAspectFlagBits::eColor, .layerCount = 1},
            .imageExtent = {resource.size[0], resource.size[1], 1}});
}

const Slot* Plan::Impl::slotOf(const Execution& execution) const {
    for (const Slot& slot : objects.slots)
        if (slot.execution.serial == execution.serial) return &slot;
    return nullptr;
}

std::vector<PassTiming> Plan::Impl::readTimings(const Slot& slot) const {
    const std::vector<double> times = slot.stamps.milliseconds(std::uint32_t(compiled.steps.size() + 1));
    std::vector<PassTiming> result;
    for (std::size_t i = 0; i + 1 < times.size(); ++i)
        result.push_back({stepName(compiled.steps[i]), times[i + 1] - times[i]});
    return result;
}

Plan::Plan() = default;
Plan::Plan(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Plan::~Plan() = default;
Plan::Plan(Plan&&) noexcept = default;
Plan& Plan::operator=(Plan&&) noexcept = default;

Execution Plan::execute() {
    assert(impl_ && "an empty plan cannot be executed");
    return gpu::translateErrors("executing a plan", [&] { return impl_->execute(); });
}

void Plan::wait(const Execution& execution) const {
    impl_->checkToken(execution);
    impl_->device->queue.wait(execution.value);
}

std::vector<PassTiming> Plan::timings(const Execution& execution) const {
    wait(execution);
    if (const Slot* slot = impl_->slotOf(execution)) return impl_->readTimings(*slot);
    for (const auto& [serial, times] : impl_->timings)
        if (serial == execution.serial) return times;
    refuse("", "",
           fmt::format("the times of execution {} are gone; ask within the next {}", execution.serial,
                       Impl::keptTimings));
}

AliasingStatistics Plan::aliasing() const {
    return impl_->compiled.aliasing;
}

std::vector<std::string> Plan::passes() const {
    std::vector<std::string> names;
    for (const Step& step : impl_->compiled.steps)
        if (step.kind == StepKind::Pass) names.push_back(impl_->passes[step.index].name);
    return names;
}

std::vector<std::string> Plan::culled() const {
    std::vector<std::string> names;
    for (const graph::CulledPass& culled : impl_->compiled.culledPasses)
        names.push_back(impl_->input.passes[culled.pass].name);
    return names;
}

std::string Plan::graphviz() const {
    return graph::dumpGraphviz(impl_->input, impl_->compiled);
}
std::string Plan::json() const {
    return graph::dumpJson(impl_->input, impl_->compiled);
}

ReadbackBytes::ReadbackBytes() = default;

std::vector<std::byte> ReadbackBytes::wait(const Execution& execution) const {
    assert(impl_ && "an empty readback cannot be waited for");
    const auto found = impl_->plans.find(execution.plan);
    if (found == impl_->plans.end())
        refuse("", impl_->resource,
               "the readback is of no living plan of this token; keep the plan until the readback is taken");
    const Plan::Impl& plan = *found->second;
    plan.checkToken(execution);
    const Slot* slot = plan.slotOf(execution);
    if (!slot)
        refuse("", impl_->resource,
               fmt::format(
                   "later executions took the memory of execution {}; take it before {} more are started, or "
                   "raise CompileOptions::executionsInFlight",
                   execution.serial, plan.objects.slots.size()));
    plan.device->queue.wait(execution.value);
    const gpu::BufferResource& buffer = slot->readbacks[impl_->index];
    return {buffer.mapped, buffer.mapped + buffer.bytes};
}

}  // namespace helio
