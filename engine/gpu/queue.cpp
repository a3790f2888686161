#include "engine/gpu/queue.hpp"

#include "engine/gpu/names.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

namespace helio::gpu {

struct Recording::Slot {
    vk::raii::CommandPool pool;
    vk::raii::CommandBuffer commands;
};

Recording::Recording(Queue* queue, std::unique_ptr<Slot> slot) : queue_(queue), slot_(std::move(slot)) {}
Recording::Recording(Recording&& other) noexcept = default;
Recording::~Recording() {
    if (slot_) queue_->recycle(std::move(slot_));
}
const vk::raii::CommandBuffer& Recording::operator*() const {
    assert(slot_);
    return slot_->commands;
}

Queue::Queue(const vk::raii::Device& device, std::uint32_t family)
    : device_(device), family_(family), queue_(device, family, 0), timeline_(nullptr) {
    const vk::StructureChain<vk::SemaphoreCreateInfo, vk::SemaphoreTypeCreateInfo> info{
        {}, {.semaphoreType = vk::SemaphoreType::eTimeline, .initialValue = 0}};
    timeline_ = vk::raii::Semaphore(device, info.get());
    setName(device, *timeline_, "timeline");
}

Queue::~Queue() {
    try {
        waitIdle();
    } catch (const Error&) {
        // A lost device: nothing runs any more, so everything may go.
    }
}

Recording Queue::begin(std::string_view name) {
    return translateErrors("recording commands", [&] {
        std::unique_ptr<Recording::Slot> slot;
        {
            const std::lock_guard lock(mutex_);
            if (!idle_.empty()) {
                slot = std::move(idle_.back());
                idle_.pop_back();
            }
        }
        if (slot) {
            slot->pool.reset();
        } else {
            vk::raii::CommandPool pool(
                device_, {.flags = vk::CommandPoolCreateFlagBits::eTransient, .queueFamilyIndex = family_});
            vk::raii::CommandBuffers buffers(
                device_,
                {.commandPool = *pool, .level = vk::CommandBufferLevel::ePrimary, .commandBufferCount = 1});
            slot.reset(new Recording::Slot{std::move(pool), std::move(buffers.front())});
        }
        if (!name.empty()) setName(device_, *slot->commands, name);
        slot->commands.begin({.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
        return Recording(this, std::move(slot));
    });
}

std::uint64_t Queue::submit(Recording recording, bool forHost) {
    const vk::raii::CommandBuffer& commands = *recording;
    const std::uint64_t value = translateErrors("submitting to the device", [&] {
        commands.end();
        const std::lock_guard lock(mutex_);
        const std::uint64_t previous = submitted_;
        const vk::SemaphoreSubmitInfo wait{.semaphore = *timeline_,
                                           .value = previous,
                                           .stageMask = vk::PipelineStageFlagBits2::eAllCommands};
        const vk::SemaphoreSubmitInfo signal{.semaphore = *timeline_,
                                             .value = previous + 1,
                                             .stageMask = vk::PipelineStageFlagBits2::eAllCommands};
        const vk::CommandBufferSubmitInfo buffer{.commandBuffer = *commands};
        queue_.submit2(vk::SubmitInfo2{.waitSemaphoreInfoCount = previous > 0 ? 1u : 0u,
                                       .pWaitSemaphoreInfos = &wait,
                                       .commandBufferInfoCount = 1,
                                       .pCommandBufferInfos = &buffer,
                                       .signalSemaphoreInfoCount = 1,
                                       .pSignalSemaphoreInfos = &signal});
        submitted_ = previous + 1;
        if (forHost) forHost_ = previous + 1;
        running_.emplace_back(previous + 1, std::move(recording.slot_));
        return previous + 1;
    });
    collect();
    return value;
}

bool Queue::done(std::uint64_t value) const {
    if (value <= reached_) return true;
    reached_ =
        translateErrors("asking the device how far it is", [&] { return timeline_.getCounterValue(); });
    return value <= reached_;
}

void Queue::wait(std::uint64_t value) {
    assert(value <= submitted_);
    if (!done(value)) {
        translateErrors("waiting for the device", [&] {
            const vk::Semaphore semaphore = *timeline_;
            const vk::SemaphoreWaitInfo info{
                .semaphoreCount = 1, .pSemaphores = &semaphore, .pValues = &value};
            while (device_.waitSemaphores(info, std::numeric_limits<std::uint64_t>::max()) ==
                   vk::Result::eTimeout) {
            }
        });
    }
    collect();
}

void Queue::retireShared(std::shared_ptr<void> object) {
    {
        const std::lock_guard lock(mutex_);
        retired_.emplace_back(submitted_, std::move(object));
    }
    try {
        collect();
    } catch (const Error&) {
        // A lost device; called from destructors. The object goes with the queue.
    }
}

void Queue::collect() {
    // Objects are destroyed outside the lock: their destructors may retire others.
    std::vector<std::shared_ptr<void>> dead;
    {
        const std::lock_guard lock(mutex_);
        while (!running_.empty() && done(running_.front().first)) {
            idle_.push_back(std::move(running_.front().second));
            running_.pop_front();
        }
        while (!retired_.empty() && done(retired_.front().first)) {
            dead.push_back(std::move(retired_.front().second));
            retired_.pop_front();
        }
    }
}

void Queue::recycle(std::unique_ptr<Recording::Slot> slot) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(slot));
}

}  // namespace helio::gpu
