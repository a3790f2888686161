#pragma once
/** @file Device timestamps. */
#include "engine/gpu/vk.hpp"

#include <heliograph/device.hpp>

#include <cstdint>
#include <vector>

namespace helio::gpu {

/** Milliseconds from tick `from` to tick `to` of a counter of `validBits` bits that may have wrapped once. */
double ticksToMilliseconds(std::uint64_t from, std::uint64_t to, std::uint32_t validBits,
                           double periodNanoseconds);

/** A fixed number of timestamps. Does nothing on a device without them (available() is false). */
class TimestampPool {
public:
    TimestampPool() = default;
    TimestampPool(Device::Impl& gpu, std::uint32_t count);

    bool available() const { return count_ > 0; }
    std::uint32_t count() const { return count_; }
    /** To be recorded before the first write of a recording, outside of rendering. */
    void reset(const vk::raii::CommandBuffer& commands) const;
    /** Notes the time when all commands before have finished `stage`. */
    void write(const vk::raii::CommandBuffer& commands, std::uint32_t index,
               vk::PipelineStageFlags2 stage = vk::PipelineStageFlagBits2::eAllCommands) const;
    /** The first `written` times in milliseconds after the first of them. The submission must be done. */
    std::vector<double> milliseconds(std::uint32_t written) const;

private:
    vk::raii::QueryPool pool_ = nullptr;
    std::uint32_t count_ = 0;
    std::uint32_t validBits_ = 0;
    double period_ = 1;  // nanoseconds per tick
};

}  // namespace helio::gpu
