#include "engine/gpu/timestamps.hpp"

#include "engine/gpu/device_impl.hpp"

#include <cassert>

namespace helio::gpu {

double ticksToMilliseconds(std::uint64_t from, std::uint64_t to, std::uint32_t validBits,
                           double periodNanoseconds) {
    const std::uint64_t mask = validBits >= 64 ? ~0ull : (1ull << validBits) - 1;
    return double((to - from) & mask) * periodNanoseconds * 1e-6;
}

TimestampPool::TimestampPool(Device::Impl& gpu, std::uint32_t count)
    : validBits_(gpu.facts.queues[gpu.queue.family()].timestampValidBits),
      period_(gpu.limits().timestampPeriod) {
    if (validBits_ == 0 || count == 0) return;
    pool_ = translateErrors("creating timestamps", [&] {
        return vk::raii::QueryPool(
            gpu.device, vk::QueryPoolCreateInfo{.queryType = vk::QueryType::eTimestamp, .queryCount = count});
    });
    count_ = count;
    setName(gpu.device, *pool_, "timestamps");
}

void TimestampPool::reset(const vk::raii::CommandBuffer& commands) const {
    if (available()) commands.resetQueryPool(*pool_, 0, count_);
}

void TimestampPool::write(const vk::raii::CommandBuffer& commands, std::uint32_t index,
                          vk::PipelineStageFlags2 stage) const {
    assert(!available() || index < count_);
    if (available()) commands.writeTimestamp2(stage, *pool_, index);
}

std::vector<double> TimestampPool::milliseconds(std::uint32_t written) const {
    assert(!available() || written <= count_);
    if (!available() || written == 0) return {};
    return translateErrors("reading timestamps", [&] {
        const auto [result, ticks] = pool_.getResults<std::uint64_t>(
            0, written, written * sizeof(std::uint64_t), sizeof(std::uint64_t),
            vk::QueryResultFlagBits::e64 | vk::QueryResultFlagBits::eWait);
        if (result != vk::Result::eSuccess)
            throw DeviceError("timestamps were asked for before they were written");
        std::vector<double> times;
        for (const std::uint64_t tick : ticks) {
            times.push_back(ticksToMilliseconds(ticks.front(), tick, validBits_, period_));
        }
        return times;
    });
}

}  // namespace helio::gpu
